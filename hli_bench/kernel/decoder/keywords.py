"""Keywords in the brackets of '#' commands: KEY=value, KEY value and the glued KEY10 all mean the same."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from hli_bench.kernel.decoder.configuration import DecoderAxis
from hli_bench.kernel.decoder.context import Context
from hli_bench.kernel.decoder.expressions import evaluate
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables

Kind = Literal["flag", "value", "word"]

_NAME = re.compile(r"[A-Z_][A-Z0-9_]*", re.IGNORECASE)
_VALUE_WORD = re.compile(r"[A-Z0-9_.]+", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Keyword:
    """One keyword with its value; `at` is its place in the block."""

    name: str
    value: float
    word: str
    at: int


def keywords(scanner: Scanner, memory: Variables, known: Mapping[str, Kind]) -> Iterator[Keyword]:
    """Take '[ KEY=value ... ]' keyword by keyword; commas between them are allowed."""
    scanner.expect("[")
    while not scanner.accept("]"):
        yield _keyword(scanner, memory, known)
        scanner.accept(",")


def _keyword(scanner: Scanner, memory: Variables, known: Mapping[str, Kind]) -> Keyword:
    expected = f"expected one of {', '.join(known)}"
    found = scanner.match(_NAME)
    if found is None:
        raise scanner.error(f"{expected} or ']', found {scanner.found()}")
    at, name = found.start(), found.group().upper()
    if name not in known:
        name = _glued(name, known)
        if not name:
            raise scanner.error(f"{expected}, found '{found.group()}'", at)
        scanner.pos = at + len(name)
    kind = known[name]
    if kind == "flag":
        return Keyword(name, 1.0, "", at)
    scanner.accept("=")
    if kind == "value":
        return Keyword(name, evaluate(scanner, memory), "", at)
    word = scanner.match(_VALUE_WORD)
    if word is None:
        raise scanner.error(f"expected a word after {name}=, found {scanner.found()}")
    return Keyword(name, 0.0, word.group(), at)


def _glued(name: str, known: Mapping[str, Kind]) -> str:
    """Return the keyword that a number follows without a blank, "" for none."""
    fits = [key for key, kind in known.items() if kind == "value" and name.startswith(key)]
    key = max(fits, key=len, default="")
    return key if name[len(key) : len(key) + 1].isdigit() else ""


def axis_of(scanner: Scanner, context: Context, keyword: Keyword) -> DecoderAxis:
    """Return the axis that AX=<name> or AXNR=<logical number> means."""
    if keyword.name == "AX":
        axis = context.by_name.get(keyword.word.upper())
        if axis is None:
            names = ", ".join(context.by_name)
            raise scanner.error(f"AX={keyword.word}: expected an axis of the channel ({names})", keyword.at)
        return axis
    axis = context.by_number.get(int(keyword.value)) if keyword.value == int(keyword.value) else None
    if axis is None:
        numbers = ", ".join(str(number) for number in context.by_number)
        raise scanner.error(
            f"AXNR={keyword.value:g}: expected an axis number of the channel ({numbers})", keyword.at
        )
    return axis
