"""The candump log read by programs that know nothing of the bench."""

import shutil
import subprocess
from itertools import pairwise
from pathlib import Path

import can
import pytest

from hli_bench.bench.bench import Bench
from hli_bench.laws.rows import LOG_CYCLES
from hli_bench.runtime.frames import cycle_frames
from hli_bench.runtime.machine_side import SYNC
from hli_bench.shells.candump import CandumpLog, line
from hli_bench.wire.can import CanFrame

PROGRAM = "N10 G01 G90 Z299 F2000\nN20 M30"
TPDOS = (0x180, 0x280, 0x380, 0x480)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Bench, Path]:
    path = tmp_path_factory.mktemp("candump") / "run.log"
    bench = Bench("demo", plc=[])
    log = CandumpLog(path, bench.kernel.setup, bench.kernel.rows.log)
    bench.engine.observers.append(log)
    bench.run(PROGRAM)
    log.close()
    log.close()
    return bench, path


@pytest.fixture(scope="module")
def messages(run: tuple[Bench, Path]) -> list[can.Message]:
    return list(can.CanutilsLogReader(run[1]))


def test_python_can_reads_every_cycle(run: tuple[Bench, Path], messages: list[can.Message]) -> None:
    cycles = run[0].engine.cycle
    syncs = [message for message in messages if message.arbitration_id == SYNC.cob_id]
    assert len(syncs) == cycles
    assert round(syncs[0].timestamp, 6) == 1767225600.001
    assert all(round(after.timestamp - before.timestamp, 6) == 0.001 for before, after in pairwise(syncs))
    targets = [message for message in messages if message.arbitration_id == 0x203]
    assert len(targets) == cycles


def test_the_bus_is_seen_from_power_on(messages: list[can.Message]) -> None:
    assert [(m.arbitration_id, bytes(m.data)) for m in messages[:7]] == [
        (0x700 + node, b"\0") for node in range(1, 8)
    ]
    assert {m.arbitration_id & 0x780 for m in messages} >= {0x000, 0x580, 0x600, 0x700, *TPDOS}


def test_a_drive_sends_no_telegram_before_it_is_started(messages: list[can.Message]) -> None:
    start = next(at for at, m in enumerate(messages) if m.arbitration_id == 0 and bytes(m.data) == b"\1\3")
    first = next(at for at, m in enumerate(messages) if m.arbitration_id == 0x183)
    assert start < first
    assert messages[first].timestamp - messages[start].timestamp == pytest.approx(0.001, abs=1e-5)


def test_a_block_of_lines_is_frame_by_frame_the_cycle(
    run: tuple[Bench, Path], messages: list[can.Message]
) -> None:
    bench = run[0]
    cycle, nodes = bench.engine.cycle, [axis.node for axis in bench.kernel.setup.axes]
    frames = cycle_frames(nodes, bench.kernel.rows.log[cycle % LOG_CYCLES])
    assert [CanFrame(m.arbitration_id, bytes(m.data)) for m in messages[-len(frames) :]] == frames


@pytest.mark.parametrize(
    ("frame", "text"),
    [
        (CanFrame(0x80), b"(1767225600.001000) vcan0 080#\n"),
        (CanFrame(0x701, remote=True), b"(1767225600.001000) vcan0 701#R\n"),
        (CanFrame(0x0, b"\x01\x0a"), b"(1767225600.001000) vcan0 000#010A\n"),
    ],
)
def test_a_line(frame: CanFrame, text: bytes) -> None:
    assert line(frame, 1_767_225_600_001_000_000, "vcan0") == text


@pytest.mark.skipif(shutil.which("tshark") is None, reason="tshark is not installed")
def test_tshark_decodes_canopen(run: tuple[Bench, Path]) -> None:
    command = ["tshark", "-r", str(run[1]), "-d", "can.subdissector,canopen", "-c", "2000"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    lines = shown.splitlines()
    assert len(lines) == 2000
    assert all("CANopen" in one for one in lines)
    assert "SYNC" in shown
    assert "SDO" in shown
    assert "NMT" in shown
