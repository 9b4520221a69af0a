"""SDO server (CiA 301): expedited, segmented and block transfers to and from an ObjectValues store."""

import struct
from binascii import crc_hqx
from dataclasses import dataclass, field
from typing import Final

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import size_of
from hli_bench.protocols.canopen.dictionary import ObjectValues
from hli_bench.protocols.canopen.sdo import (
    ABORT,
    EXPEDITED_BYTES,
    FRAME_LENGTH,
    SEGMENT_BYTES,
    SERVER_TIMEOUT,
    TOGGLE_BIT,
    abort_frame,
    header,
    multiplexer,
    segment,
    segment_data,
)
from hli_bench.wire.can import CanFrame

MAX_BLOCK: Final = 127
"""Segments per block that this server asks for in a block download; the standard's greatest number."""
MAX_TRANSFER_BYTES: Final = 1 << 20
"""Longest download taken; more is refused as out of memory (decided here)."""


@dataclass(slots=True)
class _SegmentedDownload:
    address: tuple[int, int]
    size: int | None
    data: bytearray = field(default_factory=bytearray)
    toggle: int = 0


@dataclass(slots=True)
class _SegmentedUpload:
    address: tuple[int, int]
    data: bytes
    position: int = 0
    toggle: int = 0


@dataclass(slots=True)
class _BlockDownload:
    address: tuple[int, int]
    size: int | None
    with_crc: bool
    data: bytearray = field(default_factory=bytearray)
    expected: int = 1
    complete: bool = False


@dataclass(slots=True)
class _BlockUpload:
    address: tuple[int, int]
    data: bytes
    with_crc: bool
    block: int
    position: int = 0
    sent: int = 0
    ended: bool = False


_Transfer = _SegmentedDownload | _SegmentedUpload | _BlockDownload | _BlockUpload


