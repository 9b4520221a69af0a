"""Ends a call into a user's script that does not return, whether it computes or waits."""

import signal
import threading
from collections.abc import Callable
from math import inf
from time import monotonic, sleep
from types import FrameType
from typing import Final, TypeVar, TypeVarTuple

A = TypeVarTuple("A")
T = TypeVar("T")

LOOK_S: Final = 0.2
"""Between two looks at the call under way."""
SIGNAL: Final = signal.SIGURG
"""What wakes the main thread; ignored where nobody handles it."""


class Overdue(BaseException):
    """Raised inside the call; no Exception, so that a script that catches those is ended all the same."""


class Watchdog:
    """Watches the calls that the main thread makes, one at a time; all there is to know is when one must be back.

    A signal ends it, because only that interrupts a call which waits in the operating system, and its handler runs
    between two steps of the main thread, so that none is ended that has just returned. A thread sends the signal: the
    operating system's timers belong to the user, whose tests may have a time-out of their own.
    """

    def __init__(self) -> None:
        self._until = inf
        self._limit_s = inf
        self._main = threading.main_thread().ident
        self._watching = False

    def limited(self, limit_s: float, work: Callable[[*A], T], *arguments: *A) -> T:
        """Return what `work` returns. Raises Overdue out of it after `limit_s` by the clock.

        Not limited are calls in other threads than the main one, where Python handles no signals.
        """
        if threading.get_ident() != self._main:
            return work(*arguments)
        if not self._watching:
            self._watch()
        self._limit_s = limit_s
        self._until = monotonic() + limit_s
        try:
            return work(*arguments)
        finally:
            self._until = inf

    def _watch(self) -> None:
        self._watching = True
        signal.signal(SIGNAL, self._on_signal)
        threading.Thread(target=self._look, name="watchdog", daemon=True).start()

    def _look(self) -> None:
        while True:
            sleep(LOOK_S)
            if monotonic() > self._until and self._main is not None:
                signal.pthread_kill(self._main, SIGNAL)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        if monotonic() > self._until:
            self._until = monotonic() + self._limit_s
            raise Overdue


WATCHDOG: Final = Watchdog()
"""The one of this process."""
