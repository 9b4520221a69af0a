"""The keys of machine.toml, each declared once as data: checks and the printed schema derive from them."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, date, datetime
from enum import StrEnum
from functools import lru_cache
from typing import Final

from hli_bench.base.time import DC_END, DC_EPOCH
from hli_bench.terminals.settings import CONTINUOUS, SINGLE_EVENT

FAULTS: Final = (
    "frame_loss",
    "node_off",
    "cable_break",
    "plc_stall",
    "probe_stuck",
    "edge_missed",
    "clock_skew",
)
"""Kinds of scheduled faults."""
BITS: Final = ("negative_limit", "positive_limit", "home", "interlock", "bit_4", "bit_5", "bit_6", "bit_7")
"""Names of bits 0..7 of a drive's digital inputs (60FD)."""
PLACEHOLDER: Final = re.compile(r"<(\w+)>")
SIDES: Final = ("above", "below")

Plain = bool | int | float | str | datetime


SIZES: Final = (1e-12, 1e12)
"""Numbers other than 0 lie between, whatever the unit (decided here): no law divides by less."""


class Kind(StrEnum):
    """What a key takes."""

    BOOLEAN = "true or false"
    INTEGER = "integer"
    NUMBER = "number"
    TEXT = "text"
    INSTANT = "instant (ISO 8601), 2000-01-01 to 2199-12-31"


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """One key: `plant.cam.<AXIS>.from_mm`. `default` None: none, or as `doc` says."""

    path: str
    kind: Kind
    doc: str
    default: Plain | None = None
    low: float | None = None
    high: float | None = None
    above: float | None = None
    """The value must be larger than this."""
    step: int = 0
    """The value must be a multiple of this."""
    choices: tuple[str, ...] = ()

    def expected(self) -> str:
        """Return what the key takes, for messages and the schema."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        text = str(self.kind)
        if self.above is not None:
            text += f" above {self.above}"
        if self.low is not None or self.high is not None:
            text += f" {'' if self.low is None else self.low}..{'' if self.high is None else self.high}"
        return text + (f", a multiple of {self.step}" if self.step else "")

    def accept(self, raw: object) -> Plain:
        """Return the value in the key's type; raise ValueError when it is not permitted."""
        value = _typed(self.kind, raw)
        if self.choices and value not in self.choices:
            raise ValueError(raw)
        if isinstance(value, int | float) and not isinstance(value, bool):
            self._check_number(value)
        if isinstance(value, datetime) and not DC_EPOCH <= value < DC_END:
            raise ValueError(raw)
        return value

    def _check_number(self, value: float) -> None:
        """Raise ValueError for a number out of range."""
        too_low = self.low is not None and value < self.low
        too_high = self.high is not None and value > self.high
        not_above = self.above is not None and value <= self.above
        if too_low or too_high or not_above or (self.step and value % self.step) or not sizeable(value):
            raise ValueError(value)


def sizeable(value: float) -> bool:
    """Tell whether a number is 0 or of a size that a machine can have."""
    return value == 0 or SIZES[0] <= abs(value) <= SIZES[1]


def _typed(kind: Kind, raw: object) -> Plain:
    """Return a TOML or Python value in the type of `kind`, or raise ValueError."""
    if kind is Kind.INSTANT:
        return _instant(raw)
    if kind is Kind.BOOLEAN and isinstance(raw, bool):
        return raw
    if kind is Kind.TEXT and isinstance(raw, str):
        return raw
    if isinstance(raw, int | float) and not isinstance(raw, bool) and abs(raw) < float("inf"):
        if kind is Kind.INTEGER and raw == int(raw):
            return int(raw)
        if kind is Kind.NUMBER:
            return float(raw)
    raise ValueError(raw)


def _instant(raw: object) -> datetime:
    """Return an instant; one without a time zone is UTC."""
    if isinstance(raw, str):
        raw = datetime.fromisoformat(raw)
    if isinstance(raw, date) and not isinstance(raw, datetime):
        raw = datetime(raw.year, raw.month, raw.day, tzinfo=UTC)
    if isinstance(raw, datetime):
        return raw if raw.tzinfo is not None else raw.replace(tzinfo=UTC)
    raise ValueError(raw)


def _number(path: str, default: float | None, doc: str, **limits: float) -> Key:
    return Key(path=path, kind=Kind.NUMBER, default=default, doc=doc, **limits)  # type: ignore[arg-type]


def _text(path: str, default: str | None, doc: str, choices: tuple[str, ...] = ()) -> Key:
    return Key(path=path, kind=Kind.TEXT, default=default, doc=doc, choices=choices)


