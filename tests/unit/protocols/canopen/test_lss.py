"""LSS slave with frames of the master as CiA 305 lays them out."""

import struct
from typing import Any

import canopen
import pytest

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.wire.can import CanFrame

IDENTITY = (0x11, 0x22, 0x33, 0x44)


def ask(device: Any, service: Any, data: bytes = b"") -> Any:
    answers = device.on_frame(CanFrame(0x7E5, (bytes((service,)) + data).ljust(8, b"\0")), Ns(0))
    assert all(answer.cob_id == 0x7E4 and len(answer.data) == 8 for answer in answers)
    return [answer.data for answer in answers]


def select(device: Any, identity: Any) -> Any:
    replies = []
    for service, number in enumerate(identity, start=0x40):
        replies += ask(device, service, struct.pack("<I", number))
    return replies


def test_selection_needs_the_whole_identity_in_order(device: Any) -> None:
    assert select(device, (0x11, 0x22, 0x33, 0x45)) == []
    assert select(device, (0x11, 0x23, 0x33, 0x44)) == []
    assert ask(device, 0x5E) == []
    assert ask(device, 0x43, struct.pack("<I", 0x44)) == []
    assert select(device, IDENTITY)[0][0] == 0x44
    assert ask(device, 0x5E)[0][:2] == b"\x5e\x05"


def test_identify_by_range(device: Any) -> None:
    def identify(revisions: Any, serials: Any) -> Any:
        replies = []
        for service, number in enumerate((0x11, 0x22, *revisions, *serials), start=0x46):
            replies += ask(device, service, struct.pack("<I", number))
        return replies

    assert identify((0, 0xFF), (0x44, 0x44))[0][0] == 0x4F
    assert identify((0, 0x32), (0x44, 0x44)) == []
    assert identify((0, 0xFF), (0x45, 0xFF)) == []


def test_python_canopens_master_inquires_and_configures(bus: Any, device: Any) -> None:
    bus.lss.send_switch_state_global(bus.lss.CONFIGURATION_STATE)
    assert [bus.lss.inquire_lss_address(service) for service in range(0x5A, 0x5E)] == list(IDENTITY)
    assert bus.lss.inquire_node_id() == 5
    bus.lss.configure_node_id(9)
    bus.lss.configure_bit_timing(2)
    for wrong in (5, 9):
        with pytest.raises(canopen.lss.LssError):
            bus.lss.configure_bit_timing(wrong)
    for wrong in (0, 128, 255):
        with pytest.raises(canopen.lss.LssError):
            bus.lss.configure_node_id(wrong)
    bus.lss.send_switch_state_global(bus.lss.WAITING_STATE)
    assert ask(device, 0x5E) == []
    assert device.node_id == 5


def test_node_id_counts_from_the_communication_reset_and_stays_when_stored(device: Any) -> None:
    def reset(command: int) -> Any:
        return device.on_frame(nmt_frame(command), Ns(0))

    ask(device, 0x04, b"\x01")
    ask(device, 0x11, b"\x09")
    assert reset(NmtCommand.RESET_COMMUNICATION) == [CanFrame(0x709, b"\0")]
    assert device.values.get(0x1014) == 0x89
    assert device.on_frame(CanFrame(0x609, b"\x40\0\x10\0\0\0\0\0"), Ns(0))[0].cob_id == 0x589
    assert device.values.get(0x1018, 4) == 0x44
    assert reset(NmtCommand.RESET_NODE) == [CanFrame(0x705, b"\0")]
    ask(device, 0x04, b"\x01")
    ask(device, 0x11, b"\x09")
    assert ask(device, 0x17)[0][:2] == b"\x17\x00"
    assert reset(NmtCommand.RESET_NODE) == [CanFrame(0x709, b"\0")]
    reset(NmtCommand.START)
    assert device.on_sync(Ns(0))[0].cob_id == 0x189
