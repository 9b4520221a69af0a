"""NMT, boot-up, heartbeat, guarding: python-canopen as master, and resets."""

import struct
from typing import Any

import canopen
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode
from hli_bench.protocols.canopen.device import Device
from hli_bench.protocols.canopen.nmt import (
    NmtCommand,
    NmtState,
    guarding_request,
    nmt_frame,
    node_state,
)
from hli_bench.wire.can import CanFrame

BOOT_UP = CanFrame(0x705, b"\0")


def download(master: Any, index: int, subindex: int, value: int, kind: Any) -> None:
    master.sdo.download(index, subindex, struct.pack("<" + kind, value))


def test_boot_up(description: Any) -> None:
    device = Device(description, 5)
    assert device.nmt.state is NmtState.INITIALISING
    assert device.power_on() == [BOOT_UP]
    assert device.nmt.state is NmtState.PRE_OPERATIONAL


def test_states_commanded_by_python_canopens_master(master: Any, bus: Any, device: Any) -> None:
    for word, state in (
        ("OPERATIONAL", NmtState.OPERATIONAL),
        ("STOPPED", NmtState.STOPPED),
        ("PRE-OPERATIONAL", NmtState.PRE_OPERATIONAL),
    ):
        master.nmt.state = word
        assert device.nmt.state is state
    bus.nmt.state = "OPERATIONAL"
    assert device.nmt.state is NmtState.OPERATIONAL
    bus.seen.clear()
    master.nmt.state = "RESET"
    assert bus.seen == [BOOT_UP]
    assert device.nmt.state is NmtState.PRE_OPERATIONAL
    master.nmt.state = "RESET COMMUNICATION"
    assert bus.seen == [BOOT_UP, BOOT_UP]


def test_stopped_node_answers_no_sdo(device: Any) -> None:
    request = CanFrame(0x605, b"\x40\0\x10\0\0\0\0\0")
    assert device.on_frame(request, Ns(0))
    device.on_frame(nmt_frame(NmtCommand.STOP), Ns(0))
    assert device.on_frame(request, Ns(0)) == []


@pytest.mark.parametrize("data", [b"\x01\x06", b"\x07\x05", b"\x01", b"", b"\x01\x05\x00"])
def test_frames_that_are_no_command_to_this_node(device: Any, data: bytes) -> None:
    device.on_frame(CanFrame(0, data), Ns(0))
    assert device.nmt.state is NmtState.PRE_OPERATIONAL


@given(st.lists(st.sampled_from(list(NmtCommand)), max_size=20))
def test_state_is_that_of_the_last_command(description: Any, commands: Any) -> None:
    device = Device(description, 5)
    device.power_on()
    expected = NmtState.PRE_OPERATIONAL
    for command in commands:
        device.on_frame(nmt_frame(command, 5), Ns(0))
        expected = {
            NmtCommand.START: NmtState.OPERATIONAL,
            NmtCommand.STOP: NmtState.STOPPED,
        }.get(command, NmtState.PRE_OPERATIONAL)
        assert device.nmt.state is expected


