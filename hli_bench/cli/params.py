"""`hli-bench params show / check`: the sheet of a parameter, and what is wrong with a list file."""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from enum import IntEnum, IntFlag
from pathlib import Path
from typing import Any, Final

from hli_bench.base import paths
from hli_bench.base.errors import InputError
from hli_bench.cli import tables
from hli_bench.cli.console import say, tell
from hli_bench.cli.options import Commands, add_lenient
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import Catalogue, catalogue
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.lists import Severity, parse_list, refusals
from hli_bench.manual.sheet import Effect, Entry, Sheet

KINDS: Final[Mapping[str, type[Any]]] = {"axis": AxisParams, "channel": ChannelParams}
EFFECTS: Final[Mapping[Effect, str]] = {
    Effect.EMULATED: "emulated",
    Effect.ACCEPTED: "accepted, changes nothing",
    Effect.REFUSED: "only the default is accepted, anything else is NotEmulated",
}
ARTICLE: Final[Mapping[str, str]] = {"axis": "an axis list", "channel": "a channel list"}
AXIS_TYPES: Final[Mapping[str, str]] = {"T": "translatory", "R": "rotary", "S": "spindle"}
BAD: Final = 2


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser("params", help="sheets of axis and channel parameters; check list files")
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    show = actions.add_parser("show", help="print the sheet of a parameter")
    show.add_argument(
        "names", metavar="ID-OR-PATH", nargs="+", help="P-AXIS-00516, P-CHAN-00057 or kenngr.measure.signal"
    )
    show.set_defaults(execute=show_sheets)
    search = actions.add_parser("find", help="list the parameters whose sheet holds all words")
    search.add_argument("words", metavar="WORD", nargs="+")
    search.set_defaults(execute=find_sheets)
    check = actions.add_parser(
        "check",
        help="check a list file",
        description="Prints what is wrong with a list file as file:line: text; ends with 2 when there are errors.",
    )
    check.add_argument("files", metavar="FILE.lis", nargs="+")
    check.add_argument("--kind", choices=tuple(KINDS), help="what the list is (default: by its content)")
    add_lenient(check)
    check.set_defaults(execute=check_lists)


# -- show -------------------------------------------------------------------------------------------------


def show_sheets(arguments: argparse.Namespace) -> int:
    """Print the sheets, an empty line between them. Raises InputError for an unknown parameter."""
    for number, (kind, entry) in enumerate([find(name) for name in arguments.names]):
        if number:
            say("")
        for line in tables.lines(sheet_rows(kind, entry)):
            say(line)
    return 0


def find_sheets(arguments: argparse.Namespace) -> int:
    """Print a line for each parameter that holds the words. Raises InputError when none does."""
    found = list(_holding([word.lower() for word in arguments.words]))
    if not found:
        raise InputError(f"no parameter holds {' and '.join(arguments.words)}", file="params find")
    for line in tables.lines(found):
        say(line)
    return 0


def _holding(words: Sequence[str]) -> Iterator[tuple[str, str, str]]:
    """Yield number, path and meaning of the parameters whose sheets hold all words, in small letters."""
    for kind, cls in KINDS.items():
        for entry in catalogue(cls).entries:
            text = " ".join(text for _, text in sheet_rows(kind, entry)).lower()
            if all(word in text for word in words):
                yield entry.sheet.number or "-", entry.path, entry.sheet.doc


def find(name: str) -> tuple[str, Entry]:
    """Return the kind of list and the parameter of a number or path. Raises InputError with the nearest."""
    known = {kind: catalogue(cls) for kind, cls in KINDS.items()}
    for kind, found in known.items():
        entry = found.find(name)
        if entry is not None:
            return kind, entry
    if name.upper().startswith("P-"):
        raise InputError(f"{name}: unknown parameter, expected P-AXIS-nnnnn, P-CHAN-nnnnn or a list path")
    if name.isdecimal():
        raise InputError(f"{name}: no parameter; `hli-bench errors show {name}` looks among the messages")
    if next(_holding([name.lower()]), None):
        raise InputError(
            f"{name}: no parameter of that name; `hli-bench params find {name}` lists those that hold it"
        )
    reasons = [reason for found in known.values() if (reason := _unknown(found, name))]
    raise InputError(next((reason for reason in reasons if "did you mean" in reason), reasons[0]))


