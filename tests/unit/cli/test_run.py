"""`run` on a bench of its own and on one that is up, and the commands that look at that one."""

import json
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from hli_bench.cli.main import main

FACE = ("--set", "plant.probe.Z.face_mm=100", "--set", "plant.probe.Z.material=below")
RESULT_KEYS = {
    *("program", "status", "messages", "errors", "variables", "measurements", "homing"),
    *("sim_s", "wall_s", "cycles"),
}
KEYS_OF = {
    "messages": {"block", "text"},
    "errors": {"id", "severity", "axis", "block", "text", "values"},
    "measurements": {"axis", "block", "source", "acs_mm", "pcs_mm", "dc_ns", "edge", "acs", "pcs", "unit"},
}
MEASURED = ["V.A.MESS.Z=100.000000", "V.A.MOFFS.Z=80.000000", "V.A.MERF.Z=1", "V.A.ABS.Z=110.000000"]
NEAR = """N10 #MEAS MODE[1]
N20 G90 G100 Z280 F6000
N30 #MSG SYN["V.A.MESS.Z=%f", V.A.MESS.Z]
N40 M30
"""
COMMAND = [sys.executable, "-m", "hli_bench.cli.main"]


def read_result(path: Path) -> Any:
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--trace", "own.nc"], "own.nc: --trace: is read by this run"),
        (["--result", "./own.nc"], "own.nc: --result: is read by this run"),
        (["--plc", "own.py", "--can-log", "own.py"], "own.py: --can-log: is read by this run"),
        (["--set", "plc.0.script=own.py", "--result", "own.py"], "own.py: --result: is read by this run"),
        (["--machine", ".", "--trace", "machine.toml"], "machine.toml: --trace: is read by this run"),
        (["--result", "x", "--report", "./x"], "x: --report: is given to --result too"),
    ],
)
def test_no_file_of_a_run_is_written_over(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    options: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    texts = {
        "own.nc": NEAR,
        "own.py": "class Own:\n    def cycle(self, hli, io): ...\n",
        "machine.toml": "[axis.X]\nstart_mm = 0\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    assert main(["run", "own.nc", *options]) == 2
    assert capsys.readouterr().err == f"{said}\n"
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == texts


def test_what_an_earlier_run_left_in_the_machine_folder_is_written_over(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "own.nc").write_text("N10 M30\n")
    (tmp_path / "machine.toml").write_text("[axis.X]\nstart_mm = 0\nkopf.achs_nr = 1\n")
    for _ in range(2):
        options = [f"--result={tmp_path}/r.json", f"--trace={tmp_path}/t.mcap", "--machine", str(tmp_path)]
        assert main(["run", str(tmp_path / "own.nc"), *options]) == 0, capsys.readouterr().err


@pytest.mark.parametrize(
    ("redirected", "status", "said"),
    [
        (">&-", 0, "completed"),
        (">/dev/full", 3, "standard output: cannot be written: No space left on device"),
        (">/dev/full 2>/dev/full", 3, ""),
        ("2>/dev/full", 3, None),
        ("2>&-", 0, None),
    ],
)
def test_standard_streams_that_are_closed_or_full(
    tmp_path: Path, redirected: str, status: int, said: str
) -> None:
    (tmp_path / "near.nc").write_text(NEAR)
    line = " ".join([*COMMAND, "run", str(tmp_path / "near.nc"), *FACE, redirected])
    ended = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=False)
    assert ended.returncode == status
    assert "Traceback" not in ended.stderr
    if said is None:
        assert ended.stdout == "V.A.MESS.Z=0.000000\n"
    else:
        assert said in ended.stderr


def test_messages_are_all_of_standard_output(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    names = {"result": "r.json", "report": "r.html", "trace": "r.mcap", "can-log": "can.log"}
    files = {option: tmp_path / name for option, name in names.items()}
    for file in files.values():
        file.write_text("of an earlier run", encoding="utf-8")
    options = [text for option, file in files.items() for text in (f"--{option}", str(file))]
    assert main(["run", "probe.nc", *FACE, *options]) == 0
    said = capsys.readouterr()
    assert said.out.splitlines() == MEASURED
    assert "completed" in said.err
    result = read_result(files["result"])
    assert set(result) == RESULT_KEYS
    assert result["status"] == "completed"
    assert [message["text"] for message in result["messages"]] == MEASURED
    for name in ("messages", "measurements"):
        assert result[name]
        assert all(set(one) == KEYS_OF[name] for one in result[name])
    assert result["variables"]["V.A.MESS.Z"] == 100.0
    assert "<svg" in files["report"].read_text(encoding="utf-8")
    assert files["trace"].read_bytes().startswith(b"\x89MCAP0\r\n")
    assert files["can-log"].read_text(encoding="ascii").startswith("(1767225600.000000) can0 ")


def test_an_error_of_the_cnc_ends_with_1(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    program, file = tmp_path / "far.nc", tmp_path / "r.json"
    program.write_text("N10 G90 G01 Z2000 F60000\nN20 M30\n", encoding="utf-8")
    assert main(["run", str(program), "--result", str(file)]) == 1
    said = capsys.readouterr()
    assert said.out == ""
    result = read_result(file)
    assert result["status"] == "error"
    (error,) = result["errors"]
    assert set(error) == KEYS_OF["errors"]
    assert said.err.splitlines()[0] == f"P-ERR-{error['id']} [Z] N10: {error['text']}"


def test_the_name_of_a_supplied_program_and_script_will_do(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "probe.nc", *FACE, "--plc", "probing.py"]) == 0
    assert capsys.readouterr().out.splitlines() == MEASURED


def test_a_limit_of_machine_time_ends_with_1(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    program, file = tmp_path / "slow.nc", tmp_path / "r.json"
    program.write_text("N20 G90 G01 Z290 F1\nN30 M30\n", encoding="utf-8")
    assert main(["run", str(program), "--limit", "1.5", "--result", str(file)]) == 1
    assert "--limit: not done after 1.5 s of machine time" in capsys.readouterr().err
    assert (read_result(file)["status"], read_result(file)["cycles"]) == ("aborted", 1500)
    program.write_text("N30 M30\n", encoding="utf-8")
    assert main(["run", str(program), "--limit", "1.5"]) == 0


@pytest.mark.parametrize("given", ["0", "-1", "nan", "inf", "soon"])
def test_a_limit_is_seconds_above_0(capsys: pytest.CaptureFixture[str], given: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["run", "probe.nc", f"--limit={given}"])
    assert ended.value.code == 2
    assert f"{given!r}: expected seconds above 0" in capsys.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_aborts_and_still_writes_the_result(tmp_path: Path, number: int) -> None:
    program, file = tmp_path / "slow.nc", tmp_path / "r.json"
    program.write_text('N10 #MSG SYN["started"]\nN20 G90 G01 Z290 F1\nN30 M30\n', encoding="utf-8")
    running = subprocess.Popen(
        [*COMMAND, "run", str(program), "--pace", "real", "--result", str(file)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # As a shell without job control starts it with `&`.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN),  # noqa: PLW1509 - allocates nothing
    )
    assert running.stdout is not None
    assert running.stdout.readline() == "started\n"
    running.send_signal(number)
    out, said = running.communicate(timeout=30)
    assert (running.returncode, out) == (130, "")
    assert "aborted" in said
    result = read_result(file)
    assert set(result) == RESULT_KEYS | {"late_cycles", "worst_lateness_us", "lateness_histogram", "plcs"}
    assert result["status"] == "aborted"
    assert [message["text"] for message in result["messages"]] == ["started"]


# -- a bench that is up -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def served() -> Iterator[str]:
    """The endpoint of a bench in free pace that is up, without a PLC."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        endpoint = f"tcp/127.0.0.1:{listener.getsockname()[1]}"
    near = ("--set", "plant.probe.Z.face_mm=298", "--set", "plant.probe.Z.material=below")
    options = ["--pace", "free", "--plc", "none", "--zenoh", endpoint, *near]
    bench = subprocess.Popen([*COMMAND, "serve", *options], stdout=subprocess.PIPE, text=True)
    assert bench.stdout is not None
    try:
        assert endpoint in bench.stdout.readline()
        yield endpoint
    finally:
        bench.send_signal(signal.SIGINT)
        bench.stdout.close()
        ended = bench.wait(30)
    assert ended == 0


def ask(capsys: pytest.CaptureFixture[str], endpoint: str, *arguments: str) -> list[str]:
    assert main([*arguments, "--connect", endpoint]) == 0
    return capsys.readouterr().out.splitlines()


def test_elements_are_listed_with_type_and_unit(capsys: pytest.CaptureFixture[str], served: str) -> None:
    lines = ask(capsys, served, "hli", "ls", "ax/3/lr_mc_control/probing_position")
    assert lines[0].split() == ["PATH", "TYPE", "UNIT", "ACCESS"]
    assert ["SGN32", "0.1", "µm", "w"] in [line.split()[1:] for line in lines]


def test_what_is_set_is_there_when_the_command_is_done(
    capsys: pytest.CaptureFixture[str], served: str
) -> None:
    unit = "gpAx[2]^.lr_mc_control.probing_position"
    assert ask(capsys, served, "hli", "set", f"{unit}.command_w", "-125") == []
    assert ask(capsys, served, "hli", "get", f"{unit}.command_w") == ["-125"]
    members = dict(line.split() for line in ask(capsys, served, "hli", "get", unit))
    assert members["command_w"] == "-125"
    assert members["enable_w"] == "FALSE"


def test_the_state_shows_axes_and_drives(capsys: pytest.CaptureFixture[str], served: str) -> None:
    lines = ask(capsys, served, "state")
    assert "machine: demo" in lines
    state = json.loads("\n".join(ask(capsys, served, "state", "--json")))
    assert state["machine"] == "demo"
    (told,) = [axis for axis in state["axes"] if axis["name"] == "Z"]
    (z,) = [line.split() for line in lines if line.strip().startswith("Z ")]
    assert z[:3] == ["Z", "3", str(told["command_mm"])]
    assert 0.0 < told["command_mm"] <= 300.0  # where the machine starts, or where other tests have moved it
    assert told["drive"].split()[0] in z


def test_a_watch_prints_each_change(capsys: pytest.CaptureFixture[str], served: str) -> None:
    member = "ax/4/lr_mc_control/probing_position/command_w"
    watch = subprocess.Popen(
        [*COMMAND, "hli", "watch", member, "--connect", served], stdout=subprocess.PIPE, text=True
    )
    assert watch.stdout is not None
    with watch.stdout as lines:
        assert lines.readline() == "0\n"
        ask(capsys, served, "hli", "set", member, "77")
        assert lines.readline() == "77\n"
        watch.send_signal(signal.SIGINT)
        assert watch.wait(30) == 0


def test_a_program_runs_on_the_bench_that_is_up_with_an_attached_script(
    capsys: pytest.CaptureFixture[str], served: str, tmp_path: Path
) -> None:
    script = subprocess.Popen([*COMMAND, "plc", "probing.py", "--connect", served])
    try:
        looks = (json.loads("\n".join(ask(capsys, served, "state", "--json"))) for _ in range(100))
        assert next(look["plcs"][0]["name"] for look in looks if look["plcs"]) == "probing"
        program, file = tmp_path / "near.nc", tmp_path / "r.json"
        program.write_text(NEAR, encoding="utf-8")
        lines = ask(capsys, served, "run", str(program), "--result", str(file))
        assert lines == ["V.A.MESS.Z=298.000000"]
        assert set(read_result(file)) == RESULT_KEYS
    finally:
        script.send_signal(signal.SIGINT)
        ended = script.wait(30)
    assert ended == 0
