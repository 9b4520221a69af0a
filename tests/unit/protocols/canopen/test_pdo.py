"""PDOs: remapping by python-canopen's master, transmission types, every refusal."""

import struct
from typing import Any

import canopen
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file
from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.device import Device
from hli_bench.protocols.canopen.eds import load, parse_text
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.wire.can import CanFrame

INVALID = 1 << 31
WORD, BYTE, LONG = 0x2005, 0x2006, 0x2008


@pytest.fixture
def running(device: Any) -> Any:
    device.on_frame(nmt_frame(NmtCommand.START, 5), Ns(0))
    return device


def write(master: Any, index: int, subindex: int, value: int, kind: Any = "I") -> None:
    master.sdo.download(index, subindex, struct.pack("<" + kind, value))


def refused(master: Any, index: int, subindex: int, value: int, kind: Any = "I") -> Any:
    with pytest.raises(canopen.SdoAbortedError) as error:
        write(master, index, subindex, value, kind)
    return AbortCode(error.value.code)


def sync(device: Any, now: int = 0) -> Any:
    return device.on_frame(CanFrame(0x80), Ns(now))


def test_remap_by_python_canopens_master(master: Any, running: Any, bus: Any) -> None:
    master.pdo.read()
    mapping = master.tpdo[1]
    mapping.clear()
    for name, bits in ((BYTE, 8), (LONG, None), (WORD, 16)):
        if bits:
            mapping.add_variable(name, 0, bits)
    mapping.trans_type = 1
    mapping.save()
    running.values.put(BYTE, 0, 0x12)
    running.values.put(WORD, 0, 0x3456)
    assert sync(running) == [CanFrame(0x185, b"\x12\x56\x34")]
    commands = master.rpdo[1]
    commands.clear()
    commands.add_variable(LONG, 0, 64)
    commands.save()
    assert running.on_frame(CanFrame(0x205, struct.pack("<Q", 1 << 63)), Ns(0)) == []
    sync(running)
    assert running.values.get(LONG) == 1 << 63


@given(values=st.tuples(st.integers(-(1 << 15), (1 << 15) - 1), st.integers(0, 255), st.integers(0, 65535)))
def test_pack_and_unpack_keep_every_value(description: Any, values: Any) -> None:
    device = Device(description, 5)
    device.pdos.start()
    sent = device.pdos.tpdos[0]
    device.values.put(0x2004, 0, values[0])
    assert sent.plan.codec.unpack(sent.pack()) == (values[0],)


def test_changes_are_refused_while_the_pdo_is_valid_or_counted(master: Any) -> None:
    assert refused(master, 0x1A00, 0, 0, "B") is AbortCode.UNSUPPORTED_ACCESS
    assert refused(master, 0x1A00, 1, 0x20050010) is AbortCode.UNSUPPORTED_ACCESS
    write(master, 0x1800, 1, 0x185 | INVALID)
    assert refused(master, 0x1A00, 1, 0x20050010) is AbortCode.UNSUPPORTED_ACCESS
    write(master, 0x1A00, 0, 0, "B")
    write(master, 0x1A00, 1, 0x20050010)
    write(master, 0x1A00, 2, 0)


@pytest.mark.parametrize(
    ("mapping", "entry", "code"),
    [
        (0x1A00, 0x2FFF0010, AbortCode.NO_OBJECT),
        (0x1A00, 0x10180910, AbortCode.NO_SUBINDEX),
        (0x1A00, 0x20090010, AbortCode.NOT_MAPPABLE),
        (0x1A00, 0x20050008, AbortCode.NOT_MAPPABLE),
        (0x1A00, 0x20070001, AbortCode.NOT_MAPPABLE),
        (0x1A00, 0x20000008, AbortCode.NOT_MAPPABLE),
        (0x1A00, 0x00050008, AbortCode.NO_OBJECT),
        (0x1600, 0x20040010, AbortCode.NOT_MAPPABLE),
        (0x1600, 0x00010008, AbortCode.NOT_MAPPABLE),
        (0x1600, 0x00050010, AbortCode.NOT_MAPPABLE),
        (0x1600, 0x00050108, AbortCode.NOT_MAPPABLE),
    ],
)
def test_entries_that_cannot_be_mapped(master: Any, mapping: int, entry: int, code: int) -> None:
    communication = mapping - 0x200
    write(master, communication, 1, INVALID | (0x185 if mapping == 0x1A00 else 0x205))
    write(master, mapping, 0, 0, "B")
    assert refused(master, mapping, 1, entry) is code


