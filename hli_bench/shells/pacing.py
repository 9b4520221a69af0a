"""Wall clock: how long a run took, and a cycle that keeps real time."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

from hli_bench.base.time import NS_PER_US

LEAST_SPIN_NS: Final = 10 * NS_PER_US
MOST_SPIN_NS: Final = 100 * NS_PER_US
"""The last stretch before a deadline is spun, because a sleep ends late; it is never longer than this."""
SPIN_UP_NS: Final = 1960
SPIN_DOWN_NS: Final = 40
"""The spin grows by the first when a sleep outlasted it, else shrinks by the second: it settles where one sleep in
fifty outlasts it. Sleeps that no spin could have covered do not count (decided here)."""
BINS: Final = 22
"""Below 1 us, then a bin for each power of two; the last one begins at about a second and is open."""


class Stopwatch:
    """Wall time since it was made."""

    __slots__ = ("_start",)

    def __init__(self) -> None:
        self._start = time.perf_counter()

    def seconds(self) -> float:
        """Return the wall time in s."""
        return time.perf_counter() - self._start


@dataclass(slots=True)
class Lateness:
    """How well a paced bench kept its cycle: cycles, how many times of a cycle were missed, worst, by powers of two.

    `late` counts every time of the grid that passed before the cycle due at it began: a gap of nine counts nine.
    `bins[0]` counts cycles late by less than 1 us, `bins[n]` those from 2**(n-1) us to 2**n us.
    """

    cycles: int = 0
    late: int = 0
    worst_ns: int = 0
    bins: list[int] = field(default_factory=lambda: [0] * BINS)

    def add(self, other: "Lateness") -> "Lateness":
        """Return both together."""
        return Lateness(
            self.cycles + other.cycles,
            self.late + other.late,
            max(self.worst_ns, other.worst_ns),
            [one + two for one, two in zip(self.bins, other.bins, strict=True)],
        )

    def figures(self) -> dict[str, Any]:
        """Return what a result says: late cycles, worst lateness, histogram (us, up to its last filled bin)."""
        filled = max((number for number, count in enumerate(self.bins) if count), default=-1) + 1
        return {
            "late_cycles": self.late,
            "worst_lateness_us": self.worst_ns / NS_PER_US,
            "lateness_histogram": [
                {
                    "from_us": 2 ** (number - 1) if number else 0,
                    "below_us": 2**number if number < BINS - 1 else None,
                    "cycles": self.bins[number],
                }
                for number in range(filled)
            ],
        }


class RealPace:
    """Absolute deadlines, one a cycle, on a grid that stays: a bench that fell behind leaves cycles out of it.

    A cycle that begins n whole cycles behind its deadline counts n late ones (decided here). `idle` is called with the
    time in ns that is left before a deadline; it must be back before that.
    """

    __slots__ = ("_clock", "_cycle_ns", "_due_ns", "_idle", "_sleep", "_total", "part", "spin_ns")

    def __init__(
        self,
        cycle_ns: int,
        clock: Callable[[], int] = time.perf_counter_ns,
        sleep: Callable[[float], None] = time.sleep,
        idle: Callable[[int], None] | None = None,
    ) -> None:
        self._cycle_ns = cycle_ns
        self._clock = clock
        self._sleep = sleep
        self._idle = idle
        self.spin_ns = MOST_SPIN_NS
        self.restart()

    @property
    def lateness(self) -> Lateness:
        """All since the restart."""
        return self._total.add(self.part)

    def restart(self) -> None:
        """Keep time from now on and count anew: what came before, such as compiling the laws, is nobody's lateness."""
        self._total = Lateness()
        self.part = Lateness()
        self.resume()

    def resume(self) -> None:
        """Keep time from now on: nobody stepped the bench for a while."""
        self._due_ns = self._clock()

    def take_part(self) -> Lateness:
        """Return what was counted since the last call, and begin anew."""
        part, self.part = self.part, Lateness()
        self._total = self._total.add(part)
        return part

    def wait(self) -> None:
        """Wait for the next cycle."""
        clock = self._clock
        due = self._due_ns + self._cycle_ns
        rest = due - clock()
        if self._idle is not None and rest > self.spin_ns:
            self._idle(rest - self.spin_ns)
            rest = due - clock()
        if rest > self.spin_ns:
            self._sleep((rest - self.spin_ns) * 1e-9)
            behind = clock() - due
            if behind <= 0:
                self.spin_ns = max(self.spin_ns - SPIN_DOWN_NS, LEAST_SPIN_NS)
            elif behind <= MOST_SPIN_NS - self.spin_ns:
                self.spin_ns = min(self.spin_ns + SPIN_UP_NS, MOST_SPIN_NS)
        now = clock()
        while now < due:
            now = clock()
        self._due_ns = due + self._count(now - due)

    def _count(self, late: int) -> int:
        """Count a cycle; return by how much the grid has run away, in whole cycles."""
        part = self.part
        part.cycles += 1
        part.bins[min((late // NS_PER_US).bit_length(), BINS - 1)] += 1
        if late > part.worst_ns:
            part.worst_ns = late
        if late < self._cycle_ns:
            return 0
        part.late += late // self._cycle_ns
        return late - late % self._cycle_ns
