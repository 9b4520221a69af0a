"""What comes from outside while a program runs: Ctrl-C, a CNC reset, what a client puts on the HLI."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import Final

from hli_bench import Bench
from hli_bench.base.errors import InputError
from hli_bench.wire.hli import Commands, Write

PATIENCE_NS: Final = 1_500_000_000
"""Machine time for which a held program is watched."""


@dataclass(frozen=True, slots=True)
class Act:
    """`what` is interrupt, reset or put (`path`, `value`), `at_ms` ms of the machine behind the program's start."""

    what: str
    at_ms: float
    path: str = ""
    value: int = 0

    def __str__(self) -> str:
        more = f" {self.path}={self.value}" if self.path else ""
        return f"{self.what}@{self.at_ms:g}{more}"


class Outside:
    """Does what is due exactly at its cycle, between two steps of the engine, as the bench's door to the net does."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._due: list[tuple[int, Act]] = []
        self._step = bench.engine.step
        self._look_at = 0
        self._seen: tuple[object, ...] = ()
        self.patience = False
        """Programs that something holds are reset."""
        self.gave_up = False
        """One was, since the last plan."""
        bench.engine.step = self.step  # type: ignore[method-assign]

    def plan(self, acts: Iterable[Act]) -> None:
        """Let acts come from now on; those of before that have not come are dropped."""
        now, cycle_ns = self._bench.engine.cycle, self._bench.config.cycle_ns
        due = [(now + max(round(act.at_ms * 1e6 / cycle_ns), 1), act) for act in acts]
        self._due = sorted(due, key=lambda one: one[0])
        self.gave_up = False

    def step(self, limit: int) -> None:
        """Step the engine, no further than the next act."""
        engine = self._bench.engine
        while self._due and self._due[0][0] <= engine.cycle:
            self._do(self._due.pop(0)[1])
        if self.patience and engine.cycle >= self._look_at:
            self._look()
        until = [self._due[0][0]] if self._due else []
        self._step(min(limit, *until, self._look_at) if self.patience else min([limit, *until]))

    def _look(self) -> None:
        """Reset a program that has been held since the last look, with nothing to come that would free it."""
        kernel = self._bench.kernel
        self._look_at = self._bench.engine.cycle + PATIENCE_NS // self._bench.config.cycle_ns
        held = (*kernel.holding(), kernel.rows.axis["command"].tobytes()) if kernel.holding() else ()
        if held and held == self._seen and not self._due:
            self.gave_up = True
            self._bench.reset()
        self._seen = held

    def _do(self, act: Act) -> None:
        engine = self._bench.engine
        if act.what == "interrupt":
            raise KeyboardInterrupt
        if act.what == "reset":
            self._bench.reset()
        elif act.what == "put":
            try:
                element = self._bench.kernel.image.layout.element(act.path)
            except InputError:
                return  # an element that this commit does not know: its end shows it
            value = bool(act.value) if element.type == "BOOL" else act.value
            with suppress(InputError):  # a unit of a PLC's own, which a client is refused
                engine.apply(Commands("", engine.cycle, (Write(element.path, value),)))
