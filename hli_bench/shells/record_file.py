"""A file that a run writes while it lasts: what befalls the file is no affair of the run's.

Neither a full disk nor Ctrl-C may leave half a piece between whole ones.
"""

import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Final

from hli_bench.base.errors import EnvironmentLacks, InputError

OnNote = Callable[[str], None]
INTERRUPTS: Final = (signal.SIGINT, signal.SIGTERM)


class RecordFile:
    """Written from its beginning to its end. When that fails it is told once, and what comes later is dropped.

    So what stands in front of the failure can be read. `close` raises EnvironmentLacks that names the file.
    """

    def __init__(self, path: Path, on_note: OnNote) -> None:
        """Raises InputError when the file cannot be opened."""
        self._path = path
        self._on_note = on_note
        self._failure: EnvironmentLacks | None = None
        self._at = 0
        try:
            self._file = path.open("wb")
        except OSError as error:
            raise InputError(f"cannot be written: {error.strerror}", file=str(path)) from error

    @property
    def closed(self) -> bool:
        """Nothing more can be written."""
        return self._file.closed

    def write(self, data: bytes | memoryview) -> int:
        """Write all of it."""
        size = memoryview(data).nbytes
        self._at += size
        self._try(lambda: self._file.write(data))
        return size

    def writelines(self, lines: Iterable[bytes]) -> None:
        """Write them one behind the other."""
        self.write(b"".join(lines))

    def tell(self) -> int:
        """Return how many bytes have been written."""
        return self._at

    def flush(self) -> None:
        """Hand all to the operating system, so that it stands in the file whatever becomes of this process."""
        self._try(self._file.flush)

    def close(self) -> None:
        """Close it. Raises EnvironmentLacks when not all stands in a file of that name."""
        self._on_note = _not_told
        self.flush()
        self._try(self._check_name)
        with suppress(OSError):
            self._file.close()
        if self._failure is not None:
            raise self._failure

    def _check_name(self) -> None:
        if not os.path.samestat(os.fstat(self._file.fileno()), self._path.stat()):
            raise FileNotFoundError(0, "another file has taken its place")

    def _try(self, action: Callable[[], object]) -> None:
        if self._failure is not None:
            return
        try:
            action()
        except OSError as error:
            self._failure = EnvironmentLacks(f"{self._path}: recording has failed: {error.strerror}")
            self._on_note(f"{self._failure}; the run goes on without it")


def _not_told(note: str) -> None:
    """What is raised need not be told."""


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Let Ctrl-C and SIGTERM wait until what is begun is done; Python delivers them to its main thread only."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    with ExitStack() as behind:
        behind.callback(_deliver, came)
        for number in INTERRUPTS:
            behind.callback(signal.signal, number, signal.getsignal(number))
        for number in INTERRUPTS:
            signal.signal(number, lambda which, _: came.append(which))
        yield


def _deliver(came: list[int]) -> None:
    """Let each signal that came take effect, also behind one whose handler raises."""
    try:
        while came:
            signal.raise_signal(came.pop(0))
    finally:
        if came:
            _deliver(came)
