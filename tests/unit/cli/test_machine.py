"""`hli-bench machine`: a folder of one's own from a supplied one; names that are none."""

from pathlib import Path

import pytest

from hli_bench.cli.main import main


def test_a_copied_machine_is_a_machine_of_its_own(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    own = tmp_path / "own"
    assert main(["machine", "copy", "demo", str(own)]) == 0
    assert f"--machine {own}" in capsys.readouterr().out
    file = own / "machine.toml"
    file.write_text(file.read_text(encoding="utf-8") + "\n[plant.stop.Z]\nat_mm = 1\n", encoding="utf-8")
    assert main(["machine", "check", str(own)]) == 2
    assert f"{file}" in capsys.readouterr().err
    assert main(["machine", "check", "demo"]) == 0


def test_a_machine_is_not_copied_over_what_is_there(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["machine", "copy", "demo", str(tmp_path)]) == 2
    expected = "is there already and is not written over; choose another folder, or remove it first"
    assert capsys.readouterr().err == f"{tmp_path}: {expected}\n"
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", [["check", "nosuch"], ["copy", "nosuch", "x"]])
def test_a_name_that_is_no_machine(capsys: pytest.CaptureFixture[str], command: list[str]) -> None:
    assert main(["machine", *command]) == 2
    said = capsys.readouterr().err
    assert said == "'nosuch' is neither a machine of the package nor a folder with machine.toml\n"
