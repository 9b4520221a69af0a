"""Bad input as a user meets it: what the command line says, where it points, and how it ends."""

import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from hli_bench.base.endpoints import endpoint
from hli_bench.base.loading import data_file
from hli_bench.cli.main import main
from hli_bench.shells.zenoh_client import HliClient

UNIT = "ax/3/lr_mc_control/probing_signal"
Ended = tuple[int, str, str]
Command = Callable[..., Ended]

DRIVE_WITHOUT_EDS = """
from types import SimpleNamespace
from hli_bench_drives.cia402 import drive
from hli_bench.base.loading import data_file

MODEL = SimpleNamespace(eds="nowhere.eds")

def create(name, node_id, row, options):
    return drive.create(name, node_id, data_file("eds", MODEL.eds), row, options)
"""


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Command:
    """Runs a command line in this process: (exit status, standard output, standard error)."""

    def run(*arguments: object) -> Ended:
        status = main([str(argument) for argument in arguments])
        said = capsys.readouterr()
        return status, said.out, said.err

    return run


def program(folder: Path, *blocks: str) -> Path:
    path = folder / "part.nc"
    path.write_text("\n".join(blocks) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("plnt.seed=3", "--set: plnt.seed: unknown key; `hli-bench machine schema` lists them\n"),
        ("sed=3", "--set: sed: unknown key (did you mean seed?); `hli-bench machine schema` lists them\n"),
        ("seed=-3", "--set: seed: -3 is not valid, expected integer 0..4294967295\n"),
        ("seed", "--set: 'seed': expected KEY=VALUE, e.g. plant.probe.Z.face_mm=100\n"),
        (
            "axis.Z.kenngr.measure.signl=PLC",
            "--set: axis.Z.kenngr.measure.signl: unknown parameter (did you mean kenngr.measure.signal?)\n",
        ),
        (
            "axis.Z.kenngr.measure.input=256",
            "--set: axis.Z.kenngr.measure.input: 256 is out of range 0..255 (P-AXIS-00517)\n",
        ),
        (
            "axis.Z.kenngr.measure.edge=UP",
            "--set: axis.Z.kenngr.measure.edge: 'UP' is not valid, expected (empty), POS, NEG (P-AXIS-00518)\n",
        ),
        (
            "axis.Q.start_mm=1",
            "--set: axis.Q.start_mm: 'Q' is not an axis of this machine (X, Y, Z, X2, A, B, S)\n",
        ),
        ("plant.probe.Z.face_mm=1", "--set: plant.probe.Z.face_mm: needs plant.probe.Z.material as well\n"),
    ],
)
def test_a_bad_setting_is_named_with_its_key_and_what_is_permitted(
    command: Command, setting: str, message: str
) -> None:
    assert command("run", "probe.nc", "--set", setting) == (2, "", message)


def test_all_bad_settings_are_named_at_once(command: Command) -> None:
    status, _, said = command("run", "probe.nc", "--set", "seed=x", "--set", "cycle_us=7")
    assert status == 2
    assert {line.split(": ")[1] for line in said.splitlines()} == {"seed", "cycle_us"}


def test_an_unknown_parameter_and_a_value_out_of_range_in_a_list_are_named_by_line(
    command: Command, tmp_path: Path
) -> None:
    folder = tmp_path / "cell"
    folder.mkdir()
    (folder / "machine.toml").write_text('[axis.Z]\nlist = "z.lis"\n', encoding="utf-8")
    path = folder / "z.lis"
    path.write_text("kopf.achs_nr 1\nkenngr.mesachse 1\n\nkenngr.measure.input 256\n", encoding="utf-8")
    wrong = [
        (2, "kenngr.mesachse: unknown parameter (did you mean kenngr.messachse?)"),
        (4, "kenngr.measure.input: 256 is out of range 0..255 (P-AXIS-00517)"),
    ]
    status, _, said = command("run", "probe.nc", "--machine", folder)
    assert status == 2
    for (line, text), told in zip(wrong, said.splitlines(), strict=True):
        assert told.startswith(f"{path}:{line}:")
        assert told.endswith(text)
    status, _, said = command("params", "check", path)
    assert (status, said) == (2, "".join(f"{path}:{line}: error: {text}\n" for line, text in wrong))


