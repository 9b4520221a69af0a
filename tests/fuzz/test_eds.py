"""Mutated EDS files: read, or refused as bad input; a drive made of one lives."""

import random
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hli_bench_drives.cia402.drive import Drive, create

from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file
from hli_bench.base.time import Ns
from hli_bench.laws.rows import SERVO
from hli_bench.protocols.canopen.eds import load, parse_text
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.wire.can import CanFrame
from tests.fuzz.inputs import seeds

EDS = data_file("eds", "servo402.eds").read_text()
WORDS = (
    "",
    "0",
    "-1",
    "0xFF",
    "0x40490FDB",
    "$NODEID",
    "$NODEID+",
    "1e400",
    "nan",
    "NULL",
    "0x",
    "9" * 30,
    "\xb2",
    "a=b",
)


def made(path: Path, row: Any) -> tuple[Drive | None, str]:
    """Return a drive of an EDS, or why there is none."""
    try:
        return create("Z", 3, path, row, {}), ""
    except InputError as error:
        return None, str(error)


def mutated(draw: random.Random) -> str:
    """Change some lines: other values, lines gone, doubled, cut, moved."""
    lines = EDS.splitlines()
    for _ in range(draw.randint(1, 20)):
        at = draw.randrange(len(lines))
        key, equals, _ = lines[at].partition("=")
        match draw.randrange(6):
            case 0 | 1 if equals:
                lines[at] = f"{key}={draw.choice(WORDS)}"
            case 2:
                del lines[at]
            case 3:
                lines.insert(at, draw.choice(lines))
            case 4:
                lines[at] = lines[at][: draw.randrange(len(lines[at]) + 1)]
            case _:
                lines[at] = "".join(chr(draw.randrange(1, 0x300)) for _ in range(draw.randrange(12)))
    return "\n".join(lines)


@pytest.mark.parametrize("seed", seeds(10))
def test_a_mutated_eds_is_read_or_refused(seed: int, tmp_path: Path) -> None:
    path = tmp_path / "mutated.eds"
    path.write_text(mutated(random.Random(seed)), encoding="utf-8")
    row: Any = np.zeros(1, SERVO)[0]
    row["inertia"] = row["rated_torque"] = 1.0
    drive, refused = made(path, row)
    if drive is None:
        assert str(path) in refused
        return
    described = load(path)
    drive.power_on()
    drive.on_frame(nmt_frame(NmtCommand.START, 3), Ns(0))
    for index, subindex in described.entries:
        drive.on_frame(CanFrame(0x603, struct.pack("<BHB4x", 0x40, index, subindex)), Ns(0))
    for cycle in range(5):
        drive.on_frame(CanFrame(0x80), Ns(cycle))
        drive.tick(Ns(cycle))


@pytest.mark.parametrize("seed", seeds(10))
def test_noise_is_no_eds(seed: int) -> None:
    draw = random.Random(seed)
    alphabet = "[]=;\n0123456789ABCDEFabcdefx$NODEIDsub \xff"
    text = "".join(draw.choice(alphabet) for _ in range(draw.randrange(400)))
    refused = ""
    try:
        parse_text(text, "noise.eds")
    except InputError as error:
        refused = str(error)
    # 400 characters of noise never make a device: it would need a section of its own for each entry
    assert refused.startswith("noise.eds: not an EDS: no ")
