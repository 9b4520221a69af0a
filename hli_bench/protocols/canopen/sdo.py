"""SDO frames and the client (CiA 301): expedited and segmented transfers as a state machine."""

import struct
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import Final

from hli_bench.base.time import NS_PER_MS, NS_PER_S, Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.wire.can import CanFrame

REQUEST_COB_ID: Final = 0x600
RESPONSE_COB_ID: Final = 0x580
FRAME_LENGTH: Final = 8
SEGMENT_BYTES: Final = 7
EXPEDITED_BYTES: Final = 4
ABORT: Final = 0x80
TOGGLE_BIT: Final = 0x10

CLIENT_TIMEOUT: Final = Ns(NS_PER_S)
"""How long a client waits for an answer (decided here)."""
SERVER_TIMEOUT: Final = Ns(500 * NS_PER_MS)
"""How long a server waits for the next frame of a started transfer (decided here)."""

_HEADER: Final = struct.Struct("<BHB")


def header(command: int, index: int, subindex: int, data: bytes = b"") -> bytes:
    """Return an 8-byte frame with command, multiplexer and up to four bytes."""
    return _HEADER.pack(command, index, subindex) + data.ljust(EXPEDITED_BYTES, b"\0")


def multiplexer(data: bytes) -> tuple[int, int]:
    """Return index and sub-index of an initiate or abort frame."""
    _, index, subindex = _HEADER.unpack_from(data)
    return index, subindex


def abort_frame(cob_id: int, address: tuple[int, int], code: int) -> CanFrame:
    """Return the frame that ends a transfer early."""
    return CanFrame(cob_id, header(ABORT, *address, struct.pack("<I", code)))


def initiate_download(address: tuple[int, int], data: bytes) -> bytes:
    """Return the first frame of a download: all of it up to four bytes, else the size of what follows."""
    if 1 <= len(data) <= EXPEDITED_BYTES:
        return header(0x23 | (EXPEDITED_BYTES - len(data)) << 2, *address, data)
    return header(0x21, *address, struct.pack("<I", len(data)))


def segment(toggle: int, data: bytes, position: int) -> bytes:
    """Return the frame of the segment of `data` that starts at `position`."""
    part = data[position : position + SEGMENT_BYTES]
    last = position + SEGMENT_BYTES >= len(data)
    first = toggle | (SEGMENT_BYTES - len(part)) << 1 | last
    return bytes((first,)) + part.ljust(SEGMENT_BYTES, b"\0")


def segment_data(data: bytes) -> tuple[bytes, bool]:
    """Return the bytes of a received segment and whether it is the last one."""
    unused = data[0] >> 1 & 7
    return data[1 : FRAME_LENGTH - unused], bool(data[0] & 1)


class _Waiting(Enum):
    """What a client waits for."""

    NOTHING = auto()
    DOWNLOAD_STARTED = auto()
    DOWNLOAD_SEGMENT = auto()
    UPLOAD_STARTED = auto()
    UPLOAD_SEGMENT = auto()


_DOWNLOADS: Final = 0x60
_UPLOADS: Final = 0x40
_INITIATED: Final = {_Waiting.DOWNLOAD_STARTED: _DOWNLOADS, _Waiting.UPLOAD_STARTED: _UPLOADS}
"""Command of the answer that names the object and that a client waits for."""


@dataclass(slots=True)
class _Transfer:
    """What a client knows of its transfer."""

    address: tuple[int, int]
    data: bytearray = field(default_factory=bytearray)
    size: int | None = None
    position: int = 0
    toggle: int = 0


