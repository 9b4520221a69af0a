"""What a program run gives back: messages, errors, variables, measurements, homing, times."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

from hli_bench.base.units import mm
from hli_bench.kernel.cycle import Kernel
from hli_bench.kernel.records import CncError, Emitted, Homed, MeasuredValue, MessageText
from hli_bench.kernel.setup import AxisSetup
from hli_bench.shells.pacing import Lateness


@dataclass(frozen=True, slots=True)
class Message:
    """A #MSG text."""

    block: str
    text: str


@dataclass(frozen=True, slots=True)
class Error:
    """An error or warning of the CNC; `values` by their meaning."""

    id: int
    severity: str
    axis: str
    block: str
    text: str
    values: Mapping[str, float | int | str]

    def __str__(self) -> str:
        place = "".join(f" {part}" for part in (f"[{self.axis}]" if self.axis else "", self.block) if part)
        return f"P-ERR-{self.id}{place}: {self.text}"


@dataclass(frozen=True, slots=True)
class Measurement:
    """A measured value in `unit`; `source` is the value of P-AXIS-00516, `edge` POS or NEG.

    `acs_mm` and `pcs_mm` are older names of `acs` and `pcs`, which are degrees for rotary axes.
    """

    axis: str
    block: str
    source: str
    acs_mm: float
    pcs_mm: float
    dc_ns: int
    edge: str
    acs: float
    pcs: float
    unit: str


@dataclass(frozen=True, slots=True)
class NotMeasured:
    """An axis that a measuring run gave no value, and why: no entry among the measurements stands for it."""

    axis: str
    block: str
    why: str


@dataclass(frozen=True, slots=True)
class Homing:
    """An axis that was homed: the position it took over, in `unit`, and how; `position_mm` is an older name."""

    axis: str
    referenced: bool
    position_mm: float
    method: str
    position: float
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """Result of one program; lengths in mm, angles in degrees, as in the NC program."""

    program: str
    status: str
    messages: Sequence[Message]
    errors: Sequence[Error]
    variables: Mapping[str, float]
    measurements: Sequence[Measurement]
    unmeasured: Sequence[NotMeasured] = ()
    homing: Sequence[Homing]
    sim_s: float
    wall_s: float
    cycles: int
    notes: Sequence[str] = ()
    """What the bench remarks beside the CNC: commands that did not count, what held the motion, no face to probe."""
    plcs: Sequence[Mapping[str, Any]] = ()
    """How the PLC tasks of a bench in real pace kept their periods: name, period_us, runs, overruns, min_us, mean_us,
    max_us; empty in free pace."""
    lateness: Lateness | None = None
    """How a bench in real pace kept its cycle meanwhile, None in free pace."""

    @property
    def late_cycles(self) -> int:
        """Cycles that began a cycle or more behind their time."""
        return self.lateness.late if self.lateness else 0

    @property
    def worst_lateness_us(self) -> float:
        """How far behind its time the worst cycle began, us."""
        return self.lateness.figures()["worst_lateness_us"] if self.lateness else 0.0

    @property
    def lateness_histogram(self) -> Sequence[Mapping[str, Any]]:
        """How many cycles began how far behind their time; empty in free pace."""
        return self.lateness.figures()["lateness_histogram"] if self.lateness else ()

    @property
    def completed(self) -> bool:
        """The program ended with M02 or M30."""
        return self.status == "completed"

    def to_dict(self) -> dict[str, Any]:
        """Return what `--result` writes, and `notes`; of a bench in real pace also how it kept its cycle."""
        found = asdict(self)
        if not found["unmeasured"]:
            del found["unmeasured"]
        del found["lateness"], found["plcs"]
        if self.lateness is None:
            return found
        return found | self.lateness.figures() | {"plcs": [dict(one) for one in self.plcs]}


MOST_KEPT: Final = 100_000
"""Messages, and errors, that a result holds: a program need not end (decided here)."""


class Collector:
    """Gathers what the kernel emits while a program runs."""

    __slots__ = ("_axes", "errors", "homing", "left_out", "messages")

    def __init__(self, axes: Sequence[AxisSetup]) -> None:
        self._axes = axes
        self.messages: list[Message] = []
        self.left_out = 0
        """Messages and errors that came when there were as many as a result holds."""
        self.errors: list[Error] = []
        self.homing: list[Homing] = []

    def status(self, *, completed: bool) -> str:
        """Return how a program ended: without M02 or M30 by an error, or by a CNC reset."""
        if completed:
            return "completed"
        return "error" if any(error.severity == "error" for error in self.errors) else "aborted"

    def take(self, records: Sequence[Emitted]) -> None:
        """Sort records by kind."""
        for record in records:
            match record:
                case MessageText() if len(self.messages) >= MOST_KEPT:
                    self.left_out += 1
                case CncError() if len(self.errors) >= MOST_KEPT:
                    self.left_out += 1
                case MessageText():
                    self.messages.append(Message(record.source.name, record.text))
                case CncError():
                    self.errors.append(error_of(record))
                case Homed():
                    name = self._axes[record.axis].name
                    position, unit = mm(record.position_tenth_um), self._axes[record.axis].unit
                    self.homing.append(Homing(name, True, position, record.method, position, unit))
                case MeasuredValue():
                    pass


def error_of(record: CncError) -> Error:
    """Return the result form of an error record."""
    return Error(
        record.number,
        str(record.severity),
        record.axis,
        record.source.name,
        record.text,
        dict(record.values),
    )


def measurements(kernel: Kernel) -> list[Measurement]:
    """Return what the program has measured, in order."""
    return [
        Measurement(
            axis=kernel.setup.axes[value.axis].name,
            block=value.source.name,
            source=value.origin,
            acs_mm=mm(value.acs_tenth_um),
            pcs_mm=pcs_mm,
            dc_ns=int(value.dc_ns),
            edge=value.edge,
            acs=mm(value.acs_tenth_um),
            pcs=pcs_mm,
            unit=kernel.setup.axes[value.axis].unit,
        )
        for value, pcs_mm in kernel.channel.measured
    ]
