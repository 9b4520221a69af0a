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

from hli_bench.base.errors import Stop

A = TypeVarTuple("A")
T = TypeVar("T")

LOOK_S: Final = 1.0
"""Between two looks at the call under way; seldom, because a paced bench shares Python's lock with who looks."""
SIGNAL: Final = signal.SIGURG
"""What wakes the main thread; ignored where nobody handles it."""
DEBUGGERS: Final = ("bdb", "pdb", "pydevd", "_pydevd")
"""How modules begin that hold a script because somebody looks at it."""


class Overdue(Stop):
    """Raised inside the call that takes too long."""


class Watchdog:
    """Watches the calls that the main thread makes, the innermost of them.

    A signal ends one that takes too long, because only that interrupts a call which waits in the operating system. A
    thread sends it: the operating system's timers belong to the user, whose tests may have a time-out of their own. The
    thread has the clock; a call costs no more than a count.
    """

    def __init__(self) -> None:
        self._main = threading.main_thread().ident
        self._watching = False
        self._count = 0
        """Grows with every begin and end of a call."""
        self._limit_s = inf
        """What the present call may take."""
        self._overdue = -1
        """The count of a call that has taken longer."""
        self._told = False
        """Overdue has been raised in the present call."""

    def limited(self, limit_s: float, work: Callable[[*A], T], *arguments: *A) -> T:
        """Return what `work` returns; raise Overdue out of it when it takes longer than `limit_s` by the clock.

        What catches even Overdue is not ended before it returns, and Overdue is raised then. A single step outside of
        Python is not ended either; one that keeps Python's lock from all others is not even noticed. A call held in a
        debugger is not limited, nor are those in other threads than the main one, where Python handles no signals,
        and in programs that handle SIGURG themselves.
        """
        if threading.get_ident() != self._main or not (self._watching or self._watch()):
            return work(*arguments)
        # Counted before the limit changes, so that no limit is held against what came before or comes after.
        self._count += 1
        outer, told = self._limit_s, self._told
        self._limit_s, self._told = limit_s, False
        try:
            result = work(*arguments)
            if self._told:
                raise Overdue
            return result
        finally:
            self._count += 1
            self._limit_s, self._told = outer, told

    def _watch(self) -> bool:
        """Begin to look, unless the signal is somebody else's; tell whether somebody looks."""
        if signal.getsignal(SIGNAL) not in (signal.SIG_DFL, self._on_signal):
            return False
        self._watching = True
        signal.signal(SIGNAL, self._on_signal)
        threading.Thread(target=self._look, name="watchdog", daemon=True).start()
        return True

    def forked(self) -> None:
        """Begin anew in a child process, which has none of the threads."""
        self._watching = False
        self._main = threading.main_thread().ident

    def _look(self) -> None:
        seen, since = self._count, monotonic()
        while True:
            sleep(LOOK_S)
            count, limit_s, now = self._count, self._limit_s, monotonic()
            if count != seen:
                seen, since = count, now
            elif now - since > limit_s and self._main is not None:
                self._overdue = count
                signal.pthread_kill(self._main, SIGNAL)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        """End the call, and again if it has caught that; let it be where Ctrl-C ends it or somebody debugs it."""
        if self._overdue != self._count:
            return
        interrupted = isinstance(sys.exc_info()[1], KeyboardInterrupt)
        if interrupted or any(module.startswith(DEBUGGERS) for module in _modules(frame)):
            self._count += 2
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
