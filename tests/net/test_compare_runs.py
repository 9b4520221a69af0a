"""The comparison of runs with a commit: what differs is named with its place, and nothing else is."""

import dataclasses
import subprocess
import sys
from pathlib import Path

import pytest
from net.comparing import Shapes, compare
from net.performing import Performed, perform
from net.runs import FACE, Run, all_runs, text

ROOT = Path(__file__).parents[2]
PROBE = Run(name="probe", programs=[text("G90 G01 Z105 F6000", "G100 Z90 F900")], settings=FACE)


def performed(tmp_path: Path, run: Run, **changed: object) -> Performed:
    """Perform a run with these settings changed, write it to a file and read it again."""
    settings = {**run.settings, **{key.replace("__", "."): value for key, value in changed.items()}}
    perform(dataclasses.replace(run, settings=settings), tmp_path).save(tmp_path / "a.run", [tmp_path])
    return Performed.load(tmp_path / "a.run")


def test_the_set_is_large_and_its_names_are_files() -> None:
    names = [run.name for run in all_runs()]
    assert len(names) >= 80
    assert len(set(names)) == len(names)
    assert all(name == Path(name).name for name in names)


def test_a_run_performed_twice_is_the_same(tmp_path: Path) -> None:
    shapes = Shapes()
    found = compare(performed(tmp_path, PROBE), performed(tmp_path, PROBE), shapes)
    assert found.first is None
    assert not shapes.base
    assert not shapes.now


def test_a_face_that_lies_higher_shows_first_in_its_edge(tmp_path: Path) -> None:
    base, now = performed(tmp_path, PROBE), performed(tmp_path, PROBE, plant__probe__Z__face_mm=100.01)
    found = compare(base, now, Shapes())
    assert found.first is not None
    assert (found.first.channel, found.first.what) == ("edges", "probe")
    (edge,) = [
        cycle for cycle, name, value in now.events["edges"] if name == "probe" and value.startswith("True")
    ]
    assert found.first.cycle == edge
    assert {"axes", "cnc", "plc", "result"} <= found.counts.keys()


def test_a_changed_acceleration_shows_in_the_axis_that_has_it(tmp_path: Path) -> None:
    base = performed(tmp_path, PROBE)
    now = performed(tmp_path, PROBE, **{"axis__Z__getriebe[0]__lslope_profil__a_stufe_1": 900})
    found = compare(base, now, Shapes())
    assert found.first is not None
    assert found.first.channel == "axes"
    assert found.first.what.startswith("Z ")
    at = found.first.cycle
    differ = [
        name for name in base.log.dtype.names if (base.log[name][: at - 1] != now.log[name][: at - 1]).any()
    ]
    assert differ == []


def test_a_setting_that_is_refused_is_an_outcome(tmp_path: Path) -> None:
    now = performed(tmp_path, PROBE, axis__Z__nonsense=1)
    assert now.outcomes[0].startswith("refused: InputError: ")
    found = compare(performed(tmp_path, PROBE), now, Shapes())
    assert found.first is not None
    assert found.first.channel == "outcome"


def test_the_tool_lists_runs_by_a_pattern() -> None:
    tool = [sys.executable, str(ROOT / "tools" / "compare_runs.py")]
    listed = subprocess.run(
        [*tool, "--list", "--only", "type1_*"], capture_output=True, text=True, check=True
    )
    assert "type1_drive" in listed.stdout.split()


@pytest.mark.parametrize("moved", [False, True])
def test_report(tmp_path: Path, capsys: pytest.CaptureFixture[str], moved: bool) -> None:
    import compare_runs

    for number, face in enumerate((100.0, 100.01 if moved else 100.0)):
        folder = tmp_path / str(number)
        folder.mkdir()
        changed = dataclasses.replace(PROBE, settings=FACE | {"plant.probe.Z.face_mm": face})
        perform(changed, folder).save(folder / "probe.run")
    assert compare_runs.report(tmp_path / "0", tmp_path / "1", ["probe"], "before") == moved
    said = capsys.readouterr().out
    if moved:
        assert said.startswith("probe: cycle ")
        assert "edges: probe: True at " in said
        assert said.endswith("1 of 1 runs differ from before\n")
    else:
        assert said == "1 runs, none differs from before\n"
