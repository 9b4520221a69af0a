"""SDO server against python-canopen's client, and frame by frame where that client never goes."""

import struct
from binascii import crc_hqx
from typing import Any

import canopen
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode
from hli_bench.protocols.canopen.device import Device
from hli_bench.protocols.canopen.sdo_server import MAX_TRANSFER_BYTES
from hli_bench.wire.can import CanFrame

NODE_ID = 5
BLOB, TEXT, LIMITED, WRITE_ONLY, READ_ONLY = 0x2000, 0x2001, 0x2002, 0x2003, 0x2004


def ask(device: Any, first: Any, *rest: int, now: int = 0) -> list[bytes]:
    data = bytes((first, *rest)) if rest else first
    return [frame.data for frame in device.on_frame(CanFrame(0x605, data.ljust(8, b"\0")), Ns(now))]


def initiate(command: int, index: int, subindex: int = 0, data: bytes = b"") -> Any:
    return struct.pack("<BHB", command, index, subindex) + data.ljust(4, b"\0")


def abort_code(replies: Any) -> Any:
    assert len(replies) == 1
    assert replies[0][0] == 0x80
    return AbortCode(struct.unpack_from("<I", replies[0], 4)[0])


@pytest.mark.parametrize("length", [0, 1, 2, 3, 4, 5, 7, 8, 14, 15, 889, 890, 2000])
def test_download_and_upload_by_expedited_segmented_and_block_transfer(master: Any, length: int) -> None:
    content = bytes(number * 7 % 251 for number in range(length))
    master.sdo.download(BLOB, 0, content)
    assert master.sdo.upload(BLOB, 0) == content
    master.sdo.download(BLOB, 0, b"other", force_segment=True)
    assert master.sdo.upload(BLOB, 0) == b"other"
    if not length:
        return
    for checked in (True, False):
        master.sdo.download(BLOB, 0, b"x")
        with master.sdo.open(
            BLOB, 0, "wb", size=length, block_transfer=True, request_crc_support=checked
        ) as stream:
            stream.write(content)
        with master.sdo.open(BLOB, 0, "rb", block_transfer=True, request_crc_support=checked) as stream:
            assert stream.read() == content


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(content=st.binary(max_size=300), segmented=st.booleans())
def test_any_content_survives(master: Any, content: bytes, segmented: bool) -> None:
    master.sdo.download(BLOB, 0, content, force_segment=segmented)
    assert master.sdo.upload(BLOB, 0) == content


def test_typed_values(master: Any) -> None:
    master.sdo[LIMITED].raw = -10
    assert master.sdo[LIMITED].raw == -10
    master.sdo[TEXT].raw = "a longer text"
    assert master.sdo[TEXT].raw == "a longer text"
    assert master.sdo[READ_ONLY].raw == -7
    assert master.sdo[0x1018][4].raw == 0x44
    assert master.sdo[0x1014].raw == 0x85


@pytest.mark.parametrize(
    ("index", "subindex", "data", "code"),
    [
        (0x2FFF, 0, b"\0", AbortCode.NO_OBJECT),
        (0x1018, 9, b"\0", AbortCode.NO_SUBINDEX),
        (READ_ONLY, 0, b"\0\0", AbortCode.READ_ONLY),
        (0x1018, 1, b"\0\0\0\0", AbortCode.READ_ONLY),
        (LIMITED, 0, b"\0\0", AbortCode.TOO_SHORT),
        (WRITE_ONLY, 0, b"\0\0\0", AbortCode.TOO_LONG),
        (LIMITED, 0, struct.pack("<i", 11), AbortCode.TOO_HIGH),
        (LIMITED, 0, struct.pack("<i", -11), AbortCode.TOO_LOW),
        (0x2007, 0, b"\2", AbortCode.RANGE),
        (0x1003, 0, b"\1", AbortCode.RANGE),
        (0x1005, 0, struct.pack("<I", 0x40000080), AbortCode.RANGE),
        (0x1005, 0, struct.pack("<I", 0x20000080), AbortCode.RANGE),
        (0x1005, 0, struct.pack("<I", 0), AbortCode.RANGE),
        (0x1010, 1, b"load", AbortCode.CANNOT_STORE),
        (0x1011, 1, b"save", AbortCode.CANNOT_STORE),
        (0x1014, 0, struct.pack("<I", 0x90), AbortCode.RANGE),
        (0x1016, 1, struct.pack("<I", 0x1000064), AbortCode.RANGE),
    ],
)
@pytest.mark.parametrize("segmented", [False, True])
def test_refused_downloads_change_nothing(
    master: Any, device: Any, index: int, subindex: int, data: bytes, code: int, segmented: bool
) -> None:
    before = device.values.get(index, subindex) if device.values.has(index, subindex) else None
    with pytest.raises(canopen.SdoAbortedError) as refused:
        master.sdo.download(index, subindex, data, force_segment=segmented)
    assert refused.value.code == code
    if before is not None:
        assert device.values.get(index, subindex) == before


