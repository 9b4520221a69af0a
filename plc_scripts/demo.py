"""The PLC of the machine `demo`: touch probe and reference cams to the axes X Y Z X2 A B (1 to 6).

Terminals: `probe`, an EL1252 with the touch probe on channel 2; `cams`, digital inputs with the cam switch of
axis n on channel n.
"""

from hli_bench.plc import Plc


class Demo(Plc):
    """Releases the feed of all axes and forwards probe level, time of its last edge, and cams."""

    period_us = 1000
    axes = (1, 2, 3, 4, 5, 6)
    spindle = 7

    def start(self, hli, io):
        for number in (*self.axes, self.spindle):
            axis = hli.ax[number]
            axis.head.plc_present_w = True
            axis.lr_mc_control.release_feedhold.enable_w = True
            axis.lr_mc_control.release_feedhold.command_w = True
        for number in self.axes:
            axis = hli.ax[number].lr_mc_control
            axis.probing_signal.enable_w = True
            axis.timestamp.enable_w = True
            axis.reference_cam.enable_w = True
        self.switch = {number: getattr(io.cams, f"ch{number}") for number in self.axes}

    def cycle(self, hli, io):
        probe = io.probe.ch2
        level = probe.input
        edge_ns = probe.latch_pos if level else probe.latch_neg
        for number, switch in self.switch.items():
            axis = hli.ax[number].lr_mc_control
            axis.probing_signal.command_w = level
            axis.timestamp.command_w = edge_ns
            axis.reference_cam.command_w = switch.input