class SdoServer:
    """An SDO server on its two identifiers; one transfer at a time, a new request replaces an old one."""

    __slots__ = ("_address", "_deadline", "_transfer", "_values", "request", "response")

    def __init__(self, values: ObjectValues, request: int, response: int) -> None:
        self._values = values
        self.request = request
        self.response = response
        self._transfer: _Transfer | None = None
        self._address = (0, 0)
        self._deadline = Ns(0)

    def reset(self) -> None:
        """Forget a transfer under way."""
        self._transfer = None

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Answer a request; frames of another COB-ID or of other than 8 bytes are not requests."""
        data = frame.data
        if frame.cob_id != self.request or frame.remote or len(data) != FRAME_LENGTH:
            return []
        if data[0] == ABORT:
            self._transfer = None
            return []
        self._deadline = Ns(now + SERVER_TIMEOUT)
        try:
            replies = self._answer(data)
        except SdoAbort as abort:
            return self._abort(abort.code)
        return [CanFrame(self.response, reply) for reply in replies]

    def tick(self, now: Ns) -> list[CanFrame]:
        """Abort a transfer whose client fell silent."""
        if self._transfer is None or now < self._deadline:
            return []
        return self._abort(AbortCode.TIME_OUT)

    def next_due(self) -> Ns | None:
        """Return when `tick` has something to do at the latest."""
        return None if self._transfer is None else self._deadline

    def _abort(self, code: int) -> list[CanFrame]:
        self._transfer = None
        return [abort_frame(self.response, self._address, code)]

    def _answer(self, data: bytes) -> list[bytes]:
        """Dispatch by state and command specifier."""
        transfer = self._transfer
        if isinstance(transfer, _BlockDownload) and not transfer.complete:
            return self._block_segment(transfer, data)
        match data[0] >> 5:
            case 0:
                return self._download_segment(data)
            case 1:
                return self._download(data)
            case 2:
                self._address = multiplexer(data)
                return self._upload(self._values.upload(*self._address))
            case 3:
                return self._upload_segment(data)
            case 5:
                return self._block_upload(data)
            case 6:
                return self._block_download(data)
            case _:
                if transfer is None:
                    self._address = multiplexer(data)
                raise SdoAbort(AbortCode.BAD_COMMAND)

    def _download(self, data: bytes) -> list[bytes]:
        self._transfer = None
        self._address = multiplexer(data)
        if data[0] & 2:
            self._values.download(*self._address, self._expedited(data))
            return [header(0x60, *self._address)]
        size = struct.unpack_from("<I", data, 4)[0] if data[0] & 1 else None
        self._check_size(size)
        self._transfer = _SegmentedDownload(self._address, size)
        return [header(0x60, *self._address)]

    def _expedited(self, data: bytes) -> bytes:
        """Return the bytes of an expedited download; without a size as many as the object takes."""
        if data[0] & 1:
            return data[4 : FRAME_LENGTH - (data[0] >> 2 & 3)]
        size = size_of(self._values.entry(*self._address).data_type)
        return data[4:] if size is None else data[4 : 4 + size]

    def _check_size(self, size: int | None) -> None:
        self._values.check_download(*self._address, size)
        if size is not None and size > MAX_TRANSFER_BYTES:
            raise SdoAbort(AbortCode.MEMORY)

    def _download_segment(self, data: bytes) -> list[bytes]:
        transfer = self._transfer
        if not isinstance(transfer, _SegmentedDownload):
            raise SdoAbort(AbortCode.BAD_COMMAND)
        if data[0] & TOGGLE_BIT != transfer.toggle:
            raise SdoAbort(AbortCode.TOGGLE)
        part, last = segment_data(data)
        transfer.data += part
        _check_received(transfer.data, transfer.size, last=last)
        if last:
            self._transfer = None
            self._values.download(*transfer.address, bytes(transfer.data))
        reply = 0x20 | transfer.toggle
        transfer.toggle ^= TOGGLE_BIT
        return [bytes((reply,)).ljust(FRAME_LENGTH, b"\0")]

    def _upload(self, content: bytes) -> list[bytes]:
        self._transfer = None
        if 1 <= len(content) <= EXPEDITED_BYTES:
            return [header(0x43 | (EXPEDITED_BYTES - len(content)) << 2, *self._address, content)]
        self._transfer = _SegmentedUpload(self._address, content)
        return [header(0x41, *self._address, struct.pack("<I", len(content)))]

    def _upload_segment(self, data: bytes) -> list[bytes]:
        transfer = self._transfer
        if not isinstance(transfer, _SegmentedUpload):
            raise SdoAbort(AbortCode.BAD_COMMAND)
        if data[0] & TOGGLE_BIT != transfer.toggle:
            raise SdoAbort(AbortCode.TOGGLE)
        reply = segment(transfer.toggle, transfer.data, transfer.position)
        transfer.position += SEGMENT_BYTES
        transfer.toggle ^= TOGGLE_BIT
        if transfer.position >= len(transfer.data):
            self._transfer = None
        return [reply]

    def _block_upload(self, data: bytes) -> list[bytes]:
        """Serve the four client commands of a block upload: initiate, end, acknowledge, start."""
        match data[0] & 3:
            case 0:
                return self._block_upload_initiate(data)
            case 1:
                if not self._uploading().ended:
                    raise SdoAbort(AbortCode.BAD_COMMAND)
                self._transfer = None
                return []
            case 2:
                return self._block_acknowledged(self._uploading(), acknowledged=data[1], block=data[2])
            case _:
                return self._send_block(self._uploading())

    def _uploading(self) -> _BlockUpload:
        if not isinstance(self._transfer, _BlockUpload):
            raise SdoAbort(AbortCode.BAD_COMMAND)
        return self._transfer

    def _block_upload_initiate(self, data: bytes) -> list[bytes]:
        self._transfer = None
        self._address = multiplexer(data)
        block, switch_bytes = data[4], data[5]
        _check_block(block)
        content = self._values.upload(*self._address)
        if len(content) <= switch_bytes:
            return self._upload(content)
        checked = data[0] & 4
        self._transfer = _BlockUpload(self._address, content, bool(checked), block)
        return [header(0xC2 | checked, *self._address, struct.pack("<I", len(content)))]

    def _send_block(self, transfer: _BlockUpload) -> list[bytes]:
        """Return the segments of the next block, from the position acknowledged so far."""
        frames = []
        position = transfer.position
        for number in range(1, transfer.block + 1):
            part = transfer.data[position : position + SEGMENT_BYTES]
            position += SEGMENT_BYTES
            last = position >= len(transfer.data)
            frames.append(bytes((number | last << 7,)) + part.ljust(SEGMENT_BYTES, b"\0"))
            if last:
                break
        transfer.sent = len(frames)
        return frames

    def _block_acknowledged(self, transfer: _BlockUpload, acknowledged: int, block: int) -> list[bytes]:
        if acknowledged > transfer.sent:
            raise SdoAbort(AbortCode.SEQUENCE)
        _check_block(block)
        transfer.block = block
        transfer.position += acknowledged * SEGMENT_BYTES
        if transfer.position < max(1, len(transfer.data)):
            return self._send_block(transfer)
        transfer.ended = True
        unused = transfer.position - len(transfer.data)
        checksum = crc_hqx(transfer.data, 0) if transfer.with_crc else 0
        return [struct.pack("<BH5x", 0xC1 | unused << 2, checksum)]

    def _block_download(self, data: bytes) -> list[bytes]:
        if data[0] & 1:
            return self._block_download_end(data)
        self._transfer = None
        self._address = multiplexer(data)
        size = struct.unpack_from("<I", data, 4)[0] if data[0] & 2 else None
        self._check_size(size)
        self._transfer = _BlockDownload(self._address, size, bool(data[0] & 4))
        return [header(0xA4, *self._address, bytes((MAX_BLOCK,)))]

    def _block_segment(self, transfer: _BlockDownload, data: bytes) -> list[bytes]:
        """Take a segment in sequence; the last of a block is answered with what arrived without a gap."""
        number, last = data[0] & 0x7F, bool(data[0] & 0x80)
        if number == 0:
            raise SdoAbort(AbortCode.SEQUENCE)
        if number == transfer.expected:
            transfer.data += data[1:]
            transfer.expected += 1
            transfer.complete = last
            if len(transfer.data) > MAX_TRANSFER_BYTES + SEGMENT_BYTES:
                raise SdoAbort(AbortCode.MEMORY)
        if number < MAX_BLOCK and not last:
            return []
        acknowledged = transfer.expected - 1
        transfer.expected = 1
        return [bytes((0xA2, acknowledged, MAX_BLOCK)).ljust(FRAME_LENGTH, b"\0")]

    def _block_download_end(self, data: bytes) -> list[bytes]:
        transfer = self._transfer
        if not isinstance(transfer, _BlockDownload):
            raise SdoAbort(AbortCode.BAD_COMMAND)
        content = bytes(transfer.data[: len(transfer.data) - (data[0] >> 2 & 7)])
        _check_received(content, transfer.size, last=True)
        if transfer.with_crc and crc_hqx(content, 0) != struct.unpack_from("<H", data, 1)[0]:
            raise SdoAbort(AbortCode.CRC)
        self._transfer = None
        self._values.download(*transfer.address, content)
        return [bytes((0xA1,)).ljust(FRAME_LENGTH, b"\0")]


def _check_received(data: bytes | bytearray, size: int | None, *, last: bool) -> None:
    """Raise SdoAbort when more or, at the end, fewer bytes came than announced."""
    if len(data) > MAX_TRANSFER_BYTES:
        raise SdoAbort(AbortCode.MEMORY)
    if size is not None and (len(data) > size or (last and len(data) != size)):
        raise SdoAbort(AbortCode.LENGTH)


def _check_block(block: int) -> None:
    if not 1 <= block <= MAX_BLOCK:
        raise SdoAbort(AbortCode.BLOCK_SIZE)