def test_an_unknown_word_is_named_with_file_line_and_column(command: Command, tmp_path: Path) -> None:
    path = program(tmp_path, "N10 G90 G01 Z299 F6000", "N20 G999 Z1", "N30 M30")
    result = tmp_path / "result.json"
    status, out, said = command("run", path, "--result", result)
    assert (status, out) == (2, "")
    assert said.startswith(f"{path}:2:5: expected ")
    assert said.endswith("found 'G999'\n")
    assert not result.exists()


def test_what_is_no_file_is_not_run(command: Command, tmp_path: Path) -> None:
    missing = tmp_path / "nothing.nc"
    assert command("run", missing) == (2, "", f"{missing}: no such file, nor one of programs/\n")
    assert command("run", tmp_path) == (2, "", f"{tmp_path}: is a folder, expected a file\n")


def test_an_unknown_machine_is_named(command: Command, tmp_path: Path) -> None:
    message = "--machine: 'demos' is neither a machine of the package nor a folder with machine.toml\n"
    assert command("run", "probe.nc", "--machine", "demos") == (2, "", message)
    assert command("machine", "check", tmp_path) == (2, "", f"{tmp_path}: no machine.toml there\n")


def test_a_folder_that_is_no_machine_hides_none_of_the_package(
    command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("demo", "mine"):
        (tmp_path / name).mkdir()
    assert command("machine", "check", "demo")[0] == 0
    assert command("machine", "check", "mine") == (2, "", "mine: no machine.toml there\n")
    assert command("machine", "check", "..") == (2, "", "..: no machine.toml there\n")


def test_a_missing_eds_is_named(command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "drive_without_eds.py").write_text(DRIVE_WITHOUT_EDS, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    drive = "axis.Z.drive=drive_without_eds"
    status, _, said = command("run", "probe.nc", "--set", drive)
    assert (status, said) == (2, "axis.Z.drive: no 'nowhere.eds' in eds/\n")
    status, _, said = command("machine", "check", "demo", "--set", drive)
    assert (status, said) == (2, "axis.Z.drive: no 'nowhere.eds' in eds/\n")


def test_a_drive_model_is_the_same_to_run_and_to_machine_check(
    command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    eds = data_file("eds", "servo402.eds").read_text(encoding="latin-1")
    (tmp_path / "poor.eds").write_text(
        eds.replace("[6041]", "[2FFF]").replace("=0x6041\n", "=0x2FFF\n"), "latin-1"
    )
    (tmp_path / "no_drive.py").write_text("")
    (tmp_path / "poor_drive.py").write_text(
        DRIVE_WITHOUT_EDS.replace("nowhere.eds", str(tmp_path / "poor.eds"))
    )
    (tmp_path / "plain_drive.py").write_text("from hli_bench_drives.models.servo402 import create\n")
    (tmp_path / "failing_drive.py").write_text("\n1 / 0\n")
    monkeypatch.syspath_prepend(tmp_path)
    empty = program(tmp_path, "N10 M30")
    for words in (("run", empty), ("machine", "check", "demo")):
        status, _, said = command(*words, "--set", "axis.Z.drive=no_drive")
        assert (status, said) == (2, "axis.Z.drive: 'no_drive' is no drive model, it has no create()\n")
        status, _, said = command(*words, "--set", "axis.Z.drive=poor_drive")
        assert (status, said.endswith("poor.eds: a CiA 402 drive needs the objects 6041:00\n")) == (2, True)
        status, _, said = command(*words, "--set", "axis.Z.drive=failing_drive")
        place = f"{tmp_path / 'failing_drive.py'}:2"
        assert (status, said) == (2, f"axis.Z.drive: {place}: ZeroDivisionError: division by zero\n")
        assert command(*words, "--set", "axis.Z.drive=plain_drive")[0] == 0


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["fault.0.value=2"], "fault[0].value: 2 is no level of a stuck probe, 0 or 1 expected"),
        (["fault.0.value=-1"], "fault[0].value: -1 is no level of a stuck probe, 0 or 1 expected"),
        (["fault.0.when=x", "axis.Z.begin=3"], "axis.Z.begin: "),
        (["fault.0.when=x"], "NotEmulated: --set: fault[0].when: faults at a condition"),
        (["dc_epoch=2400-01-01"], "dc_epoch: "),
    ],
)
def test_values_that_no_bench_can_take(command: Command, settings: list[str], message: str) -> None:
    options = [word for one in ("fault.0.kind=probe_stuck", *settings) for word in ("--set", one)]
    status, _, said = command("machine", "check", "demo", *options)
    assert status == 2
    assert message in said


