"""The blocks behind the prepared path segments, and what "delete distance to go" makes of them.

Source: TF5200 delete distance to go 2.1, 2.3, 2.5, 2.6. The rising edge brakes the path; where it stands the rest of
the block is dropped, and a straight line leads to the target of the next block: in rapid traverse where the dropped
block was, else with the feed of the next. What stands between the two blocks is executed at the stop.
"""

from collections import deque
from dataclasses import replace

from hli_bench.kernel.blocks import Flush, Home, Line, MeasuringRun, ProgramEnd, Source, Text
from hli_bench.kernel.core import Core
from hli_bench.kernel.watches import path_stands
from hli_bench.laws.rows import SEGMENTS
from hli_bench.manual.errors import path_interpolator as errors


class PathBlocks:
    """Puts lines on the path and knows which of them each segment is."""

    __slots__ = ("_core", "_cut", "_lines", "_watch")

    def __init__(self, core: Core) -> None:
        self._core = core
        self._lines: dict[int, Line] = {}
        self._cut: Line | None = None
        """The block whose rest was dropped and behind which no other has come yet."""
        self._watch: int | None = None
        """The condition that the path stands, while it brakes for a short cut."""

    @property
    def source(self) -> Source | None:
        """The block in execution, None when it is none on the path."""
        line = self._lines.get(self._core.path.segment)
        return None if line is None else line.source

    def forget(self) -> None:
        """No motion is left that the blocks belong to."""
        self._lines.clear()

    def abandon(self) -> None:
        """The program ends: nothing is cut any more."""
        self._stop_waiting()
        self._cut = None

    def put(self, line: Line) -> None:
        """Put a line behind the prepared path; behind a dropped rest it begins where the path stands."""
        cut, self._cut = self._cut, None
        if cut is not None:
            rapid = cut.rapid or (line.rapid and not line.feed)
            line = replace(line, rapid=rapid, target={**cut.target, **line.target})
        number = self._core.preparation.line(line)
        if number is None:
            return
        self._lines.pop(number - SEGMENTS, None)
        self._lines[number] = line
        self._core.rows.segment[number % SEGMENTS]["block"] = line.source.value
        if cut is not None:
            self._core.preparation.separate()

    def delete_distance_to_go(self, *, on: bool) -> bool:
        """Begin to brake for a short cut, or take that back before the path stands; tell whether there is one."""
        self._stop_waiting()
        core = self._core
        if not on or core.path.segment not in self._lines or not core.path.hold_for_short_cut(on=True):
            core.path.hold_for_short_cut(on=False)
            return False
        self._watch = core.watches.watch(path_stands())
        return True

    def cut(self, texts: deque[tuple[int, Text]]) -> None:
        """Drop the rest of the block once the path stands; `texts` wait for segments, which are put anew."""
        core = self._core
        if self._watch is None or not core.path.stands:
            return
        self._stop_waiting()
        if core.path.idle:
            return
        running, end = core.path.segment, core.path.tail
        behind = [self._lines[number] for number in range(running + 1, end)]
        self._cut = self._lines[running]
        self._lines.clear()
        core.path.drop()
        core.preparation.synchronise()
        for line in behind:
            self.put(line)
        for at, (segment, text) in enumerate(texts):
            texts[at] = segment + end - running - 1, text

    def settle(self, block: object) -> bool:
        """Before a block that no short cut passes the line leads to where it begins; the program's end only warns.

        Tells whether there is a way to go first.
        """
        if self._cut is None:
            return False
        cut, core = self._cut, self._core
        if isinstance(block, ProgramEnd):
            self._cut = None
            core.report(errors.NO_END_OF_SHORT_CUT, block.source)
        elif isinstance(block, MeasuringRun | Home) or (isinstance(block, Flush) and block.takes_positions):
            core.report(errors.SHORT_CUT_ENDED, block.source)
            self.put(cut)
        return not core.path.idle

    def _stop_waiting(self) -> None:
        """Let the path go on; nothing is waited for."""
        if self._watch is not None:
            self._core.watches.forget(self._watch)
            self._watch = None
        self._core.path.hold_for_short_cut(on=False)
