"""How far a campaign is: a bar with the remaining time on a terminal, else a line at once and for every 10 %."""

from typing import Final, TextIO

from hli_bench.shells.pacing import Stopwatch

WIDTH: Final = 30
LINES: Final = 10


class Progress:
    """Tells of the runs that are done; those of an earlier start count, but not for the remaining time."""

    def __init__(self, total: int, before: int, stream: TextIO) -> None:
        self._total = total
        self._before = before
        self._done = before
        self._stream = stream
        self._watch = Stopwatch()
        self._bar = stream.isatty()
        self._told = before * LINES // total
        if self._bar:
            self._draw()
        else:
            self._line()

    def add(self, runs: int) -> None:
        """Some more runs are done."""
        self._done += runs
        tenth = self._done * LINES // self._total
        if self._bar:
            self._draw()
        elif tenth > self._told:
            self._told = tenth
            self._line()

    def end(self) -> None:
        """Leave the line of the bar."""
        if self._bar:
            print(file=self._stream, flush=True)

    def _line(self) -> None:
        print(self._text(), file=self._stream, flush=True)

    def _draw(self) -> None:
        full = WIDTH * self._done // self._total
        bar = "#" * full + "." * (WIDTH - full)
        print(f"\r[{bar}] {self._text():<60}", end="", file=self._stream, flush=True)

    def _text(self) -> str:
        share = f"{100 * self._done // self._total} %, {self._done} of {self._total} runs"
        here = self._done - self._before
        rest = self._total - self._done
        if not here or not rest:
            return share
        return f"{share}, {clock(self._watch.seconds() / here * rest)} left"


def clock(seconds: float) -> str:
    """Return a duration: 45 s, 3:20 min, 2:05 h."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60}:{whole % 60:02d} min"
    return f"{whole // 3600}:{whole % 3600 // 60:02d} h"
