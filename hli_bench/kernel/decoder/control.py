"""Statements that steer the program: $IF, $WHILE, $FOR, $BREAK, $CONTINUE."""

import re
from collections.abc import Generator
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Final

from hli_bench.kernel.blocks import Idle, MachineState
from hli_bench.kernel.decoder.context import Context, Item, Steps
from hli_bench.kernel.decoder.expressions import evaluate, is_true
from hli_bench.kernel.decoder.faults import CncStop
from hli_bench.kernel.decoder.text import BlockText, Lines, Scanner, comment, cost, read_block
from hli_bench.kernel.decoder.variables import Slot, Variables, needs_flush
from hli_bench.manual.dialect import BUILT, STATEMENTS, missing
from hli_bench.manual.errors import decoder as errors

if TYPE_CHECKING:
    from collections.abc import Callable

Skipped = Generator[Item, MachineState | None, tuple[str, Scanner]]
"""What reading over blocks yields, and the word it comes to."""
_WORD = re.compile(r"\$\s*([A-Z]+)", re.IGNORECASE)
_JUMP = re.compile(r"\$\s*GOTO\b", re.IGNORECASE)
_OPENING: Final = frozenset(("IF", "WHILE", "FOR", "DO", "REPEAT", "SWITCH"))
_CLOSING: Final = frozenset(("ENDIF", "ENDWHILE", "ENDFOR", "ENDDO", "UNTIL", "ENDSWITCH"))
_WORDS: Final = tuple(word for word, what in STATEMENTS.items() if what == BUILT)
MAX_NESTING: Final = 64
"""Open control blocks (decided here; the manual names no number for P-ERR-20211)."""


@dataclass(frozen=True, slots=True)
class _Open:
    """An open control block: its word and block; for loops where the body begins and what ends the loop."""

    word: str
    block: BlockText
    body: int = 0
    head: int = 0
    counter: Slot = 0
    last: float = 0.0
    step: float = 0.0


