"""What a paced process asks of Python and of the operating system, so that nothing holds its cycle."""

import ctypes
import errno
import gc
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, Final

PRIORITY: Final = 50
"""Of SCHED_FIFO: above what computes, below the interrupt threads of a kernel with PREEMPT_RT."""
YOUNG: Final = 2000
"""So many young objects are worth a collection in an idle gap (decided here)."""
SHARE: Final = 3
"""A gap must be so many times as long as the longest collection so far (decided here)."""
FIRST_GAP_NS: Final = 300_000
"""Before the first collection of all, a gap must be as long as this (decided here)."""
LEAST_SLACK_NS: Final = 1

_PR_SET_TIMERSLACK: Final = 29
_PR_GET_TIMERSLACK: Final = 30
_MCL_CURRENT: Final = 1
_MCL_FUTURE: Final = 2
_MCL_ONFAULT: Final = 4


class Garbage:
    """Collects young objects in idle gaps that are long enough, all others between programs, none by itself."""

    __slots__ = ("_clock", "_collect", "_longest_ns", "_young")

    def __init__(
        self,
        clock: Callable[[], int] = time.perf_counter_ns,
        young: Callable[[], int] = lambda: gc.get_count()[0],
        collect: Callable[[int], object] = gc.collect,
    ) -> None:
        self._clock = clock
        self._young = young
        self._collect = collect
        self._longest_ns = FIRST_GAP_NS // SHARE

    def idle(self, rest_ns: int) -> None:
        """Use a gap of `rest_ns`, if there is enough to collect and the gap is long enough for it."""
        if self._young() < YOUNG or rest_ns < SHARE * self._longest_ns:
            return
        start = self._clock()
        self._collect(0)
        self._longest_ns = max(self._longest_ns, self._clock() - start)

    def between_programs(self) -> None:
        """Collect all: nobody measures now."""
        self._collect(2)


def settle() -> None:
    """Let the collector never again look at what is there now."""
    gc.collect()
    gc.freeze()


class _Frozen:
    """How many paced benches of this process keep the collector still, and whether it ran before the first."""

    benches = 0
    was_enabled = True


@contextmanager
def frozen_garbage() -> Iterator[None]:
    """The collector never looks at what is there now, and does not start by itself, while any bench wants it so."""
    if not _Frozen.benches:
        _Frozen.was_enabled = gc.isenabled()
    _Frozen.benches += 1
    settle()
    gc.disable()
    try:
        yield
    finally:
        _Frozen.benches -= 1
        if not _Frozen.benches:
            gc.unfreeze()
            if _Frozen.was_enabled:
                gc.enable()


class Calm:
    """What the operating system gave a paced process; `close` gives it back. `notes` is for people."""

    def __init__(self) -> None:
        self._closing = ExitStack()
        self.notes: list[str] = []

    def close(self) -> None:
        """Run as before."""
        self._closing.close()

    def exact_sleep(self) -> None:
        """End sleeps of this thread when they are due, not up to 50 us later (Linux); everybody may."""
        library = _library()
        if library is None:
            return
        before = library.prctl(_PR_GET_TIMERSLACK, 0, 0, 0, 0)
        if before > 0 and library.prctl(_PR_SET_TIMERSLACK, LEAST_SLACK_NS, 0, 0, 0) == 0:
            self._closing.callback(library.prctl, _PR_SET_TIMERSLACK, before, 0, 0, 0)

    def real_time(self) -> None:
        """Ask for SCHED_FIFO and for locked memory; note what was given and what not."""
        self.notes += [self._priority(), self._lock_memory()]

    def _priority(self) -> str:
        """Put the calling thread under SCHED_FIFO; neither its children nor other threads."""
        if sys.platform != "linux":
            return f"real time: {sys.platform} has no SCHED_FIFO"
        try:
            before = take_fifo()
        except OSError as error:
            return f"real time: no SCHED_FIFO ({error.strerror}); {_ADVICE}"
        self._closing.callback(give_back, *before)
        return f"real time: SCHED_FIFO with priority {PRIORITY}"

    def _lock_memory(self) -> str:
        """Keep the pages of this process in memory, those to come only where there is no limit to run into."""
        library = _library()
        if library is None:
            return f"real time: memory is not locked on {sys.platform}"
        import resource

        unlimited = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY
        flags = _MCL_CURRENT | _MCL_ONFAULT | (_MCL_FUTURE if unlimited else 0)
        if library.mlockall(flags) != 0:
            reason = os.strerror(ctypes.get_errno() or errno.EPERM)
            return f"real time: memory is not locked ({reason}); {_ADVICE}"
        self._closing.callback(library.munlockall)
        return "real time: memory is locked" + (
            "" if unlimited else ", but not what is asked for from now on"
        )


_ADVICE: Final = "hli-bench doctor says how to get it"


def ask(*, realtime: bool) -> Calm:
    """Ask the operating system for what a paced process needs, with `realtime` for what few may have too."""
    calm = Calm()
    calm.exact_sleep()
    if realtime:
        calm.real_time()
    return calm


def take_fifo() -> tuple[int, Any]:
    """Put the calling thread under SCHED_FIFO, not its children; return what to give back. Raises OSError."""
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(PRIORITY))
    return before


def give_back(policy: int, parameter: Any) -> None:
    """Run as before `take_fifo`. Only root may clear the flag about children; it does no harm where it stays."""
    try:
        os.sched_setscheduler(0, policy, parameter)
    except PermissionError:
        os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, parameter)


def _library() -> Any:
    """Return the C library of Linux, None elsewhere."""
    return ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None
