"""NC variables (`V.*`) the decoder knows: type, unit, access, and whether a read empties the channel first.

The decoder takes from these rows which names can be read, what may be written, and where a read waits.
Sources: measurement manual 5, fixed stop manual, TF5200 programming manual 1.32 (its `Integer` is SGN32).
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from hli_bench.manual.sheet import DataType, Effect


class Access(StrEnum):
    """What a program may do with a variable."""

    READ = "R"
    READ_WRITE = "RW"


@dataclass(frozen=True, slots=True, kw_only=True)
class NcVariable:
    """One variable; `<axis>` stands for an axis name or an index 0..31 in brackets, `<name>` for any name."""

    pattern: str
    data_type: DataType
    unit: str
    access: Access
    flush: bool
    """The read waits until everything programmed before it has been executed."""
    effect: Effect
    doc: str

    @property
    def name(self) -> str:
        """The name without area and axis: `MEAS.ACS.VALUE` of `V.A.MEAS.ACS.VALUE.<axis>`."""
        return self.pattern.partition(".")[2].partition(".")[2].partition(".<")[0]


def _axis(
    pattern: str,
    doc: str,
    *,
    flush: bool,
    data_type: DataType = DataType.REAL64,
    unit: str = "mm, °",
    effect: Effect = Effect.EMULATED,
) -> NcVariable:
    """Return a row for a readable axis variable."""
    return NcVariable(
        pattern=pattern,
        data_type=data_type,
        unit=unit,
        access=Access.READ,
        flush=flush,
        effect=effect,
        doc=doc,
    )


def _own(prefix: str, doc: str) -> NcVariable:
    """Return a row for variables that programs declare and write themselves; numbers are REAL64."""
    return NcVariable(
        pattern=f"{prefix}.<name>",
        data_type=DataType.REAL64,
        unit="",
        access=Access.READ_WRITE,
        flush=False,
        effect=Effect.EMULATED,
        doc=doc,
    )


NC_VARIABLES: Final = (
    _axis("V.A.MESS.<axis>", "Measured value of the last measuring run.", flush=True),
    _axis(
        "V.A.MERF.<axis>",
        "The last measuring run got a value.",
        flush=True,
        data_type=DataType.BOOLEAN,
        unit="",
    ),
    _axis("V.A.MOFFS.<axis>", "Measured offset: measured value less target.", flush=True),
    _axis("V.A.MEIN.<axis>", "Measured offset that G101 has included.", flush=False),
    _axis("V.A.MEAS.ACS.VALUE.<axis>", "Measured value in the axis coordinate system.", flush=True),
    _axis("V.A.MEAS.PCS.VALUE.<axis>", "Measured value in the program coordinate system.", flush=True),
    _axis("V.A.ABS.<axis>", "Command position in the program's coordinates, offsets included.", flush=False),
    _axis("V.A.PROG.<axis>", "Programmed position.", flush=False),
    _axis("V.A.ACT_POS.<axis>", "Actual position without offsets.", flush=True),
    _axis("V.A.ACS.ABS.<axis>", "Command position in the axis coordinate system.", flush=False),
    _axis("V.A.RERF.<axis>", "The axis is homed.", flush=True, data_type=DataType.BOOLEAN, unit=""),
    _axis("V.A.REF.<axis>", "Reference point; filled after homing.", flush=True, effect=Effect.REFUSED),
    _axis("V.A.BZP.<axis>", "Offset of the reference point.", flush=False),
    NcVariable(
        pattern="V.G.MEAS_TYPE",
        data_type=DataType.SGN32,
        unit="",
        access=Access.READ,
        flush=False,
        effect=Effect.EMULATED,
        doc="Measurement type in force.",
    ),
    NcVariable(
        pattern="V.G.FEEDRATE",
        data_type=DataType.REAL64,
        unit="mm/min",
        access=Access.READ,
        flush=False,
        effect=Effect.EMULATED,
        doc="Feed that was programmed last (F word).",
    ),
    NcVariable(
        pattern="V.G.RW",
        data_type=DataType.REAL64,
        unit="mm",
        access=Access.READ_WRITE,
        flush=False,
        effect=Effect.REFUSED,
        doc="Path after an edge banding event.",
    ),
    NcVariable(
        pattern="V.RTA.FIXED_STOP.ACTIVE.<axis>",
        data_type=DataType.BOOLEAN,
        unit="",
        access=Access.READ,
        flush=True,
        effect=Effect.REFUSED,
        doc="The axis moves to or stands at a fixed stop.",
    ),
    NcVariable(
        pattern="V.RTA.FIXED_STOP.DETECTED.<axis>",
        data_type=DataType.BOOLEAN,
        unit="",
        access=Access.READ,
        flush=True,
        effect=Effect.REFUSED,
        doc="The fixed stop was found.",
    ),
    NcVariable(
        pattern="V.RTA.FIXED_STOP.ACS.POS.<axis>",
        data_type=DataType.SGN64,
        unit="mm, °",
        access=Access.READ,
        flush=True,
        effect=Effect.REFUSED,
        doc="Position of the fixed stop.",
    ),
    _own("V.P", "Own variable, valid in the program and its subroutines until the end of the program."),
    _own("V.S", "Own variable, kept beyond the end of the program."),
    _own("V.L", "Own variable of the program and of subroutines it calls directly (none is built)."),
    _own("V.E", "External variable, shared with the PLC."),
)
"""All rows."""


def emulated(area: str) -> tuple[NcVariable, ...]:
    """Return the variables of an area (`A`, `G`) that have a value here."""
    return tuple(
        row for row in NC_VARIABLES if row.pattern.startswith(f"V.{area}.") and row.effect is Effect.EMULATED
    )


def own_areas() -> frozenset[str]:
    """Return the letters of the areas in which a program names variables itself."""
    return frozenset(row.pattern[2] for row in NC_VARIABLES if row.pattern.endswith("<name>"))
