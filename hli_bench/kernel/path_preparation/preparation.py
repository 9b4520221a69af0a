"""The look-ahead as the channel commands it; its numbers are the compiled `put_segment`."""

import math
from collections.abc import Mapping

import numpy as np

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import TENTH_UM_PER_MM, tenth_um_per_s
from hli_bench.kernel.blocks import Line, MeasuringRun
from hli_bench.kernel.path_preparation import dynamics
from hli_bench.kernel.path_preparation.dynamics import Ramp
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import SEGMENTS, KernelRows, Rows
from hli_bench.laws.segments import NOTHING, put_segment


class Preparation:
    """Writes the segment ring of the kernel rows; knows where the prepared path ends."""

    def __init__(self, setup: KernelSetup, rows: KernelRows) -> None:
        self._setup = setup
        self._rows = rows
        measuring = [dynamics.measuring(axis, setup.channel) for axis in setup.axes]
        self._rapid = dynamics.rows(dynamics.rapid(axis, setup.channel) for axis in setup.axes)
        self._feed = dynamics.rows(dynamics.feed(axis, setup.channel) for axis in setup.axes)
        self._measuring = dynamics.rows(profile for profile, _ in measuring)
        self._behind_event = [ramp for _, ramp in measuring]
        self._target = np.empty(len(setup.axes))
        rows.plan["linear"] = [axis.kind == "T" for axis in setup.axes]

    def synchronise(self) -> None:
        """Begin anew where the set points are (after a stop, a measuring run, homing)."""
        self._rows.plan["end"] = self._rows.axis["command"]
        self._rows.plan["joined"] = 0

    @property
    def room(self) -> int:
        """Segments that can still be put."""
        path = self._rows.path[0]
        return int(SEGMENTS - 1 - (path["tail"] - path["head"]))

    def line(self, block: Line) -> int | None:
        """Put a block of straight motion; return its segment number, None when it moves nothing."""
        may = self._rapid if block.rapid else self._feed
        return self._put(block.target, tenth_um_per_s(block.feed), may, rapid=block.rapid)

    def measuring_run(
        self, block: MeasuringRun, feed: float, offsets: Mapping[AxisIndex, float]
    ) -> tuple[int, float] | None:
        """Put a measuring run with `feed` (0.1 um/s); return (segment number, path to the target in 0.1 um).

        `offsets` (0.1 um) is how far past the target an axis may go while nothing was probed
        (P-AXIS-00467). Returns None when the block moves nothing.
        """
        number = self._put(block.target, feed, self._measuring, rapid=False)
        if number is None:
            return None
        segment = self._rows.segment[number % SEGMENTS]
        length = float(segment["length"])
        moved = [i for i, offset in offsets.items() if segment["moves"][i] and offset >= 0]
        beyond = min((offsets[i] / abs(segment["direction"][i]) for i in moved), default=0.0)
        if beyond > 0.0:
            segment["length"] = length + beyond
            segment["end"] = segment["end"] + segment["direction"] * beyond
        return number, length

    def limit_feed(self, number: int, stroke: float) -> tuple[float, float]:
        """Lower the feed of measuring run `number` so that it brakes within `stroke` (0.1 um).

        Returns the feed before and after (0.1 um/s).
        """
        segment = self._rows.segment[number % SEGMENTS]
        before = float(segment["feed"])
        segment["feed"] = min(before, self.brake_ramp(number).velocity_over(stroke))
        return before, float(segment["feed"])

    def brake_ramp(self, number: int) -> Ramp:
        """Return the deceleration after the probing event along segment `number`."""
        segment = self._rows.segment[number % SEGMENTS]
        moved = np.flatnonzero(segment["moves"])
        return dynamics.ramp_along(
            [self._behind_event[int(i)] for i in moved], [float(segment["direction"][i]) for i in moved]
        )

    def retraction(self, target: Mapping[AxisIndex, float], velocity: float) -> int | None:
        """Put a straight way to `target` (0.1 um, ACS) with `velocity` (0.1 um/s): relief after a fixed stop."""
        millimetres = {axis: position / TENTH_UM_PER_MM for axis, position in target.items()}
        return self._put(millimetres, velocity, self._feed, rapid=False)

    def _put(self, target: Mapping[AxisIndex, float], feed: float, may: Rows, *, rapid: bool) -> int | None:
        """Put a straight way; `feed` in 0.1 um/s."""
        rows = self._rows
        self._target.fill(math.nan)
        for axis, position in target.items():
            self._target[axis] = position * TENTH_UM_PER_MM
        number: int = put_segment(
            rows.axis,
            rows.path,
            rows.segment,
            rows.plan,
            may,
            self._target,
            feed,
            rapid,
            self._setup.cycle_ns * 1e-9,
        )
        return None if number == NOTHING else number
