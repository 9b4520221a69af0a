"""Decodes NC text block by block; a block is decoded when the kernel asks for it."""

import re
from collections.abc import Generator, Iterable, Sequence
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Idle, Line, MachineState, Source
from hli_bench.kernel.decoder.commands import COMMANDS
from hli_bench.kernel.decoder.configuration import DecoderAxis, DecoderDefaults
from hli_bench.kernel.decoder.context import LARGEST_POSITION, Context, Item, Steps
from hli_bench.kernel.decoder.control import Control
from hli_bench.kernel.decoder.faults import CncStop, cnc_error
from hli_bench.kernel.decoder.text import MAX_LINE, Lines, Scanner, comment, cost, read_block, short
from hli_bench.kernel.decoder.variables import Variables, needs_flush
from hli_bench.kernel.decoder.words import WordReader
from hli_bench.manual.dialect import COMMANDS as DIALECT
from hli_bench.manual.dialect import SIGNS, missing
from hli_bench.manual.errors import Severity
from hli_bench.manual.errors import decoder as errors

_PLAIN_WORDS = re.compile(r"([A-Za-z])([+-]?(?:[0-9]{1,20}\.?[0-9]{0,20}|\.[0-9]{1,20}))|[^ \t\r\n]")
_HASH = re.compile(r"#\s*([A-Z]+)", re.IGNORECASE)
_SUBROUTINE = re.compile(r"%L\s", re.IGNORECASE)
_RAPID: Final = {"0": True, "00": True, "1": False, "01": False}
WITHOUT_MOTION: Final = 2000
"""Blocks without motion in a row for which a cycle passes (decided here): a loop may be endless."""
_ABSOLUTE: Final = {"90": True, "91": False}


class _Other:
    """Marks a line that is not plain motion."""


_OTHER: Final = _Other()


