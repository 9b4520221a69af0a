"""Wall clock: how long a run took, and a cycle that keeps real time."""

import time
from dataclasses import dataclass

from hli_bench.base.time import NS_PER_US

SPIN_NS = 150 * NS_PER_US
"""The last stretch before a deadline is spun: sleeping alone is late by about 0.1 ms."""


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
    """How well a paced bench kept its cycle: cycles, late ones (by a cycle or more), worst lateness."""

    cycles: int = 0
    late: int = 0
    worst_ns: int = 0


class RealPace:
    """Absolute deadlines, one a cycle; a bench that fell behind goes on from where it is."""

    __slots__ = ("_cycle_ns", "_due_ns", "lateness")

    def __init__(self, cycle_ns: int) -> None:
        self._cycle_ns = cycle_ns
        self.restart()

    def restart(self) -> None:
        """Keep time from now on: what came before, such as compiling the laws, is nobody's lateness."""
        self._due_ns = time.perf_counter_ns()
        self.lateness = Lateness()

    def wait(self) -> None:
        """Wait for the next cycle."""
        self._due_ns += self._cycle_ns
        rest = self._due_ns - time.perf_counter_ns()
        if rest > SPIN_NS:
            time.sleep((rest - SPIN_NS) * 1e-9)
        while (now := time.perf_counter_ns()) < self._due_ns:
            pass
        late = now - self._due_ns
        self.lateness.cycles += 1
        self.lateness.worst_ns = max(self.lateness.worst_ns, late)
        if late >= self._cycle_ns:
            self.lateness.late += 1
            self._due_ns = now