def test_what_a_run_does_not_use_is_named_in_one_remark(command: Command, tmp_path: Path) -> None:
    path = program(tmp_path, "N10 G01 X10 F1000", "N20 M30")
    unused = ("axis.X.kenngr.max_vb_override=7", "axis.Y.getriebe[0].slope_profil.a_feedh=9")
    options = [word for one in (*unused, "axis.X.kenngr.vb_messen=9000") for word in ("--set", one)]
    status, _, said = command("run", path, *options)
    assert status == 0
    assert [line for line in said.splitlines() if line.startswith("note: given")] == [
        (
            "note: given, and nothing in this bench uses it: axis.X.kenngr.max_vb_override (--set), "
            "axis.Y.getriebe[0].slope_profil.a_feedh (--set)"
        )
    ]


@pytest.mark.parametrize("words", [("run",), ("machine", "check", "demo")])
def test_a_drive_type_that_is_not_built_ends_before_the_run(
    command: Command, tmp_path: Path, words: tuple[str, ...]
) -> None:
    given = [program(tmp_path, "N10 G100 X10 F1000", "N20 M30")] if words == ("run",) else []
    status, out, said = command(*words, *given, "--set", "axis.X.kenngr.antr_typ=2")
    assert (status, out) == (2, "")
    assert said == (
        "NotEmulated: --set: axis.X: P-AXIS-00020: kenngr.antr_typ = 2 (SERCOS) is not emulated\n"
    )


def test_an_axis_that_does_not_measure_stops_the_program(command: Command, tmp_path: Path) -> None:
    path = program(tmp_path, "N10 #MEAS MODE[1]", "N20 G100 B10 F100", "N30 M30")
    status, out, said = command("run", path, "--set", "axis.B.kenngr.messachse=0")
    assert (status, out) == (1, "")
    assert said.splitlines()[0] == "P-ERR-50059 [B] N20: axis 6 is not a measurement axis (P-AXIS-00118)"


def test_two_plcs_that_write_one_unit_are_named(command: Command, tmp_path: Path) -> None:
    second = tmp_path / "second.py"
    second.write_text(
        "class Second:\n    period_us = 1000\n\n    def cycle(self, hli, io):\n"
        "        hli.ax[3].lr_mc_control.probing_signal.enable_w = True\n",
        encoding="utf-8",
    )
    status, _, said = command("run", "probe.nc", "--plc", "demo.py", "--plc", second)
    assert status == 2
    assert said.startswith("plc second: ax/3/lr_mc_control/probing_signal/enable_w: ")
    assert "demo" in said


def test_an_unknown_plc_script_is_named(command: Command) -> None:
    assert command("run", "probe.nc", "--plc", "nix.py") == (
        2,
        "",
        "nix.py: no such file, nor one of plc_scripts/\n",
    )
    status, _, said = command("run", "probe.nc", "--plc", "none", "--plc", "demo.py")
    assert (status, said) == (2, "--plc: none stands for itself, not beside a script\n")


@pytest.mark.parametrize("option", ["--result", "--trace", "--report", "--can-log"])
def test_a_file_that_cannot_be_written_is_named_before_the_run(
    command: Command, tmp_path: Path, option: str
) -> None:
    file = tmp_path / "missing" / "file"
    message = f"{file}: {option}: cannot be written: No such file or directory\n"
    assert command("run", "probe.nc", option, file) == (2, "", message)


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "probe.nc", "--modbus", "127.0.0.1:5020"),
        ("run", "probe.nc", "--can", "socketcand:127.0.0.1:29536"),
        ("machine", "check", "demo", "--modbus"),
        ("scope",),
        ("inject", "--list"),
        ("clear",),
    ],
)
def test_what_is_not_built_says_so(command: Command, arguments: tuple[str, ...]) -> None:
    status, out, said = command(*arguments)
    assert (status, out) == (2, "")
    assert said.startswith("NotEmulated: ")