def test_too_long_a_mapping_is_refused_at_its_activation(master: Any) -> None:
    write(master, 0x1800, 1, 0x185 | INVALID)
    write(master, 0x1A00, 0, 0, "B")
    write(master, 0x1A00, 1, 0x20080040)
    write(master, 0x1A00, 2, 0x20060008)
    assert refused(master, 0x1A00, 0, 2, "B") is AbortCode.PDO_LENGTH
    assert refused(master, 0x1A00, 0, 9, "B") is AbortCode.PDO_LENGTH
    assert refused(master, 0x1A00, 0, 3, "B") is AbortCode.NO_OBJECT
    write(master, 0x1A00, 0, 1, "B")


def test_dummies_take_place_in_an_rpdo(master: Any, running: Any) -> None:
    write(master, 0x1400, 1, 0x205 | INVALID)
    write(master, 0x1600, 0, 0, "B")
    for sub, entry in enumerate((0x00060010, 0x20060008, 0x00050008), start=1):
        write(master, 0x1600, sub, entry)
    write(master, 0x1600, 0, 3, "B")
    write(master, 0x1400, 1, 0x205)
    running.on_frame(CanFrame(0x205, b"\xff\xff\x42\xff"), Ns(0))
    sync(running)
    assert running.values.get(BYTE) == 0x42


@pytest.mark.parametrize(
    "cob_id", [0, 0x80, 0x101, 0x180, 0x585, 0x605, 0x6E0, 0x701, 0x7FF, 0x186, 0x20000185, 0x10000185]
)
def test_cob_ids_that_are_refused(master: Any, cob_id: int) -> None:
    assert refused(master, 0x1800, 1, cob_id) is AbortCode.RANGE


def test_cob_id_moves_through_invalid(master: Any, running: Any) -> None:
    assert [frame.cob_id for frame in sync(running)] == [0x185]
    write(master, 0x1800, 1, 0x185 | INVALID)
    assert sync(running) == []
    write(master, 0x1800, 1, 0x1A5)
    assert [frame.cob_id for frame in sync(running)] == [0x1A5]


@pytest.mark.parametrize("kind", [241, 250, 252, 253])
@pytest.mark.parametrize("index", [0x1400, 0x1800])
def test_reserved_transmission_types(master: Any, index: int, kind: Any) -> None:
    assert refused(master, index, 2, kind, "B") is AbortCode.RANGE


def test_inhibit_time_changes_only_while_invalid(master: Any) -> None:
    assert refused(master, 0x1801, 3, 10, "H") is AbortCode.UNSUPPORTED_ACCESS
    write(master, 0x1801, 3, 0, "H")
    write(master, 0x1801, 1, 0x285 | INVALID)
    write(master, 0x1801, 3, 10, "H")


@pytest.mark.parametrize("every", [1, 2, 3, 240])
def test_synchronous_tpdo_is_sent_every_nth_sync(master: Any, running: Any, every: int) -> None:
    write(master, 0x1800, 2, every, "B")
    sent = [number for number in range(1, 3 * every + 1) if sync(running)]
    assert sent == [every, 2 * every, 3 * every]


def test_acyclic_tpdo_is_sent_with_the_sync_after_a_change(master: Any, running: Any) -> None:
    write(master, 0x1800, 2, 0, "B")
    assert len(sync(running)) == 1
    assert sync(running) == []
    running.values.put(0x2004, 0, 9)
    assert sync(running) == [CanFrame(0x185, b"\x09\x00")]


def test_event_driven_tpdo_follows_changes_timer_and_inhibit_time(
    master: Any, running: Any, bus: Any
) -> None:
    write(master, 0x1801, 1, 0x285 | INVALID)
    write(master, 0x1801, 3, 20, "H")
    write(master, 0x1801, 5, 10, "H")
    write(master, 0x1801, 1, 0x285)
    bus.seen.clear()

    def sent_at(milliseconds: float) -> Any:
        bus.seen.clear()
        bus.advance(milliseconds)
        return [frame.data for frame in bus.seen]

    assert sent_at(0) == [b"\0\0"]
    assert running.next_due(bus.now) == 10_000_000
    running.values.put(WORD, 0, 1)
    assert running.next_due(bus.now) == 2_000_000
    assert sent_at(1.999) == []
    assert sent_at(0.001) == [b"\x01\0"]
    assert sent_at(9.999) == []
    assert sent_at(0.001) == [b"\x01\0"]
    assert sync(running) == [CanFrame(0x185, b"\xf9\xff")]


