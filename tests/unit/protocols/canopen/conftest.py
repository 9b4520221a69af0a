"""A slave with every kind of object, on a bus in memory that python-canopen's master shares."""

from pathlib import Path
from typing import Any

import canopen
import pytest

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.device import Device
from hli_bench.protocols.canopen.eds import load
from hli_bench.wire.can import CanFrame

EDS = Path(__file__).with_name("node.eds")
NODE_ID = 5


class MemoryBus(canopen.Network):
    """python-canopen's network whose frames go straight to a device and back; time is a number."""

    def __init__(self, device: Any) -> None:
        super().__init__()
        self.device = device
        self.now = Ns(0)
        self.seen = []

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        self.deliver(self.device.on_frame(CanFrame(can_id, bytes(data), remote), self.now))

    def deliver(self, frames: Any) -> None:
        for frame in frames:
            assert 0 <= frame.cob_id <= 0x7FF
            assert len(frame.data) <= 8
            self.seen.append(frame)
            self.notify(frame.cob_id, bytearray(frame.data), self.now / 1e9)

    def advance(self, milliseconds: float = 0.0) -> None:
        self.now = Ns(self.now + round(milliseconds * 1e6))
        self.deliver(self.device.tick(self.now))


@pytest.fixture(scope="session")
def description() -> Any:
    return load(EDS)


@pytest.fixture
def device(description: Any) -> Any:
    node = Device(description, NODE_ID)
    node.power_on()
    return node


@pytest.fixture
def bus(device: Any) -> Any:
    return MemoryBus(device)


@pytest.fixture
def master(bus: Any) -> Any:
    """The remote node of python-canopen, PRE-OPERATIONAL."""
    return bus.add_node(NODE_ID, str(EDS))
