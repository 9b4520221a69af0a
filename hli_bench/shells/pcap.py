"""The bus as a capture file that tshark and Wireshark open: link type SocketCAN, stamps in ns."""

from struct import Struct
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.time import NS_PER_S
from hli_bench.wire.can import CanFrame

LINKTYPE_CAN_SOCKETCAN: Final = 227
_MAGIC_NS: Final = 0xA1B23C4D
_SNAP_BYTES: Final = 16
_REMOTE: Final = 0x40000000
_FILE: Final = Struct("<IHHiIII")
_RECORD: Final = Struct("<IIII")
_CAN: Final = Struct(">IBxxx")


class Pcap:
    """Form of a classic pcap file, version 2.4."""

    head: Final = _FILE.pack(_MAGIC_NS, 2, 4, 0, 0, _SNAP_BYTES, LINKTYPE_CAN_SOCKETCAN)
    tail: Final = 0

    def frame(self, frame: CanFrame, unix_ns: int) -> bytes:
        """Return one frame as a record."""
        seconds, rest = divmod(unix_ns, NS_PER_S)
        length = _CAN.size + len(frame.data)
        identifier = frame.cob_id | (_REMOTE if frame.remote else 0)
        head = _RECORD.pack(seconds, rest, length, length)
        return head + _CAN.pack(identifier, len(frame.data)) + frame.data

    def stamps(self, unix_ns: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Return seconds and nanoseconds, 4 bytes each."""
        stamps = np.stack(np.divmod(unix_ns, NS_PER_S), axis=1)
        return stamps.astype("<u4").view(np.uint8)

    def data(self, payload: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return the data as they are."""
        return payload
