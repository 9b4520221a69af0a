"""Random frames into a drive: it lives, answers, and its dictionary is whole."""

import random
import struct
from typing import Any

import numpy as np
import pytest
from hli_bench_drives.models import servo402

from hli_bench.base.time import Ns
from hli_bench.laws.rows import SERVO
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.wire.can import CanFrame
from tests.fuzz.inputs import seeds

NODE = 3
HEARD = (0x000, 0x080, 0x203, 0x303, 0x403, 0x603, 0x603, 0x603, 0x683, 0x703, 0x704, 0x7E5)
INDICES = (
    0x1005,
    0x1010,
    0x1014,
    0x1016,
    0x1017,
    0x1201,
    0x1400,
    0x1600,
    0x1800,
    0x1A00,
    0x6040,
    0x6060,
    0x605A,
    0x60B8,
)


def frame(draw: random.Random) -> CanFrame:
    """Return a frame that a node may act on, more often one with some sense."""
    cob_id = draw.choice(HEARD) if draw.random() < 0.9 else draw.randrange(0x800)
    data = bytes(draw.randrange(256) for _ in range(draw.choice((8, 8, 8, draw.randrange(9)))))
    if cob_id == 0x603 and len(data) == 8 and draw.random() < 0.8:
        value = draw.choice((0, 1, 0x80, 0xFFFFFFFF, 0x80000183, 0x60410010, draw.getrandbits(32)))
        command = draw.choice((0x23, 0x2B, 0x2F, 0x22, 0x40, 0x21, 0xC2, 0xA0, 0x60, 0x00))
        data = struct.pack("<BHBI", command, draw.choice(INDICES), draw.randrange(9), value)
    if cob_id == 0x000:
        data = bytes((draw.choice((1, 2, 0x80, 0x81, 0x82, draw.randrange(256))), draw.choice((0, NODE))))
    return CanFrame(cob_id, data, draw.random() < 0.03)


@pytest.mark.parametrize("seed", seeds(30))
def test_random_frames_leave_a_node_alive_and_its_dictionary_whole(seed: int) -> None:
    draw = random.Random(seed)
    row: Any = np.zeros(1, SERVO)[0]
    row["inertia"] = row["rated_torque"] = 1.0
    row["increments_per_turn"] = row["peak_permille"] = 1000
    drive = servo402.create("Z", NODE, row, {})
    entries = dict(drive.device.values.description.entries)
    drive.power_on()
    now = Ns(0)
    for _ in range(2000):
        for answer in drive.on_frame(frame(draw), now):
            assert 0 < answer.cob_id < 0x800
            assert len(answer.data) <= 8
        now = Ns(now + draw.choice((0, 0, 1_000_000, 600_000_000)))
        drive.tick(now)
        drive.cyclic_signature()
    assert dict(drive.device.values.description.entries) == entries
    node = drive.node_id
    boot_up = drive.on_frame(nmt_frame(NmtCommand.RESET_NODE, node), now)
    assert boot_up[-1].data == b"\0"
    node = drive.node_id
    (answer,) = drive.on_frame(CanFrame(0x600 + node, struct.pack("<BHB4x", 0x40, 0x1000, 0)), now)
    assert struct.unpack("<BHBI", answer.data) == (0x43, 0x1000, 0, 0x00020192)
    for index, subindex in entries:
        drive.device.values.get(index, subindex)
