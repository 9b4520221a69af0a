"""Layer setting services (CiA 305), slave side: find a node by its identity, set node id and bit rate."""

import struct
from enum import IntEnum
from typing import Final

from hli_bench.wire.can import CanFrame

MASTER_COB_ID: Final = 0x7E5
SLAVE_COB_ID: Final = 0x7E4
_LENGTH: Final = 8
_DONE, _REFUSED = 0, 1
_BIT_RATES: Final = {0: 1000, 1: 800, 2: 500, 3: 250, 4: 125, 6: 50, 7: 20, 8: 10}
"""kbit/s by table index of the standard bit timing table; 5 is reserved."""


class _Service(IntEnum):
    SWITCH_GLOBAL = 0x04
    CONFIGURE_NODE_ID = 0x11
    CONFIGURE_BIT_TIMING = 0x13
    ACTIVATE_BIT_TIMING = 0x15
    STORE = 0x17
    SELECT_VENDOR = 0x40
    SELECT_SERIAL = 0x43
    SELECTED = 0x44
    IDENTIFY_VENDOR = 0x46
    IDENTIFY_SERIAL_HIGH = 0x4B
    IDENTIFIED = 0x4F
    INQUIRE_VENDOR = 0x5A
    INQUIRE_SERIAL = 0x5D
    INQUIRE_NODE_ID = 0x5E


class LssSlave:
    """LSS of a node with `identity` (vendor, product, revision, serial of object 0x1018).

    `pending_node_id` counts from the next NMT reset communication, `stored_node_id` from the next reset node.
    The bit rate is kept but changes nothing: the emulated bus has no bit timing (decided here).
    """

    __slots__ = (
        "_matched",
        "_range",
        "configuring",
        "identity",
        "kbit_per_s",
        "pending_node_id",
        "stored_node_id",
    )

    def __init__(self, node_id: int, identity: tuple[int, int, int, int]) -> None:
        self.identity = identity
        self.pending_node_id = node_id
        self.stored_node_id = node_id
        self.kbit_per_s = 1000
        self.configuring = False
        self._matched = 0
        self._range: list[int] = []

    def on_frame(self, frame: CanFrame, node_id: int) -> list[CanFrame]:
        """Answer a master's service; `node_id` is the active one."""
        if frame.cob_id != MASTER_COB_ID or frame.remote or len(frame.data) != _LENGTH:
            return []
        service = frame.data[0]
        number: int = struct.unpack_from("<I", frame.data, 1)[0]
        if service == _Service.SWITCH_GLOBAL:
            self.configuring = frame.data[1] == 1
            return []
        if _Service.SELECT_VENDOR <= service <= _Service.SELECT_SERIAL:
            return self._select(service - _Service.SELECT_VENDOR, number)
        if _Service.IDENTIFY_VENDOR <= service <= _Service.IDENTIFY_SERIAL_HIGH:
            return self._identify(service - _Service.IDENTIFY_VENDOR, number)
        return self._configure(service, frame.data, node_id) if self.configuring else []

    def _select(self, part: int, number: int) -> list[CanFrame]:
        """Take one of the four identity parts, which come in order; the last one selects."""
        if part == 0:
            self._matched = 0
        if part != self._matched or self.identity[part] != number:
            self._matched = 0
            return []
        self._matched += 1
        if self._matched < len(self.identity):
            return []
        self._matched = 0
        self.configuring = True
        return _reply(_Service.SELECTED)

    def _identify(self, part: int, number: int) -> list[CanFrame]:
        """Take one of vendor, product, revision and serial low/high; answer when all fit."""
        self._range = [*self._range[:part], number] if part <= len(self._range) else []
        if len(self._range) < 6:
            return []
        vendor, product, revision_low, revision_high, serial_low, serial_high = self._range
        self._range = []
        inside = (
            self.identity[:2] == (vendor, product)
            and revision_low <= self.identity[2] <= revision_high
            and serial_low <= self.identity[3] <= serial_high
        )
        return _reply(_Service.IDENTIFIED) if inside else []

    def _configure(self, service: int, data: bytes, node_id: int) -> list[CanFrame]:
        """Serve what only a node in configuration state answers."""
        if _Service.INQUIRE_VENDOR <= service <= _Service.INQUIRE_SERIAL:
            return _reply(service, struct.pack("<I", self.identity[service - _Service.INQUIRE_VENDOR]))
        match service:
            case _Service.INQUIRE_NODE_ID:
                return _reply(service, bytes((node_id,)))
            case _Service.CONFIGURE_NODE_ID:
                return _reply(service, bytes((self._set_node_id(data[1]),)))
            case _Service.CONFIGURE_BIT_TIMING:
                return _reply(service, bytes((self._set_bit_timing(data[1], data[2]),)))
            case _Service.STORE:
                self.stored_node_id = self.pending_node_id
                return _reply(service, bytes((_DONE,)))
            case _:
                return []

    def _set_node_id(self, node_id: int) -> int:
        """Accept 1..127; giving up the node id (255) is refused, an axis without a drive helps nobody."""
        if not 1 <= node_id <= 127:
            return _REFUSED
        self.pending_node_id = node_id
        return _DONE

    def _set_bit_timing(self, table: int, index: int) -> int:
        if table != 0 or index not in _BIT_RATES:
            return _REFUSED
        self.kbit_per_s = _BIT_RATES[index]
        return _DONE


def _reply(service: int, data: bytes = b"") -> list[CanFrame]:
    return [CanFrame(SLAVE_COB_ID, (bytes((service,)) + data).ljust(_LENGTH, b"\0"))]
