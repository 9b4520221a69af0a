"""List files (`*.lis`): parsing and checking. Every finding names file and line.

`path value  # comment`, one a line; `path[i].x` for arrays; `End` closes the list; lines of dots are skipped.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Final, NamedTuple

from hli_bench.base.errors import InputError
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis.fallbacks import effective_signal, permitted_inputs
from hli_bench.manual.catalogue import INDEX, PLACEHOLDER, Catalogue, catalogue, convert, named
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.drive_types import AxisMode
from hli_bench.manual.measuring_methods import corrections
from hli_bench.manual.sheet import Effect, Entry, Value
from hli_bench.manual.trees import build, converted, flatten, refusals, value_at, with_value

__all__ = [
    "Finding",
    "ParsedList",
    "Severity",
    "build",
    "check_values",
    "converted",
    "flatten",
    "parse_axis_list",
    "parse_channel_list",
    "parse_list",
    "refusals",
    "value_at",
    "with_value",
]

FILLER: Final = re.compile(r"^\.{2,}$")
PER_MILLE: Final = frozenset({"P-AXIS-00772", "P-AXIS-00777"})
ONE_OF_SEVERAL: Final = ("getriebe[", "lr_hw[")
END: Final = frozenset({"end", "ende"})


class Severity(StrEnum):
    """How much a finding matters."""

    ERROR = "error"
    """The list is not accepted."""
    WARNING = "warning"
    """Accepted; the control would correct or ignore something."""
    NOTE = "note"
    """Accepted; changes nothing in this bench."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One remark about a list, with its place."""

    severity: Severity
    message: str
    file: str = ""
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        return str(self.as_error())

    def place(self) -> str:
        """Return file and line, as far as they are known."""
        return ":".join(str(part) for part in (self.file, self.line) if part)

    def as_error(self) -> InputError:
        """Return the finding as the usage error to raise."""
        return InputError(self.message, self.file, self.line, self.column)


class ParsedList(NamedTuple):
    """What a list says: values by full path (`getriebe[0].vb_max`), and everything that was wrong with it."""

    values: dict[str, Value]
    findings: list[Finding]
    lines: dict[str, int]
    """Line of each path."""
    ignored: list[str]
    """What a lenient reading passed over, with its line."""


def parse_axis_list(text: str, file: str = "", *, lenient: bool = False) -> ParsedList:
    """Parse and check an axis list; never raises for what the list says."""
    return parse_list(AxisParams, text, file, lenient=lenient)


def parse_channel_list(text: str, file: str = "", *, lenient: bool = False) -> ParsedList:
    """Parse and check a channel list; never raises for what the list says."""
    return parse_list(ChannelParams, text, file, lenient=lenient)


def parse_list(cls: type[Any], text: str, file: str = "", *, lenient: bool = False) -> ParsedList:
    """Parse a list for the tree `cls`: all values that are right, and all findings.

    A `lenient` reading passes over parameters that the bench does not know and over remarks that begin with a bracket
    which never closes, as lists of real machines have them; what it passed over is one warning. Values of parameters
    that it knows must be right all the same: a default in the place of a wrong value would be a different machine.
    """
    known = catalogue(cls)
    parsed = ParsedList({}, [], {}, [])
    rows = _rows(text)
    for number, path, column, raw in rows:
        if path.lower() in END:
            parsed.findings.extend(_behind_end(rows, number, file))
            break
        if lenient and known.find(path) is None:
            parsed.ignored.append(f"{path} (line {number}, unknown)")
            continue
        value, remark = _open_remark(raw) if lenient else (raw, "")
        if remark:
            parsed.ignored.append(f"{remark!r} (line {number}, behind the value)")
        try:
            located = known.locate(path)
            if located.path in parsed.lines:
                raise InputError(
                    f"{located.path}: given twice, lines {parsed.lines[located.path]} and {number}"
                )
            parsed.lines[located.path] = number
            if value is None and not located.entry.takes_empty:
                raise InputError(f"{located.path}: the value is missing")
            parsed.values[located.path] = convert(located.entry, located.path, value or "")
        except InputError as error:
            parsed.findings.append(Finding(Severity.ERROR, error.message, file, number, column))
    if parsed.ignored:
        count = len(parsed.ignored)
        message = (
            f"lenient: {count} {'thing' if count == 1 else 'things'} ignored: {'; '.join(parsed.ignored)}"
        )
        parsed.findings.append(Finding(Severity.WARNING, message, file))
    parsed.findings.extend(_placed(check_values(cls, parsed.values), parsed.lines, file))
    return parsed


def _rows(text: str) -> Iterator[tuple[int, str, int, str | None]]:
    """Yield (line, path, column, value text) of every line that says something."""
    for number, line in enumerate(text.splitlines(), start=1):
        content = line.split("#", 1)[0].strip()
        if not content or FILLER.match(content):
            continue
        path, *rest = content.split(maxsplit=1)
        yield number, path, line.index(path[0]) + 1, _value_text(rest[0] if rest else "")


def _behind_end(rows: Iterator[tuple[int, str, int, str | None]], end: int, file: str) -> Iterator[Finding]:
    """Yield a warning when `End` in line `end` is not the end: the control reads no further."""
    first = next(rows, None)
    if first is not None:
        number, path, column, _ = first
        count = 1 + sum(1 for _ in rows)
        message = f"{path}: stands behind `End` of line {end} and does not count" + (
            f", nor do {count - 1} more lines" if count > 1 else ""
        )
        yield Finding(Severity.WARNING, message, file, number, column)


