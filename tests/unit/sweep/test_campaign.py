import sys
from pathlib import Path

import pytest

from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file
from hli_bench.sweep.campaign import kind_of, read
from hli_bench.sweep.work import nc_text

ROOT = Path(__file__).resolve().parents[3]
GOOD = """\
program = "p.nc"
seed = 4
repeats = 3
[settings]
"plant.probe.Z.material" = "below"
[grid]
"axis.Z.kenngr.measure.signal" = ["PLC", "DRIVE"]
program.feed = [500, 1000.5]
[random]
plant.probe.Z.face_mm = { uniform = [10, 11] }
"seed" = { integers = [0, 9] }
[metrics]
error_um = "measurements.0.acs_mm"
"""


@pytest.fixture
def write(tmp_path):
    (tmp_path / "p.nc").write_text("N10 G01 Z10 F{feed}\nN20 M30\n")

    def written(text):
        file = tmp_path / "c.toml"
        file.write_text(text)
        return file

    return written


def test_runs_count_through_the_grid_the_last_key_fastest(write):
    campaign = read(write(GOOD))
    assert campaign.runs == 12
    signals = [campaign.drawn(run)["axis.Z.kenngr.measure.signal"] for run in range(12)]
    feeds = [campaign.drawn(run)["program.feed"] for run in range(12)]
    assert signals == ["PLC"] * 6 + ["DRIVE"] * 6
    assert feeds == [500] * 3 + [1000.5] * 3 + [500] * 3 + [1000.5] * 3
    assert [kind_of(campaign, key) for key in campaign.varied] == [str, float, float, int]


def test_draws_differ_by_run_and_depend_on_the_seed_alone(write):
    campaign = read(write(GOOD))
    faces = [campaign.drawn(run)["plant.probe.Z.face_mm"] for run in range(12)]
    assert len(set(faces)) == 12
    other_grid = read(write(GOOD.replace("[500, 1000.5]", "[600]")))
    assert [other_grid.drawn(run)["plant.probe.Z.face_mm"] for run in range(6)] == faces[:6]
    other_seed = read(write(GOOD.replace("seed = 4", "seed = 5")))
    assert other_seed.drawn(0)["plant.probe.Z.face_mm"] != faces[0]


def test_the_program_gets_its_values(write):
    campaign = read(write(GOOD))
    assert nc_text(campaign.job.text, campaign.run(3).settings).startswith("N10 G01 Z10 F1000.5\n")


def test_a_program_without_keys_is_left_as_it_is():
    assert nc_text("N10 {x}", {"cycle_us": 1000}) == "N10 {x}"


