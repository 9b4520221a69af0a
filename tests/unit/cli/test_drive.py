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
        ("servo999", "no module 'drives.models.servo999' on the Python path"),
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


def test_a_broken_eds_is_named_by_line(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "broken.eds"
    path.write_text("[1000]\nParameterName\n", encoding="latin-1")
    assert main(["drive", "check", str(path)]) == 2
    assert capsys.readouterr().err == f"{path}:2: 'ParameterName' is neither [section] nor key=value\n"


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
