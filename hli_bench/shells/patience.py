"""A word to somebody who waits."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer


@contextmanager
def patience(on_note: Callable[[str], None], note: str, after_s: float = 1.0) -> Iterator[None]:
    """Give `note` to `on_note` when what is done in the context lasts longer than `after_s`."""
    timer = Timer(after_s, on_note, (note,))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
