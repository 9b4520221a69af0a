"""Notices that a program stands because a PLC holds it; without a word a run in free pace would go on for ever."""

from collections.abc import Callable
from typing import Final

from hli_bench.base.time import NS_PER_S
from hli_bench.kernel.cycle import Kernel

LOOK_S: Final = 10
"""Machine time between two looks: one that stands at both is spoken of (decided here)."""


class Standstill:
    """Looks at a running program from time to time; `on_note` gets one line a block that stands."""

    def __init__(self, kernel: Kernel, on_note: Callable[[str], None]) -> None:
        self._kernel = kernel
        self._on_note = on_note
        self._between = LOOK_S * NS_PER_S // kernel.setup.cycle_ns
        self._seen: tuple[object, ...] = ()
        self._spoken: tuple[object, ...] = ()
        self.due = 0
        """Cycle of the next look."""

    def begin(self, cycle: int) -> None:
        """A program begins."""
        self._seen = self._spoken = ()
        self.due = cycle + self._between

    def look(self, cycle: int) -> None:
        """Look; to be called from cycle `due` on."""
        self.due = cycle + self._between
        holding = self._kernel.holding()
        now = (self._kernel.source.name, self._kernel.rows.axis["command"].tobytes(), *holding)
        if holding and now == self._seen and now != self._spoken:
            self._spoken = now
            self._on_note(f"{self._kernel.source.name} stands for {LOOK_S} s and more: {', '.join(holding)}")
        self._seen = now
