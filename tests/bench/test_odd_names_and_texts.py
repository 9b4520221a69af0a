"""Names, numbers and texts that no machine has: bad input with its place, never a traceback, and nothing is lost."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.bench.folder import load
from hli_bench.bench.sources import parse_set
from hli_bench.cli.main import INTERRUPTED, main
from hli_bench.shells.whole_file import write_whole

LONG = "n" * 300
FACE = ("--set", "plant.probe.Z.face_mm=100", "--set", "plant.probe.Z.material=below")
Ended = tuple[int, str, str]
Command = Callable[..., Ended]


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Command:
    """Runs a command line in this process: (exit status, standard output, standard error)."""

    def run(*arguments: object) -> Ended:
        status = main([str(argument) for argument in arguments])
        said = capsys.readouterr()
        return status, said.out, said.err

    return run


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text('N10 #MSG ["done"]\nN20 M30\n', encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--machine", LONG], "--machine: "),
        (["--plc", LONG], "no such file, nor one of plc_scripts/"),
        (["--result", f"/tmp/{LONG}"], "--result: cannot be written: File name too long"),
        (["--report", "/tmp/a\0b"], "--report: no file can have that name"),
        (["--set", f"axis.Z.list={LONG}"], "axis.Z.list: "),
        (["--set", f"plc.0.script={LONG}.py"], "plc[0].script: "),
        (["--set", r'axis.Z.list="x\u0000.lis"'], "axis.Z.list: "),
        (["--set", r'plc.0.script="x\u0000.py"'], "plc[0].script: "),
        (["--set", "axis.Z.list=/dev/zero"], "axis.Z.list: '/dev/zero' is not a readable file"),
        (
            ["--set", "axis.Z.getriebe[].pos_refpkt=1"],
            "the index is missing, expected e.g. getriebe[0].pos_refpkt",
        ),
        (["--set", "seed=" + "[" * 5000], "seed: '[["),
        (["--set", "plant.axis.Z.pitch_mm=1e-320"], "expected number above 0.0, 0 or 1e-12 to 1e+12 in size"),
        (["--set", "plant.axis.Z.pitch_mm=1e-9"], "axis.Z.start_mm: 300.0 is beyond the encoder's"),
        (
            ["--set", "plant.axis.Z.zero_pulse_offset_mm=1e11"],
            "plant.axis.Z.zero_pulse_offset_mm: 100000000000.0 is beyond the encoder's +-",
        ),
        (
            ["--set", "plant.axis.Z.zero_pulse_offset_increments=1" + "0" * 30],
            "expected integer -2147483648..2147483647",
        ),
    ],
)
def test_names_and_numbers_that_cannot_be(
    command: Command, program: Path, options: list[str], message: str
) -> None:
    status, out, said = command("run", program, *options)
    assert (status, out) == (2, "")
    assert message in said
    assert len(said) < 1000


def test_a_program_of_a_name_that_no_file_can_have(command: Command) -> None:
    status, _, said = command("run", f"{LONG}.nc")
    assert (status, "no such file, nor one of programs/" in said) == (2, True)


def test_a_supplied_program_is_found_without_its_ending_and_a_near_one_is_named(command: Command) -> None:
    assert command("run", "probe", *FACE)[0] == 0
    status, _, said = command("run", "meas9")
    assert (status, "did you mean meas" in said) == (2, True)


def test_brackets_in_a_machine_file_that_nobody_can_read(
    command: Command, tmp_path: Path, program: Path
) -> None:
    (tmp_path / "machine.toml").write_text("x = " + "[" * 5000, encoding="utf-8")
    status, _, said = command("run", program, "--machine", tmp_path)
    assert (status, said) == (2, f"{tmp_path / 'machine.toml'}: not valid TOML: nested too deeply\n")


@pytest.mark.parametrize("name", ["a*b", "a#b", "@a", b"x\xff".decode(errors="surrogateescape")])
def test_a_machine_whose_name_is_no_key_is_refused_only_where_it_becomes_one(
    command: Command, tmp_path: Path, program: Path, name: str
) -> None:
    folder = tmp_path / name
    assert command("machine", "copy", "demo", folder)[0] == 0
    result = tmp_path / "result.json"
    assert (
        command("run", program, "--machine", folder, "--result", result, "--trace", tmp_path / "t.mcap")[0]
        == 0
    )
    assert json.loads(result.read_text(encoding="utf-8"))["status"] == "completed"
    status, _, said = command("run", program, "--machine", folder, "--zenoh", "tcp/127.0.0.1:7593")
    assert (status, "can be no part of a Zenoh key" in said) == (2, True)


@pytest.mark.parametrize("name", ["a*b", "@a"])
def test_a_terminal_whose_name_is_no_key(command: Command, program: Path, name: str) -> None:
    options = ("--set", f'terminal.{name}.model="EL1252"')
    assert command("run", program, *options)[0] == 0
    status, _, said = command("run", program, *options, "--zenoh", "tcp/127.0.0.1:7593")
    assert (status, f"a terminal is called {name!r}" in said) == (2, True)


WORST = """class Worst:
    period_us = 1000
    def cycle(self, hli, io):
        class Bad(BaseException):
            def __str__(self):
                raise RuntimeError("no text")
        raise Bad
