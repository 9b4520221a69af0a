"""Where the axes are: programmed, absolute in the active system, in axis coordinates; the #CS stack."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.decoder.expressions import cosine, sine

SAME: Final = 1e-9
"""Positions nearer than this (mm or degrees) are the same; converted positions are rounded to it."""

DIGITS: Final = 9
MAX_FRAMES: Final = 5
"""#CS systems that can be stacked."""

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]


def rounded(value: float) -> float:
    """Return a measured or converted position rounded to 1e-9, never minus zero."""
    return round(value, DIGITS) + 0.0


@dataclass(frozen=True, slots=True)
class Frame:
    """A Cartesian system: p_acs = shift + turn * p_cs on the three main axes."""

    shift: Vector
    turn: Matrix

    def to_acs(self, point: Vector) -> Vector:
        """Return a point of this system in axis coordinates."""
        x, y, z = point
        (a, b, c), (d, e, f), (g, h, i) = self.turn
        u, v, w = self.shift
        return (
            rounded(u + a * x + b * y + c * z),
            rounded(v + d * x + e * y + f * z),
            rounded(w + g * x + h * y + i * z),
        )

    def from_acs(self, point: Vector) -> Vector:
        """Return a point of the axis coordinates in this system (the turn is orthogonal)."""
        x, y, z = (p - s for p, s in zip(point, self.shift, strict=True))
        (a, b, c), (d, e, f), (g, h, i) = self.turn
        return (
            rounded(a * x + d * y + g * z),
            rounded(b * x + e * y + h * z),
            rounded(c * x + f * y + i * z),
        )

    def then(self, inner: "Frame") -> "Frame":
        """Return the system `inner` that is given in coordinates of this one."""
        return Frame(self.to_acs(inner.shift), _product(self.turn, inner.turn))


def frame(values: Sequence[float]) -> Frame:
    """Return the frame of #CS ON[v1,v2,v3,phi1,phi2,phi3] (degrees): turn = Rz(phi3) Ry(phi2) Rx(phi1)."""
    v1, v2, v3, phi1, phi2, phi3 = values
    rx: Matrix = ((1, 0, 0), (0, cosine(phi1), -sine(phi1)), (0, sine(phi1), cosine(phi1)))
    ry: Matrix = ((cosine(phi2), 0, sine(phi2)), (0, 1, 0), (-sine(phi2), 0, cosine(phi2)))
    rz: Matrix = ((cosine(phi3), -sine(phi3), 0), (sine(phi3), cosine(phi3), 0), (0, 0, 1))
    return Frame((v1, v2, v3), _product(rz, _product(ry, rx)))


def _product(left: Matrix, right: Matrix) -> Matrix:
    columns = tuple(zip(*right, strict=True))
    rows = [tuple(sum(a * b for a, b in zip(row, column, strict=True)) for column in columns) for row in left]
    return (_vector(rows[0]), _vector(rows[1]), _vector(rows[2]))


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return (x, y, z)


