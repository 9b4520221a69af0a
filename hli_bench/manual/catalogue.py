"""Parameters by path and by number, and the conversion of list texts and TOML values to their types."""

import difflib
import re
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from enum import Enum, IntFlag, StrEnum
from functools import cache, cached_property
from types import MappingProxyType
from typing import Any, Final, cast

from hli_bench.base.errors import InputError
from hli_bench.manual.sheet import LIMITS, Entry, Sheet, Value, entries

INDEX: Final = re.compile(r"\[\s*(\d{1,9})\s*\]")
PLACEHOLDER: Final = re.compile(r"\[[ijk]\]")
WORDS_OF_TRUTH: Final = MappingProxyType({"0": False, "1": True, "FALSE": False, "TRUE": True})


@dataclass(frozen=True, slots=True)
class Located:
    """A path that was found: its entry and its full spelling in the manual's words."""

    entry: Entry
    path: str


@dataclass(frozen=True)
class Catalogue:
    """All parameters of one tree, by path and by number."""

    cls: type[Any]
    entries: tuple[Entry, ...] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", tuple(entries(self.cls)))

    @cached_property
    def by_pattern(self) -> Mapping[str, Entry]:
        """Entries by path with empty indices (`getriebe[].vb_max`), aliases included."""
        found = {PLACEHOLDER.sub("[]", entry.path): entry for entry in self.entries}
        for entry in self.entries:
            for alias in entry.sheet.aliases:
                found[alias] = entry
        return found

    @cached_property
    def by_number(self) -> Mapping[str, Entry]:
        """Entries by number (`P-AXIS-00516`)."""
        return {entry.sheet.number: entry for entry in self.entries if entry.sheet.number}

    @cached_property
    def unbuilt_defaults(self) -> tuple[Entry, ...]:
        """Parameters of array elements whose default asks for something that is not built."""
        return tuple(
            one for one in self.entries if "]." in one.path and one.default in one.sheet.not_emulated
        )

    def find(self, text: str) -> Entry | None:
        """Return the parameter meant by a number or a path, with or without indices."""
        pattern = PLACEHOLDER.sub("[]", INDEX.sub("[]", text))
        return self.by_number.get(text.upper()) or self.by_pattern.get(pattern)

    def locate(self, path: str) -> Located:
        """Return the parameter at a full path; raise InputError for an unknown name or an index too large."""
        entry = self.by_pattern.get(INDEX.sub("[]", path))
        if entry is None:
            raise InputError(f"{path}: unknown parameter{self._hint(path)}")
        indices = [int(index) for index in INDEX.findall(path)]
        if len(indices) < len(entry.sizes):
            written = PLACEHOLDER.sub("[0]", entry.path)
            raise InputError(f"{path}: the index is missing, expected e.g. {written}")
        for index, size in zip(indices, entry.sizes, strict=True):
            if index >= size:
                raise InputError(f"{path}: index {index} is out of range 0..{size - 1}")
        rest = iter(indices)
        return Located(entry, PLACEHOLDER.sub(lambda _: f"[{next(rest)}]", entry.path))

    def _hint(self, path: str) -> str:
        """Return ' (did you mean ...?)' for the nearest known path."""
        pattern = INDEX.sub("[]", path)
        near = difflib.get_close_matches(pattern, self.by_pattern, n=1, cutoff=0.75)
        if not near:
            last = pattern.rsplit(".", 1)[-1]
            near = [known for known in self.by_pattern if known.rsplit(".", 1)[-1] == last][:1]
        return f" (did you mean {near[0].replace('[]', '[0]')}?)" if near else ""


def catalogue(cls: type[Any]) -> Catalogue:
    """Return the catalogue of AxisParams or ChannelParams."""
    return _catalogue(cast("Hashable", cls))


@cache
def _catalogue(cls: Hashable) -> Catalogue:
    return Catalogue(cast("type[Any]", cls))


def convert(entry: Entry, path: str, raw: object) -> Value:
    """Return a list or TOML value in the parameter's type; raise InputError naming the permitted values."""
    sheet = entry.sheet
    text = (
        raw.strip() if isinstance(raw, str) else ("1" if raw else "0") if isinstance(raw, bool) else str(raw)
    )
    try:
        value = _typed(entry, _unquoted(text))
    except ValueError:
        expected = f"expected {sheet.range_text()}" if sheet.choices else f"expected {sheet.data_type}"
        raise InputError(f"{path}: {text!r} is not valid, {expected}{named(sheet)}") from None
    if not _in_range(sheet, value):
        raise InputError(f"{path}: {text} is out of range {sheet.range_text()}{named(sheet)}")
    return value


def named(sheet: Sheet) -> str:
    """Return the number of a parameter in brackets for messages, or nothing."""
    return f" ({sheet.number})" if sheet.number else ""


def _unquoted(text: str) -> str:
    return text[1:-1] if len(text) >= 2 and text[0] == text[-1] and text[0] in "\"'" else text


def _typed(entry: Entry, text: str) -> Value:
    """Return the text in the parameter's type, or raise ValueError."""
    kind = entry.python_type
    text_or_number = dict(entry.sheet.words).get(text, text)
    if issubclass(kind, IntFlag):
        return _flags(kind, str(text_or_number))
    if issubclass(kind, Enum):
        word = text_or_number if issubclass(kind, StrEnum) else int(str(text_or_number), 0)
        return cast("Value", kind(word))
    if kind is bool:
        if text.upper() not in WORDS_OF_TRUTH:
            raise ValueError(text)
        return WORDS_OF_TRUTH[text.upper()]
    if kind is int:
        return int(text, 0) if text.lower().lstrip("+-").startswith("0x") else int(text)
    return float(text) if kind is float else text


def _flags(kind: type[IntFlag], text: str) -> Value:
    """Return mode bits; unknown bits are not valid."""
    number = int(text, 0)
    known = 0
    for member in kind:
        known |= member.value
    if number & ~known or number < 0:
        raise ValueError(text)
    return kind(number)


def _in_range(sheet: Sheet, value: Value) -> bool:
    """Tell whether a value lies in the sheet's range; bounds that are other parameters are checked later."""
    if isinstance(value, str):
        return (not sheet.choices or value in sheet.choices) and (
            not sheet.max_length or len(value) <= sheet.max_length
        )
    if value == sheet.unset:
        return True
    if sheet.choices:
        return value in sheet.choices
    if sheet.nonzero and value == 0:
        return False
    low, high = LIMITS.get(sheet.data_type, (float("-inf"), float("inf")))
    low = max(low, sheet.low) if isinstance(sheet.low, int | float) else low
    high = min(high, sheet.high) if isinstance(sheet.high, int | float) else high
    return low <= value <= high
