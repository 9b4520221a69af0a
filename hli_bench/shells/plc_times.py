"""How PLC tasks of a bench in real pace keep their period: runs, overruns, times."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from time import perf_counter_ns
from typing import Any, Final

from hli_bench.base.time import NS_PER_US

TOLD_FROM: Final = 10
TOLD_SHARE: Final = 0.2
"""So many overruns, and such a share of all runs, are told to people: a busy computer gives any task a few. They are
counted all (decided here)."""
KEPT: Final = 100
"""So many tasks are kept in mind: clients come and go under ever new names (decided here)."""


@dataclass(slots=True)
class Times:
    """Counts of one task. The times are of scripts inside the bench: how long others compute, only they know."""

    runs: int = 0
    overruns: int = 0
    timed: int = 0
    least_ns: int = 0
    total_ns: int = 0
    worst_ns: int = 0

    @property
    def often(self) -> bool:
        """Whether there are so many overruns that people should know."""
        return self.overruns >= max(TOLD_FROM, TOLD_SHARE * self.runs)

    def took(self, ns: int) -> None:
        """Count how long a run took."""
        self.least_ns = min(self.least_ns, ns) if self.timed else ns
        self.timed += 1
        self.total_ns += ns
        self.worst_ns = max(self.worst_ns, ns)

    def add(self, other: "Times") -> "Times":
        """Return both together."""
        timed = [one for one in (self, other) if one.timed]
        return Times(
            self.runs + other.runs,
            self.overruns + other.overruns,
            self.timed + other.timed,
            min((one.least_ns for one in timed), default=0),
            self.total_ns + other.total_ns,
            max(self.worst_ns, other.worst_ns),
        )

    def figures(self) -> dict[str, Any]:
        """Return what state and result say; the times in us, None where nobody knows them."""
        known = self.timed > 0
        return {
            "runs": self.runs,
            "overruns": self.overruns,
            "min_us": self.least_ns / NS_PER_US if known else None,
            "mean_us": self.total_ns / self.timed / NS_PER_US if known else None,
            "max_us": self.worst_ns / NS_PER_US if known else None,
        }


@dataclass(slots=True)
class PlcTimes:
    """A task with its counts since it takes part, and since the running program began (`part`)."""

    name: str
    period_ns: int
    before: Times = field(default_factory=Times)
    part: Times = field(default_factory=Times)
    _clock: Callable[[], int] = perf_counter_ns
    _begun: int = 0

    @property
    def whole(self) -> Times:
        """All since it takes part."""
        return self.before.add(self.part)

    def begin(self) -> None:
        """A run begins."""
        self._begun = self._clock()

    def ended(self) -> bool:
        """Count the run that ends, and as an overrun when it took longer than the period; return whether it did."""
        took_ns = self._clock() - self._begun
        self.part.runs += 1
        self.part.took(took_ns)
        return took_ns > self.period_ns and self.overran()

    def answered(self) -> None:
        """Count a run of a task elsewhere."""
        self.part.runs += 1

    def overran(self) -> bool:
        """Count an overrun: True."""
        self.part.overruns += 1
        return True


class PlcBook:
    """The tasks of a bench; those that have gone are kept until the next program begins."""

    __slots__ = ("_tasks",)

    def __init__(self) -> None:
        self._tasks: list[PlcTimes] = []

    def enter(self, name: str, period_ns: int) -> PlcTimes:
        """Begin to count a task."""
        times = PlcTimes(name, period_ns)
        self._tasks = [*self._tasks[-KEPT + 1 :], times]
        return times

    def begin(self, present: Iterable[str]) -> None:
        """A program begins, with these tasks."""
        names = set(present)
        newest = {times.name: times for times in self._tasks if times.name in names}
        self._tasks = list(newest.values())
        for times in self._tasks:
            times.before, times.part = times.whole, Times()

    def often(self, name: str) -> Times | None:
        """Return the counts of a task that has so many overruns that people should know, else None."""
        times = next((times for times in reversed(self._tasks) if times.name == name), None)
        return times.whole if times is not None and times.whole.often else None

    def rows(self) -> list[dict[str, Any]]:
        """Return what a result says of the program's time."""
        return [
            {"name": times.name, "period_us": times.period_ns // NS_PER_US, **times.part.figures()}
            for times in self._tasks
        ]

    def remarks(self) -> Iterator[str]:
        """Yield a line for people for each task whose overruns are a good share of its runs."""
        for times in self._tasks:
            if times.part.often:
                worst = f", {times.part.worst_ns / 1e6:.1f} ms at worst" if times.part.timed else ""
                yield (
                    f"PLC {times.name}: {times.part.overruns} overruns of its period of "
                    f"{times.period_ns / 1e6:g} ms in {times.part.runs} runs{worst}"
                )
