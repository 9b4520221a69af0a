"""Emergency messages (CiA 301): error register, history, inhibit time."""

import struct
from enum import IntFlag
from typing import Final

from hli_bench.base.time import NS_PER_US, Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import Value
from hli_bench.protocols.canopen.dictionary import ObjectValues
from hli_bench.wire.can import CanFrame

NO_ERROR: Final = 0x0000
RPDO_TOO_SHORT: Final = 0x8210
RPDO_TOO_LONG: Final = 0x8220
COMMUNICATION_LOST: Final = 0x8130

_REGISTER: Final = 0x1001
_HISTORY: Final = 0x1003
_COB_ID: Final = 0x1014
_INHIBIT: Final = 0x1015
_INVALID: Final = 1 << 31


class ErrorRegister(IntFlag):
    """Bits of object 0x1001."""

    GENERIC = 0x01
    CURRENT = 0x02
    VOLTAGE = 0x04
    TEMPERATURE = 0x08
    COMMUNICATION = 0x10
    PROFILE = 0x20
    VENDOR = 0x80


class EmergencyProducer:
    """Keeps 0x1001 and 0x1003 and gives the frames, not denser than the inhibit time (0x1015, 100 us)."""

    __slots__ = ("_allowed_at", "_history_depth", "_queue", "_values", "active")

    def __init__(self, values: ObjectValues) -> None:
        self._values = values
        self._queue: list[bytes] = []
        self._allowed_at = Ns(0)
        self.active: dict[int, ErrorRegister] = {}
        """Errors that have occurred and not recovered, with their bits of the register."""
        self._history_depth = len(values.description.subindices(_HISTORY)) if values.has(_HISTORY) else 0
        if self._history_depth:
            values.on_write(_HISTORY, 0, self._clear_history)
        if values.has(_COB_ID):
            values.on_write(_COB_ID, 0, self._write_cob_id)

    def occur(self, code: int, register: ErrorRegister, detail: bytes = b"") -> bool:
        """Report an error in register, history and message. False: it is active already."""
        if code in self.active:
            return False
        self.active[code] = register | ErrorRegister.GENERIC
        self._remember(code)
        self._update(code, detail)
        return True

    def recover(self, code: int) -> None:
        """Report that an error is gone; the message carries code 0 when it was the last one."""
        if self.active.pop(code, None) is not None:
            self._update(next(reversed(self.active), NO_ERROR), b"")

    def reset(self, *, keep_errors: bool) -> None:
        """Forget waiting messages and, unless they are kept over a reset communication, active errors."""
        self._queue.clear()
        self._allowed_at = Ns(0)
        if not keep_errors:
            self.active.clear()
        self._set_register()

    def tick(self, now: Ns) -> list[CanFrame]:
        """Return the messages that the inhibit time allows now."""
        if not self._queue:
            return []
        word = self._values.number(_COB_ID) if self._values.has(_COB_ID) else 0x80 + self._values.node_id
        if word & _INVALID:
            self._queue.clear()
        inhibit = (self._values.number(_INHIBIT) if self._values.has(_INHIBIT) else 0) * 100 * NS_PER_US
        frames = []
        while self._queue and now >= self._allowed_at:
            frames.append(CanFrame(word & 0x7FF, self._queue.pop(0)))
            self._allowed_at = Ns(now + inhibit)
        return frames

    def next_due(self) -> Ns | None:
        """Return when a waiting message may be sent."""
        return self._allowed_at if self._queue else None

    def _update(self, code: int, detail: bytes) -> None:
        self._queue.append(struct.pack("<HB5s", code, self._set_register(), detail))

    def _set_register(self) -> int:
        """Show the bits of all active errors in 0x1001 and return them."""
        register = 0
        for bits in self.active.values():
            register |= bits
        if self._values.has(_REGISTER):
            self._values.put(_REGISTER, 0, register)
        return register

    def _remember(self, code: int) -> None:
        """Shift the history by one; the newest stands at sub-index 1."""
        if not self._history_depth:
            return
        count = min(self._values.number(_HISTORY, 0) + 1, self._history_depth)
        for sub in range(count, 1, -1):
            self._values.put(_HISTORY, sub, self._values.get(_HISTORY, sub - 1))
        self._values.put(_HISTORY, 1, code)
        self._values.put(_HISTORY, 0, count)

    def _clear_history(self, value: Value) -> None:
        if value:
            raise SdoAbort(AbortCode.RANGE)
        for sub in range(1, self._history_depth + 1):
            self._values.put(_HISTORY, sub, 0)

    def _write_cob_id(self, value: Value) -> None:
        word = int(value)
        present = self._values.number(_COB_ID)
        change_while_valid = not (word | present) & _INVALID and word != present
        if word & 0x7FFFF800 or word & 0x7FF == 0 or change_while_valid:
            raise SdoAbort(AbortCode.RANGE)
