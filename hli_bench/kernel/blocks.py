"""What the decoder hands on (frozen blocks) and what it asks for (queries, each of them a flush)."""

from collections.abc import Mapping
from dataclasses import dataclass

from hli_bench.base.ids import AxisIndex


@dataclass(frozen=True, slots=True)
class Source:
    """Where a block stands: N number as written ("N050", "" without one) and line of the program, from 1."""

    number: str
    line: int

    @property
    def value(self) -> int:
        """The N number, 0 of a block without one."""
        return int("".join(filter(str.isdigit, self.number)) or 0) & 0xFFFFFFFF

    @property
    def name(self) -> str:
        """What people look for: the N number, or the line of a block without one."""
        return self.number or (f"line {self.line}" if self.line else "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """Straight motion to ACS targets (mm or degrees) of the axes that move; the others stay.

    `feed` is the F word in mm/min (degrees/min when only rotary axes move); ignored when `rapid` (G00).
    """

    source: Source
    rapid: bool
    feed: float
    target: Mapping[AxisIndex, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuringRun:
    """G100: motion to ACS targets that ends at the probing event.

    `axes` must deliver a signal (moved axes; with an active #CS all three main axes); those of `together`
    (the main axes under a #CS) have a value only when each of them has delivered one;
    `measuring_type` is the active P-CHAN-00057 value.
    """

    source: Source
    measuring_type: int
    feed: float
    target: Mapping[AxisIndex, float]
    axes: tuple[AxisIndex, ...]
    together: tuple[AxisIndex, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Home:
    """G74: axes with their ranks; ascending, equal ranks together."""

    source: Source
    ranks: Mapping[AxisIndex, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class Text:
    """#MSG: a text to hand out; `synchronous` (SYN) in step with the interpolator, else at decoding."""

    source: Source
    text: str
    synchronous: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveWrite:
    """#DRIVE WR [SYN]: writes `value` through function `key` of P-AXIS antr.function[]; `wait` for the answer."""

    source: Source
    axis: AxisIndex
    key: str
    value: float
    synchronous: bool
    wait: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureSettings:
    """#MEAS, #MEAS DEFAULT: probing parameters of `axis` (None: of every axis); None leaves a parameter alone.

    `reset` takes signal, edge and input back to the axis list (P-AXIS-00516..00518).
    """

    source: Source
    axis: AxisIndex | None
    signal: str | None
    edge: str | None
    input: int | None
    error_no_signal: bool | None
    reset: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Dwell:
    """G04: stand still for `seconds`."""

    source: Source
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramEnd:
    """M02 or M30."""

    source: Source


@dataclass(frozen=True, slots=True)
class Idle:
    """The decoder has worked through many blocks that give nothing to execute: no item, but time to go on later."""


Block = Line | MeasuringRun | Home | Text | DriveWrite | MeasureSettings | Dwell | ProgramEnd


@dataclass(frozen=True, slots=True, kw_only=True)
class Flush:
    """A query: execute everything before it, then answer with `MachineState`.

    `takes_positions`: the program goes on from where the axes stand.
    """

    source: Source
    takes_positions: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineState:
    """The answer to a `Flush`: per axis, mm or degrees in ACS.

    `measured` holds the last latched position of each axis that ever delivered one, `delivered` how many it has
    delivered in this program; `latched` tells for the axes of the last measuring run whether the event came
    before the target (V.A.MERF).
    """

    command: Mapping[AxisIndex, float]
    actual: Mapping[AxisIndex, float]
    measured: Mapping[AxisIndex, float]
    delivered: Mapping[AxisIndex, int]
    latched: Mapping[AxisIndex, bool]
    referenced: Mapping[AxisIndex, bool]
