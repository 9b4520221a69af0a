"""`hli-bench errors show / find`: the messages of the CNC as sheets."""

import argparse
from collections.abc import Iterator

from hli_bench.base.errors import InputError
from hli_bench.cli import tables
from hli_bench.cli.console import say
from hli_bench.cli.options import Commands
from hli_bench.manual.errors import ErrorSheet, by_number


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser("errors", help="sheets of the messages of the CNC")
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    show = actions.add_parser("show", help="print the sheet of a message")
    show.add_argument("numbers", metavar="ID", nargs="+", help="70020 or P-ERR-70020")
    show.set_defaults(execute=show_sheets)
    search = actions.add_parser("find", help="list the messages whose sheet holds all words")
    search.add_argument("words", metavar="WORD", nargs="+")
    search.set_defaults(execute=find_sheets)


def show_sheets(arguments: argparse.Namespace) -> int:
    """Print the sheets, an empty line between them. Raises InputError for an unknown message."""
    for place, sheet in enumerate([sheet_of(text) for text in arguments.numbers]):
        if place:
            say("")
        for line in tables.lines(rows(sheet)):
            say(line)
    return 0


def find_sheets(arguments: argparse.Namespace) -> int:
    """Print a line for each message that holds the words. Raises InputError when none does."""
    words = [word.lower() for word in arguments.words]
    found = [
        (str(sheet), str(sheet.severity), sheet.message())
        for sheet in by_number().values()
        if all(word in " ".join(text for _, text in rows(sheet)).lower() for word in words)
    ]
    if not found:
        raise InputError(f"no message holds {' and '.join(arguments.words)}", file="errors find")
    for line in tables.lines(sorted(found)):
        say(line)
    return 0


def sheet_of(text: str) -> ErrorSheet:
    """Return the sheet of a number, with or without P-ERR-. Raises InputError."""
    digits = text.upper().removeprefix("P-ERR-")
    sheet = by_number().get(int(digits)) if digits.isdecimal() and len(digits) < 9 else None
    if sheet is None:
        raise InputError(f"{text}: no message of that number is known; `hli-bench errors find WORD` searches")
    return sheet


def rows(sheet: ErrorSheet) -> Iterator[tuple[str, str]]:
    """Yield the lines of a sheet: (heading, text)."""
    yield "number", str(sheet)
    yield "name", sheet.name
    yield "text", sheet.message()
    yield "severity", str(sheet.severity)
    yield "reaction", f"{int(sheet.reaction_class)} ({sheet.reaction_class.name.lower().replace('_', ' ')})"
    yield "remedy", str(sheet.remedy_class)
    for place, meaning in enumerate(sheet.values):
        yield f"value {place + 1}", meaning
    if sheet.details:
        yield "the bench adds", ", ".join(sheet.details)
    yield "source", sheet.source
