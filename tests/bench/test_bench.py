"""What a bench does when something goes wrong around a program."""

import re
from pathlib import Path

import pytest

from hli_bench import Bench
from hli_bench.base.errors import BenchError, InputError, NotEmulated
from hli_bench.bench import plc_ports
from hli_bench.bench.bench import WITHOUT_MOTION_PACED
from hli_bench.kernel.records import CncError


def test_a_program_that_breaks_off_leaves_no_gap_in_time() -> None:
    with Bench("demo", plc=[]) as bench:
        with pytest.raises(NotEmulated):
            bench.run('%a\nN10 #MSG["old"]\nN20 G01 X1 F6000\nN30 G04 0.05\nN40 G02 X1\nM30\n')
        assert bench.engine.cycle > 100
        assert bench.position_mm("X") == pytest.approx(1.0, abs=0.01)
        result = bench.run("%b\nN10 G01 X0 F6000\nM30\n")
        assert result.completed
        assert not result.messages


def test_a_limit_of_machine_time_aborts_a_program() -> None:
    with Bench("demo", plc=[]) as bench:
        result = bench.run("%a\nN10 G01 X100 F60\nM30\n", limit_s=1.0)
        assert (result.status, result.cycles) == ("aborted", 1000)
        assert bench.run("%b\nN10 G01 X0 F600\nM30\n").completed


@pytest.mark.parametrize(("pace", "cycles"), [("free", 1), ("real", 11)])
def test_blocks_without_motion_take_cycles_so_that_a_paced_bench_keeps_its_time(
    pace: str, cycles: int
) -> None:
    with Bench("demo", plc=[], pace=pace) as bench:
        result = bench.run("N10 P1=1\n" * 500 + "N20 M30\n")
    assert (result.completed, result.cycles) == (True, cycles)


def test_blocks_between_motion_do_not_change_it_in_real_pace() -> None:
    between = "N20 P1=1\n" * (WITHOUT_MOTION_PACED - 2)
    program = f"N10 G91 G01 X0.02 F6000\n{between}" * 40 + "N30 M30\n"
    cycles = []
    for pace in ("free", "real"):
        with Bench("demo", plc=[], pace=pace) as bench:
            cycles.append(bench.run(program).cycles)
    assert cycles[0] == cycles[1]


@pytest.mark.req("M-024")
@pytest.mark.parametrize("kind", [1, 2, 3, 4])
def test_the_measuring_type_of_the_channel_list_is_that_of_a_program_that_sets_none(kind: int) -> None:
    face = {"plant.probe.Z.face_mm": 100, "plant.probe.Z.material": "below"}
    program = 'N20 G90 G100 Z20 F600\nN30 #MSG["%f", V.G.MEAS_TYPE]\nN40 M30\n'
    with Bench("demo", face | {"channel.messtyp": kind}) as bench:
        listed = bench.run(program)
    with Bench("demo", face) as bench:
        programmed = bench.run(f"N10 #MEAS MODE[{kind}]\n{program}")
    assert [float(message.text) for message in listed.messages] == [kind]
    assert listed.measurements
    assert (listed.measurements, listed.variables) == (programmed.measurements, programmed.variables)


@pytest.mark.parametrize("processes", [False, True])
def test_what_is_wrong_with_plcs_that_are_replaced_does_not_matter(processes: bool) -> None:
    with pytest.raises(InputError, match=r"plc\[0\]\.period_us: 1000 is not a multiple of cycle_us = 2000"):
        Bench("demo", {"cycle_us": 2000})
    with Bench("demo", {"cycle_us": 2000}, plc=[], processes=processes) as bench:
        assert bench.run("N10 G01 X1 F600\nN20 M30\n").completed


DYING = """
from hli_bench.plc import Plc

class Dying(Plc):
    def start(self, hli, io):
        self.cycles = 0

    def cycle(self, hli, io):
        self.cycles += 1
        if self.cycles == 300:
            raise ValueError("enough")
"""


def test_a_script_that_failed_is_told_of_in_every_later_result_and_its_error_in_none(tmp_path) -> None:
    (tmp_path / "dying.py").write_text(DYING)
    program = "N10 G01 G90 X20 F1000\nN20 G01 X0\nN30 M30\n"
    with Bench("demo", plc=[tmp_path / "dying.py"]) as bench:
        with pytest.raises(InputError, match="ValueError: enough"):
            bench.run(program)
        for _ in range(2):
            result = bench.run(program)
            assert (result.completed, result.errors) == (True, [])
            assert "PLC dying takes part no more: its script has failed" in result.notes


def test_a_bench_that_is_closed_runs_nothing() -> None:
    with Bench("demo", plc=[]) as bench:
        bench.start_up()
    for use in (lambda: bench.run("N10 M30\n"), lambda: bench.advance(1)):
        with pytest.raises(BenchError, match="this bench is closed"):
            use()


