"""What the other tests of this folder take for granted: frames of one process reach another over vcan0."""

import subprocess
import sys
from collections.abc import Iterator

import can
import pytest

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.shells import environment
from hli_bench.shells.can_bus import CanBus
from hli_bench.wire.can import CanFrame

PATIENCE_S = 10.0

# Answers each frame with its data reversed under the next identifier, until one without data comes.
ANSWERER = """
import can
with can.Bus("vcan0", interface="socketcan") as bus:
    print("ready", flush=True)
    for frame in bus:
        if frame.dlc == 0:
            break
        answer = frame.data[::-1]
        bus.send(can.Message(arbitration_id=frame.arbitration_id + 1, data=answer, is_extended_id=False))
"""


@pytest.fixture
def answerer(bus: can.BusABC) -> Iterator[subprocess.Popen[str]]:
    """Another process that answers frames; ended by a frame without data."""
    with subprocess.Popen([sys.executable, "-c", ANSWERER], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            yield process
            bus.send(can.Message(arbitration_id=0x7FF, is_extended_id=False))
            assert process.wait(PATIENCE_S) == 0
        finally:
            process.kill()


def _answer(bus: can.BusABC) -> can.Message:
    frame = bus.recv(PATIENCE_S)
    assert frame is not None
    return frame


def test_frames_of_two_processes_meet_in_order(bus: can.BusABC, answerer: subprocess.Popen[str]) -> None:
    sent = [
        can.Message(arbitration_id=0x180 + 2 * n, data=[n, 1, 2, 3], is_extended_id=False) for n in range(50)
    ]
    for frame in sent:
        bus.send(frame)
        answer = _answer(bus)
        assert answer.arbitration_id == frame.arbitration_id + 1
        assert answer.data == frame.data[::-1]


def test_every_listener_sees_every_frame(bus: can.BusABC) -> None:
    with can.Bus("vcan0", interface="socketcan") as second, can.Bus("vcan0", interface="socketcan") as third:
        bus.send(can.Message(arbitration_id=0x80, is_extended_id=False))
        assert [_answer(listener).arbitration_id for listener in (second, third)] == [0x80, 0x80]


def test_a_remote_frame_stays_one(bus: can.BusABC) -> None:
    """Node guarding rests on it."""
    with can.Bus("vcan0", interface="socketcan") as listener:
        bus.send(can.Message(arbitration_id=0x701, is_remote_frame=True, is_extended_id=False))
        assert _answer(listener).is_remote_frame


def test_an_interface_that_is_down_is_named() -> None:
    frame = CanFrame(0x80, b"")
    with CanBus("vcan0") as bus:
        bus.send(frame)
        subprocess.run(["ip", "link", "set", "vcan0", "down"], check=True)
        try:
            with pytest.raises(EnvironmentLacks, match="CAN interface vcan0: "):
                bus.receive()
            with pytest.raises(EnvironmentLacks, match="CAN interface vcan0: "):
                bus.send(frame)
        finally:
            subprocess.run(["ip", "link", "set", "vcan0", "up"], check=True)
        bus.send(frame)


def test_the_doctor_finds_what_is_here() -> None:
    assert environment.can_sockets().ok
    assert environment.can_interface("vcan0").ok