def _unknown(known: Catalogue, name: str) -> str:
    try:
        known.locate(name)
    except InputError as error:
        return error.message
    return ""


def sheet_rows(kind: str, entry: Entry) -> Iterator[tuple[str, str]]:
    """Yield the lines of a sheet that say something: (heading, text)."""
    sheet = entry.sheet
    rows = {
        "number": sheet.number or "none printed",
        "path": entry.path,
        "list": kind,
        "meaning": sheet.doc,
        "type": str(sheet.data_type),
        "values": sheet.range_text(),
        "words": ", ".join(f"{word} = {value}" for word, value in sheet.words),
        "indices": ", ".join(
            f"{letter} = 0..{size - 1}" for letter, size in zip("ijk", entry.sizes, strict=False)
        ),
        "default": _shown(entry.default),
        "unit": _units(entry) if kind == "axis" else sheet.units.t,
        "axis types": ", ".join(AXIS_TYPES[letter] for letter in sheet.axis_types) if kind == "axis" else "",
        "drive types": _drive_types(sheet) if kind == "axis" else "",
        "effect": EFFECTS[sheet.effect],
        "not emulated": ", ".join(map(_shown, sheet.not_emulated)),
        "replaces": ", ".join(map(_named, sheet.replaces)),
        "replaced by": _named(sheet.replaced_by) if sheet.replaced_by else "",
        "also spelt": ", ".join(sheet.aliases),
        "since": sheet.since,
        "source": sheet.source,
    }
    return ((heading, text) for heading, text in rows.items() if text)


def _units(entry: Entry) -> str:
    """Return the unit, for each axis type where they differ."""
    units = entry.sheet.units
    by_type = {"T": units.t, "R": units.r, "S": units.s}
    used = {letter: unit for letter, unit in by_type.items() if letter in entry.sheet.axis_types and unit}
    if len(set(used.values())) <= 1:
        return next(iter(used.values()), "")
    return ", ".join(f"{AXIS_TYPES[letter]} {unit}" for letter, unit in used.items())


def _drive_types(sheet: Sheet) -> str:
    named = [f"{one.name} ({one.value})" for one in sheet.drive_types]
    return ", ".join([*named, *filter(None, [sheet.other_drives])]) or "all"


def _named(number: str) -> str:
    """Return a parameter number with its path."""
    for cls in KINDS.values():
        entry = catalogue(cls).find(number)
        if entry is not None:
            return f"{number} ({entry.path})"
    return number


def _shown(value: object) -> str:
    if isinstance(value, IntFlag):
        return f"{value:#x} ({value.name})"
    if isinstance(value, IntEnum):
        return f"{value.value} ({value.name})"
    if isinstance(value, int):
        return str(int(value))
    return str(value) or "(empty)"


# -- check ------------------------------------------------------------------------------------------------


def check_lists(arguments: argparse.Namespace) -> int:
    """Print the findings of all files; 2 when one of them is not accepted."""
    return max(
        [check_list(Path(file), arguments.kind, lenient=bool(arguments.lenient)) for file in arguments.files]
    )


def check_list(path: Path, kind: str | None, *, lenient: bool) -> int:
    """Print the findings of one list and what it is; errors go to standard error. Raises InputError."""
    text = paths.text(path)
    kind = kind or kind_of(text)
    cls = KINDS[kind]
    parsed = parse_list(cls, text, str(path), lenient=lenient)
    errors = [finding for finding in parsed.findings if finding.severity is Severity.ERROR]
    for finding in sorted(parsed.findings, key=lambda one: one.line):
        show = tell if finding.severity is Severity.ERROR else say
        place = f"{path}:{finding.line}" if finding.line else str(path)
        show(f"{place}: {finding.severity}: {finding.message}")
    if errors:
        return BAD
    for refused, text in refusals(cls, parsed.values):
        say(f"{path}:{parsed.lines[refused]}: note: NotEmulated: {text}")
    say(f"{path}: {ARTICLE[kind]} with {len(parsed.values)} parameters, accepted")
    return 0


def kind_of(text: str) -> str:
    """Return the kind of list that knows more of the names in it; axis when neither does better."""
    unknown = {kind: _count_unknown(cls, text) for kind, cls in KINDS.items()}
    return min(unknown, key=lambda kind: unknown[kind])


def _count_unknown(cls: type[Any], text: str) -> int:
    return sum("unknown parameter" in finding.message for finding in parse_list(cls, text).findings)