class Control:
    """The open control blocks of a program and the reading over what is not executed."""

    __slots__ = ("_context", "_lines", "_memory", "_open", "_without_motion")

    def __init__(self, context: Context, memory: Variables, lines: Lines, without_motion: int) -> None:
        self._context = context
        self._memory = memory
        self._lines = lines
        self._without_motion = without_motion
        self._open: list[_Open] = []

    def check_closed(self) -> None:
        """Raise CncStop when a control block is open at the end of the text."""
        if self._open:
            raise self._left_open(self._open[-1], len(self._open))

    @staticmethod
    def _left_open(opened: _Open, count: int) -> CncStop:
        keywords = (f"${opened.word}", f"$END{opened.word}")
        return CncStop(errors.CONTROL_STATEMENT_OPEN, opened.block.source, count, *keywords)

    def run(self, scanner: Scanner) -> Steps:
        """Decode the statement at the scanner."""
        found = scanner.match(_WORD)
        word = found.group(1).upper() if found else ""
        if found and missing(STATEMENTS, word):
            raise scanner.not_emulated(f"${word}: {STATEMENTS[word]} not built", found.start())
        if jump := _JUMP.search(scanner.text):
            raise scanner.not_emulated(f"$GOTO: {STATEMENTS['GOTO']} not built", jump.start())
        if word not in _WORDS:
            raise scanner.error(
                f"expected one of ${', $'.join(_WORDS)}, found {scanner.found()}", scanner.start
            )
        handlers: dict[str, Callable[[Scanner], Steps]] = {
            "IF": self._if,
            "WHILE": self._while,
            "FOR": self._for,
            "ENDWHILE": self._end_while,
            "ENDFOR": self._end_for,
        }
        if word in handlers:
            yield from handlers[word](scanner)
        else:
            yield from self._other(scanner, word)
        if not scanner.at_end():
            raise scanner.error(f"expected ${word} alone in its block, found {scanner.found()}")

    def _other(self, scanner: Scanner, word: str) -> Steps:
        if word in ("ELSE", "ELSEIF", "ENDIF"):
            opened = self._top(scanner, "IF", word)
            if word == "ENDIF":
                self._open.pop()
            else:
                # Reached from the branch that was executed: the other branches are read over.
                yield from self._read_over(opened, branches=False)
            scanner.pos = len(scanner.text) if word == "ELSEIF" else scanner.pos
            return
        inside = 0
        while self._open and self._open[-1].word == "IF":
            self._open.pop()
            inside += 1
        if not self._open:
            raise scanner.error(f"expected ${word} inside a loop", scanner.start)
        loop = self._open[-1]
        _, end = yield from self._skip(loop, branches=False, depth=inside)
        if word == "CONTINUE":
            yield from self._again_while(end) if loop.word == "WHILE" else self._again_for()
        else:
            self._leave()

    def _if(self, scanner: Scanner) -> Steps:
        opened = _Open("IF", scanner.block)
        self._begin(opened)
        if not is_true(evaluate(scanner, self._memory, condition=True)):
            yield from self._read_over(opened, branches=True)

    def _read_over(self, opened: _Open, *, branches: bool) -> Steps:
        """Read on to the branch that is executed, or to $ENDIF."""
        while True:
            word, scanner = yield from self._skip(opened, branches=branches)
            if word == "ENDIF":
                self._open.pop()
            elif word == "ELSEIF":
                if needs_flush(scanner.text, self._context):
                    yield from self._context.flush(scanner.block.source)
                if not is_true(evaluate(scanner, self._memory, condition=True)):
                    continue
            return

    def _while(self, scanner: Scanner) -> Steps:
        loop = _Open("WHILE", scanner.block, self._lines.mark(), scanner.pos)
        self._begin(loop)
        if not is_true(evaluate(scanner, self._memory, condition=True)):
            yield from self._skip(loop, branches=False)
            self._leave()
        yield from ()

    def _end_while(self, scanner: Scanner) -> Steps:
        self._top(scanner, "WHILE", "ENDWHILE")
        yield from self._again_while(scanner)

    def _again_while(self, end: Scanner) -> Steps:
        loop = self._open[-1]
        head = Scanner(loop.block)
        head.pos = loop.head
        if needs_flush(head.text, self._context):
            yield from self._context.flush(end.block.source)
        if is_true(evaluate(head, self._memory, condition=True)):
            self._lines.rewind(loop.body)
        else:
            self._leave()

    def _for(self, scanner: Scanner) -> Steps:
        """$FOR counter = begin, end, step; the three are computed once (decided here)."""
        memory = self._memory
        counter = memory.assign(scanner)
        scanner.expect(",")
        last = evaluate(scanner, memory)
        step = evaluate(scanner, memory) if scanner.accept(",") else 1.0
        if not step:
            raise scanner.error("$FOR: expected a step other than 0")
        loop = _Open("FOR", scanner.block, self._lines.mark(), 0, counter, last, step)
        self._begin(loop)
        if not self._within(loop):
            yield from self._skip(loop, branches=False)
            self._leave()
        yield from ()

    def _within(self, loop: _Open) -> bool:
        value = self._memory.get(loop.counter)
        return value <= loop.last if loop.step > 0 else value >= loop.last

    def _end_for(self, scanner: Scanner) -> Steps:
        self._top(scanner, "FOR", "ENDFOR")
        yield from self._again_for()

    def _again_for(self) -> Steps:
        yield from ()
        loop = self._open[-1]
        self._memory.put(loop.counter, self._memory.get(loop.counter) + loop.step)
        if self._within(loop):
            self._lines.rewind(loop.body)
        else:
            self._leave()

    def _begin(self, opened: _Open) -> None:
        if len(self._open) == MAX_NESTING:
            raise CncStop(errors.NESTING_TOO_DEEP, opened.block.source)
        self._open.append(opened)

    def _top(self, scanner: Scanner, word: str, by: str) -> _Open:
        if not self._open or self._open[-1].word != word:
            raise scanner.error(f"expected an open ${word} before ${by}", scanner.start)
        return self._open[-1]

    def _leave(self) -> None:
        self._open.pop()
        if not any(opened.word in ("WHILE", "FOR") for opened in self._open):
            self._lines.forget()

    def _skip(self, opened: _Open, *, branches: bool, depth: int = 0) -> Skipped:
        """Read over blocks up to the end of the control block (or its next branch); return its word.

        `depth` counts the control blocks inside it that are left as well.
        """
        blocks, name = 0, self._context.name
        while (raw := self._lines.next()) is not None:
            scanner = Scanner(read_block(self._lines, raw, name))
            for line in chain((raw,), comment(self._lines, name)):
                blocks += cost(line)
                if blocks >= self._without_motion:
                    blocks = 0
                    yield Idle()
            word = _statement(scanner)
            if word in _OPENING and not _JUMP.search(scanner.text):
                depth += 1
            elif word in _CLOSING:
                if depth == 0:
                    return word, scanner
                depth -= 1
            elif branches and depth == 0 and word in ("ELSE", "ELSEIF"):
                return word, scanner
        raise self._left_open(opened, depth + 1)


def _statement(scanner: Scanner) -> str:
    """Take the control word a block begins with, "" without one."""
    found = scanner.match(_WORD)
    return found.group(1).upper() if found else ""
