"""PLC tasks as the engine sees them: in this process, or attached over Zenoh."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, Protocol

from hli_bench.base.errors import InputError
from hli_bench.base.time import NS_PER_S, Ns
from hli_bench.plc import Task, load
from hli_bench.plc.script import line_of
from hli_bench.shells.plc_times import PlcTimes
from hli_bench.shells.watchdog import WATCHDOG, Overdue
from hli_bench.wire.hli import Commands

ANSWER_S: Final = 10.0
"""Time by the clock in which a PLC for which the kernel waits must be done with a cycle (decided here)."""
LAPSE_PERIODS: Final = 10
LAPSE_NS: Final = 100_000_000
"""An answer counts for nothing when the image it answers is older than so many periods of the PLC and older than so
long (decided here): a PLC that lags must not act on a machine of long ago.
"""
SILENCE_S: Final = 1.0
"""Machine time, beyond its period, for which a PLC for which it does not wait may say nothing (decided here)."""


def period_cycles(name: str, period_us: int, cycle_ns: int) -> int:
    """Return a PLC period in kernel cycles. Raises InputError when it is no whole number of them."""
    cycle_us = cycle_ns // 1000
    if period_us <= 0 or period_us % cycle_us:
        raise InputError(
            f"plc {name}: period_us = {period_us}, allowed are multiples of cycle_us = {cycle_us}"
        )
    return period_us // cycle_us


def loaded(path: Path) -> Any:
    """Return the script at `path`. Raises InputError when it cannot be loaded, or is not within the time of a cycle."""
    try:
        return WATCHDOG.limited(ANSWER_S, load, path)
    except Overdue as overdue:
        message = f"the script has not been loaded within {ANSWER_S:g} s"
        raise InputError(message, str(path), line_of(overdue, path)) from overdue


OnOverrun = Callable[[str, int], None]
"""Gets the name of a PLC that has not kept its period, and the cycle in which it was due."""


class LocalPlc:
    """A script that runs in this process. `on_note` gets a line when it does not return from a cycle.

    With `times` it is measured against its period, and `on_overrun` is called when it takes longer. Its first run is
    not: that one has `start` in it, as the first answer of an attached one.
    """

    __slots__ = ("_on_note", "_on_overrun", "_task", "name", "period_cycles", "times")

    def __init__(
        self,
        task: Task,
        cycle_ns: int,
        on_note: Callable[[str], None],
        times: PlcTimes | None = None,
        on_overrun: OnOverrun = lambda *_: None,
    ) -> None:
        self.times = times
        self._on_overrun = on_overrun
        self._task = task
        self._on_note = on_note
        self.name = task.name
        self.period_cycles = period_cycles(task.name, task.period_us, cycle_ns)

    @property
    def figures(self) -> Mapping[str, object]:
        """How it keeps its period, in real pace."""
        return self.times.whole.figures() if self.times is not None else {}

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Run the script once; None when it does not return in time, then it must not be stepped any further."""
        if self.times is None or self._task.starting:
            return self._step(cycle, dc_ns, image, io)
        self.times.begin()
        commands = self._step(cycle, dc_ns, image, io)
        if self.times.ended():
            self._on_overrun(self.name, cycle)
        return commands

    def _step(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        try:
            return WATCHDOG.limited(ANSWER_S, self._task.step, cycle, dc_ns, image, io)
        except Overdue as overdue:
            where = "its start" if self._task.starting else f"cycle {cycle}"
            self._on_note(
                f"PLC {self.name} has not returned from {where} within {ANSWER_S:g} s "
                f"({self._task.place(overdue)}): it takes part no more"
            )
            return None


class Exchange(Protocol):
    """The door through which attached PLCs are reached."""

    def commands(self, plc: str, cycle: int, timeout_s: float) -> Commands | None:
        """Wait for a PLC's answer to a cycle."""

    def latest_commands(self, plc: str, cycle: int, oldest: int = 0) -> Commands | None:
        """Return what a PLC has written since the last call; the bench is at `cycle`, answers before `oldest` lapse."""


class AttachedPlc:
    """A PLC in another process: its image has been published, its answer is awaited (lock-step) or taken as it comes.

    `publish` puts the images of a cycle; every port may call it, it acts once a cycle. `patience_s` is how long it may
    be silent: by the clock in lock-step, else of the machine, at first as long as in lock-step. With `times` (not in
    lock-step) an image that is not answered before the next one is due counts as an overrun, once it has answered.
    """

    __slots__ = (
        "_cycle_ns",
        "_exchange",
        "_heard",
        "_lockstep",
        "_on_overrun",
        "_publish",
        "name",
        "patience_s",
        "period_cycles",
        "times",
    )

    def __init__(
        self,
        name: str,
        cycles: int,
        exchange: Exchange,
        publish: Callable[[int, Ns, Mapping[str, bytes]], None],
        *,
        lockstep: bool,
        cycle_ns: int,
        times: PlcTimes | None = None,
        on_overrun: OnOverrun = lambda *_: None,
    ) -> None:
        self.name = name
        self.times = times
        self._on_overrun = on_overrun
        self.period_cycles = cycles
        self.patience_s = ANSWER_S
        self._exchange = exchange
        self._publish = publish
        self._lockstep = lockstep
        self._cycle_ns = cycle_ns
        self._heard: int | None = None
        """Cycle in which it was heard last, at first the one in which it was due."""

    @property
    def figures(self) -> Mapping[str, object]:
        """How it keeps its period, in real pace."""
        return self.times.whole.figures() if self.times is not None else {}

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Exchange images and commands; None when the PLC does not answer in time."""
        self._publish(cycle, dc_ns, io)
        if self._lockstep:
            return self._exchange.commands(self.name, cycle, self.patience_s)
        # What it answers first counts however long its start took.
        oldest = cycle - self._lapse_cycles if self.patience_s == SILENCE_S else 0
        commands = self._exchange.latest_commands(self.name, cycle, oldest)
        self._count(cycle, commands)
        if commands is not None:
            self._heard, self.patience_s = cycle, SILENCE_S
            return commands
        if self._heard is None:
            self._heard = cycle
        silent = cycle - self._heard - self.period_cycles
        return (
            None if silent * self._cycle_ns > self.patience_s * NS_PER_S else Commands(self.name, cycle, ())
        )

    @property
    def _lapse_cycles(self) -> int:
        """After so many cycles an answer counts for nothing."""
        return max(LAPSE_PERIODS * self.period_cycles, LAPSE_NS // self._cycle_ns)

    def _count(self, cycle: int, commands: Commands | None) -> None:
        """Count the image that was due before this one: answered, or an overrun."""
        if self.times is None or (self.patience_s == ANSWER_S and commands is None):
            return
        answered = commands is not None and commands.cycle >= cycle - self.period_cycles
        self.times.answered()
        if not answered and self.patience_s == SILENCE_S:
            self.times.overran()
            self._on_overrun(self.name, cycle - self.period_cycles)
