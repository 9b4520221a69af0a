"""SYNC: the object that every node of a bus acts on at the same instant."""

from typing import Final

from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import Value
from hli_bench.protocols.canopen.dictionary import ObjectValues
from hli_bench.wire.can import CanFrame

SYNC_COB_ID: Final = 0x80
_OBJECT: Final = 0x1005
_GENERATES: Final = 1 << 30


def sync_frame(cob_id: int = SYNC_COB_ID) -> CanFrame:
    """Return the SYNC that a master sends (no counter)."""
    return CanFrame(cob_id)


class SyncConsumer:
    """Knows which identifier is SYNC for this node (object 0x1005)."""

    __slots__ = ("_values", "cob_id")

    def __init__(self, values: ObjectValues) -> None:
        self._values = values
        self.cob_id = SYNC_COB_ID
        if values.has(_OBJECT):
            values.on_write(_OBJECT, 0, self._write)
        self.reload()

    def reload(self) -> None:
        """Take over the dictionary's value after a reset."""
        if self._values.has(_OBJECT):
            self.cob_id = self._values.number(_OBJECT) & 0x7FF

    def _write(self, value: Value) -> None:
        """Refuse to produce SYNC and 29-bit identifiers; both are not offered."""
        word = int(value)
        if word & _GENERATES or word & 0x3FFFF800 or not word & 0x7FF:
            raise SdoAbort(AbortCode.RANGE)
        self.cob_id = word & 0x7FF
