"""What the processes of a bench say to one another in each cycle, as bytes."""

from collections.abc import Iterable, Sequence
from enum import IntEnum
from struct import Struct
from typing import Final

from hli_bench.base.time import Ns
from hli_bench.wire.can import CanFrame
from hli_bench.wire.signals import Edge

_FRAME: Final = Struct("<HB")
_EDGE: Final = Struct("<HqB")
_HEAD: Final = Struct("<BQ")
_COUNT: Final = Struct("<I")
_REMOTE: Final = 0x8000


class Order(IntEnum):
    """What a worker process is asked to do."""

    POWER_ON = 1
    CYCLE = 2


def order(kind: Order, cycle: int, body: bytes = b"") -> bytes:
    """Return a request."""
    return _HEAD.pack(kind, cycle) + body


def read_order(message: bytes) -> tuple[Order, int, bytes]:
    """Return kind, cycle and body of a request."""
    kind, cycle = _HEAD.unpack_from(message)
    return Order(kind), cycle, message[_HEAD.size :]


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
