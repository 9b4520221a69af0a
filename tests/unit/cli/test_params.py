"""`params show` and `params check`."""

import re
from pathlib import Path

import pytest

from hli_bench.cli.main import main
from hli_bench.cli.params import kind_of


def rows(text: str) -> dict[str, str]:
    """Return a printed sheet by heading."""
    cells = (re.split(r"  +", line, maxsplit=1) for line in text.splitlines())
    return dict(cells)


def shown(capsys: pytest.CaptureFixture[str], name: str) -> dict[str, str]:
    assert main(["params", "show", name]) == 0
    return rows(capsys.readouterr().out)


@pytest.mark.parametrize("name", ["P-AXIS-00516", "p-axis-00516", "kenngr.measure.signal"])
def test_a_sheet_is_found_by_number_and_path(capsys: pytest.CaptureFixture[str], name: str) -> None:
    sheet = shown(capsys, name)
    assert sheet["number"] == "P-AXIS-00516"
    assert sheet["path"] == "kenngr.measure.signal"
    assert sheet["list"] == "axis"
    assert sheet["type"] == "STRING"
    assert "PLC_TIMESTAMP" in sheet["values"]
    assert sheet["default"] == "(empty)"
    assert sheet["effect"] == "emulated"
    assert "P-AXIS-00257 (kenngr.probing_signal_via_plc)" in sheet["replaces"]
    assert sheet["source"] == "measurement manual 8.2.2"


def test_a_sheet_names_range_unit_by_axis_type_and_indices(capsys: pytest.CaptureFixture[str]) -> None:
    sheet = shown(capsys, "getriebe[0].vb_refmax")
    assert sheet["unit"] == "translatory µm/s, rotary 0.001°/s, spindle 0.001°/s"
    assert sheet["indices"].startswith("i = 0..")
    sheet = shown(capsys, "P-AXIS-00517")
    assert sheet["values"] == "0..255"
    assert sheet["default"] == "0"


def test_a_channel_parameter_has_no_axis_types(capsys: pytest.CaptureFixture[str]) -> None:
    sheet = shown(capsys, "P-CHAN-00057")
    assert sheet["list"] == "channel"
    assert "axis types" not in sheet
    assert "drive types" not in sheet


def test_several_sheets_are_set_apart(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["params", "show", "P-AXIS-00516", "P-AXIS-00517"]) == 0
    assert len(capsys.readouterr().out.split("\n\n")) == 2


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("P-AXIS-99999", "unknown parameter, expected P-AXIS-nnnnn, P-CHAN-nnnnn or a list path"),
        ("kenngr.measure.signl", "unknown parameter (did you mean kenngr.measure.signal?)"),
        ("nothing.like.it", "unknown parameter"),
    ],
)
def test_an_unknown_parameter_is_named(capsys: pytest.CaptureFixture[str], name: str, message: str) -> None:
    assert main(["params", "show", name]) == 2
    assert capsys.readouterr().err == f"{name}: {message}\n"


def test_the_kind_of_a_list_follows_from_what_stands_in_it() -> None:
    assert kind_of("kopf.achs_nr 1\nkenngr.messachse 1\nkenngr.mesachse 1\n") == "axis"
    assert kind_of("messtyp 1\nmestyp 2\n") == "channel"
    assert kind_of("") == "axis"


def test_a_good_list_is_accepted_with_its_remarks(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "good.lis"
    path.write_text("kopf.achs_nr 1\nkenngr.measure.signal PLC_FIRST_EVENT\nEnd\n", encoding="utf-8")
    assert main(["params", "check", str(path)]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0].startswith(f"{path}:2: note: NotEmulated: P-AXIS-00516: ")
    assert out[-1] == f"{path}: an axis list with 2 parameters, accepted"


def test_the_kind_may_be_forced(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "axis.lis"
    path.write_text("kopf.achs_nr 1\n", encoding="utf-8")
    assert main(["params", "check", str(path), "--kind", "channel"]) == 2
    assert capsys.readouterr().err.startswith(f"{path}:1: error: kopf.achs_nr: unknown parameter")


def test_one_bad_list_of_several_decides(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    good, bad = tmp_path / "good.lis", tmp_path / "bad.lis"
    good.write_text("kopf.achs_nr 1\n", encoding="utf-8")
    bad.write_text("kopf.achs_nr 0\n", encoding="utf-8")
    assert main(["params", "check", str(bad), str(good)]) == 2
    said = capsys.readouterr()
    assert "an axis list with 1 parameters, accepted" in said.out
    assert said.err.startswith(f"{bad}:1: error: kopf.achs_nr: 0 is out of range")
    assert main(["params", "check", str(tmp_path / "none.lis")]) == 2
    assert capsys.readouterr().err == f"{tmp_path / 'none.lis'}: cannot be read: No such file or directory\n"