@pytest.mark.parametrize(
    ("old", "new", "line", "named"),
    [
        ('program = "p.nc"', 'program = "q.nc"', 1, "program: 'q.nc' is neither"),
        ('program = "p.nc"', 'program = "p.nc"\nprogramme = 1', 2, "programme: unknown key"),
        ('program = "p.nc"', 'program = "p.nc"\nmachine = "nowhere"', 2, "machine: 'nowhere'"),
        ('program = "p.nc"', 'program = "p.nc"\nplc = "demo.py"', 2, "expected a list of scripts"),
        ('program = "p.nc"', 'program = "p.nc"\nplc = ["none.py"]', 2, "'none.py' is neither"),
        ("repeats = 3", "repeats = 0", 3, "repeats: 0 is not valid"),
        ("seed = 4", 'seed = "x"', 2, "seed: 'x' is not valid"),
        ('"below"', '"sideways"', 5, "expected one of above, below"),
        ('"PLC", "DRIVE"', '"PLC", "DRIVES"', 7, "kenngr.measure.signal"),
        ('"PLC", "DRIVE"', '"PLC", "PLC"', 7, "a value stands twice"),
        ('["PLC", "DRIVE"]', '"PLC"', 7, "expected a list of values"),
        ('["PLC", "DRIVE"]', '["PLC", 1]', 7, "values of one kind"),
        ("[500, 1000.5]", "[]", 8, "expected a list of values"),
        ("program.feed", "program.speed", 8, "has no placeholder {speed} (feed)"),
        ("program.feed = [500, 1000.5]", "program.feed = [500]\nprogram.x = [1]", 9, "no placeholder {x}"),
        ("uniform = [10, 11]", "uniform = [11, 10]", 10, "expected [low, high]"),
        ("{ uniform = [10, 11] }", "{ gauss = [10, 11] }", 10, "unknown key|gauss"),
        ("{ uniform = [10, 11] }", "[10, 11]", 10, "expected { uniform"),
        ("plant.probe.Z.face_mm", "plant.probe.Q.face_mm", 10, "'Q' is not an axis"),
        ('"seed" = {', '"plant.probe.Z.material" = {', 11, "stands twice in this campaign"),
        ("integers = [0, 9]", "integers = [-9, 9]", 11, "seed: -"),
        ('error_um = "measurements.0.acs_mm"', 'error_um = "measurements.0.mcs"', 13, "'mcs' is not one of"),
        ("error_um =", "cycles =", 13, "cannot name a metric"),
        ("[metrics]", '[report]\nby = "cycle_us"\n[metrics]', 13, "report.by: 'cycle_us' is not one of"),
        (
            "[grid]",
            '[grid]\n"fault.0.kind" = ["probe_stuck", "node_off"]',
            7,
            "fault[0].kind: fault node_off",
        ),
        (
            "[grid]",
            "[grid]\ncycle_us = [1000, 2000]",
            7,
            "cycle_us = 2000: |plc[0].period_us: 1000 is not a multiple",
        ),
        ('program = "p.nc"', 'program = "p.nc', 1, "not valid TOML"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(write, old, new, line, named):
    file = write(GOOD.replace(old, new))
    with pytest.raises(InputError) as error:
        read(file)
    assert error.value.file == str(file)
    assert error.value.line == line
    assert any(text in error.value.message for text in named.split("|"))


def test_plc_keys_beside_other_scripts_would_have_no_effect(write):
    text = GOOD.replace("seed = 4", 'plc = ["demo.py"]').replace(
        "[grid]", '[grid]\n"plc.0.period_us" = [1000]'
    )
    with pytest.raises(InputError, match="has no effect on scripts"):
        read(write(text))


def test_a_file_beside_a_plc_script_counts_as_part_of_it(write, tmp_path):
    (tmp_path / "mine.py").write_text((data_file("plc_scripts", "demo.py")).read_text())
    (tmp_path / "gain.py").write_text("GAIN = 1\n")
    text = GOOD.replace("seed = 4", 'plc = ["mine.py"]')
    before = read(write(text)).digests
    (tmp_path / "gain.py").write_text("GAIN = 2\n")
    after = read(write(text)).digests
    assert {name for name in before if before[name] != after[name]} == {"plc"}


def test_a_drive_model_that_a_run_may_name_counts_as_part_of_it(write, tmp_path, monkeypatch):
    model = tmp_path / "my_drive.py"
    model.write_text("from hli_bench_drives.models.servo402 import MODEL, create\n")
    monkeypatch.syspath_prepend(tmp_path)
    text = GOOD.replace("[grid]", '[grid]\n"axis.Z.drive" = ["drives.models.servo402", "my_drive"]')
    before = read(write(text)).digests
    model.write_text("from hli_bench_drives.models.servo402 import create\n")
    after = read(write(text)).digests
    assert {name for name in before if before[name] != after[name]} == {"drives"}
    model.write_text(
        f'from types import SimpleNamespace\nMODEL = SimpleNamespace(eds="{tmp_path}/my.eds")\ndef create(): ...'
    )
    digests = []
    for content in ("old", "new"):
        (tmp_path / "my.eds").write_text(content)
        monkeypatch.delitem(sys.modules, "my_drive")
        digests.append(read(write(text)).digests["drives"])
    assert digests[0] != digests[1]
    with pytest.raises(InputError, match=r"axis\.Z\.drive = nowhere: no module 'nowhere'") as caught:
        read(write(text.replace("my_drive", "nowhere")))
    assert caught.value.file.endswith(".toml")


def test_too_many_runs_are_a_mistake(write):
    with pytest.raises(InputError, match="allowed"):
        read(write(GOOD.replace("repeats = 3", "repeats = 1000000000")))


def test_digests_tell_which_part_has_changed(write, tmp_path):
    before = read(write(GOOD)).digests
    assert before == read(write("# a remark\n" + GOOD)).digests
    (tmp_path / "p.nc").write_text("N10 G01 Z11 F{feed}\nN20 M30\n")
    after = read(write(GOOD.replace("500", "501"))).digests
    assert [part for part in before if before[part] != after[part]] == ["program", "grid"]


def test_the_supplied_campaign_is_accepted():
    campaign = read(ROOT / "campaigns" / "probe_error.toml")
    assert "program.feed" in campaign.varied
