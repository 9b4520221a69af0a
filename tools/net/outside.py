"""What comes from outside while a program runs: Ctrl-C, a CNC reset, what a client puts on the HLI."""

from collections.abc import Iterable
from dataclasses import dataclass

from hli_bench import Bench
from hli_bench.base.errors import InputError
from hli_bench.wire.hli import Commands, Write


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
        bench.engine.step = self.step  # type: ignore[method-assign]

    def plan(self, acts: Iterable[Act]) -> None:
        """Let acts come from now on; those of before that have not come are dropped."""
        now, cycle_ns = self._bench.engine.cycle, self._bench.config.cycle_ns
        due = [(now + max(round(act.at_ms * 1e6 / cycle_ns), 1), act) for act in acts]
        self._due = sorted(due, key=lambda one: one[0])

    def step(self, limit: int) -> None:
        """Step the engine, no further than the next act."""
        engine = self._bench.engine
        while self._due and self._due[0][0] <= engine.cycle:
            self._do(self._due.pop(0)[1])
        self._step(min(limit, self._due[0][0]) if self._due else limit)

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
            engine.apply(Commands("", engine.cycle, (Write(element.path, value),)))