def _integer(
    path: str, default: int | None, doc: str, low: float | None, high: float | None = None, step: int = 0
) -> Key:
    return Key(path=path, kind=Kind.INTEGER, default=default, doc=doc, low=low, high=high, step=step)


GENERAL: Final = (
    _integer("cycle_us", 1000, "interpolation and position control cycle, us", 125, 20_000, 125),
    Key(
        path="dc_epoch",
        kind=Kind.INSTANT,
        default=datetime(2026, 1, 1, tzinfo=UTC),
        doc="DC time at bench start",
    ),
    _integer("seed", 0, "seed of everything random", 0, 2**32 - 1),
    Key(
        path="lenient",
        kind=Kind.BOOLEAN,
        default=False,
        doc="list files: parameters that the bench does not know and open brackets are remarked, no errors",
    ),
    _text("channel.list", "", "channel list file of the folder"),
)
AXIS: Final = (
    _text("axis.<AXIS>.list", "", "axis list file of the folder"),
    _text("axis.<AXIS>.drive", "drives.models.servo402", "drive model, a module path"),
    _text(
        "axis.<AXIS>.following_error",
        None,
        "what the drive does, beside bit 13, when the following error leaves the window 6065 for longer than 6066; "
        "default: what its model does, servo402 a fault",
        ("fault", "status"),
    ),
    _integer("axis.<AXIS>.node_id", None, "CANopen node id; default: the axis number", 1, 127),
    _number("axis.<AXIS>.start_mm", 0.0, "where the axis stands at the start, mm or degrees"),
    _text("axis.<AXIS>.probe_input_1", "probe", "signal at touch probe input 1 of the drive"),
    _text("axis.<AXIS>.probe_input_2", "", "signal at touch probe input 2 of the drive"),
    _text("axis.<AXIS>.input.<BIT>", "", f"signal at a bit of 60FD: {', '.join(BITS)}"),
)
PLANT: Final = (
    _number("plant.probe.<AXIS>.face_mm", None, "a workpiece face across the axis, machine coordinate"),
    _text("plant.probe.<AXIS>.material", None, "the solid side of the face; needed with face_mm", SIDES),
    _number("plant.probe.pretravel_um", 0.0, "way into the material until the probe switches", low=0.0),
    _number("plant.probe.bounce_us", 0.0, "contact bounce of the probe", low=0.0, high=100_000.0),
    _number("plant.probe.sigma_um", 0.0, "spread of the trigger point (one sigma)", low=0.0),
    _number("plant.stop.<AXIS>.at_mm", None, "a mechanical fixed stop, machine coordinate"),
    _text("plant.stop.<AXIS>.side", None, "the solid side of the stop; needed with at_mm", SIDES),
    _number(
        "plant.stop.<AXIS>.stiffness_n_per_um",
        100.0,
        "stiffness of the stop, N/um; rotary axes: Nm per 0.001 degree",
        above=0.0,
    ),
    _number("plant.cam.<AXIS>.from_mm", None, "lower end of the reference cam"),
    _number("plant.cam.<AXIS>.to_mm", None, "upper end of the reference cam; needed with from_mm"),
    _number("plant.cam.<AXIS>.hysteresis_um", 50.0, "how far beyond the cam it is released", low=0.0),
)
DRIVE_TRAIN: Final = (
    _number("plant.axis.<AXIS>.inertia_kg_m2", 3.3e-3, "moment of inertia at the motor, kg m2", above=0.0),
    _number("plant.axis.<AXIS>.mass_kg", 0.0, "moved mass on top of it (linear axes), kg", low=0.0),
    _number(
        "plant.axis.<AXIS>.pitch_mm",
        None,
        "way per motor turn, mm or degrees; default 10 mm, rotary 36 degrees",
        above=0.0,
    ),
    _number("plant.axis.<AXIS>.viscous_nm_s", 0.002, "viscous friction, Nm s/rad", low=0.0),
    _number("plant.axis.<AXIS>.coulomb_nm", 0.05, "dry friction while moving, Nm", low=0.0),
    _number("plant.axis.<AXIS>.static_nm", 0.06, "dry friction at standstill, Nm", low=0.0),
    _number(
        "plant.axis.<AXIS>.brake_nm",
        0.0,
        "brake that falls in without power, Nm; 0: the axis coasts",
        low=0.0,
    ),
    _number("plant.axis.<AXIS>.rated_torque_nm", 15.0, "rated torque of the motor (6076), Nm", above=0.0),
    _number(
        "plant.axis.<AXIS>.peak_permille", 3000.0, "peak torque, per mille of rated", above=0.0, high=32_000.0
    ),
    _integer("plant.axis.<AXIS>.increments_per_turn", 1_048_576, "encoder increments per turn", 4, 2**31 - 1),
    _number("plant.axis.<AXIS>.zero_pulse_offset_mm", 0.0, "zero pulse nearest to 0, machine coordinate"),
    _integer(
        "plant.axis.<AXIS>.zero_pulse_offset_increments",
        None,
        "the same in increments, goes first",
        -(2**31),
        2**31 - 1,
    ),
    _number("plant.axis.<AXIS>.kv_per_s", 50.0, "position loop gain, 1/s", above=0.0),
    _number("plant.axis.<AXIS>.speed_bandwidth_per_s", 300.0, "speed loop gain over inertia, 1/s", above=0.0),
    _number("plant.axis.<AXIS>.speed_reset_ms", 20.0, "reset time of the speed loop, ms", above=0.0),
)
NODES: Final = (
    _text("plc[<N>].script", None, "PLC program; looked for in the folder, then among those supplied"),
    _text("plc[<N>].name", None, "name of the task; default: the script's name"),
    _integer("plc[<N>].period_us", None, "task period, a multiple of cycle_us; default: the script's", 1),
    Key(
        path="plc[<N>].process",
        kind=Kind.BOOLEAN,
        default=False,
        doc="the script runs in a process of its own, attached over Zenoh",
    ),
    _text("terminal.<TERMINAL>.model", None, "terminal model, needed"),
    _integer(
        "terminal.<TERMINAL>.period_us",
        None,
        "refresh of the process image, a multiple of cycle_us; default: cycle_us",
        1,
    ),
    _text("terminal.<TERMINAL>.wiring.<CHANNEL>", "", 'signal at a channel: ch2 = "probe"'),
    _text("terminal.<TERMINAL>.mode", CONTINUOUS, "latch mode of its edges", (CONTINUOUS, SINGLE_EVENT)),
    _integer("terminal.<TERMINAL>.delay_ns", None, "input delay; default: the model's", 0, 10**9),
    _integer(
        "terminal.<TERMINAL>.clock_skew_ns",
        0,
        "how far its clock is ahead of DC time: latched times are off by it",
        -(10**9),
        10**9,
    ),
    _text("fault[<N>].kind", None, "kind of fault", FAULTS),
    _text("fault[<N>].target", "", "what it concerns: a signal, an axis, a terminal, a PLC task"),
    _number("fault[<N>].at_ms", 0.0, "bench time at which it begins, ms", low=0.0),
    _number("fault[<N>].for_ms", None, "how long it lasts, ms; default: to the end", above=0.0),
    _text("fault[<N>].when", "", "a condition instead of a time"),
    _number(
        "fault[<N>].value", 0.0, "level of a stuck probe (0 or 1), ns of a clock skew, rate of a frame loss"
    ),
)
KEYS: Final = (*GENERAL, *AXIS, *PLANT, *DRIVE_TRAIN, *NODES)
LIST_KEYS: Final = (
    ("channel.<list path>", "a channel parameter; see `hli-bench params show`"),
    ("axis.<AXIS>.<list path>", "an axis parameter; see `hli-bench params show`"),
)


