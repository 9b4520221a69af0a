"""The look-ahead: puts segments into the ring and lets the path run through block transitions where it may."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import TENTH_UM_PER_MM, tenth_um_per_s
from hli_bench.kernel.blocks import Line, MeasuringRun
from hli_bench.kernel.path_preparation import dynamics
from hli_bench.kernel.path_preparation.dynamics import Dynamics, Ramp
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import IDLE, PATH, RUN, SEGMENTS, KernelRows

SHORTEST = 1e-6
"""A block that moves nothing by more than this (0.1 um) has no path."""


class Preparation:
    """Writes the segment ring of the kernel rows; knows where the prepared path ends."""

    def __init__(self, setup: KernelSetup, rows: KernelRows) -> None:
        self._setup = setup
        self._rows = rows
        self._rapid = [dynamics.rapid(axis, setup.channel) for axis in setup.axes]
        self._feed = [dynamics.feed(axis, setup.channel) for axis in setup.axes]
        self._measuring = [dynamics.measuring(axis, setup.channel) for axis in setup.axes]
        self._end = np.zeros(len(setup.axes))
        self._transition: tuple[np.ndarray, float] | None = None

    def synchronise(self) -> None:
        """Begin anew where the set points are (after a stop, a measuring run, homing)."""
        self._end = self._rows.axis["command"].copy()
        self._transition = None

    @property
    def room(self) -> int:
        """Segments that can still be put."""
        path = self._rows.path[0]
        return int(SEGMENTS - 1 - (path["tail"] - path["head"]))

    def line(self, block: Line) -> int | None:
        """Put a block of straight motion; return its segment number, None when it moves nothing."""
        sets = self._rapid if block.rapid else self._feed
        return self._put(block.target, tenth_um_per_s(block.feed), sets, rapid=block.rapid)

    def measuring_run(
        self, block: MeasuringRun, feed: float, offsets: Mapping[AxisIndex, float]
    ) -> tuple[int, float] | None:
        """Put a measuring run with `feed` (0.1 um/s); return (segment number, path to the target in 0.1 um).

        `offsets` (0.1 um) is how far past the target an axis may go while nothing was probed
        (P-AXIS-00467). Returns None when the block moves nothing.
        """
        sets = [profile for profile, _ in self._measuring]
        number = self._put(block.target, feed, sets, rapid=False)
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
            [self._measuring[int(i)][1] for i in moved], [float(segment["direction"][i]) for i in moved]
        )

    def retraction(self, target: Mapping[AxisIndex, float], velocity: float) -> int | None:
        """Put a straight way to `target` (0.1 um, ACS) with `velocity` (0.1 um/s): relief after a fixed stop."""
        millimetres = {axis: position / TENTH_UM_PER_MM for axis, position in target.items()}
        return self._put(millimetres, velocity, self._feed, rapid=False)

    def _put(
        self, target: Mapping[AxisIndex, float], feed: float, sets: Sequence[Dynamics], *, rapid: bool
    ) -> int | None:
        """Put a segment; `feed` in 0.1 um/s."""
        end = self._end.copy()
        for axis, position in target.items():
            end[axis] = position * TENTH_UM_PER_MM
        way = end - self._end
        moves = np.abs(way) > SHORTEST
        length = self._length(way, moves)
        if length == 0.0:
            return None
        direction = np.where(moves, way / length, 0.0)
        moved = np.flatnonzero(moves)
        may = dynamics.along([sets[int(i)] for i in moved], [float(direction[i]) for i in moved])
        velocity = may.limit if rapid else min(feed, may.limit)
        path = self._rows.path[0]
        number = int(path["tail"])
        segment = self._rows.segment[number % SEGMENTS]
        segment["length"] = length
        segment["feed"] = velocity
        segment["rapid"] = rapid
        segment["v_start"] = 0.0
        segment["v_end"] = 0.0
        segment["acceleration"] = (may.up.low, may.up.high)
        segment["deceleration"] = (may.down.low, may.down.high)
        segment["hold"] = (may.hold.low, may.hold.high)
        segment["split"] = may.up.split
        segment["moves"] = moves
        segment["start"] = self._end
        segment["direction"] = direction
        segment["end"] = end
        self._join(number, direction, velocity, sets)
        self._transition = (direction, velocity)
        self._end = end
        path["tail"] = number + 1
        self._rows.axis["mode"][moves] = PATH
        if path["state"] == IDLE:
            path["head"] = number
            path["s"] = 0.0
            path["v"] = 0.0
            path["state"] = RUN
        return number

    def _length(self, way: np.ndarray, moves: np.ndarray) -> float:
        """Path length that the F word counts: linear axes when any moves, else the rotary ones."""
        kinds = np.array([axis.kind == "T" for axis in self._setup.axes])
        counted = moves & kinds if (moves & kinds).any() else moves
        return math.sqrt(float((way[counted] ** 2).sum()))

    def _join(self, number: int, direction: np.ndarray, velocity: float, sets: Sequence[Dynamics]) -> None:
        """Let the path run from the segment before into `number` as fast as no axis jumps and all can brake."""
        path = self._rows.path[0]
        if self._transition is None or path["state"] == IDLE:
            return
        before, velocity_before = self._transition
        cycle = self._setup.cycle_ns * 1e-9
        through = min(velocity, velocity_before)
        for axis in np.flatnonzero(np.abs(direction - before) > 1e-9):
            jump = min(sets[int(axis)].up.low, sets[int(axis)].down.low) * cycle
            through = min(through, jump / abs(direction[axis] - before[axis]))
        self._rows.segment[number % SEGMENTS]["v_start"] = through
        for one in range(number, int(path["head"]), -1):
            segment = self._rows.segment[one % SEGMENTS]
            previous = self._rows.segment[(one - 1) % SEGMENTS]
            rate = float(min(segment["deceleration"]))
            reach = math.sqrt(float(segment["v_end"]) ** 2 + 2.0 * rate * float(segment["length"]))
            allowed = min(float(segment["v_start"]), reach) if one < number else min(through, reach)
            if one < number and allowed <= float(previous["v_end"]):
                return
            previous["v_end"] = allowed