"""


@pytest.fixture
def worst(tmp_path: Path) -> tuple[Path, Path, str]:
    """A program, a script that raises no Exception in its first cycle, and how that is told."""
    script, part = tmp_path / "worst.py", tmp_path / "part.nc"
    script.write_text(WORST, encoding="utf-8")
    part.write_text("N10 G90 G01 Z299 F1000\nN20 M30\n", encoding="utf-8")
    return part, script, f"{script}:7: Bad (its text cannot be had: RuntimeError)"


def test_a_script_may_raise_whatever_it_likes(command: Command, worst: tuple[Path, Path, str]) -> None:
    part, script, where = worst
    status, _, said = command("run", part, "--plc", script)
    assert (status, where in said) == (2, True)


def test_a_script_of_its_own_process_may_too(
    capfd: pytest.CaptureFixture[str], worst: tuple[Path, Path, str]
) -> None:
    part, script, where = worst
    status = main(["run", str(part), "--set", f"plc.0.script={script}", "--set", "plc.0.process=true"])
    assert (status, where in capfd.readouterr().err) == (1, True)


@pytest.mark.parametrize("text", ["raise GeneratorExit\n", "import sys\nsys.exit(3)\n"])
def test_a_script_that_does_not_load_names_its_line(
    command: Command, tmp_path: Path, program: Path, text: str
) -> None:
    script = tmp_path / "gone.py"
    script.write_text(text, encoding="utf-8")
    line = text.count("\n")
    status, _, said = command("run", program, "--plc", script)
    assert (status, said.startswith(f"{script}:{line}: ")) == (2, True)


def test_escape_sequences_of_a_program_do_not_reach_the_terminal(command: Command, tmp_path: Path) -> None:
    part = tmp_path / "part.nc"
    part.write_text('N10 #MSG ["a\x1b[2J\x07b\x9b1m"]\nN20 M30\n', encoding="utf-8")
    result = tmp_path / "result.json"
    status, out, _ = command("run", part, "--result", result)
    assert (status, out) == (0, "a\\x1b[2J\\x07b\\x9b1m\n")
    assert json.loads(result.read_text(encoding="utf-8"))["messages"][0]["text"] == "a\x1b[2J\x07b\x9b1m"
    status, _, said = command("run", tmp_path / "a\x1b]0;owned\x07.nc")
    assert (status, "\x1b" in said, "\\x1b" in said) == (2, False, True)


def test_files_with_a_byte_order_mark_are_read(command: Command, tmp_path: Path) -> None:
    mark = b"\xef\xbb\xbf"
    part = tmp_path / "part.nc"
    part.write_bytes(mark + b"%main\nN10 M30\n")
    assert command("run", part)[0] == 0
    folder = tmp_path / "marked"
    command("machine", "copy", "demo", folder)
    for name in ("machine.toml", "z.lis"):
        (folder / name).write_bytes(mark + (folder / name).read_bytes())
    assert command("run", part, "--machine", folder)[0] == 0
    assert command("params", "check", folder / "z.lis")[0] == 0


# -- what was there before stays ---------------------------------------------------------------------------


def test_a_full_disk_leaves_the_earlier_result_whole(tmp_path: Path) -> None:
    place = tmp_path / "result.json"
    place.write_text("earlier", encoding="utf-8")
    code = (
        "import resource, sys; from pathlib import Path; from hli_bench.shells.whole_file import write_whole\n"
        "import signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)); write_whole(Path(sys.argv[1]), 'x' * 1000)\n"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code, str(place)], capture_output=True, text=True, check=False
    )
    assert "cannot be written: File too large" in ended.stderr
    assert place.read_text(encoding="utf-8") == "earlier"
    assert list(tmp_path.iterdir()) == [place]


def test_a_program_that_cannot_begin_leaves_the_earlier_result_whole(
    command: Command, tmp_path: Path
) -> None:
    for name in ("result.json", "report.html"):
        (tmp_path / name).write_text("earlier", encoding="utf-8")
    options = ("--result", tmp_path / "result.json", "--report", tmp_path / "report.html")
    assert command("run", "probe.nc", *options, "--set", "seed=x")[0] == 2
    for name in ("result.json", "report.html"):
        assert (tmp_path / name).read_text(encoding="utf-8") == "earlier"


def test_a_written_file_has_the_rights_that_any_new_file_has(tmp_path: Path) -> None:
    plain, whole = tmp_path / "plain", tmp_path / "whole"
    plain.touch()
    write_whole(whole, "text")
    assert whole.stat().st_mode == plain.stat().st_mode
    whole.chmod(0o640)
    write_whole(whole, "other")
    assert (whole.stat().st_mode & 0o777, whole.read_text(encoding="utf-8")) == (0o640, "other")


def test_a_link_to_a_result_stays_a_link(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_text("earlier", encoding="utf-8")
    link.symlink_to(target)
    write_whole(link, "new")
    assert (link.is_symlink(), target.read_text(encoding="utf-8")) == (True, "new")


def test_a_folder_that_has_gone_meanwhile_is_named(tmp_path: Path) -> None:
    with pytest.raises(EnvironmentLacks, match="cannot be written: No such file or directory"):
        write_whole(tmp_path / "gone" / "result.json", "text")


# -- signals in the first moments ---------------------------------------------------------------------------

EARLY = """
import os, sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == sys.argv[1]:
            os.kill(os.getpid(), int(sys.argv[2]))
