"""Forwards the reference cam switches to their axes.

The switches are wired to the digital inputs called `cams`, axis n to channel n. The level is passed on as it
is: whether TRUE or FALSE means operated is the axis parameter P-AXIS-00038.
"""

from hli_bench.plc import Plc


class HomingCam(Plc):
    """Channel n of the terminal `cams` to axis n, for every axis in `axes`."""

    period_us = 1000
    axes = (1, 2, 3, 4, 5, 6)

    def start(self, hli, io):
        for number in self.axes:
            axis = hli.ax[number]
            axis.head.plc_present_w = True
            axis.lr_mc_control.release_feedhold.enable_w = True
            axis.lr_mc_control.release_feedhold.command_w = True
            axis.lr_mc_control.reference_cam.enable_w = True
        self.switch = {number: getattr(io.cams, f"ch{number}") for number in self.axes}

    def cycle(self, hli, io):
        for number, switch in self.switch.items():
            hli.ax[number].lr_mc_control.reference_cam.command_w = switch.input
