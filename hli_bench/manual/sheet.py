"""The manual's parameter sheet as a record, and the dataclass field that carries it.

A parameter is a field of a frozen dataclass; the nesting of the classes is its path in the list file.
Everything else (parser, checks, index by number, documentation) is derived by walking the fields: `entries`.
"""

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, field, fields
from enum import StrEnum
from typing import Any, Final, TypeVar, get_args, get_origin, get_type_hints

from hli_bench.manual.drive_types import DriveType

Value = bool | int | float | str
"""What a parameter may hold; enumerations are subclasses of int or str."""

SHEET: Final = "sheet"
ARRAY: Final = "array"

T = TypeVar("T")


class DataType(StrEnum):
    """Data types as printed on the sheets."""

    BOOLEAN = "BOOLEAN"
    UNS08 = "UNS08"
    UNS16 = "UNS16"
    UNS32 = "UNS32"
    SGN08 = "SGN08"
    SGN16 = "SGN16"
    SGN32 = "SGN32"
    SGN64 = "SGN64"
    REAL64 = "REAL64"
    STRING = "STRING"


LIMITS: Final[Mapping[DataType, tuple[int, int]]] = {
    DataType.BOOLEAN: (0, 1),
    DataType.UNS08: (0, 2**8 - 1),
    DataType.UNS16: (0, 2**16 - 1),
    DataType.UNS32: (0, 2**32 - 1),
    DataType.SGN08: (-(2**7), 2**7 - 1),
    DataType.SGN16: (-(2**15), 2**15 - 1),
    DataType.SGN32: (-(2**31), 2**31 - 1),
    DataType.SGN64: (-(2**63), 2**63 - 1),
}
"""Smallest and largest value of each whole-number type."""


class Effect(StrEnum):
    """What the bench does with a parameter."""

    EMULATED = "EMULATED"
    """Changes the behaviour as the manual says."""
    ACCEPTED = "ACCEPTED"
    """Valid input that changes nothing yet; `params check` says so."""
    REFUSED = "REFUSED"
    """Any value but the default raises NotEmulated when the machine is built."""


@dataclass(frozen=True, slots=True)
class Units:
    """Dimension of a parameter for translatory (T), rotary (R) and spindle (S) axes."""

    t: str = ""
    r: str = ""
    s: str = ""


NO_UNIT: Final = Units()
LENGTH: Final = Units("0.1 µm", "0.0001°", "0.0001°")
VELOCITY: Final = Units("µm/s", "0.001°/s", "0.001°/s")
ACCELERATION: Final = Units("mm/s²", "°/s²", "°/s²")
JERK: Final = Units("mm/s³", "°/s³", "°/s³")
MICROSECONDS: Final = Units("µs", "µs", "µs")
TENTH_PERCENT: Final = Units("0.1 %", "0.1 %", "0.1 %")
CYCLES: Final = Units("cycles", "cycles", "cycles")


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """One parameter sheet, column by column. A bound given as text is the number of another parameter.

    `2*P-AXIS-00008` is twice its value.
    """

    number: str
    """`P-AXIS-00516`; empty where a manual uses the path but prints no number."""
    data_type: DataType
    doc: str
    source: str
    effect: Effect
    low: float | str | None = None
    high: float | str | None = None
    unset: float | None = None
    """A value outside the range that stands for 'not set' (mostly the default 0)."""
    nonzero: bool = False
    choices: tuple[int | str, ...] = ()
    words: tuple[tuple[str, int | str], ...] = ()
    """Further words a list may use, and the value each stands for."""
    max_length: int = 0
    units: Units = NO_UNIT
    axis_types: str = "TRS"
    drive_types: tuple[DriveType, ...] = ()
    """Empty: all, but with `other_drives` only those."""
    other_drives: str = ""
    """Drives that P-AXIS-00020 has no number for."""
    since: str = ""
    replaces: tuple[str, ...] = ()
    replaced_by: str = ""
    aliases: tuple[str, ...] = ()
    """Other spellings of the path that printed examples use."""
    not_emulated: tuple[int | str, ...] = ()
    """Values of an otherwise emulated parameter that are not built: NotEmulated when the machine is built."""

    def range_text(self) -> str:
        """Return the permitted values as text for messages: `0..255`, `POS, NEG`, `1..P-AXIS-00212`."""
        if self.choices:
            return ", ".join(str(choice) or "(empty)" for choice in self.choices)
        if self.data_type is DataType.STRING:
            return f"at most {self.max_length} characters" if self.max_length else "text"
        if self.data_type is DataType.REAL64 and self.low is None and self.high is None:
            return "(any number but 0)" if self.nonzero else "(any number)"
        low, high = LIMITS.get(self.data_type, ("", ""))
        text = f"{low if self.low is None else self.low}..{high if self.high is None else self.high}"
        return text if self.unset is None else f"{self.unset} (not set) or {text}"


@dataclass(frozen=True, slots=True)
class Array:
    """Marks a field that is an array of parameter groups."""

    element: type[Any]
    size: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A parameter found by walking the classes: `getriebe[i].vb_refmax` with its sheet, type and default."""

    path: str
    sheet: Sheet
    python_type: type
    default: Value
    sizes: tuple[int, ...] = ()
    """How many elements each index of the path may have."""

    @property
    def takes_empty(self) -> bool:
        """Whether a line without a value gives an empty text, as lists print it."""
        return self.python_type is str and (not self.sheet.choices or "" in self.sheet.choices)


def axis_page(page: int) -> str:
    """Return the source text of a page of the public TF5200 axis parameter book."""
    return f"TF5200 axis parameters, infosys page {page}"


def param(default: T, sheet: Sheet) -> T:
    """Return a dataclass field with this default that carries its sheet (typed as the default, for mypy)."""
    return field(default=default, metadata={SHEET: sheet})


def array_of(element: type[Any], size: int) -> dict[str, Array]:
    """Return the metadata of a field that is an array of at most `size` groups."""
    return {ARRAY: Array(element, size)}


def entries(cls: type[Any], prefix: str = "", sizes: tuple[int, ...] = ()) -> Iterator[Entry]:
    """Yield every parameter below `cls` in the order of declaration."""
    hints = get_type_hints(cls)
    for item in fields(cls):
        path, hint = prefix + item.name, hints[item.name]
        sheet, array = item.metadata.get(SHEET), item.metadata.get(ARRAY)
        index = f"[{'ijk'[len(sizes)]}]"
        if array is not None:
            yield from entries(array.element, f"{path}{index}.", (*sizes, array.size))
        elif sheet is None:
            yield from entries(hint, path + ".", sizes)
        elif get_origin(hint) is tuple:
            values: Any = item.default
            yield Entry(
                path=path + index,
                sheet=sheet,
                python_type=get_args(hint)[0],
                default=values[0],
                sizes=(*sizes, len(values)),
            )
        else:
            assert item.default is not MISSING
            yield Entry(path=path, sheet=sheet, python_type=hint, default=item.default, sizes=sizes)
