"""Forwards a touch probe to the measurement axes: its level and the time of its last edge.

The probe is wired to channel 2 of the EL1252 called `probe` (measurement manual 7.4). The level serves the
signal source PLC, level and time together serve PLC_TIMESTAMP: both control units must be enabled.
"""

from hli_bench.plc import Plc


class Probing(Plc):
    """Channel 2 of the terminal `probe` to every axis in `axes`."""

    period_us = 1000
    axes = (1, 2, 3, 4, 5, 6)

    def start(self, hli, io):
        for number in self.axes:
            axis = hli.ax[number]
            axis.head.plc_present_w = True
            axis.lr_mc_control.release_feedhold.enable_w = True
            axis.lr_mc_control.release_feedhold.command_w = True
            axis.lr_mc_control.probing_signal.enable_w = True
            axis.lr_mc_control.timestamp.enable_w = True

    def cycle(self, hli, io):
        probe = io.probe.ch2
        level = probe.input
        edge_ns = probe.latch_pos if level else probe.latch_neg
        for number in self.axes:
            axis = hli.ax[number].lr_mc_control
            axis.probing_signal.command_w = level
            axis.timestamp.command_w = edge_ns