sys.meta_path.insert(0, Finder())
sys.argv[1:] = [sys.argv[1], sys.argv[2], "--version"]
from hli_bench.start import main
sys.exit(main())
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("importing", ["hli_bench.cli.main", "argparse", "hli_bench.cli.trace"])
def test_a_signal_while_the_command_is_imported_ends_it_without_a_traceback(
    number: int, importing: str
) -> None:
    command = [sys.executable, "-c", EARLY, importing, str(int(number))]
    ended = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ})
    assert (ended.returncode, ended.stdout, ended.stderr) == (INTERRUPTED, "", "")


# -- lists of real machines ---------------------------------------------------------------------------------

REAL = """kenngr.messachse 1 ( measuring axis
kenngr.of_another_version 3
antr.fixed_stop.drive_ident[0].rd_ident # Leerstring
"""


def test_a_list_of_a_real_machine_is_taken_leniently_and_says_what_it_passed_over(
    command: Command, tmp_path: Path, program: Path
) -> None:
    folder = tmp_path / "mine"
    command("machine", "copy", "demo", folder)
    place = folder / "z.lis"
    lines = [
        line for line in place.read_text(encoding="utf-8").splitlines() if "kenngr.messachse" not in line
    ]
    place.write_text(REAL + "\n".join(lines), encoding="utf-8")
    status, _, said = command("run", program, "--machine", folder)
    assert status == 2
    assert f"{place}:1:1: kenngr.messachse: '1 ( measuring axis' is not valid" in said
    assert f"{place}:2:1: kenngr.of_another_version: unknown parameter" in said
    ignored = (
        "lenient: 2 things ignored: '( measuring axis' (line 1, behind the value); "
        "kenngr.of_another_version (line 2, unknown)"
    )
    status, _, said = command("run", program, "--machine", folder, "--lenient")
    assert (status, f"warning: {place}: {ignored}" in said) == (0, True)
    status, out, _ = command("params", "check", "--lenient", place)
    assert (status, f"{place}: warning: {ignored}\n" in out, out.endswith("parameters, accepted\n")) == (
        0,
        True,
        True,
    )
    toml = folder / "machine.toml"
    toml.write_text("lenient = true\n" + toml.read_text(encoding="utf-8"), encoding="utf-8")
    assert command("machine", "check", folder)[0] == 0
    assert command("run", program, "--machine", folder, "--set", "lenient=false")[0] == 2


