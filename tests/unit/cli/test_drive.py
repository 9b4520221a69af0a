"""`drive show` and `drive check`, `machine check` and `machine schema`, `doctor`."""

from itertools import pairwise
from pathlib import Path

import pytest

from hli_bench.base.loading import data_file
from hli_bench.cli.main import main

SERVO = data_file("eds", "servo402.eds")


@pytest.mark.parametrize("model", ["servo402", "drives.models.servo402"])
def test_a_model_shows_its_object_dictionary(capsys: pytest.CaptureFixture[str], model: str) -> None:
    assert main(["drive", "show", model]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == ["OBJECT", "NAME", "TYPE", "ACCESS", "PDO", "DEFAULT", "RANGE"]
    (statusword,) = [line for line in lines if line.startswith("6041:00")]
    assert "UNSIGNED16" in statusword
    (emergency,) = [line for line in lines if line.startswith("1014:00")]
    assert "0x80 + node id" in emergency


@pytest.mark.parametrize(
    ("model", "message"),
    [
        ("servo999", "no module 'hli_bench_drives.models.servo999' on the Python path"),
        (
            "json.decoder",
            "'json.decoder' is no drive model, it has no create()",
        ),
    ],
)
def test_an_unknown_model_is_named_beside_those_there_are(
    capsys: pytest.CaptureFixture[str], model: str, message: str
) -> None:
    assert main(["drive", "show", model]) == 2
    assert capsys.readouterr().err == f"{message}; supplied models: servo402\n"


def test_a_good_eds_is_accepted(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["drive", "check", str(SERVO)]) == 0
    assert capsys.readouterr().out.startswith(f"{SERVO}: CiA 402 drive, ")


def test_a_drive_that_lacks_an_object_is_not_accepted(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "poor.eds"
    path.write_text(
        "[1000]\nParameterName=Device type\nObjectType=7\nDataType=7\nAccessType=ro\nDefaultValue=0x20192\n",
        encoding="latin-1",
    )
    assert main(["drive", "check", str(path), str(SERVO)]) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"{path}: a CiA 402 drive needs the objects ")
    assert "6041:00" in said.err
    assert str(SERVO) in said.out


def test_what_is_wrong_with_an_eds_is_said_at_once_and_it_is_accepted(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "bent.eds"
    head = "[{0}]\nParameterName=x\nDataType={1}\nAccessType=ro\n"
    text = (
        head.format("1000", 7)
        + head.format("2008", 2)
        + "LowLimit=5\nHighLimit=1\n"
        + head.format("2009", 0x99)
    )
    path.write_text(text, encoding="latin-1")
    assert main(["drive", "check", str(path)]) == 0
    said = capsys.readouterr()
    assert [line.split(":")[1] for line in said.err.splitlines()] == ["9", "13"]
    assert "accepted" in said.out


def test_a_drive_with_the_least_says_what_is_off(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """No device type, no modes: it is a drive by its control and status word."""
    path = tmp_path / "least.eds"
    path.write_text(
        "".join(
            f"[{index}]\nParameterName=x\nDataType={kind}\nAccessType=rw\n"
            for index, kind in (("1000", 7), ("6040", 6), ("6041", 6), ("6060", 2), ("6061", 2), ("6502", 7))
        )
    )
    assert main(["drive", "check", str(path)]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert "CiA 402 drive" in said.out
    for feature in ("touch probe", "torque limit", "time stamps"):
        assert f"off, for want of objects: {feature}" in said.out
    assert "cannot be moved by the bench's CNC, for want of 607A:00, 6064:00" in said.out


def test_words_of_bits_are_shown_in_hexadecimal(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["drive", "show", "servo402"]) == 0
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    for address, text in (
        ("1600:01", "0x60400010"),
        ("1000:00", "0x00020192"),
        ("1018:01", "0x00FF0402"),
        ("6502:00", "0x00000080"),
        ("1600:00", " 2"),
        ("6065:00", " 1048575"),
    ):
        assert lines[address].rstrip().endswith(text), lines[address]


def test_a_machine_is_checked_with_its_settings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", "check", "demo"]) == 0
    assert "7 axes (X, Y, Z, X2, A, B, S)" in capsys.readouterr().out
    assert main(["machine", "check", "demo", "--set", "axis.Z.drive=drives.models.none"]) == 2
    assert capsys.readouterr().err == ("axis.Z.drive: no module 'drives.models.none' on the Python path\n")


def test_a_plc_script_that_cannot_be_loaded_is_named(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    script = tmp_path / "wrong.py"
    script.write_text("x = 1\nthis is wrong\n", encoding="utf-8")
    assert main(["machine", "check", "demo", "--set", f"plc.0.script={script}"]) == 2
    assert capsys.readouterr().err.startswith(f"{script}:2:")


def test_the_schema_names_every_kind_of_key(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", "schema"]) == 0
    lines = capsys.readouterr().out.splitlines()
    keys = {line.partition(":")[0] for line in lines}
    assert {"cycle_us", "axis.<AXIS>.drive", "plant.probe.<AXIS>.face_mm", "axis.<AXIS>.<list path>"} <= keys


def test_doctor_advises_on_what_is_lacking_and_does_not_fail(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.split()[:2] == ["ok", "python"] for line in lines)
    for line, following in pairwise(lines):
        assert not line.startswith("lacks") or following.startswith("       ")
