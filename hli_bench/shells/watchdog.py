"""Ends a call into a user's script that does not return, whether it computes or waits."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from math import inf
from time import monotonic, sleep
from types import FrameType
from typing import Final, TypeVar, TypeVarTuple

A = TypeVarTuple("A")
T = TypeVar("T")

LOOK_S: Final = 1.0
"""Between two looks at the call under way; seldom, because a paced bench shares Python's lock with who looks."""
GRACE_S: Final = 2 * LOOK_S
"""A call that comes back so late and was not ended has kept Python's lock to itself, so that nobody could look."""
SIGNAL: Final = signal.SIGURG
"""What wakes the main thread; ignored where nobody handles it."""
DEBUGGERS: Final = ("bdb", "pdb", "pydevd", "_pydevd")
"""How modules begin that hold a script because somebody looks at it."""


class Overdue(BaseException):
    """Raised inside the call; no Exception, so that a script that catches those is ended all the same."""


class Watchdog:
    """Watches the calls that the main thread makes, the innermost; all there is to know is when it must be back.

    A signal ends it, because only that interrupts a call which waits in the operating system. A thread sends it: the
    operating system's timers belong to the user, whose tests may have a time-out of their own.
    """

    def __init__(self) -> None:
        self._until = inf
        self._told = False
        """Overdue has been raised in the present call."""
        self._main = threading.main_thread().ident
        self._watching = False

    def limited(self, limit_s: float, work: Callable[[*A], T], *arguments: *A) -> T:
        """Return what `work` returns within `limit_s` by the clock, else raise Overdue, out of it where that can be.

        Nothing ends a single step outside of Python before it returns, nor what catches even Overdue; it is overdue
        then. A call that is held in a debugger is not limited, nor are those in other threads than the main one, where
        Python handles no signals, and in programs that handle SIGURG themselves.
        """
        if threading.get_ident() != self._main or not self._watches():
            return work(*arguments)
        outer = self._until
        self._told = False
        self._until = monotonic() + limit_s
        try:
            result = work(*arguments)
            if self._told or monotonic() > self._until + GRACE_S:
                raise Overdue
            return result
        finally:
            self._until = outer

    def _watches(self) -> bool:
        """Tell whether somebody looks; see to it where it can be."""
        if not self._watching and signal.getsignal(SIGNAL) in (signal.SIG_DFL, self._on_signal):
            self._watching = True
            signal.signal(SIGNAL, self._on_signal)
            threading.Thread(target=self._look, name="watchdog", daemon=True).start()
        return self._watching

    def forked(self) -> None:
        """Begin anew in a child process, which has none of the threads."""
        self._watching = False
        self._main = threading.main_thread().ident

    def _look(self) -> None:
        while True:
            sleep(LOOK_S)
            if monotonic() > self._until and self._main is not None:
                signal.pthread_kill(self._main, SIGNAL)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        """End the call, and again if it has caught that; let it be where Ctrl-C ends it or somebody debugs it."""
        if monotonic() <= self._until:
            return
        interrupted = isinstance(sys.exc_info()[1], KeyboardInterrupt)
        if interrupted or any(module.startswith(DEBUGGERS) for module in _modules(frame)):
            self._until = inf
            return
        self._told = True
        raise Overdue


def _modules(frame: FrameType | None) -> Iterator[str]:
    """Yield the names of the modules in which a thread is, innermost first."""
    while frame is not None:
        yield frame.f_globals.get("__name__", "")
        frame = frame.f_back


WATCHDOG: Final = Watchdog()
"""The one of this process."""
os.register_at_fork(after_in_child=WATCHDOG.forked)
