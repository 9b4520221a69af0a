"""Times ways of doing the same work in turns in one run, because what else the computer does touches them alike.

What counts is a ratio: the median of the ratios of the turns. Seconds are printed for the reader only.
"""

import gc
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

Work = Callable[[], float]
"""Does the work once and returns how much it was: cycles, blocks, seconds of machine time."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Turns of one way: `work` a turn, wall `seconds` of each."""

    work: float
    seconds: tuple[float, ...]

    @property
    def rate(self) -> float:
        """Work a second, median of the turns."""
        return self.work / statistics.median(self.seconds)

    @property
    def best(self) -> float:
        """Work a second in the best turn."""
        return self.work / min(self.seconds)


def in_turns(ways: Mapping[str, Work], turns: int = 5) -> dict[str, Timing]:
    """Do each way once to warm up, then all of them `turns` times one after the other."""
    work = {name: way() for name, way in ways.items()}
    seconds: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(turns):
        for name, way in ways.items():
            gc.collect()
            begin = time.perf_counter()
            way()
            seconds[name].append(time.perf_counter() - begin)
    return {name: Timing(work[name], tuple(seconds[name])) for name in ways}


def rate_ratio(one: Timing, other: Timing) -> float:
    """Return how many times the rate of `other` the rate of `one` is: median over the turns."""
    turns = zip(one.seconds, other.seconds, strict=True)
    return statistics.median((one.work / a) / (other.work / b) for a, b in turns)


def print_table(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table: the first column to the left, the others to the right."""
    widths = [max(len(row[column]) for row in (heads, *rows)) for column in range(len(heads))]
    print(title)
    for row in (heads, *rows):
        cells = [cell.rjust(width) for cell, width in zip(row, widths, strict=True)]
        print("  " + "  ".join([row[0].ljust(widths[0]), *cells[1:]]))
    print()