def pattern(key: Key) -> re.Pattern[str]:
    """Return the pattern of a key's path; `<AXIS>`, `<N>` ... become groups of that name."""
    parts = PLACEHOLDER.split(key.path)
    text = "".join(
        f"(?P<{part}>{'[0-9]+' if part == 'N' else '[^.]+'})" if number % 2 else re.escape(part)
        for number, part in enumerate(parts)
    )
    return re.compile(text)


UNIT: Final = "_mm"
"""Ends the names of positions, which are degrees for a rotary axis: each is taken without it too."""
WITHOUT_UNIT: Final = tuple(
    pattern(replace(key, path=key.path.removesuffix(UNIT))) for key in KEYS if key.path.endswith(UNIT)
)


@lru_cache(maxsize=4096)
def canonical(path: str) -> str:
    """Return the path under which a key stands in the schema: `plant.probe.A.face` is `plant.probe.A.face_mm`."""
    return path + UNIT if any(expression.fullmatch(path) for expression in WITHOUT_UNIT) else path


def lines() -> Iterator[str]:
    """Yield the schema of machine.toml, a line a key."""
    for key in KEYS:
        default = "" if key.default is None or key.default == "" else f" [{_shown(key.default)}]"
        also = f"; also without {UNIT}" if key.path.endswith(UNIT) else ""
        yield f"{key.path}: {key.expected()}{default}: {key.doc}{also}"
    for path, doc in LIST_KEYS:
        yield f"{path}: {doc}"


def text() -> str:
    """Return the schema as one text."""
    return "\n".join(lines()) + "\n"


def _shown(value: Plain) -> str:
    """Return a default as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    return value.isoformat() if isinstance(value, datetime) else str(value)