@pytest.mark.parametrize(
    ("index", "subindex", "code"),
    [
        (0x2FFF, 0, AbortCode.NO_OBJECT),
        (0x1018, 9, AbortCode.NO_SUBINDEX),
        (WRITE_ONLY, 0, AbortCode.WRITE_ONLY),
    ],
)
@pytest.mark.parametrize("block", [False, True])
def test_refused_uploads(master: Any, index: int, subindex: int, code: int, block: bool) -> None:
    with (
        pytest.raises(canopen.SdoAbortedError) as refused,
        master.sdo.open(index, subindex, block_transfer=block) as stream,
    ):
        stream.read()
    assert refused.value.code == code


def test_block_download_of_a_read_only_object_is_refused_at_once(device: Any) -> None:
    assert abort_code(ask(device, initiate(0xC6, READ_ONLY, 0, b"\2"))) is AbortCode.READ_ONLY


def test_expedited_download_without_a_size_takes_what_the_object_needs(device: Any) -> None:
    assert ask(device, initiate(0x22, WRITE_ONLY, 0, b"\x34\x12\xff\xff"))[0][0] == 0x60
    assert device.values.get(WRITE_ONLY) == 0x1234


@pytest.mark.parametrize("command", [0x00, 0x60, 0xA1, 0xA2, 0xA3, 0xC1, 0xE0, 0xFF])
def test_commands_that_fit_no_transfer_are_aborted(device: Any, command: int) -> None:
    assert abort_code(ask(device, command, 0, 0)) is AbortCode.BAD_COMMAND
    assert ask(device, initiate(0x40, READ_ONLY))[0][:4] == initiate(0x4B, READ_ONLY)[:4]


def test_toggle_bit_is_checked_both_ways(device: Any) -> None:
    ask(device, initiate(0x21, BLOB, 0, struct.pack("<I", 20)))
    assert ask(device, b"\x00" + b"a" * 7)[0][0] == 0x20
    assert abort_code(ask(device, b"\x00" + b"a" * 7)) is AbortCode.TOGGLE
    device.values.put(BLOB, 0, bytes(20))
    assert ask(device, initiate(0x40, BLOB))[0] == initiate(0x41, BLOB, 0, struct.pack("<I", 20))
    assert ask(device, b"\x60")[0][0] == 0x00
    assert abort_code(ask(device, b"\x60")) is AbortCode.TOGGLE


@pytest.mark.parametrize("announced", [6, 8])
def test_announced_size_must_come(device: Any, announced: int) -> None:
    ask(device, initiate(0x21, BLOB, 0, struct.pack("<I", announced)))
    assert abort_code(ask(device, b"\x01" + b"a" * 7)) is AbortCode.LENGTH
    ask(device, initiate(0xC2, BLOB, 0, struct.pack("<I", announced)))
    ask(device, b"\x81" + b"a" * 7)
    assert abort_code(ask(device, b"\xc1")) is AbortCode.LENGTH


def test_more_than_memory_is_refused(device: Any) -> None:
    size = struct.pack("<I", MAX_TRANSFER_BYTES + 1)
    assert abort_code(ask(device, initiate(0x21, BLOB, 0, size))) is AbortCode.MEMORY
    assert abort_code(ask(device, initiate(0xC2, BLOB, 0, size))) is AbortCode.MEMORY


def test_block_download_answers_a_gap_with_the_last_segment_in_sequence(device: Any) -> None:
    content = bytes(range(21))
    checksum = struct.pack("<H", crc_hqx(content, 0))
    assert (
        ask(device, initiate(0xC6, BLOB, 0, struct.pack("<I", 21)))[0][:5]
        == initiate(0xA4, BLOB)[:4] + b"\x7f"
    )
    assert ask(device, b"\x01" + content[:7]) == []
    assert ask(device, b"\x83" + content[14:])[0][:3] == b"\xa2\x01\x7f"
    assert ask(device, b"\x01" + content[7:14]) == []
    assert ask(device, b"\x82" + content[14:])[0][:3] == b"\xa2\x02\x7f"
    assert ask(device, b"\xc1" + checksum)[0][0] == 0xA1
    assert device.values.get(BLOB) == content


