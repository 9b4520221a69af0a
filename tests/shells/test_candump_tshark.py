"""The CAN log of a run, read by tshark as CANopen."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TSHARK = shutil.which("tshark")
DECODE = ("-d", "can.subdissector,canopen")
PROGRAM = """%logged
N10 #MEAS MODE[1]
N20 G90 G01 Z299 F6000
N30 G100 Z290 F1000
N40 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=50 WAIT]
N50 M30
"""
FACE = ("--set", "plant.probe.Z.face_mm=298", "--set", "plant.probe.Z.material=below")

pytestmark = pytest.mark.skipif(
    TSHARK is None and "CI" not in os.environ, reason="needs tshark: apt-get install tshark"
)


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("tshark")
    (folder / "logged.nc").write_text(PROGRAM)
    hli_bench = Path(sys.executable).with_name("hli-bench")
    command = [hli_bench, "run", "logged.nc", "--can-log", "run.log", *FACE]
    subprocess.run(command, cwd=folder, check=True)
    return folder / "run.log"


def decoded(log: Path, *arguments: str) -> list[str]:
    """Return the lines that tshark prints. In CI it must be there; .ci/run installs it."""
    assert TSHARK is not None, "tshark is missing: apt-get install tshark"
    command = [TSHARK, "-r", str(log), *DECODE, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def test_every_frame_is_canopen(log: Path) -> None:
    lines = decoded(log)
    assert len(lines) == len(log.read_text().splitlines()) > 1000
    assert [line for line in lines if "CANopen" not in line or "Malformed" in line] == []
    shown = "\n".join(lines)
    for service in ("SYNC", "Boot-up", "Start remote node", "PDO1 (tx)", "PDO4 (tx)", "PDO1 (rx)", "SDO"):
        assert service in shown


@pytest.mark.req("M-167")
def test_the_download_of_the_torque_limit_and_its_confirmation(log: Path) -> None:
    """#DRIVE writes 50 times the factor 10 of the function table: 500 per mille to node 3."""
    shown = decoded(log, "-Y", "canopen.sdo.main_idx == 0x6072", "-O", "canopen")
    said = [line.strip() for line in shown]
    for line in (
        "COB-ID: 0x00000603",
        "Type: Default-SDO (rx)",
        "Data: f4010000",
        "COB-ID: 0x00000583",
        "Type: Default-SDO (tx)",
    ):
        assert said.count(line) == 1, line
    assert any(
        "Client command specifier: Initiate download request, Expedited transfer" in line for line in said
    )
    assert any("Server command specifier: Initiate download response" in line for line in said)


def test_time_stamps_are_the_cycles(log: Path) -> None:
    stamps = decoded(log, "-Y", "can.id == 0x80", "-T", "fields", "-e", "frame.time_epoch")
    at = [round(float(stamp) * 1000) for stamp in stamps]
    assert at == list(range(at[0], at[0] + len(at)))
    assert at[0] == 1767225600001