def test_a_wrong_value_of_a_known_parameter_is_an_error_leniently_too(
    command: Command, tmp_path: Path
) -> None:
    path = tmp_path / "x.lis"
    path.write_text("kenngr.messachse 7\nkenngr.foo 1\n", encoding="utf-8")
    status, _, said = command("params", "check", "--lenient", path)
    assert (status, "kenngr.messachse: '7' is not valid" in said, "foo: unknown" in said) == (2, True, False)


# -- names without a unit that would be untrue --------------------------------------------------------------


def test_positions_of_rotary_axes_have_names_without_mm(tmp_path: Path) -> None:
    told = load(
        "demo", parse_set(["plant.probe.A.face=30", "plant.probe.A.material=above", "axis.A.start=5"])
    )
    assert told == load(
        "demo", parse_set(["plant.probe.A.face_mm=30", "plant.probe.A.material=above", "axis.A.start_mm=5"])
    )
    text = "[axis.X]\nstart = 1\nstart_mm = 2\n"
    (tmp_path / "machine.toml").write_text(text, encoding="utf-8")
    with pytest.raises(
        InputError, match=r"machine\.toml:3: axis\.X\.start_mm: the same as .* given in line 2"
    ):
        load(tmp_path)


def test_a_measured_value_says_its_unit(command: Command, tmp_path: Path) -> None:
    part, file = tmp_path / "part.nc", tmp_path / "result.json"
    part.write_text("N10 G90 G100 A90 F2000\nN20 M30\n", encoding="utf-8")
    options = ("plant.probe.A.face=30", "plant.probe.A.material=above", "channel.messtyp=1")
    words = [word for option in options for word in ("--set", option)]
    assert command("run", part, "--result", file, *words)[0] == 0
    (measured,) = json.loads(file.read_text(encoding="utf-8"))["measurements"]
    assert (measured["acs"], measured["unit"]) == (30.0, "deg")
    assert (measured["acs_mm"], measured["pcs_mm"]) == (measured["acs"], measured["pcs"])


# -- looking things up --------------------------------------------------------------------------------------


def test_what_is_looked_up_in_the_wrong_place_is_told_the_right_one(command: Command) -> None:
    assert command("params", "show", "70020")[2].endswith(
        "`hli-bench errors show 70020` looks among the messages\n"
    )
    assert "`hli-bench params find homing` lists" in command("params", "show", "homing")[2]
    status, out, _ = command("params", "find", "homing", "zero", "pulse")
    assert (status, "P-AXIS-" in out) == (0, True)
    assert command("params", "find", "nosuchword")[0] == 2
    status, out, _ = command("errors", "show", "P-ERR-70020", "50886")
    assert (status, out.splitlines()[0].split(), "\n\n" in out) == (0, ["number", "P-ERR-70020"], True)
    status, out, _ = command("errors", "find", "position", "lag")
    assert (status, "P-ERR-70020" in out) == (0, True)
    assert command("errors", "show", "1")[0] == 2
    assert command("errors", "find", "nosuchword")[0] == 2
