"""One servo402 on its row, and python-canopen's master on a bus in memory."""

from pathlib import Path
from typing import Any

import canopen
import numpy as np
import pytest
from hli_bench_drives.cia402.drive import Drive
from hli_bench_drives.models import servo402

from hli_bench.base.loading import data_file
from hli_bench.base.time import Ns
from hli_bench.laws.rows import SERVO
from hli_bench.wire.can import CanFrame

NODE_ID = 3


class DriveBus(canopen.Network):
    """python-canopen's network whose frames go straight to a drive and back; time is a number."""

    def __init__(self, drive: Drive) -> None:
        super().__init__()
        self.drive = drive
        self.now = Ns(0)
        self.seen: list[CanFrame] = []

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        self.deliver(self.drive.on_frame(CanFrame(can_id, bytes(data), remote), self.now))

    def deliver(self, frames: list[CanFrame]) -> None:
        for frame in frames:
            self.seen.append(frame)
            self.notify(frame.cob_id, bytearray(frame.data), self.now / 1e9)

    def cycle(self, milliseconds: int = 1) -> list[CanFrame]:
        """Let time pass, send SYNC; return what the drive sent."""
        self.seen.clear()
        self.now = Ns(self.now + milliseconds * 1_000_000)
        self.send_message(0x80, b"")
        self.deliver(self.drive.tick(self.now))
        return list(self.seen)


@pytest.fixture
def row() -> Any:
    row = np.zeros(1, SERVO)[0]
    row["rated_torque"], row["peak_permille"], row["increments_per_turn"] = 15.0, 3000, 1_048_576
    return row


@pytest.fixture
def drive(row: Any) -> Drive:
    made = servo402.create("Z", NODE_ID, row, {})
    made.power_on()
    return made


@pytest.fixture
def eds() -> Path:
    return data_file("eds", servo402.MODEL.eds)


@pytest.fixture
def bus(drive: Drive) -> DriveBus:
    return DriveBus(drive)


@pytest.fixture
def master(bus: DriveBus, eds: Path) -> Any:
    """The drive as python-canopen's remote 402 node, PRE-OPERATIONAL."""
    node = canopen.BaseNode402(NODE_ID, str(eds))
    return bus.add_node(node)


@pytest.fixture
def enabled(drive: Drive, bus: DriveBus) -> Drive:
    """The drive in OPERATION ENABLED, commanded over RPDO1."""
    bus.send_message(0, bytes((1, NODE_ID)))
    for word in (0x06, 0x07, 0x0F):
        bus.send_message(0x200 + NODE_ID, word.to_bytes(2, "little") + bytes(4))
        bus.cycle()
    return drive