def test_heartbeat_starts_with_the_write_and_keeps_its_period(master: Any, bus: Any, device: Any) -> None:
    bus.now = Ns(5_000_000)
    download(master, 0x1017, 0, 20, "H")
    beats = []
    for _ in range(200):
        bus.seen.clear()
        bus.advance(0.5)
        beats += [bus.now // 100_000 for frame in bus.seen if frame == CanFrame(0x705, b"\x7f")]
    assert beats[:5] == [55, 255, 455, 655, 855]
    assert device.next_due(bus.now) == 105_500_000
    assert master.nmt.state == "PRE-OPERATIONAL"
    master.nmt.state = "OPERATIONAL"
    bus.advance(20)
    assert bus.seen[-1] == CanFrame(0x705, b"\x05")
    download(master, 0x1017, 0, 0, "H")
    bus.seen.clear()
    bus.advance(100)
    assert bus.seen == []


def test_late_ticks_give_one_heartbeat_not_a_burst(master: Any, bus: Any) -> None:
    download(master, 0x1017, 0, 10, "H")
    bus.advance()
    bus.advance(95)
    bus.seen.clear()
    bus.advance()
    bus.advance(1)
    assert len(bus.seen) <= 1


def test_guarding_toggles_and_a_reset_starts_anew(device: Any) -> None:
    answers = [device.on_frame(guarding_request(5), Ns(0)) for _ in range(3)]
    assert answers == [[CanFrame(0x705, b"\x7f")], [CanFrame(0x705, b"\xff")], [CanFrame(0x705, b"\x7f")]]
    assert node_state(answers[1][0]) == (5, NmtState.PRE_OPERATIONAL)
    device.on_frame(nmt_frame(NmtCommand.RESET_COMMUNICATION), Ns(0))
    assert device.on_frame(guarding_request(5), Ns(0)) == [CanFrame(0x705, b"\x7f")]


def test_heartbeat_replaces_guarding(master: Any, device: Any) -> None:
    download(master, 0x1017, 0, 20, "H")
    assert device.on_frame(guarding_request(5), Ns(0)) == []


def emergencies(bus: Any) -> Any:
    return [struct.unpack_from("<HB", frame.data) for frame in bus.seen if frame.cob_id == 0x85]


def test_life_guarding(master: Any, bus: Any, device: Any) -> None:
    download(master, 0x100C, 0, 10, "H")
    download(master, 0x100D, 0, 3, "B")
    bus.advance(100)
    assert emergencies(bus) == []
    bus.send_message(0x705, b"", remote=True)
    bus.advance(29)
    bus.send_message(0x705, b"", remote=True)
    bus.advance(29)
    assert emergencies(bus) == []
    assert device.next_due(bus.now) == bus.now + 1_000_000
    bus.advance(1)
    assert emergencies(bus) == [(0x8130, 0x11)]
    bus.advance(100)
    bus.send_message(0x705, b"", remote=True)
    bus.advance()
    assert emergencies(bus) == [(0x8130, 0x11), (0, 0)]


@pytest.mark.parametrize(("index", "value", "code"), [(0x100C, 0, "H"), (0x100D, 0, "B"), (0x1017, 50, "H")])
@pytest.mark.parametrize("wait", [0, 200], ids=["in time", "after it was lost"])
def test_life_guarding_can_be_switched_off(
    master: Any, bus: Any, index: int, value: int, code: str, wait: int
) -> None:
    """By either factor, or by a heartbeat in its place; an error that it has raised is over with it."""
    download(master, 0x100C, 0, 10, "H")
    download(master, 0x100D, 0, 3, "B")
    bus.send_message(0x705, b"", remote=True)
    bus.advance(wait)
    raised = emergencies(bus)
    assert raised == ([(0x8130, 0x11)] if wait else [])
    download(master, index, 0, value, code)
    bus.advance(500)
    assert emergencies(bus) == ([*raised, (0, 0)] if wait else [])


def test_heartbeat_consumer(master: Any, bus: Any, device: Any) -> None:
    download(master, 0x1016, 1, 0x20 << 16 | 50, "I")
    bus.advance(100)
    assert emergencies(bus) == []
    bus.send_message(0x720, b"\x05")
    bus.advance(49)
    bus.send_message(0x720, b"\x05")
    bus.advance(49)
    bus.send_message(0x721, b"\x05")
    assert emergencies(bus) == []
    assert device.next_due(bus.now) == bus.now + 1_000_000
    bus.advance(1)
    assert emergencies(bus) == [(0x8130, 0x11)]
    bus.send_message(0x720, b"\x05")
    bus.advance()
    assert emergencies(bus)[-1] == (0, 0)
    with pytest.raises(canopen.SdoAbortedError) as refused:
        download(master, 0x1016, 2, 0x20 << 16 | 10, "I")
    assert refused.value.code == AbortCode.PARAMETER_INCOMPATIBLE
    download(master, 0x1016, 1, 0, "I")
    bus.advance(100)
    assert emergencies(bus)[-1] == (0, 0)


def test_resets_load_power_on_values_of_their_area(master: Any, device: Any) -> None:
    master.sdo.download(0x2005, 0, b"\x09\0")
    download(master, 0x1017, 0, 50, "H")
    device.on_frame(nmt_frame(NmtCommand.RESET_COMMUNICATION), Ns(0))
    assert device.values.get(0x2005) == 9
    assert device.values.get(0x1017) == 0
    device.on_frame(nmt_frame(NmtCommand.RESET_NODE), Ns(0))
    assert device.values.get(0x2005) == 0


def test_stored_parameters_survive_a_reset_until_restored(master: Any, device: Any) -> None:
    master.sdo.download(0x2005, 0, b"\x09\0")
    download(master, 0x1017, 0, 50, "H")
    master.sdo.download(0x1010, 3, b"save")
    assert master.sdo[0x1010][3].raw == 1
    device.on_frame(nmt_frame(NmtCommand.RESET_NODE), Ns(0))
    assert (device.values.get(0x2005), device.values.get(0x1017)) == (9, 0)
    master.sdo.download(0x1011, 1, b"load")
    assert device.values.get(0x2005) == 9
    device.on_frame(nmt_frame(NmtCommand.RESET_NODE), Ns(0))
    assert device.values.get(0x2005) == 0


def test_reset_restores_the_default_mapping(master: Any, device: Any) -> None:
    default = device.pdos.signature
    download(master, 0x1800, 1, 0x185 | 1 << 31, "I")
    download(master, 0x1A00, 0, 0, "B")
    assert device.pdos.signature != default
    device.on_frame(nmt_frame(NmtCommand.RESET_COMMUNICATION), Ns(0))
    assert device.pdos.signature == default


@pytest.mark.parametrize(
    "frame",
    [CanFrame(0x700, b"\x05"), CanFrame(0x705, b""), CanFrame(0x705, remote=True), CanFrame(0x705, b"\x33")],
)
def test_frames_that_carry_no_state(frame: Any) -> None:
    assert node_state(frame) is None