class Decoder:
    """Turns the lines of one program into blocks, queries and errors.

    Raises `InputError` (file, line, column) for text that is no NC program and `NotEmulated` for what is not
    built; what the CNC reports by number comes as a `CncError`, after which nothing follows.
    """

    __slots__ = (
        "_axis_of",
        "_context",
        "_control",
        "_lines",
        "_memory",
        "_named",
        "_without_motion",
        "_words",
    )

    def __init__(
        self,
        program: Iterable[str],
        name: str,
        axes: Sequence[DecoderAxis],
        defaults: DecoderDefaults,
        without_motion: int = WITHOUT_MOTION,
    ) -> None:
        self._context = Context(name, axes, defaults)
        self._lines = Lines(program)
        self._memory = Variables(self._context)
        self._control = Control(self._context, self._memory, self._lines, without_motion)
        self._words = WordReader(self._context, self._memory)
        self._without_motion = without_motion
        self._named = False
        self._axis_of: dict[str, AxisIndex] = {}
        for axis in axes:
            if len(axis.name) == 1 and axis.kind != "S" and axis.name.upper() not in "FGMNPV":
                self._axis_of[axis.name.upper()] = self._axis_of[axis.name.lower()] = axis.index

    def blocks(self) -> Generator[Item, MachineState | None, None]:
        """Yield blocks, queries (answer them with `send`), warnings, and at most one error, the last item."""
        try:
            yield from self._items()
        except CncStop as stop:
            yield stop.error
            if stop.error.severity == Severity.WARNING:
                yield cnc_error(errors.PROGRAM_END_MISSING, Source("", self._lines.number))

    def run_ended(self, state: MachineState) -> None:
        """Take what a measuring run has left behind, before the next one begins."""
        self._context.measurements.learn(state)

    def measured_pcs(self, axis: AxisIndex) -> float:
        """Return V.A.MEAS.PCS.VALUE of an axis that the machine has just measured, mm."""
        return self._context.measurements.without_offsets(axis)

    def variables(self, state: MachineState) -> dict[str, float]:
        """Return the NC variables the program set or read, given the machine's state at its end.

        The values of every measured axis are among them whether the program read them or not.
        """
        self._context.measurements.learn(state)
        return self._memory.result()

    def _items(self) -> Steps:
        context, next_line, plain = self._context, self._lines.next, self._plain
        blocks, without_motion = 0, self._without_motion
        while (raw := next_line()) is not None:
            item = plain(raw)
            if isinstance(item, Line):
                blocks = 0
                yield item
                continue
            blocks += cost(raw)
            if blocks >= without_motion:
                blocks = 0
                yield Idle()
            if item is None:
                continue
            yield from self._block(raw)
            if context.ended:
                return
            for commented in comment(self._lines, context.name):
                blocks += cost(commented)
                if blocks >= without_motion:
                    blocks = 0
                    yield Idle()
        self._control.check_closed()
        raise CncStop(errors.PROGRAM_END_MISSING, Source("", self._lines.number))

    def _plain(self, raw: str) -> Line | _Other | None:
        """Decode a line of plain motion words in one go; nothing is changed unless all of it is plain."""
        context, axis_of = self._context, self._axis_of
        if len(raw) > MAX_LINE:
            return _OTHER
        number = ""
        rapid, absolute, feed = context.rapid, context.absolute, context.feed
        words: list[tuple[AxisIndex, float]] = []
        text = raw if ";" not in raw else raw[: raw.index(";")]
        for letter, value in _PLAIN_WORDS.findall(text):
            axis = axis_of.get(letter)
            if axis is not None:
                words.append((axis, float(value)))
            elif letter in ("G", "g"):
                if value in _RAPID:
                    rapid = _RAPID[value]
                elif value in _ABSOLUTE:
                    absolute = _ABSOLUTE[value]
                else:
                    return _OTHER
            elif letter in ("N", "n") and not number and not words and value.isdigit():
                number = letter + value
            elif letter in ("F", "f") and value[0] != "-":
                feed = float(value)
            else:
                return _OTHER
        if len(words) > 1 and len(dict(words)) != len(words):
            return _OTHER
        source = Source(number, self._lines.number)
        return self._take(source, words, rapid=rapid, absolute=absolute, feed=feed)

    def _take(
        self,
        source: Source,
        words: list[tuple[AxisIndex, float]],
        *,
        rapid: bool,
        absolute: bool,
        feed: float,
    ) -> Line | _Other | None:
        context = self._context
        where = context.coordinates
        if words:
            if not rapid and not feed:
                return _OTHER
            if where.void and where.needs_machine(words, absolute=absolute):
                return _OTHER
        context.rapid, context.absolute, context.feed = rapid, absolute, feed
        if not words:
            return None
        target = where.move(words, absolute=absolute)
        if not target:
            return None
        for position in target.values():
            if not -LARGEST_POSITION <= position <= LARGEST_POSITION:
                context.check_format(target, source)
        context.measurements.state = None
        return Line(source=source, rapid=rapid, feed=feed, target=target)

    def _block(self, raw: str) -> Steps:
        """Decode any block."""
        context = self._context
        scanner = Scanner(read_block(self._lines, raw, context.name))
        first = scanner.peek()
        if not first:
            return
        if first == "%":
            self._program_name(scanner)
            return
        if needs_flush(scanner.text, context):
            yield from context.flush(scanner.block.source)
        if first == "#":
            yield from self._command(scanner)
        elif first == "$":
            yield from self._control.run(scanner)
        else:
            yield from self._words.run(scanner)

    def _program_name(self, scanner: Scanner) -> None:
        if scanner.match(_SUBROUTINE):
            raise scanner.not_emulated(f"%L: {SIGNS['%L']} not built", scanner.start)
        if self._named:
            raise CncStop(errors.PERCENT_IN_MAIN_PROGRAM, scanner.block.source)
        self._named = True

    def _command(self, scanner: Scanner) -> Steps:
        found = scanner.match(_HASH)
        if found is None:
            raise scanner.error(f"expected a command after '#', found {scanner.found()}")
        word = found.group(1).upper()
        command = COMMANDS.get(word)
        if command is None:
            if what := missing(DIALECT, word):
                raise scanner.not_emulated(f"#{word}: {what} not built", found.start())
            raise scanner.error(
                f"unknown command #{short(word)}; expected one of #{', #'.join(COMMANDS)}", found.start()
            )
        yield from command(self._context, self._memory, scanner)
        if not scanner.at_end():
            raise scanner.error(f"expected the end of the block after #{word}, found {scanner.found()}")
