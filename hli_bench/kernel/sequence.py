"""Sequences as tables: phases with what they set going, what they wait for, and what comes then.

A row waits for a `Condition` (asked by compiled code every cycle) or for a `Level` of a control unit
(which can only change when a PLC has written). The first of a phase's rows that is met decides. A row that
leads back to its own phase is used up; the phase goes on with the others, whose conditions stay armed.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, Generic, TypeVar

from hli_bench.kernel.watches import Condition, Watches

Context = TypeVar("Context")
END: Final = "end"


@dataclass(frozen=True, slots=True)
class Level:
    """A condition on what the kernel sees on the HLI; `holds` is asked in every cycle with a PLC write."""

    holds: Callable[[], bool]


Until = Condition | Level


def always(_: object) -> Level:
    """Go on at once."""
    return Level(lambda: True)


@dataclass(frozen=True, slots=True)
class Then(Generic[Context]):
    """One way out of a phase: when `until` is met, `action` runs and phase `next` begins (it may depend on the run)."""

    until: Callable[[Context], Until]
    next: "str | Callable[[Context], str]"
    action: Callable[[Context], None] | None = None


@dataclass(frozen=True, slots=True)
class Phase(Generic[Context]):
    """What a phase sets going on entry, and its ways out."""

    motion: Callable[[Context], None]
    ways: tuple[Then[Context], ...]


Table = Mapping[str, Phase[Context]]


class Sequence(Generic[Context]):
    """One run through a table; no other code changes its phase."""

    __slots__ = ("_armed", "_table", "_watches", "context", "phase")

    def __init__(self, table: Table[Context], context: Context, first: str, watches: Watches) -> None:
        self._table = table
        self.context = context
        self._watches = watches
        self._armed: list[tuple[Then[Context], int | Level]] = []
        self.phase = END
        self._enter(first)

    @property
    def ended(self) -> bool:
        """No phase is left."""
        return self.phase == END

    def step(self) -> None:
        """Leave phases as long as one of their conditions is met."""
        while not self.ended:
            met = next((way for way, until in self._armed if self._met(until)), None)
            if met is None:
                return
            self._take(met)

    def abort(self) -> None:
        """End the sequence where it is."""
        self._disarm([way for way, _ in self._armed])
        self.phase = END

    def _take(self, met: Then[Context]) -> None:
        """Go the way that was met."""
        if met.action is not None:
            met.action(self.context)
        phase = met.next if isinstance(met.next, str) else met.next(self.context)
        if phase == self.phase:
            self._disarm([met])
        else:
            self._disarm([way for way, _ in self._armed])
            self._enter(phase)

    def _met(self, until: int | Level) -> bool:
        return until.holds() if isinstance(until, Level) else self._watches.met(until)

    def _enter(self, phase: str) -> None:
        self.phase = phase
        if phase == END:
            return
        row = self._table[phase]
        try:
            row.motion(self.context)
            for way in row.ways:
                until = way.until(self.context)
                armed = until if isinstance(until, Level) else self._watches.watch(until)
                self._armed.append((way, armed))
        except BaseException:
            # Nobody may know of it yet: what it watches is taken back here.
            self.abort()
            raise

    def _disarm(self, ways: list[Then[Context]]) -> None:
        """Take the conditions of these ways back."""
        kept = []
        for way, until in self._armed:
            if way not in ways:
                kept.append((way, until))
            elif not isinstance(until, Level):
                self._watches.forget(until)
        self._armed = kept
