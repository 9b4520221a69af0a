"""Measured values as the NC program reads them (measurement manual, chapter 5)."""

from collections.abc import Iterable
from dataclasses import dataclass

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import MachineState
from hli_bench.kernel.decoder.coordinates import Coordinates, Frame, rounded


@dataclass(frozen=True, slots=True)
class Run:
    """What was in force for an axis when a measuring run of it began: system, target and offsets in it."""

    frame: Frame | None
    target: float
    offset: float


@dataclass(frozen=True, slots=True)
class Value:
    """What an axis has measured last: in axis coordinates, in the system of its run with offsets, and that run."""

    acs: float
    in_system: float
    run: Run


class Measurements:
    """The value of each axis that has measured one, seen in the light of the run that it comes from.

    A run in which an axis delivers nothing leaves the axis what it had: value, system and target. A value is
    kept as it was when it came: what other axes measure later does not change it.
    """

    __slots__ = ("_coordinates", "_delivered", "_latched", "_open", "_values", "state")

    def __init__(self, coordinates: Coordinates) -> None:
        self._coordinates = coordinates
        self._values: dict[AxisIndex, Value] = {}
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
                acs = rounded(state.measured[axis])
                self._values[axis] = Value(acs, self._in_system(state, axis, run, acs), run)
        self._open.clear()
        self._delivered.update(state.delivered)

    def has_run(self, axis: AxisIndex) -> bool:
        """Tell whether this program has started a measuring run of the axis."""
        return axis in self._latched

    def has_value(self, axis: AxisIndex) -> bool:
        """Tell whether this program has measured the axis."""
        return axis in self._values

    def completed(self, axis: AxisIndex) -> bool:
        """V.A.MERF: the event came before the target."""
        return self._latched.get(axis, False)

    def in_axes(self, axis: AxisIndex) -> float:
        """V.A.MEAS.ACS.VALUE: axis coordinates."""
        return self._values[axis].acs

    def with_offsets(self, axis: AxisIndex) -> float:
        """V.A.MESS: in the system the run took place in, offsets included."""
        return self._values[axis].in_system

    def without_offsets(self, axis: AxisIndex) -> float:
        """V.A.MEAS.PCS.VALUE: in the system the run took place in, without offsets."""
        value = self._values[axis]
        return rounded(value.in_system - value.run.offset)

    def distance(self, axis: AxisIndex) -> float:
        """V.A.MOFFS: probing position less target; an included G101 offset counts as part of the target."""
        value = self._values[axis]
        return rounded(value.in_system - value.run.target)

    def _in_system(self, state: MachineState, axis: AxisIndex, run: Run, acs: float) -> float:
        main = self._coordinates.main
        if run.frame is None or main is None or axis not in main:
            return acs
        a, b, c = (state.measured[one] for one in main)
        return run.frame.from_acs((a, b, c))[main.index(axis)]
