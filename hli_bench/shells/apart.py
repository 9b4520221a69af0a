"""Work in a thread of its own while the main thread waits, so that Ctrl-C counts at once."""

import threading
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def apart(work: Callable[[], T]) -> T:
    """Return what `work` returns, raise what it raises.

    For work that native code calls back: a KeyboardInterrupt in such a callback is printed and lost. An interrupted
    `work` goes on until the process ends, and does not hold that up.
    """
    results: list[T] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join()
    if errors:
        raise errors[0]
    return results[0]
