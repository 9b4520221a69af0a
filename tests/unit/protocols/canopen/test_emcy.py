"""Emergency messages: frames as python-canopen's consumer reads them, register, history, inhibit time."""

import struct
from typing import Any

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.emcy import ErrorRegister
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame


def test_error_and_recovery_reach_python_canopens_consumer(master: Any, bus: Any, device: Any) -> None:
    assert device.emcy.occur(0x8611, ErrorRegister.PROFILE, b"\x01\x02")
    assert not device.emcy.occur(0x8611, ErrorRegister.PROFILE)
    bus.advance()
    assert master.sdo[0x1001].raw == 0x21
    device.emcy.occur(0x4310, ErrorRegister.TEMPERATURE)
    device.emcy.recover(0x8611)
    bus.advance()
    device.emcy.recover(0x4310)
    device.emcy.recover(0x4310)
    bus.advance()
    log = [(error.code, error.register, error.data) for error in master.emcy.log]
    assert log == [
        (0x8611, 0x21, b"\x01\x02\0\0\0"),
        (0x4310, 0x29, bytes(5)),
        (0x4310, 0x09, bytes(5)),
        (0x0000, 0x00, bytes(5)),
    ]
    assert master.emcy.active == []
    assert master.sdo[0x1001].raw == 0


def test_history_has_the_newest_first_and_is_cleared_by_zero(master: Any, device: Any) -> None:
    for code in (0x1000, 0x2000, 0x3000, 0x4000):
        device.emcy.occur(code, ErrorRegister.GENERIC)
    history = master.sdo[0x1003]
    assert [history[sub].raw for sub in range(4)] == [3, 0x4000, 0x3000, 0x2000]
    history[0].raw = 0
    assert [history[sub].raw for sub in range(4)] == [0, 0, 0, 0]


def test_inhibit_time_spaces_messages(master: Any, bus: Any, device: Any) -> None:
    master.sdo[0x1015].raw = 50
    for code in (0x1000, 0x2000):
        device.emcy.occur(code, ErrorRegister.GENERIC)
    bus.seen.clear()
    bus.advance()
    assert len(bus.seen) == 1
    assert device.next_due(bus.now) == 5_000_000
    bus.advance(4.999)
    assert len(bus.seen) == 1
    bus.advance(0.001)
    assert [struct.unpack_from("<H", frame.data)[0] for frame in bus.seen] == [0x1000, 0x2000]


def test_identifier_can_move_or_be_switched_off(master: Any, bus: Any, device: Any) -> None:
    master.sdo[0x1014].raw = 0x85 | 1 << 31
    device.emcy.occur(0x1000, ErrorRegister.GENERIC)
    bus.seen.clear()
    bus.advance()
    assert bus.seen == []
    master.sdo[0x1014].raw = 0x95
    device.emcy.occur(0x2000, ErrorRegister.GENERIC)
    bus.seen.clear()
    bus.advance()
    assert [frame.cob_id for frame in bus.seen] == [0x95]


def test_nothing_is_sent_in_stopped_and_errors_outlive_a_communication_reset(bus: Any, device: Any) -> None:
    device.on_frame(nmt_frame(NmtCommand.STOP), Ns(0))
    device.emcy.occur(0x1000, ErrorRegister.GENERIC)
    bus.advance()
    assert bus.seen == []
    device.on_frame(nmt_frame(NmtCommand.RESET_COMMUNICATION), Ns(0))
    assert device.values.get(0x1001) == 1
    bus.advance()
    assert bus.seen == []
    device.on_frame(nmt_frame(NmtCommand.RESET_NODE), Ns(0))
    assert device.values.get(0x1001) == 0