LONG = "N10 G01 G90 Z200 F2000\n" + "".join(f"N{20 + at} G01 Z{100 + 100 * (at % 2)}\n" for at in range(200))


def test_a_program_after_one_that_was_aborted_with_a_full_look_ahead_moves() -> None:
    with Bench("demo", plc=[]) as bench:
        assert bench.run(LONG + "M30\n", limit_s=0.5).status == "aborted"
        assert bench.run("N10 G90 G01 Z310 F6000\nN20 M30\n", limit_s=30.0).completed
        assert bench.position_mm("Z") == pytest.approx(310, abs=0.1)


def test_a_program_after_one_that_an_error_ended_with_a_full_look_ahead_moves() -> None:
    with Bench("demo", {"plant.stop.Z.at_mm": 250, "plant.stop.Z.side": "below"}, plc=[]) as bench:
        assert bench.run(LONG + "M30\n", limit_s=60.0).status == "error"
        bench.reset()
        assert bench.run("N10 G90 G01 Z310 F6000\nN20 M30\n", limit_s=30.0).completed
        assert bench.position_mm("Z") == pytest.approx(310, abs=0.1)


@pytest.mark.parametrize(("limit_s", "cycles"), [(0.0003, 1), (0.0014, 2), (0.3, 300), (0.5004, 501)])
def test_a_limit_is_over_with_the_cycle_in_which_it_is_reached(limit_s: float, cycles: int) -> None:
    with Bench("demo", plc=[]) as bench:
        assert bench.run("N10 G01 X100 F60\nM30\n", limit_s=limit_s).cycles == cycles


@pytest.mark.parametrize(("reaction", "errors"), [("fault", [70020, 70222]), ("status", [70020])])
def test_a_machine_chooses_what_its_drives_do_at_a_following_error(reaction: str, errors: list[int]) -> None:
    settings = {"axis.Z.following_error": reaction, "plant.stop.Z.at_mm": 290, "plant.stop.Z.side": "below"}
    found: list[object] = []
    with Bench("demo", settings, plc=[], on_record=found.append) as bench:
        bench.run("N10 G90 G00 Z250\nN20 M30\n")
        bench.advance(100)
    assert [error.number for error in found if isinstance(error, CncError)] == errors


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"pace": "slow"}, "pace 'slow': expected free or real"),
        ({"settings": ["cycle_us=1000"]}, "settings .*: expected a mapping"),
        ({"plc": "demo.py"}, r"plc 'demo\.py': expected a list of scripts"),
        ({"zenoh": "foo"}, "'foo': expected PROTOCOL/HOST:PORT"),
        ({"machine": 3}, "machine 3: expected a name or a folder"),
    ],
)
def test_arguments_that_make_no_bench(options, message) -> None:
    with pytest.raises(InputError, match=message):
        Bench(**options)


@pytest.mark.parametrize(
    ("program", "limit_s", "message"),
    [
        (None, None, "program None: expected NC text, a path or lines"),
        (b"N10 M30\n", None, r"program b'N10 M30\\n': expected NC text, a path or lines"),
        ("N10 M30\n", 0.0, r"limit_s 0\.0: expected seconds above 0"),
        ("N10 M30\n", float("nan"), "limit_s nan: expected seconds above 0"),
    ],
)
def test_arguments_that_make_no_run(program, limit_s, message) -> None:
    with Bench("demo", plc=[]) as bench, pytest.raises(InputError, match=message):
        bench.run(program, limit_s=limit_s)


def test_the_file_of_a_program_that_was_aborted_is_closed(tmp_path) -> None:
    program = tmp_path / "long.nc"
    program.write_text(LONG)
    with Bench("demo", plc=[]) as bench:
        assert bench.run(program, limit_s=0.5).status == "aborted"
        opened = [str(link.readlink()) for link in Path("/proc/self/fd").iterdir() if link.exists()]
        assert str(program) not in opened


def test_a_bench_whose_plc_cannot_be_loaded_stays_refused(tmp_path) -> None:
    with Bench("demo", plc=[tmp_path / "none.py"]) as bench:
        with pytest.raises(InputError, match=r"none\.py"):
            bench.run("%a\nM30\n")
        with pytest.raises(Exception, match="failed to start"):
            bench.run("%a\nM30\n")


def test_a_script_that_fails_takes_part_no_more(tmp_path) -> None:
    script = tmp_path / "broken.py"
    script.write_text(
        "from hli_bench.plc import Plc\n\n\nclass Broken(Plc):\n    period_us = 1000\n    count = 0\n\n"
        "    def cycle(self, hli, io):\n        self.count += 1\n        if self.count > 20:\n            1 / 0\n"
    )
    with Bench("demo", plc=[script]) as bench:
        with pytest.raises(InputError, match=r"broken\.py"):
            bench.run("%a\nN10 G04 1\nM30\n")
        assert not bench.engine.plcs
        assert bench.run("%b\nN10 G04 0.1\nM30\n").completed