def test_a_bus_of_another_form_is_named(command: Command, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command("run", "probe.nc", "--can", "vcan0")
    assert ended.value.code == 2
    expected = "'vcan0': expected inproc, socketcan:INTERFACE or socketcand:HOST:PORT"
    assert expected in capsys.readouterr().err


@pytest.mark.parametrize(
    "given",
    ["foo", "", "127.0.0.1:7447", "tcp/127.0.0.1", "tcp/:7447", "tcp/127.0.0.1:65536", "carrier/me:1"],
)
def test_an_endpoint_of_another_form_is_named(
    command: Command, capsys: pytest.CaptureFixture[str], given: str
) -> None:
    for arguments in (
        *(("serve", "--zenoh"), ("run", "probe.nc", "--zenoh")),
        *(("run", "probe.nc", "--connect"), ("state", "--connect"), ("plc", "probing.py", "--connect")),
    ):
        with pytest.raises(SystemExit) as ended:
            command(*arguments, given)
        assert ended.value.code == 2
        expected = (
            f"argument {arguments[-1]}: {given!r}: expected PROTOCOL/HOST:PORT, e.g. tcp/127.0.0.1:7447"
        )
        assert expected in capsys.readouterr().err


@pytest.mark.parametrize(
    "given",
    [
        "tcp/[::1]:7447",
        "udp/bench.local:1",
        "ws/0.0.0.0:65535",
        "unixsock-stream//run/bench",
        "tcp/a:1?rel=1#iface=lo",
    ],
)
def test_whatever_zenoh_takes_is_an_endpoint(given: str) -> None:
    assert endpoint(given) == given


# -- over the net -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def served() -> Iterator[str]:
    """The endpoint of a bench that is up; at the end it is left with Ctrl-C."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        endpoint = f"tcp/127.0.0.1:{listener.getsockname()[1]}"
    arguments = [sys.executable, "-m", "hli_bench.cli.main", "serve", "--pace", "free", "--plc", "none"]
    bench = subprocess.Popen([*arguments, "--zenoh", endpoint], stdout=subprocess.PIPE, text=True)
    assert bench.stdout is not None
    try:
        assert bench.stdout.readline().startswith(f"demo is up on {endpoint}")
        yield endpoint
    finally:
        bench.send_signal(signal.SIGINT)
        bench.stdout.close()
        ended = bench.wait(30)
    assert ended == 0


def test_a_wrong_size_is_refused_counted_and_reported(served: str) -> None:
    with HliClient(served) as client:
        before = client.hli_errors()["refused"]
        client.session.put(f"demo/hli/unit/{UNIT}/command_w", b"\x01\x00")
        # A look may be answered in front of a write that waits for the next cycle, but not each of many.
        errors = next(look for _ in range(100) if (look := client.hli_errors())["refused"] > before)
        assert errors["refused"] == before + 1
        assert errors["last"][-1]["path"] == f"{UNIT}/command_w"
        assert "2 bytes" in errors["last"][-1]["reason"]
        assert client.get(f"{UNIT}/command_w") is False


def test_a_write_that_is_refused_is_named(command: Command, served: str) -> None:
    state = f"{UNIT}/state_r"
    status, _, said = command("hli", "set", state, "TRUE", "--connect", served)
    assert (status, said) == (2, f"{state}: written by the CNC, a client may only read it\n")
    status, _, said = command("hli", "set", f"{UNIT}/command_w", "maybe", "--connect", served)
    assert status == 2
    assert said.startswith(f"{UNIT}/command_w: ")
    status, _, said = command("hli", "get", "ax/3/nothing", "--connect", served)
    assert (status, said) == (2, "no HLI element 'ax/3/nothing'\n")


def test_options_that_make_a_bench_do_not_fit_one_that_is_up(command: Command, served: str) -> None:
    status, _, said = command("run", "probe.nc", "--connect", served, "--set", "seed=3")
    assert (status, said) == (2, "--connect: --set cannot be chosen for a bench that is up already\n")


def test_a_port_in_use_is_named(command: Command, served: str) -> None:
    status, _, said = command("run", "probe.nc", "--zenoh", served)
    assert status == 3
    assert said.startswith(f"Zenoh cannot listen on {served} (")
    assert "--zenoh tcp/127.0.0.1:PORT" in said


def test_nobody_at_the_endpoint_is_named(command: Command) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        nobody = f"tcp/127.0.0.1:{listener.getsockname()[1]}"
    for arguments in (("state",), ("hli", "ls"), ("plc", "probing.py"), ("run", "probe.nc")):
        status, _, said = command(*arguments, "--connect", nobody)
        assert status == 3
        assert said.startswith(f"no bench listens on {nobody} (")
