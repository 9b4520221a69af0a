"""PLC tasks as the engine sees them: in this process, or attached over Zenoh."""

from collections.abc import Callable, Mapping
from typing import Final, Protocol

from hli_bench.base.errors import InputError
from hli_bench.base.time import NS_PER_S, Ns
from hli_bench.plc import Task
from hli_bench.shells.watchdog import WATCHDOG, Overdue
from hli_bench.wire.hli import Commands

ANSWER_S: Final = 10.0
"""Time by the clock in which a PLC for which the kernel waits must be done with a cycle (decided here)."""
SILENCE_S: Final = 1.0
"""Machine time for which a PLC for which it does not wait may say nothing (decided here)."""


def period_cycles(name: str, period_us: int, cycle_ns: int) -> int:
    """Return a PLC period in kernel cycles. Raises InputError when it is no whole number of them."""
    cycle_us = cycle_ns // 1000
    if period_us <= 0 or period_us % cycle_us:
        raise InputError(
            f"plc {name}: period_us = {period_us}, allowed are multiples of cycle_us = {cycle_us}"
        )
    return period_us // cycle_us


class LocalPlc:
    """A script that runs in this process. `on_note` gets a line when it does not return from a cycle."""

    __slots__ = ("_on_note", "_task", "name", "period_cycles")

    def __init__(self, task: Task, cycle_ns: int, on_note: Callable[[str], None]) -> None:
        self._task = task
        self._on_note = on_note
        self.name = task.name
        self.period_cycles = period_cycles(task.name, task.period_us, cycle_ns)

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Run the script once; None when it does not return in time, then it must not be stepped any further."""
        try:
            return WATCHDOG.limited(ANSWER_S, self._task.step, cycle, dc_ns, image, io)
        except Overdue as overdue:
            place = self._task.place(overdue)
            self._on_note(
                f"PLC {self.name} has not returned from cycle {cycle} for {ANSWER_S:g} s ({place}): "
                "it takes part no more"
            )
            return None


class Exchange(Protocol):
    """The door through which attached PLCs are reached."""

    def commands(self, plc: str, cycle: int, timeout_s: float) -> Commands | None:
        """Wait for a PLC's answer to a cycle."""

    def latest_commands(self, plc: str, cycle: int) -> Commands | None:
        """Return what a PLC has written since the last call; the bench is at `cycle`."""


class AttachedPlc:
    """A PLC in another process: its image has been published, its answer is awaited (lock-step) or taken as it comes.

    `publish` puts the images of a cycle; every port may call it, it acts once a cycle. `patience_s` is the time in
    which it must answer: by the clock in lock-step, of the machine else.
    """

    __slots__ = ("_exchange", "_heard", "_patience", "_publish", "name", "period_cycles")

    def __init__(
        self,
        name: str,
        cycles: int,
        exchange: Exchange,
        publish: Callable[[int, Ns, Mapping[str, bytes]], None],
        *,
        lockstep: bool,
        cycle_ns: int,
    ) -> None:
        self.name = name
        self.period_cycles = cycles
        self._exchange = exchange
        self._publish = publish
        self._patience = None if lockstep else cycles + round(SILENCE_S * NS_PER_S / cycle_ns)
        """Cycles without an answer after which a PLC that is not awaited counts as gone."""
        self._heard: int | None = None
        """Cycle in which it was heard last."""

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Exchange images and commands; None when the PLC does not answer in time."""
        self._publish(cycle, dc_ns, io)
        if self._patience is None:
            return self._exchange.commands(self.name, cycle, ANSWER_S)
        commands = self._exchange.latest_commands(self.name, cycle)
        if commands is not None or self._heard is None:
            self._heard = cycle
        elif cycle - self._heard > self._patience:
            return None
        return commands or Commands(self.name, cycle, ())