@pytest.mark.parametrize("where", ["cycle", "module"])
@pytest.mark.parametrize("status", ["", "0", "7", "'bye'"])
def test_a_script_that_exits_is_an_error_of_the_script(tmp_path, where, status) -> None:
    """It is not the end of whoever runs the bench, least of all a good one."""
    script = tmp_path / "exits.py"
    leave = f"sys.exit({status})"
    script.write_text(
        "import sys\nfrom hli_bench.plc import Plc\n\n\nclass Exits(Plc):\n"
        f"    def cycle(self, hli, io):\n        {leave if where == 'cycle' else 'pass'}\n\n\n"
        f"{leave if where == 'module' else ''}\n"
    )
    with Bench("demo", plc=[script]) as bench, pytest.raises(InputError, match=r"exits\.py:\d+: SystemExit"):
        bench.run("%a\nN10 G04 1\nM30\n")


@pytest.mark.parametrize("period", ["pass", "period_us = 'fast'", "period_us = 1.5", "period_us = True"])
def test_a_period_that_is_none_is_named(tmp_path, period) -> None:
    script = tmp_path / "late.py"
    script.write_text(f"class Late:\n    {period}\n\n    def cycle(self, hli, io):\n        pass\n")
    with Bench("demo", plc=[script]) as bench, pytest.raises(InputError, match=r"late\.py: Late\.period_us"):
        bench.run("%a\nM30\n")


def test_a_script_that_hangs_while_it_is_loaded_is_named(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(plc_ports, "ANSWER_S", 0.3)
    script = tmp_path / "hangs.py"
    script.write_text("import time\ntime.sleep(3600)\n")
    with (
        Bench("demo", plc=[script]) as bench,
        pytest.raises(InputError, match=r"hangs\.py:2: .* not been loaded"),
    ):
        bench.run("%a\nM30\n")


def test_a_module_that_is_no_drive_model_is_named() -> None:
    with pytest.raises(InputError, match=r"axis\.Z\.drive: 'os\.path' is no drive model"):
        Bench("demo", {"axis.Z.drive": "os.path"})


ENDLESS = """
from threading import Event
from time import sleep
from hli_bench.plc import Plc

class Endless(Plc):
    period_us = 1000
    count = 0

    def cycle(self, hli, io):
        self.count += 1
        while self.count > 20:
            try:
                {step}
            except Exception:
                pass
"""
PLC_STOPPED = 40011


@pytest.mark.parametrize("step", ["pass", "sleep(3600)", "Event().wait()"])
def test_a_script_that_does_not_return_is_a_plc_that_stopped(tmp_path, monkeypatch, step) -> None:
    """Whether it computes or waits: it is named, the CNC reacts, and the bench goes on without it."""
    monkeypatch.setattr(plc_ports, "ANSWER_S", 0.3)
    script = tmp_path / "endless.py"
    script.write_text(ENDLESS.format(step=step))
    notes: list[str] = []
    with Bench("demo", plc=[script], on_note=notes.append) as bench:
        result = bench.run("%a\nN10 G04 1\nM30\n")
        assert [error.id for error in result.errors] == [PLC_STOPPED]
        (note,) = notes
        loop = 1 + ENDLESS.splitlines().index("        while self.count > 20:")
        found = re.fullmatch(
            r"PLC endless has not returned from cycle \d+ within 0\.3 s \((.*):(\d+)\): it takes part no more",
            note,
        )
        assert note in result.notes
        assert found, note
        assert found[1] == str(script)
        assert loop <= int(found[2]) <= loop + 2
        bench.reset()
        assert bench.run("%b\nN10 G04 0.1\nM30\n").completed


def test_a_script_that_does_not_return_from_its_start_is_told_so(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(plc_ports, "ANSWER_S", 0.3)
    script = tmp_path / "slow.py"
    script.write_text(ENDLESS.format(step="pass").replace("def cycle", "def start").replace("> 20", "> 0"))
    script.write_text(script.read_text() + "\n    def cycle(self, hli, io): ...\n")
    notes: list[str] = []
    with Bench("demo", plc=[script], on_note=notes.append) as bench:
        bench.run("%a\nN10 G04 1\nM30\n")
    assert notes[0].startswith("PLC slow has not returned from its start within 0.3 s (")


def test_a_slow_terminal_does_not_make_a_bench_without_plc_pass_frames() -> None:
    with Bench("demo", {"terminal.cams.period_us": 4000}, plc=[]) as bench:
        bench.start_up()
        passed = 0
        telegrams = bench.engine.link.telegrams

        def counted(cycle, inbox):
            nonlocal passed
            passed += 1
            return telegrams(cycle, inbox)

        bench.engine.link.telegrams = counted
        assert bench.run("%a\nN10 G01 X10 F600\nM30\n").completed
        assert passed < 5
