"""PLC tasks as the engine sees them: in this process, or attached over Zenoh."""

from collections.abc import Callable, Mapping
from typing import Protocol

from hli_bench.base.errors import InputError
from hli_bench.base.time import Ns
from hli_bench.plc import Task
from hli_bench.wire.hli import Commands


def period_cycles(name: str, period_us: int, cycle_ns: int) -> int:
    """Return a PLC period in kernel cycles. Raises InputError when it is no whole number of them."""
    cycle_us = cycle_ns // 1000
    if period_us <= 0 or period_us % cycle_us:
        raise InputError(
            f"plc {name}: period_us = {period_us}, allowed are multiples of cycle_us = {cycle_us}"
        )
    return period_us // cycle_us


class LocalPlc:
    """A script that runs in this process."""

    __slots__ = ("_task", "name", "period_cycles")

    def __init__(self, task: Task, cycle_ns: int) -> None:
        self._task = task
        self.name = task.name
        self.period_cycles = period_cycles(task.name, task.period_us, cycle_ns)

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Run the script once."""
        return self._task.step(cycle, dc_ns, image, io)


class Exchange(Protocol):
    """The door through which attached PLCs are reached."""

    def commands(self, plc: str, cycle: int, timeout_s: float) -> Commands | None:
        """Wait for a PLC's answer to a cycle."""

    def latest_commands(self, plc: str, cycle: int) -> Commands | None:
        """Return what a PLC has written since the last call; the bench is at `cycle`."""


class AttachedPlc:
    """A PLC in another process: its image has been published, its answer is awaited (lock-step) or taken as it comes.

    `publish` puts the images of a cycle; every port may call it, it acts once a cycle.
    """

    __slots__ = ("_exchange", "_lockstep", "_publish", "_timeout_s", "name", "period_cycles")

    def __init__(
        self,
        name: str,
        cycles: int,
        exchange: Exchange,
        publish: Callable[[int, Ns, Mapping[str, bytes]], None],
        *,
        lockstep: bool,
        timeout_s: float,
    ) -> None:
        self.name = name
        self.period_cycles = cycles
        self._exchange = exchange
        self._publish = publish
        self._lockstep = lockstep
        self._timeout_s = timeout_s

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Exchange images and commands; None when the PLC does not answer in time."""
        self._publish(cycle, dc_ns, io)
        if not self._lockstep:
            return self._exchange.latest_commands(self.name, cycle) or Commands(self.name, cycle, ())
        return self._exchange.commands(self.name, cycle, self._timeout_s)
