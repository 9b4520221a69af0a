"""Measured values as the NC program reads them (measurement manual, chapter 5)."""

from collections.abc import Iterable
from dataclasses import dataclass

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import MachineState
from hli_bench.kernel.decoder.coordinates import Coordinates, Frame, rounded


@dataclass(frozen=True, slots=True)
class Run:
    """What was in force for an axis when its last measuring run began: system, target and offsets in it."""

    frame: Frame | None
    target: float
    offset: float


class Measurements:
    """The measuring run that each axis has its value from, and the machine's values seen in its light.

    A run in which an axis delivers nothing leaves the axis what it had: value, system and target.
    """

    __slots__ = ("_coordinates", "_delivered", "_latched", "_open", "_runs", "state")

    def __init__(self, coordinates: Coordinates) -> None:
        self._coordinates = coordinates
        self._runs: dict[AxisIndex, Run] = {}
        self._open: dict[AxisIndex, Run] = {}
        self._delivered: dict[AxisIndex, int] = {}
        self._latched: dict[AxisIndex, bool] = {}
        self.state: MachineState | None = None

    def begin(self, axes: Iterable[AxisIndex]) -> None:
        """Note what a run over `axes` is measured against; the other axes keep their earlier run."""
        where = self._coordinates
        for axis in axes:
            self._open[axis] = Run(where.frame, where.absolute[axis], where.applied[axis])

    def learn(self, state: MachineState) -> None:
        """Take the machine's answer; axes that were not in the last run keep V.A.MERF."""
        self.state = state
        self._latched.update(state.latched)
        for axis, run in self._open.items():
            if state.delivered.get(axis, 0) > self._delivered.get(axis, 0):
                self._runs[axis] = run
        self._open.clear()
        self._delivered.update(state.delivered)

    def has_run(self, axis: AxisIndex) -> bool:
        """Tell whether this program has started a measuring run of the axis."""
        return axis in self._latched

    def has_value(self, axis: AxisIndex) -> bool:
        """Tell whether this program has measured the axis."""
        return axis in self._runs and self.state is not None and axis in self.state.measured

    def completed(self, axis: AxisIndex) -> bool:
        """V.A.MERF: the event came before the target."""
        return self._latched.get(axis, False)

    def in_axes(self, axis: AxisIndex) -> float:
        """V.A.MEAS.ACS.VALUE: axis coordinates."""
        assert self.state is not None
        return rounded(self.state.measured[axis])

    def with_offsets(self, axis: AxisIndex) -> float:
        """V.A.MESS: in the system the run took place in, offsets included.

        A main axis that delivered no value under a #CS counts with its command position.
        """
        system, main = self._runs[axis].frame, self._coordinates.main
        if system is None or main is None or axis not in main:
            return self.in_axes(axis)
        assert self.state is not None
        known = {**self.state.command, **self.state.measured}
        a, b, c = main
        point = system.from_acs((known.get(a, 0.0), known.get(b, 0.0), known.get(c, 0.0)))
        return point[main.index(axis)]

    def without_offsets(self, axis: AxisIndex) -> float:
        """V.A.MEAS.PCS.VALUE: in the system the run took place in, without offsets."""
        return rounded(self.with_offsets(axis) - self._runs[axis].offset)

    def distance(self, axis: AxisIndex) -> float:
        """V.A.MOFFS: probing position less target; an included G101 offset counts as part of the target."""
        return rounded(self.with_offsets(axis) - self._runs[axis].target)