class Coordinates:
    """The decoder's idea of the positions; axes in `void` have an unknown one until the machine is asked.

    Lists by axis index: `absolute` (in the active system, offsets included), `programmed`, `applied` (offset
    in force since the last absolute position), `shift` (G92), `included` (G101), `offset` (their sum).
    """

    __slots__ = (
        "_kept",
        "_stack",
        "absolute",
        "applied",
        "frame",
        "included",
        "including",
        "main",
        "offset",
        "programmed",
        "shift",
        "void",
    )

    def __init__(self, axes: int, main: tuple[AxisIndex, AxisIndex, AxisIndex] | None) -> None:
        self.absolute = [0.0] * axes
        self.programmed = [0.0] * axes
        self.applied = [0.0] * axes
        self.shift = [0.0] * axes
        self.included = [0.0] * axes
        self.including: set[AxisIndex] = set()
        self.offset = [0.0] * axes
        self.main = main
        self.frame: Frame | None = None
        self.void = {AxisIndex(i) for i in range(axes)}
        self._stack: list[Frame] = []
        self._kept: set[AxisIndex] = set()

    def set_shift(self, axis: AxisIndex, value: float) -> None:
        """Set the G92 offset; it acts with the next absolute position."""
        self.shift[axis] = value
        self.offset[axis] = value + self.included[axis]

    def include(self, axis: AxisIndex, value: float) -> None:
        """Set the measurement offset (G101); it acts with the next absolute position."""
        self.included[axis] = value
        self.including.add(axis)
        self.offset[axis] = self.shift[axis] + value

    def exclude(self, axis: AxisIndex) -> None:
        """Take the measurement offset out (G102) with the next absolute position."""
        self.included[axis] = 0.0
        self.including.discard(axis)
        self.offset[axis] = self.shift[axis]

    def needs_machine(self, words: Sequence[tuple[AxisIndex, float]], *, absolute: bool) -> bool:
        """Tell whether motion to `words` needs positions that only the machine knows."""
        void = self.void
        if not void:
            return False
        if not absolute and any(axis in void for axis, _ in words):
            return True
        if self.frame is None or self.main is None:
            return False
        programmed = {axis for axis, _ in words}
        touched = any(axis in programmed for axis in self.main)
        return touched and any(axis in void and axis not in programmed for axis in self.main)

    def move(self, words: Sequence[tuple[AxisIndex, float]], *, absolute: bool) -> dict[AxisIndex, float]:
        """Take programmed positions and return the ACS targets of the axes that move."""
        positions, void = self.absolute, self.void
        if self.frame is not None:
            return self._move_in_frame(words, absolute=absolute)
        target: dict[AxisIndex, float] = {}
        for axis, value in words:
            old = positions[axis]
            if absolute:
                offset = self.offset[axis]
                new = value + offset
                self.programmed[axis] = value
                self.applied[axis] = offset
            else:
                new = round(old + value, DIGITS)
                self.programmed[axis] = new - self.applied[axis]
            if axis in void:
                void.discard(axis)
                target[axis] = new
            elif not -SAME <= new - old <= SAME or axis in target:
                target[axis] = new
            positions[axis] = new
        return target

    def _move_in_frame(
        self, words: Sequence[tuple[AxisIndex, float]], *, absolute: bool
    ) -> dict[AxisIndex, float]:
        assert self.main is not None
        system, self.frame = self.frame, None
        assert system is not None
        unknown = any(axis in self.void for axis in self.main)
        before = None if unknown else system.to_acs(self._main_absolute())
        target = self.move(words, absolute=absolute)
        self.frame = system
        if any(axis in self.void for axis in self.main):
            return target
        after = system.to_acs(self._main_absolute())
        for slot, axis in enumerate(self.main):
            target.pop(axis, None)
            if before is None or abs(after[slot] - before[slot]) > SAME:
                target[axis] = after[slot]
        return target

    def axis_target(self, axes: Sequence[AxisIndex]) -> dict[AxisIndex, float]:
        """Return the ACS positions of `axes` (main axes of an active #CS all three)."""
        main = self._main_acs() if self.frame is not None else {}
        return main | {axis: self.absolute[axis] for axis in axes if axis not in main}

    def acs(self, axis: AxisIndex) -> float:
        """Return the position of an axis in axis coordinates."""
        return self.axis_target([axis])[axis]

    def forget(self, axes: Sequence[AxisIndex], *, keep_programmed: bool) -> None:
        """Mark positions as unknown: a measuring run or homing moves to where only the machine knows."""
        lost = set(axes)
        if self.frame is not None and self.main is not None and lost & set(self.main):
            lost |= set(self.main)
        self.void |= lost
        self._kept = self._kept | lost if keep_programmed else self._kept - lost

    def learn(self, positions: Mapping[AxisIndex, float]) -> None:
        """Take positions of the machine (ACS) for the axes whose position is unknown."""
        lost, self.void = sorted(self.void), set()
        in_system = self.from_acs(positions)
        for axis in lost:
            self.absolute[axis] = in_system[axis]
            if axis not in self._kept:
                self.programmed[axis] = in_system[axis] - self.applied[axis]
        self._kept.clear()

    def from_acs(self, positions: Mapping[AxisIndex, float]) -> dict[AxisIndex, float]:
        """Return ACS positions in the active system, offsets included; axes not given stand at 0."""
        result = {AxisIndex(i): rounded(positions.get(AxisIndex(i), 0.0)) for i in range(len(self.absolute))}
        if self.frame is not None and self.main is not None:
            a, b, c = self.main
            values = self.frame.from_acs((result[a], result[b], result[c]))
            result.update(zip(self.main, values, strict=True))
        return result

    def push(self, inner: Frame) -> None:
        """Activate a system given in the active one (#CS ON)."""
        self._change([*self._stack, self.frame.then(inner) if self.frame else inner])

    def pop(self, *, everything: bool) -> None:
        """Leave the last system or all of them (#CS OFF, #CS OFF ALL)."""
        self._change([] if everything else self._stack[:-1])

    @property
    def depth(self) -> int:
        """Return how many systems are stacked."""
        return len(self._stack)

    def _change(self, stack: list[Frame]) -> None:
        assert self.main is not None
        known = not any(axis in self.void for axis in self.main)
        acs = self._main_acs() if known else {}
        self._stack = stack
        self.frame = stack[-1] if stack else None
        if not known:
            self.void |= set(self.main)
            self._kept -= set(self.main)
            return
        in_system = self.from_acs(acs)
        for axis in self.main:
            self.absolute[axis] = in_system[axis]
            self.programmed[axis] = in_system[axis] - self.applied[axis]

    def _main_absolute(self) -> Vector:
        assert self.main is not None
        a, b, c = self.main
        return (self.absolute[a], self.absolute[b], self.absolute[c])

    def _main_acs(self) -> dict[AxisIndex, float]:
        assert self.main is not None
        point = self._main_absolute()
        return dict(zip(self.main, self.frame.to_acs(point) if self.frame else point, strict=True))
