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
from hli_bench.laws.native import bind
from hli_bench.laws.rows import IDLE, SEGMENTS, KernelRows
from hli_bench.laws.segments import NOTHING, put_segment

RAPID, FEED, MEASURING = range(3)
"""Kinds of ways by what the axes may do in them, as they stand in the rows of the law."""


class Preparation:
    """Writes the segment ring of the kernel rows; knows where the prepared path ends."""

    def __init__(self, setup: KernelSetup, rows: KernelRows) -> None:
        self._rows = rows
        measuring = [dynamics.measuring(axis, setup.channel) for axis in setup.axes]
        self._target = np.empty(len(setup.axes))
        kinds = (
            [dynamics.rapid(axis, setup.channel) for axis in setup.axes],
            [dynamics.feed(axis, setup.channel) for axis in setup.axes],
            [profile for profile, _ in measuring],
        )
        self._law = bind(
            put_segment,
            rows.axis,
            rows.path,
            rows.segment,
            rows.leg,
            rows.plan,
            rows.tip,
            self._target,
            setup.cycle_ns * 1e-9,
            dynamics.rows(kinds),
        )
        self._behind_event = [ramp for _, ramp in measuring]
        rows.tip["linear"] = [axis.kind == "T" for axis in setup.axes]

    def synchronise(self) -> None:
        """Begin anew where the set points are (after a stop, a measuring run, homing)."""
        self._rows.tip["end"] = self._rows.axis["command"]
        self._rows.plan["joined"] = 0

    def separate(self) -> None:
        """Let the path come to a stop before what is put next."""
        self._rows.plan["joined"] = 0

    @property
    def room(self) -> int:
        """Segments that can still be put; of a path that was stopped none is left."""
        path = self._rows.path[0]
        left = 0 if path["state"] == IDLE else path["tail"] - path["head"]
        return int(SEGMENTS - 1 - left)

    def line(self, block: Line) -> int | None:
        """Put a block of straight motion; return its segment number, None when it moves nothing."""
        kind = RAPID if block.rapid else FEED
        return self._put(kind, block.target, tenth_um_per_s(block.feed), rapid=block.rapid)

    def measuring_run(
        self, block: MeasuringRun, feed: float, offsets: Mapping[AxisIndex, float]
    ) -> tuple[int, float] | None:
        """Put a measuring run with `feed` (0.1 um/s); return (segment number, path to the target in 0.1 um).

        `offsets` (0.1 um) is how far past the target an axis may go while nothing was probed
        (P-AXIS-00467). Returns None when the block moves nothing.
        """
        number = self._put(MEASURING, block.target, feed, rapid=False)
        if number is None:
            return None
        segment, leg = self._rows.segment[number % SEGMENTS], self._rows.leg[number % SEGMENTS]
        length = float(segment["length"])
        moved = [i for i, offset in offsets.items() if leg[i]["moves"] and offset >= 0]
        beyond = min((offsets[i] / abs(leg[i]["direction"]) for i in moved), default=0.0)
        if beyond > 0.0:
            segment["length"] = length + beyond
            leg["end"] += leg["direction"] * beyond
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
        leg = self._rows.leg[number % SEGMENTS]
        moved = np.flatnonzero(leg["moves"])
        return dynamics.ramp_along(
            [self._behind_event[int(i)] for i in moved], [float(leg[i]["direction"]) for i in moved]
        )

    def retraction(self, target: Mapping[AxisIndex, float], velocity: float) -> int | None:
        """Put a straight way to `target` (0.1 um, ACS) with `velocity` (0.1 um/s): relief after a fixed stop."""
        millimetres = {axis: position / TENTH_UM_PER_MM for axis, position in target.items()}
        return self._put(FEED, millimetres, velocity, rapid=False)

    def _put(self, kind: int, target: Mapping[AxisIndex, float], feed: float, *, rapid: bool) -> int | None:
        """Put a straight way of a kind; `feed` in 0.1 um/s."""
        self._target.fill(math.nan)
        for axis, position in target.items():
            self._target[axis] = position * TENTH_UM_PER_MM
        number: int = self._law(kind, feed, rapid)
        return None if number == NOTHING else number