def test_remote_frames_are_answered_unless_forbidden(master: Any, running: Any) -> None:
    assert running.on_frame(CanFrame(0x185, remote=True), Ns(0)) == [CanFrame(0x185, b"\xf9\xff")]
    write(master, 0x1800, 1, 0x185 | 1 << 30)
    assert running.on_frame(CanFrame(0x185, remote=True), Ns(0)) == []


def test_synchronous_rpdo_takes_effect_at_the_next_sync(running: Any) -> None:
    running.on_frame(CanFrame(0x205, b"\x01\0"), Ns(0))
    running.on_frame(CanFrame(0x205, b"\x02\0"), Ns(0))
    assert running.values.get(WORD) == 0
    sync(running)
    assert running.values.get(WORD) == 2
    running.values.put(WORD, 0, 7)
    sync(running)
    assert running.values.get(WORD) == 7


def test_event_driven_rpdo_takes_effect_at_once(running: Any) -> None:
    running.on_frame(CanFrame(0x305, b"\x21"), Ns(0))
    assert running.values.get(BYTE) == 0x21


def test_rpdo_of_wrong_length(running: Any, bus: Any) -> None:
    def emergencies() -> Any:
        bus.seen.clear()
        bus.advance()
        return [struct.unpack_from("<HB", frame.data) for frame in bus.seen if frame.cob_id == 0x85]

    running.on_frame(CanFrame(0x305, b""), Ns(0))
    assert running.values.get(BYTE) == 0
    assert emergencies() == [(0x8210, 0x11)]
    running.on_frame(CanFrame(0x305, b"\x05\x06"), Ns(0))
    assert running.values.get(BYTE) == 5
    assert emergencies() == [(0x0000, 0), (0x8220, 0x11)]
    running.on_frame(CanFrame(0x305, b"\x07"), Ns(0))
    assert emergencies() == [(0x0000, 0)]


def test_value_that_its_object_refuses_is_left_out(running: Any) -> None:
    def refuse(value: int) -> None:
        raise SdoAbort(AbortCode.RANGE)

    running.values.on_write(WORD, 0, refuse)
    running.on_frame(CanFrame(0x205, b"\x05\0"), Ns(0))
    sync(running)
    assert running.values.get(WORD) == 0


def test_object_that_is_hooked_while_its_pdo_runs_is_read_from_the_hook(running: Any) -> None:
    before = sync(running)
    running.values.on_read(0x2004, 0, lambda: 0x1234)
    (frame,) = sync(running)
    assert [frame] != before
    assert b"\x34\x12" in frame.data


def test_pdos_are_silent_outside_operational(device: Any) -> None:
    device.on_frame(CanFrame(0x305, b"\x21"), Ns(0))
    assert sync(device) == []
    assert device.on_frame(CanFrame(0x185, remote=True), Ns(0)) == []
    assert device.tick(Ns(0)) == []
    assert device.values.get(BYTE) == 0


def test_missing_mapping_object_is_bad_input(request: Any) -> None:
    text = request.path.with_name("node.eds").read_text()
    text = text.replace("1A01", "2A01").replace("0x1A01", "0x2A01")
    with pytest.raises(InputError, match="0x1801 and 0x1A01"):
        Device(parse_text(text), 5)


def test_broken_default_mapping_is_bad_input(request: Any) -> None:
    text = request.path.with_name("node.eds").read_text().replace("0x20040010", "0x20090010")
    with pytest.raises(InputError, match="0x1A00"):
        Device(parse_text(text), 5)


def test_data_received_before_a_longer_mapping_are_left_out() -> None:
    """Between the RPDO and its SYNC a master maps more than the frame held."""
    device = Device(load(data_file("eds", "servo402.eds")), 5)
    device.power_on()
    device.on_frame(nmt_frame(NmtCommand.START, 5), Ns(0))
    device.on_frame(CanFrame(0x305, b"\x01\x00"), Ns(0))
    for index, subindex, kind, value in (
        (0x1401, 1, "I", 0x8000_0305),
        (0x1601, 0, "B", 0),
        (0x1601, 1, "I", 0x60B8_0010),
        (0x1601, 2, "I", 0x607A_0020),
        (0x1601, 0, "B", 2),
        (0x1401, 1, "I", 0x305),
    ):
        device.values.download(index, subindex, struct.pack(f"<{kind}", value))
    device.on_frame(CanFrame(0x80), Ns(1))
    assert device.values.get(0x60B8) == 0
    device.on_frame(CanFrame(0x305, b"\x01\x00\x07\x00\x00\x00"), Ns(1))
    device.on_frame(CanFrame(0x80), Ns(2))
    assert (device.values.get(0x60B8), device.values.get(0x607A)) == (1, 7)
