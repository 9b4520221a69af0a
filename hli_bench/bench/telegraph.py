"""What the processes of a bench say to one another in each cycle, as bytes."""

from collections.abc import Iterable, Sequence
from enum import IntEnum
from struct import Struct
from typing import Any, Final, NamedTuple

import numpy as np

from hli_bench.base.time import Ns
from hli_bench.laws.rows import Rows
from hli_bench.wire.can import CanFrame
from hli_bench.wire.signals import Edge

_FRAME: Final = Struct("<HB")
_EDGE: Final = Struct("<HqB")
_HEAD: Final = Struct("<BQ")
_COUNT: Final = Struct("<I")
_REPLY: Final = Struct("<BHHHI")
_REMOTE: Final = 0x8000


class Span:
    """Neighbouring fields of all rows as bytes: copied at once, which is much faster than field by field."""

    def __init__(self, rows: Rows, first: str, last: str) -> None:
        fields: Any = rows.dtype.fields
        begin, end = fields[first][1], fields[last][1] + fields[last][0].itemsize
        size = rows.dtype.itemsize
        span = np.dtype(
            {"names": ["span"], "formats": [f"V{end - begin}"], "offsets": [begin], "itemsize": size}
        )
        self._span: Rows = rows.view(span)["span"]
        self._dtype = self._span.dtype

    def read(self) -> bytes:
        """Return what stands in the rows."""
        return self._span.tobytes()

    def write(self, data: bytes) -> None:
        """Put it into the rows."""
        self._span[...] = np.frombuffer(data, self._dtype)


class Numbers:
    """What the telegrams of all axes say, as numbers. On both sides `axis` are rows of the same shape.

    The drives get the status words too: those bits that no law computes stay as the kernel has seen them.
    """

    def __init__(self, axis: Rows) -> None:
        self._command = Span(axis, "target", "probe_function")
        self._actual = Span(axis, "statusword", "received")
        self.command = self._command.read
        """Packs targets, control words, latch control words."""
        self.take_command = self._command.write
        self.actual = self._actual.read
        """Packs status words, latches, positions and what else the drives say at each SYNC."""
        self.take_actual = self._actual.write


class Order(IntEnum):
    """What a worker process is asked to do."""

    POWER_ON = 1
    CYCLE = 2
    """Frames pass at this SYNC."""
    WORDS = 3
    """Only numbers pass, among them control words that have changed."""
    NUMBERS = 4
    """Only numbers pass, control words are as they were."""


LOUD: Final = 0
"""The drives say: the next cycle needs frames."""
QUIET: Final = 1
"""The next cycle needs no frames from their side."""
FAULT: Final = 2
"""A drive has an error: this SYNC needs frames. The machine has moved, nothing else has happened yet."""


SETTLED: Final = b"\1"
"""The terminals say: the images stay as they are while no edge comes."""
CHANGING: Final = b"\0"
"""They may change without one."""


def order(kind: Order, cycle: int, body: bytes = b"") -> bytes:
    """Return a request."""
    return _HEAD.pack(kind, cycle) + body


def read_order(message: bytes) -> tuple[Order, int, bytes]:
    """Return kind, cycle and body of a request."""
    kind, cycle = _HEAD.unpack_from(message)
    return Order(kind), cycle, message[_HEAD.size :]


class Reply(NamedTuple):
    """The drives' answer to an order: numbers or frames of the SYNC, frames due by time, frames of others, edges."""

    state: int
    numbers: bytes = b""
    frames: bytes = b""
    due: bytes = b""
    foreign: bytes = b""
    edges: bytes = b""


def reply(answer: Reply) -> bytes:
    """Pack the drives' answer."""
    state, *before, edges = answer
    return b"".join((_REPLY.pack(state, *map(len, before)), *before, edges))


def read_reply(message: bytes) -> Reply:
    """Unpack the drives' answer."""
    state, numbers, frames, due, foreign = _REPLY.unpack_from(message)
    first = _REPLY.size + numbers
    second = first + frames
    third = second + due
    last = third + foreign
    return Reply(
        state,
        message[_REPLY.size : first],
        message[first:second],
        message[second:third],
        message[third:last],
        message[last:],
    )


def frames(items: Iterable[CanFrame]) -> bytes:
    """Pack CAN frames."""
    return b"".join(
        _FRAME.pack(one.cob_id | (_REMOTE if one.remote else 0), len(one.data)) + one.data for one in items
    )


def read_frames(data: bytes) -> list[CanFrame]:
    """Unpack CAN frames."""
    found: list[CanFrame] = []
    at = 0
    while at < len(data):
        cob_id, length = _FRAME.unpack_from(data, at)
        at += _FRAME.size
        found.append(CanFrame(cob_id & 0x7FF, data[at : at + length], bool(cob_id & _REMOTE)))
        at += length
    return found


def edges(items: Sequence[Edge], signals: Sequence[str]) -> bytes:
    """Pack edges."""
    return b"".join(_EDGE.pack(signals.index(one.signal), one.at_ns, one.level) for one in items)


def read_edges(data: bytes, signals: Sequence[str]) -> list[Edge]:
    """Unpack edges."""
    return [Edge(signals[signal], Ns(at), bool(level)) for signal, at, level in _EDGE.iter_unpack(data)]


def parts(*items: bytes) -> bytes:
    """Pack several byte strings into one."""
    return b"".join(_COUNT.pack(len(item)) + item for item in items)


def read_parts(data: bytes) -> list[bytes]:
    """Unpack what `parts` made."""
    found: list[bytes] = []
    at = 0
    while at < len(data):
        length = _COUNT.unpack_from(data, at)[0]
        at += _COUNT.size
        found.append(data[at : at + length])
        at += length
    return found