def _value_text(rest: str) -> str | None:
    """Return the value of a line without a trailing remark in round brackets; None when there is none."""
    if rest.startswith('"') and '"' in rest[1:]:
        return rest[: rest.index('"', 1) + 1]
    return re.sub(r"\s*\(.*\)$", "", rest) or None


def _open_remark(value: str | None) -> tuple[str | None, str]:
    """Return a value without the remark whose bracket never closes, and that remark; a quoted text has none."""
    if value is None or value.startswith('"'):
        return value, ""
    before, bracket, behind = value.partition("(")
    return before.rstrip() or None, bracket + behind


def _placed(found: Sequence[tuple[str, Finding]], lines: Mapping[str, int], file: str) -> Iterator[Finding]:
    """Yield findings about values with the place of the value."""
    for path, finding in found:
        yield replace(finding, file=file, line=lines.get(path, 0))


def check_values(cls: type[Any], values: Mapping[str, Value]) -> list[tuple[str, Finding]]:
    """Check values against one another and say which of them change nothing; returns (path, finding)."""
    found: list[tuple[str, Finding]] = []
    known = catalogue(cls)
    for path, value in values.items():
        entry = known.locate(path).entry
        for bound, below in ((entry.sheet.low, True), (entry.sheet.high, False)):
            if isinstance(bound, str) and not isinstance(value, str) and value != entry.sheet.unset:
                found.extend(_beyond(known, values, path, value, bound, below=below))
        if entry.sheet.number in PER_MILLE and isinstance(value, int) and value > 1000:
            message = f"{path}: {value} is above 1000; a run to a fixed stop would end with P-ERR-51026"
            found.append((path, Finding(Severity.WARNING, f"{message} ({entry.sheet.number})")))
        if path == "kenngr.achs_mode" and isinstance(value, AxisMode):
            found.extend(_axis_mode(path, value))
        if value != entry.default and not _acts(entry, path):
            note = f"{path}: accepted, changes nothing in this bench{named(entry.sheet)}"
            found.append((path, Finding(Severity.NOTE, note)))
    if cls is AxisParams:
        found.extend(_axis_rules(values))
    return found


INPUT_PATHS: Final = (
    "kenngr.measure.input",
    "antr.probing_input_nbr",
    "antr.canopen.probing_input_number",
)
"""Where a list names the probing input; the first that is not 0 counts."""


def _acts(entry: Entry, path: str) -> bool:
    """Tell whether a parameter changes anything: the first gear step and hardware set are always the engaged ones."""
    engaged = not path.startswith(ONE_OF_SEVERAL) or path.partition("]")[0].endswith("[0")
    return engaged and entry.sheet.effect is not Effect.ACCEPTED


def _axis_rules(values: Mapping[str, Value]) -> Iterator[tuple[str, Finding]]:
    """Yield findings about parameters that must fit together."""
    if values.get("kenngr.ref_ohne_nocken") is True and values.get("kenngr.ref_ohne_rev") is not True:
        message = "kenngr.ref_ohne_nocken: 1 needs kenngr.ref_ohne_rev 1 (P-AXIS-00156, P-AXIS-00157)"
        yield "kenngr.ref_ohne_nocken", Finding(Severity.WARNING, message)
    for path, message in corrections(values):
        yield path, Finding(Severity.WARNING, message)
    kenngr = build(AxisParams, values).kenngr
    inputs = permitted_inputs(effective_signal(kenngr), kenngr.antr_typ)
    path = next((path for path in INPUT_PATHS if values.get(path)), "")
    if path and inputs is not None and values[path] not in inputs:
        permitted = f"{inputs.start}..{inputs.stop - 1} of this source"
        message = (
            f"{path}: {values[path]} is not one of {permitted}, corrected to 1 (P-ERR-110587, P-AXIS-00517)"
        )
        yield path, Finding(Severity.WARNING, message)


def _beyond(
    known: Catalogue, values: Mapping[str, Value], path: str, value: float, bound: str, *, below: bool
) -> Iterator[tuple[str, Finding]]:
    """Yield the finding for a value beyond another parameter: an error if that one is in the list as well.

    Against a default it is only a warning, because a list may be an excerpt (decided here).
    """
    factor, _, number = bound.rpartition("*")
    other = known.by_number[number]
    gear = (INDEX.findall(path) or ["0"])[0]
    other_path = PLACEHOLDER.sub(f"[{gear}]", other.path)
    limit = values.get(other_path, other.default)
    if factor and not isinstance(limit, str):
        limit *= int(factor)
    if isinstance(limit, str) or (value >= limit if below else value <= limit):
        return
    relation = "below" if below else "above"
    severity = Severity.ERROR if other_path in values else Severity.WARNING
    origin = "" if other_path in values else ", its default"
    message = f"{path}: {value} is {relation} {factor}{'*' if factor else ''}{other_path} = {limit}{origin} ({bound})"
    yield path, Finding(severity, message)


def _axis_mode(path: str, mode: AxisMode) -> Iterator[tuple[str, Finding]]:
    """Yield findings about the axis mode bits. Source: homing manual 4.2, note (1)."""
    if (AxisMode.LINEAR in mode) == (AxisMode.MODULO in mode):
        message = f"{path}: {mode:#x} must have exactly one of LINEAR 0x1 and MODULO 0x4 (P-AXIS-00015)"
        yield path, Finding(Severity.ERROR, message)
    if AxisMode.MODULO_LINEAR in mode and AxisMode.MODULO not in mode:
        message = f"{path}: MODULO_LINEAR 0x400 acts only with MODULO 0x4 (P-AXIS-00015)"
        yield path, Finding(Severity.WARNING, message)
