"""What came over the net and waits for the bench's thread: bounded, and taken a little at a time in a paced cycle."""

from collections.abc import Callable
from queue import Empty, SimpleQueue
from time import monotonic_ns
from typing import Any, Final

WAITING: Final = 1000
"""So many messages wait at most; commands of attached PLCs may wait beside them in the same number."""
WAITING_BYTES: Final = 64 << 20
"""The payloads that wait have no more bytes together; one program has at most a quarter of it."""
PACED_NS: Final = 100_000
"""How long a paced bench handles messages in one look at them (decided here)."""
FREE_NS: Final = 50_000_000
"""The same of one that waits for its PLCs: who floods it must not hold it for ever."""

Handler = Callable[[Any], None]
Item = tuple[Handler, Any, int]


class Budget:
    """Time for one look: `left` until it is used up."""

    __slots__ = ("_until",)

    def __init__(self, budget_ns: int) -> None:
        self._until = monotonic_ns() + budget_ns

    @property
    def left(self) -> bool:
        """Whether there is time left."""
        return monotonic_ns() < self._until


class Inbox:
    """Filled by network threads, emptied by one other. What does not fit is dropped and counted in `dropped`."""

    __slots__ = ("_came", "_handled", "_queue", "dropped")

    def __init__(self) -> None:
        self._queue: SimpleQueue[Item] = SimpleQueue()
        self._came = 0
        self._handled = 0
        """Bytes of payloads; each is counted up by one side only. Network threads may lose a count to each other:
        the tally starts anew whenever the queue is empty."""
        self.dropped = 0

    def put(self, handle: Handler, message: Any, *, share: int = 1) -> bool:
        """Queue a message for `handle`; False when there is no room. `share` 2: may also use the room of PLCs."""
        content = message.payload
        size = 0 if content is None else len(content)
        waiting = self._queue.qsize()
        if waiting >= share * WAITING or (waiting and self._came - self._handled + size > WAITING_BYTES):
            self.dropped += 1
            return False
        self._came += size
        self._queue.put((handle, message, size))
        return True

    def handle(self, budget: Budget) -> None:
        """Handle what waits while the budget lasts."""
        while not self._queue.empty():
            self._take(self._queue.get_nowait())
            if not budget.left:
                return
        self._came = self._handled = 0

    def wait(self, timeout_s: float) -> None:
        """Wait for a message and handle it; at most `timeout_s`."""
        try:
            item = self._queue.get(timeout=timeout_s)
        except Empty:
            return
        self._take(item)

    def _take(self, item: Item) -> None:
        handle, message, size = item
        self._handled += size
        handle(message)
