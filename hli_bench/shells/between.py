"""What serves clients of a bench while the thread that owns it does something else."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, RLock, Thread
from typing import Final

LOOK_S: Final = 0.02
"""How often it is looked whether a client asks for something."""
END_S: Final = 60.0
"""A look may let cycles pass in which a PLC is waited for."""


class BetweenCalls:
    """Calls `attend` again and again, from a thread of its own, while nobody is `busy`.

    While somebody is, it costs nothing: the thread waits. It ends when `attend` raises.
    """

    def __init__(self, attend: Callable[[], None]) -> None:
        self._attend = attend
        self._turn = RLock()
        self._depth = 0
        self._idle = Event()
        self._closed = Event()
        self._thread = Thread(target=self._serve, name="between calls", daemon=True)

    def start(self) -> None:
        """Begin: from now on it is idle when nobody is busy."""
        self._thread.start()

    @contextmanager
    def busy(self) -> Iterator[None]:
        """Have the bench to oneself; may be nested."""
        self._idle.clear()
        with self._turn:
            self._depth += 1
            try:
                yield
            finally:
                self._depth -= 1
                if not self._depth and not self._closed.is_set():
                    self._idle.set()

    def close(self) -> None:
        """End the thread."""
        self._closed.set()
        self._idle.set()
        if self._thread.is_alive():
            self._thread.join(END_S)

    def _serve(self) -> None:
        while True:
            self._idle.wait()
            if self._closed.wait(LOOK_S):
                return
            with self._turn:
                if self._idle.is_set() and not self._closed.is_set():
                    self._attend()
