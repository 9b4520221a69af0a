"""Blocks of G, M, F and axis words."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from hli_bench.base.errors import BenchError
from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Dwell, Home, Line, MeasuringRun, ProgramEnd
from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.coordinates import rounded
from hli_bench.kernel.decoder.expressions import evaluate
from hli_bench.kernel.decoder.faults import CncStop
from hli_bench.kernel.decoder.text import Scanner, short
from hli_bench.kernel.decoder.variables import Variables
from hli_bench.manual.dialect import (
    AXIS_COMMANDS,
    BUILT,
    G_FUNCTIONS,
    LETTERS,
    M_FUNCTIONS,
    SIGNS,
    TECHNOLOGY,
    missing,
)
from hli_bench.manual.errors import decoder as errors

_G_WORD = re.compile(r"G([0-9]+(?:\.[0-9]+)?)", re.IGNORECASE)
_M_WORD = re.compile(r"M([0-9]+)", re.IGNORECASE)
_LETTERS = re.compile(r"[A-Z_][A-Z0-9_]*", re.IGNORECASE)
_ADDRESS = re.compile(r"[A-Z][0-9]*|LL|LV")
_AXIS_COMMAND = re.compile(rf"\s*\[\s*(MC_\w+|[MGH][0-9]+|{'|'.join(AXIS_COMMANDS)})\b", re.IGNORECASE)
LONGEST_DWELL: Final = (2**32 - 1) // 1000
"""Seconds of G04 at most (decided here: ms in UNS32)."""
_BUILT: Final = tuple(f"G{name[1:]:0>2}" for name, what in G_FUNCTIONS.items() if what == BUILT)

TAKING_AXES: Final = frozenset((74, 92, 100, 101, 102))
"""G functions that give the axis words of their block another meaning than a position to move to."""

WITHOUT_G100: Final = frozenset((5, 6))
"""Measurement types whose runs are programmed with G310 (measurement manual, chapter 3)."""

FEED_FROM_AXIS: Final = 2
"""Measurement type whose feed is P-AXIS-00215."""

IN_FORCE: Final = frozenset((17, 40, 71, 94))
"""G functions that select what is in force anyway: plane XY, no radius compensation, mm, feed per minute."""


@dataclass(slots=True)
class Words:
    """The words of one block; `at` is where the word stands that would make it an error."""

    functions: list[int] = field(default_factory=list)
    axes: list[tuple[AxisIndex, float]] = field(default_factory=list)
    seconds: float | None = None
    end: bool = False
    at: int = 0


class WordReader:
    """Takes blocks of words apart; built once a program because the axis names are known then."""

    __slots__ = ("_axis", "_context", "_memory")

    def __init__(self, context: Context, memory: Variables) -> None:
        self._context = context
        self._memory = memory
        names = sorted(context.by_name, key=len, reverse=True)
        # An axis name that ends in a digit takes its value after '=' only: X2=100, because X2 is axis X at 2.
        parts = [re.escape(name) + (r"(?=\s*=)" if name[-1].isdigit() else "") for name in names]
        self._axis = re.compile(f"({'|'.join(parts) or '(?!)'})", re.IGNORECASE)

    def run(self, scanner: Scanner) -> Steps:
        """Decode the block that begins at the scanner."""
        context, words = self._context, self._words(scanner)
        _modal(context, words, scanner)
        special = [number for number in words.functions if number in TAKING_AXES]
        if special.count(100) > 1:
            raise CncStop(errors.MEASURING_FUNCTION_TWICE, scanner.block.source, 100)
        if len(special) > 1:
            both = " and ".join(f"G{number}" for number in special)
            raise scanner.error(f"expected one of {both} in a block: each takes the axis words", words.at)
        if special:
            yield from _SPECIAL[special[0]](context, words, scanner)
        elif words.axes:
            yield from _line(context, words, scanner)
        if words.seconds is not None:
            context.moved()
            yield Dwell(source=scanner.block.source, seconds=words.seconds)
        if words.end:
            context.ended = True
            yield ProgramEnd(source=scanner.block.source)

    def _words(self, scanner: Scanner) -> Words:
        words = Words(at=scanner.start)
        while not scanner.at_end():
            if self._memory.at_name(scanner):
                self._memory.assign(scanner)
            elif self._is_dwell(scanner):
                words.seconds = self._seconds(scanner)
            elif found := scanner.match(_G_WORD):
                words.functions.append(_g_number(scanner, found))
                words.at = found.start()
            elif found := scanner.match(self._axis):
                axis, value = self._axis_word(scanner, found, homing=74 in words.functions)
                if any(axis == other for other, _ in words.axes):
                    name = found.group().upper()
                    raise scanner.error(f"expected axis {name} once in a block", found.start())
                words.axes.append((axis, value))
            else:
                self._letter(scanner, words)
        return words

    def _is_dwell(self, scanner: Scanner) -> bool:
        found = _G_WORD.match(scanner.text, scanner.pos)
        if found is None or found.group(1).lstrip("0") != "4":
            return False
        scanner.pos = found.end()
        return True

    def _seconds(self, scanner: Scanner) -> float:
        """Take the time of G04: a plain number or an X word, in seconds."""
        if scanner.peek() in ("X", "x"):
            scanner.pos += 1
        start = scanner.pos
        scanner.accept("=")
        if scanner.at_end():
            raise scanner.error("expected the seconds of G04")
        seconds = evaluate(scanner, self._memory)
        if seconds < 0:
            raise scanner.error(f"G04: expected seconds from 0 on, found {seconds:g}", start)
        if seconds > LONGEST_DWELL:
            raise CncStop(
                errors.DWELL_TIME_FORMAT, scanner.block.source, seconds * 1e6, 0, LONGEST_DWELL * 1_000_000
            )
        return seconds

    def _axis_word(self, scanner: Scanner, found: re.Match[str], *, homing: bool) -> tuple[AxisIndex, float]:
        axis = self._context.by_name[found.group(1).upper()]
        if axis.kind == "S" and not homing:
            raise scanner.not_emulated(f"{axis.name}: spindles not built", found.start())
        if command := _AXIS_COMMAND.match(scanner.text, scanner.pos):
            raise scanner.not_emulated(
                f"{axis.name}[{command.group(1).upper()} ...]: axis commands not built", found.start()
            )
        scanner.accept("=")
        if scanner.at_end():
            raise scanner.error(f"expected a position after {axis.name}, found the end of the block")
        return axis.index, evaluate(scanner, self._memory)

    def _letter(self, scanner: Scanner, words: Words) -> None:
        start = scanner.pos
        if scanner.peek() in ("F", "f"):
            scanner.pos += 1
            scanner.accept("=")
            feed = evaluate(scanner, self._memory)
            if feed < 0:
                raise scanner.error(f"F: expected a feed from 0 on, found {feed:g}", start)
            self._context.feed = feed
            return
        if found := scanner.match(_M_WORD):
            name = f"M{int(found.group(1)[:9])}"
            if what := M_FUNCTIONS.get(name, TECHNOLOGY):
                raise scanner.not_emulated(f"{short(found.group()).upper()}: {what} not built", start)
            words.end = True
            return
        raise self._unknown(scanner, start)

    def _unknown(self, scanner: Scanner, start: int) -> BenchError:
        sign = scanner.peek()
        if what := missing(SIGNS, sign):
            return scanner.not_emulated(f"{scanner.found()}: {what} not built", start)
        found = scanner.match(_LETTERS)
        if found is None:
            return scanner.error(f"expected a word such as G01, F1000 or X10, found {scanner.found()}", start)
        word = found.group().upper()
        if _ADDRESS.fullmatch(word) and (what := missing(LETTERS, word[0])):
            return scanner.not_emulated(f"{short(word)}: {what} not built", start)
        axes = ", ".join(self._context.by_name)
        if word[0] == "N" and word[1:].isdigit():
            return scanner.error(
                f"expected the block number {short(word)} at the beginning of its block", start
            )
        return scanner.error(f"expected a G, F, M or axis word (axes {axes}), found '{short(word)}'", start)


def _g_number(scanner: Scanner, found: re.Match[str]) -> int:
    written = f"G{found.group(1)}"
    name = "G" + (written[1:].lstrip("0") or "0")
    number = int(name[1:]) if name[1:].isdigit() and len(name) < 6 else -1
    if number in TAKING_AXES or number in IN_FORCE or number in (0, 1, 90, 91):
        return number
    if what := missing(G_FUNCTIONS, name):
        raise scanner.not_emulated(f"{written}: {what} not built", found.start())
    raise scanner.error(f"expected one of {', '.join(_BUILT)}, found '{short(written)}'", found.start())


def _modal(context: Context, words: Words, scanner: Scanner) -> None:
    for group in ((0, 1), (90, 91)):
        if all(number in words.functions for number in group):
            raise scanner.error(f"expected one of G{group[0]:02d} and G{group[1]:02d} in a block", words.at)
    for number in words.functions:
        if number in (0, 1):
            context.rapid = number == 0
        elif number in (90, 91):
            context.absolute = number == 90


def _positions(context: Context, words: Words, scanner: Scanner) -> Steps:
    if context.coordinates.needs_machine(words.axes, absolute=context.absolute):
        yield from context.flush(scanner.block.source)


def _line(context: Context, words: Words, scanner: Scanner) -> Steps:
    if not context.rapid and not context.feed:
        raise scanner.error("no feed (F) programmed for G01", words.at)
    yield from _positions(context, words, scanner)
    target = context.coordinates.move(words.axes, absolute=context.absolute)
    context.check_format(target, scanner.block.source)
    if target:
        context.moved()
        yield Line(source=scanner.block.source, rapid=context.rapid, feed=context.feed, target=target)


def _measuring_run(context: Context, words: Words, scanner: Scanner) -> Steps:
    kind, where = context.measuring_type, context.coordinates
    if kind in WITHOUT_G100:
        raise CncStop(errors.G100_WRONG_TYPE, scanner.block.source, kind)
    _need_axes(words, scanner, "G100")
    if not context.feed and kind != FEED_FROM_AXIS:
        raise scanner.error("no feed (F) programmed for G100", words.at)
    for axis, _ in words.axes:
        if axis in where.including:
            name, number = context.axes[axis].name, context.axes[axis].number
            raise CncStop(errors.OFFSET_ALREADY_INCLUDED, scanner.block.source, number, name, axis=name)
    yield from _positions(context, words, scanner)
    moving = where.move(words.axes, absolute=context.absolute)
    programmed = [axis for axis, _ in words.axes]
    target = where.axis_target(programmed)
    context.check_format(target, scanner.block.source)
    together = (where.main or ()) if where.frame is not None else ()
    context.measurements.begin(target)
    where.forget(list(target), keep_programmed=True)
    context.moved()
    yield MeasuringRun(
        source=scanner.block.source,
        measuring_type=kind,
        feed=context.feed,
        target=target,
        axes=tuple(sorted({*together, *moving})),
        together=together,
    )


def _home(context: Context, words: Words, scanner: Scanner) -> Steps:
    _need_axes(words, scanner, "G74")
    ranks: dict[AxisIndex, int] = {}
    for axis, rank in words.axes:
        if not context.path_axis(axis):
            name = context.axes[axis].name
            raise scanner.not_emulated(f"G74: homing of spindle {name} (homing manual 2.3.2)", words.at)
        if rank != int(rank) or rank < 1:
            raise CncStop(errors.HOMING_RANK_RANGE, scanner.block.source, context.axes[axis].number, rank, 1)
        ranks[axis] = int(rank)
    context.coordinates.forget(list(ranks), keep_programmed=False)
    context.moved()
    yield Home(source=scanner.block.source, ranks=ranks)


def _shift(context: Context, words: Words, scanner: Scanner) -> Steps:
    yield from ()
    _need_axes(words, scanner, "G92")
    where = context.coordinates
    for axis, value in words.axes:
        where.set_shift(axis, value if context.absolute else where.shift[axis] + value)


def _include(context: Context, words: Words, scanner: Scanner) -> Steps:
    _need_axes(words, scanner, "G101")
    source, measured = scanner.block.source, context.measurements
    yield from context.flush(source)
    for axis, factor in words.axes:
        name, number = context.axes[axis].name, context.axes[axis].number
        if not measured.has_value(axis):
            raise CncStop(errors.OFFSET_NOT_REQUESTED, source, name, axis=name)
        if axis in context.coordinates.including:
            raise CncStop(errors.OFFSET_ALREADY_INCLUDED, source, number, name, axis=name)
        context.coordinates.include(axis, rounded(factor * measured.distance(axis)))


def _exclude(context: Context, words: Words, scanner: Scanner) -> Steps:
    """G102: the named axes, without any all that have an offset included (decided here)."""
    yield from ()
    where = context.coordinates
    for axis in [axis for axis, _ in words.axes] or sorted(where.including):
        if axis not in where.including:
            name, number = context.axes[axis].name, context.axes[axis].number
            raise CncStop(errors.OFFSET_NOT_INCLUDED, scanner.block.source, number, name, axis=name)
        where.exclude(axis)


def _need_axes(words: Words, scanner: Scanner, function: str) -> None:
    if not words.axes:
        raise scanner.error(f"expected an axis word in the block of {function}", words.at)


_SPECIAL: Final[dict[int, Callable[[Context, Words, Scanner], Steps]]] = {
    74: _home,
    92: _shift,
    100: _measuring_run,
    101: _include,
    102: _exclude,
}