def test_block_download_with_a_wrong_checksum_is_refused(device: Any) -> None:
    ask(device, initiate(0xC4, BLOB))
    ask(device, b"\x81" + b"a" * 7)
    assert abort_code(ask(device, b"\xc1\x12\x34")) is AbortCode.CRC
    assert device.values.get(BLOB) == b""


def test_block_segment_number_zero_is_a_sequence_error(device: Any) -> None:
    ask(device, initiate(0xC4, BLOB))
    assert abort_code(ask(device, b"\x00" + b"a" * 7)) is AbortCode.SEQUENCE


@pytest.mark.parametrize("size", [0, 128])
def test_block_size_is_checked(device: Any, size: int) -> None:
    assert abort_code(ask(device, initiate(0xA4, BLOB, 0, bytes((size,))))) is AbortCode.BLOCK_SIZE
    device.values.put(BLOB, 0, bytes(30))
    ask(device, initiate(0xA4, BLOB, 0, b"\x02"))
    ask(device, b"\xa3")
    assert abort_code(ask(device, bytes((0xA2, 2, size)))) is AbortCode.BLOCK_SIZE


def test_block_upload_repeats_what_was_not_acknowledged(device: Any) -> None:
    content = bytes(range(20))
    device.values.put(BLOB, 0, content)
    ask(device, initiate(0xA4, BLOB, 0, b"\x02"))
    assert ask(device, b"\xa3") == [b"\x01" + content[:7], b"\x02" + content[7:14]]
    assert ask(device, b"\xa2\x01\x7f") == [b"\x01" + content[7:14], b"\x82" + content[14:] + b"\0"]
    end = ask(device, b"\xa2\x02\x7f")[0]
    assert end[:3] == struct.pack("<BH", 0xC1 | 1 << 2, crc_hqx(content, 0))
    assert ask(device, b"\xa1") == []


def test_acknowledging_more_than_was_sent_is_a_sequence_error(device: Any) -> None:
    device.values.put(BLOB, 0, bytes(20))
    ask(device, initiate(0xA4, BLOB, 0, b"\x02"))
    ask(device, b"\xa3")
    assert abort_code(ask(device, b"\xa2\x03\x02")) is AbortCode.SEQUENCE


def test_small_values_may_switch_a_block_upload_to_a_normal_one(device: Any) -> None:
    assert ask(device, initiate(0xA4, READ_ONLY, 0, b"\x7f\x04"))[0] == initiate(
        0x4B, READ_ONLY, 0, b"\xf9\xff"
    )


def test_a_silent_client_is_aborted_after_the_time_out(device: Any) -> None:
    ask(device, initiate(0x21, BLOB, 0, struct.pack("<I", 20)), now=1000)
    due = device.next_due(Ns(1000))
    assert due == 500_001_000
    assert device.tick(Ns(due - 1)) == []
    (frame,) = device.tick(due)
    assert frame == CanFrame(0x585, initiate(0x80, BLOB, 0, struct.pack("<I", AbortCode.TIME_OUT)))
    assert device.next_due(due) is None
    assert abort_code(ask(device, b"\x00" + b"a" * 7)) is AbortCode.BAD_COMMAND


def test_a_client_abort_ends_the_transfer_silently(device: Any) -> None:
    ask(device, initiate(0x21, BLOB, 0, struct.pack("<I", 20)))
    assert ask(device, initiate(0x80, BLOB)) == []
    assert device.next_due(Ns(0)) is None


def test_frames_that_are_no_requests_get_no_answer(device: Any) -> None:
    assert device.on_frame(CanFrame(0x605, b"\x40\x00\x10"), Ns(0)) == []
    assert device.on_frame(CanFrame(0x605, remote=True), Ns(0)) == []
    assert device.on_frame(CanFrame(0x606, initiate(0x40, 0x1000)), Ns(0)) == []


@settings(max_examples=60, deadline=None)
@given(requests=st.lists(st.binary(min_size=8, max_size=8), max_size=30))
def test_no_sequence_of_requests_breaks_the_server(description: Any, requests: Any) -> None:
    device = Device(description, NODE_ID)
    device.power_on()
    for request in requests:
        for answer in device.on_frame(CanFrame(0x605, request), Ns(0)):
            assert answer.cob_id == 0x585
            assert len(answer.data) == 8