class SdoClient:
    """One transfer at a time to the default SDO server of a node, which others on the bus may use as well.

    `begin_write`/`begin_read` give the first frame, `on_frame` the following ones; when no longer `busy`,
    `result()` has the bytes read (b"" after a write) or raises SdoAbort.
    """

    __slots__ = ("_deadline", "_error", "_transfer", "_waiting", "collided", "node_id", "timeout")

    def __init__(self, node_id: int, timeout: Ns = CLIENT_TIMEOUT) -> None:
        self.node_id = node_id
        self.timeout = timeout
        self._waiting = _Waiting.NOTHING
        self._transfer: _Transfer | None = None
        self._error: SdoAbort | None = None
        self._deadline = Ns(0)
        self.collided = False
        """Answers to somebody else came from the server during the last transfer: it may have lost that one for it."""

    @property
    def busy(self) -> bool:
        """Whether a transfer is under way."""
        return self._waiting is not _Waiting.NOTHING

    def result(self) -> bytes:
        """Return what the last transfer read. Raises its SdoAbort, or RuntimeError while busy."""
        if self.busy or self._transfer is None:
            raise RuntimeError("no finished SDO transfer")
        if self._error is not None:
            raise self._error
        return bytes(self._transfer.data) if self._transfer.size is not None else b""

    def begin_write(self, index: int, subindex: int, data: bytes, now: Ns) -> list[CanFrame]:
        """Start a download; expedited up to four bytes. Raises RuntimeError while busy."""
        self._start(_Waiting.DOWNLOAD_STARTED, _Transfer((index, subindex), bytearray(data)), now)
        return self._frame(initiate_download((index, subindex), data))

    def begin_read(self, index: int, subindex: int, now: Ns) -> list[CanFrame]:
        """Start an upload. Raises RuntimeError while busy."""
        self._start(_Waiting.UPLOAD_STARTED, _Transfer((index, subindex)), now)
        return self._frame(header(0x40, index, subindex))

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Take a frame of the bus; frames that are not this client's answers change nothing.

        What tells them apart is the object: an answer names it, or is a segment.
        """
        transfer = self._transfer
        ours = frame.cob_id == RESPONSE_COB_ID + self.node_id and len(frame.data) == FRAME_LENGTH
        if not ours or frame.remote or not self.busy or transfer is None:
            return []
        if self._is_others(transfer, frame.data):
            self.collided = True
            return []
        if frame.data[0] == ABORT:
            self._finish(SdoAbort(struct.unpack_from("<I", frame.data, 4)[0]))
            return []
        self._deadline = Ns(now + self.timeout)
        try:
            reply = self._reply(transfer, frame.data)
        except SdoAbort as abort:
            self._finish(abort)
            return [abort_frame(REQUEST_COB_ID + self.node_id, transfer.address, abort.code)]
        return [] if reply is None else self._frame(reply)

    def tick(self, now: Ns) -> list[CanFrame]:
        """Abort the transfer when its answer is overdue."""
        if not self.busy or now < self._deadline or self._transfer is None:
            return []
        self._finish(SdoAbort(AbortCode.TIME_OUT))
        return [abort_frame(REQUEST_COB_ID + self.node_id, self._transfer.address, AbortCode.TIME_OUT)]

    def next_due(self) -> Ns | None:
        """Return when `tick` has something to do at the latest."""
        return self._deadline if self.busy else None

    def _start(self, waiting: _Waiting, transfer: _Transfer, now: Ns) -> None:
        if self.busy:
            raise RuntimeError("an SDO transfer is still under way")
        self._waiting = waiting
        self._transfer = transfer
        self._error = None
        self.collided = False
        self._deadline = Ns(now + self.timeout)

    def _is_others(self, transfer: _Transfer, data: bytes) -> bool:
        """Tell whether an answer of the server is one to another client."""
        command = data[0] & 0xE0
        if command not in (_DOWNLOADS, _UPLOADS, ABORT):
            return self._waiting in (_Waiting.DOWNLOAD_STARTED, _Waiting.UPLOAD_STARTED)
        if multiplexer(data) != transfer.address:
            return True
        expected = _INITIATED.get(self._waiting)
        return command != ABORT and command != expected

    def _frame(self, data: bytes) -> list[CanFrame]:
        return [CanFrame(REQUEST_COB_ID + self.node_id, data)]

    def _finish(self, error: SdoAbort | None = None) -> None:
        self._waiting = _Waiting.NOTHING
        self._error = error

    def _reply(self, transfer: _Transfer, data: bytes) -> bytes | None:
        """Return the next request, None when the transfer is complete."""
        match self._waiting:
            case _Waiting.DOWNLOAD_STARTED:
                return self._download_started(transfer, data)
            case _Waiting.DOWNLOAD_SEGMENT:
                return self._download_segment(transfer, data)
            case _Waiting.UPLOAD_STARTED:
                return self._upload_started(transfer, data)
            case _Waiting.UPLOAD_SEGMENT:
                return self._upload_segment(transfer, data)
            case _Waiting.NOTHING:
                return None

    def _download_started(self, transfer: _Transfer, data: bytes) -> bytes | None:
        if data[0] != 0x60 or multiplexer(data) != transfer.address:
            raise SdoAbort(AbortCode.BAD_COMMAND)
        if 1 <= len(transfer.data) <= EXPEDITED_BYTES:
            self._finish()
            return None
        self._waiting = _Waiting.DOWNLOAD_SEGMENT
        return segment(0, bytes(transfer.data), 0)

    def _download_segment(self, transfer: _Transfer, data: bytes) -> bytes | None:
        if data[0] & ~TOGGLE_BIT != 0x20:
            raise SdoAbort(AbortCode.BAD_COMMAND)
        if data[0] & TOGGLE_BIT != transfer.toggle:
            raise SdoAbort(AbortCode.TOGGLE)
        transfer.position += SEGMENT_BYTES
        transfer.toggle ^= TOGGLE_BIT
        if transfer.position >= len(transfer.data):
            self._finish()
            return None
        return segment(transfer.toggle, bytes(transfer.data), transfer.position)

    def _upload_started(self, transfer: _Transfer, data: bytes) -> bytes | None:
        if data[0] & 0xE0 != 0x40 or multiplexer(data) != transfer.address:
            raise SdoAbort(AbortCode.BAD_COMMAND)
        if data[0] & 2:
            unused = data[0] >> 2 & 3 if data[0] & 1 else 0
            transfer.data += data[4 : FRAME_LENGTH - unused]
            transfer.size = len(transfer.data)
            self._finish()
            return None
        transfer.size = struct.unpack_from("<I", data, 4)[0] if data[0] & 1 else -1
        self._waiting = _Waiting.UPLOAD_SEGMENT
        return bytes((0x60,)).ljust(FRAME_LENGTH, b"\0")

    def _upload_segment(self, transfer: _Transfer, data: bytes) -> bytes | None:
        if data[0] & 0xE0:
            raise SdoAbort(AbortCode.BAD_COMMAND)
        if data[0] & TOGGLE_BIT != transfer.toggle:
            raise SdoAbort(AbortCode.TOGGLE)
        part, last = segment_data(data)
        transfer.data += part
        transfer.toggle ^= TOGGLE_BIT
        if not last:
            return bytes((0x60 | transfer.toggle,)).ljust(FRAME_LENGTH, b"\0")
        if transfer.size not in {-1, len(transfer.data)}:
            raise SdoAbort(AbortCode.LENGTH)
        self._finish()
        return None
