"""The touch probe to the axes of this machine."""

from hli_bench.plc import Plc


class Probing(Plc):
    """Channel 2 of the terminal `probe` to X, Y and Z."""

    period_us = 1000
    axes = (1, 2, 3)

    def start(self, hli, io):
        for number in self.axes:
            axis = hli.ax[number]
            axis.head.plc_present_w = True
            axis.lr_mc_control.probing_signal.enable_w = True
            axis.lr_mc_control.timestamp.enable_w = True

    def cycle(self, hli, io):
        probe = io.probe.ch2
        level, edge_ns = probe.input, probe.latch_pos
        for number in self.axes:
            axis = hli.ax[number].lr_mc_control
            axis.probing_signal.command_w = level
            axis.timestamp.command_w = edge_ns
