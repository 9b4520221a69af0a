"""`serve`, `plc`, `run --connect`, `hli` and `state` in processes, as a user runs them."""

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from threading import Event
from typing import Any

import pytest

UNIT = "ax/3/lr_mc_control/probing_signal"
SCRIPTS = Path(__file__).resolve().parents[2] / "plc_scripts"
PLAIN_PLC = Path(__file__).with_name("plain_zenoh_plc.py")
MEASURED = ["V.A.MESS.Z=298.000000"]


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_user_attaches_a_plc_probes_and_ends_it_all(serve: Any, probe: Path, pace: str) -> None:
    bench = serve("--plc", "none", "--pace", pace)
    plc = bench.plc(SCRIPTS / "demo.py")
    run = bench.run(probe)
    assert run.end() == 0, run.err
    assert run.out == MEASURED
    bench.command.interrupt()
    assert bench.command.end() == 0
    assert plc.end() == 0
    assert not bench.command.err
    assert not plc.err
    assert bench.command.nothing_left()
    assert plc.nothing_left()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_serve_and_plc_started_in_the_background_end_by_a_signal(
    start: Any, endpoint: str, number: int
) -> None:
    """A shell without job control lets them ignore SIGINT; they end by it all the same."""
    serve = start("serve", "--zenoh", endpoint, "--plc", "none", background=True)
    assert "is up" in serve.line()
    plc = start("plc", "demo.py", "--connect", endpoint, background=True)
    assert plc.line() == f"demo is attached to demo at {endpoint}, every 1000 us"
    for command in (plc, serve):
        command.process.send_signal(number)
        assert command.end() == 0, command.err
        assert command.nothing_left()


@pytest.mark.req("M-134", "M-235", "M-238")
@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_plc_made_of_zenoh_and_struct_alone_probes(
    start: Any, serve: Any, probe: Path, tmp_path: Path, result: Any, pace: str
) -> None:
    bench = serve("--plc", "none", "--pace", pace)
    # Isolated and in an empty folder: what it imports, it imports from the installed packages.
    plc = start(bench.endpoint, program=[sys.executable, "-I", PLAIN_PLC])
    before = len(bench.plcs())
    while plc.process.poll() is None and len(bench.plcs()) == before:
        pass
    run = bench.run(probe, "--result", tmp_path / "result.json")
    assert run.end() == 0, run.err
    assert run.out == MEASURED
    (measured,) = result()["measurements"]
    assert (measured["axis"], measured["source"], measured["acs_mm"]) == ("Z", "PLC_TIMESTAMP", 298.0)
    bench.command.interrupt()
    assert bench.command.end() == 0
    assert plc.end() == 0, plc.err


def test_the_plain_plc_imports_nothing_of_the_bench() -> None:
    lines = PLAIN_PLC.read_text(encoding="utf-8").splitlines()
    modules = {line.split()[1] for line in lines if line.startswith(("import ", "from "))}
    assert modules <= {"json", "struct", "sys", "queue", "typing", "zenoh"}


def test_elements_are_listed_read_set_and_watched(
    bench: Any, start: Any, do: Callable[..., list[str]]
) -> None:
    connect = ("--connect", bench.endpoint)
    listed = do("hli", "ls", "probing_signal", *connect)
    assert f"{UNIT}/command_w" in [line.split()[0] for line in listed]
    watch = start("hli", "watch", f"{UNIT}/command_w", *connect)
    assert watch.line() == "FALSE"
    for value in ("TRUE", "FALSE"):
        assert do("hli", "set", f"{UNIT}/command_w", value, *connect) == []
        assert do("hli", "get", "gpAx[3]^.lr_mc_control.probing_signal.command_w", *connect) == [value]
        assert watch.line() == value
    shown = dict(line.split() for line in do("hli", "get", UNIT, *connect))
    assert shown == {"request_r": "FALSE", "enable_w": "FALSE", "command_w": "FALSE", "state_r": "FALSE"}
    assert do("hli", "get", "io/probe/ch2/input", *connect) == ["FALSE"]
    watch.interrupt()
    assert watch.end() == 0


def test_what_the_cnc_sees_of_a_write_is_there_when_the_command_returns(
    bench: Any, do: Callable[..., list[str]]
) -> None:
    """state_r is the CNC's answer: it follows the command in the cycle that `set` waits for."""
    connect = ("--connect", bench.endpoint)
    for value in ("TRUE", "FALSE"):
        for path in ("ax/3/head/plc_present_w", f"{UNIT}/enable_w", f"{UNIT}/command_w"):
            do("hli", "set", path, value, *connect)
        assert do("hli", "get", f"{UNIT}/state_r", *connect) == [value]


def test_a_write_that_does_not_count_is_remarked(start: Any, serve: Any) -> None:
    bench = serve("--plc", "none", "--pace", "free")

    def said(path: str, value: str) -> list[str]:
        command = start("hli", "set", path, value, "--connect", bench.endpoint)
        assert (command.end(), command.out) == (0, [])
        return command.err

    absent = "does not count: ax/3/head/plc_present_w is FALSE"
    assert said(f"{UNIT}/enable_w", "TRUE") == [f"note: {UNIT}/enable_w {absent}"]
    assert said(f"{UNIT}/enable_w", "FALSE") == []
    assert said(f"{UNIT}/command_w", "TRUE") == [f"note: {UNIT}/command_w {absent}"]
    assert said("ax/3/head/plc_present_w", "TRUE") == []
    disabled = f"does not count: {UNIT}/enable_w is FALSE"
    assert said(f"{UNIT}/command_w", "FALSE") == [f"note: {UNIT}/command_w {disabled}"]
    assert said(f"{UNIT}/enable_w", "TRUE") == []
    assert said(f"{UNIT}/command_w", "TRUE") == []


def test_what_clients_write_during_a_run_is_in_its_trace(
    start: Any, endpoint: str, endless: Path, tmp_path: Path, do: Callable[..., list[str]], until: Any
) -> None:
    trace = tmp_path / "run.mcap"
    run = start("run", endless, "--pace", "real", "--zenoh", endpoint, "--trace", trace)
    position = "ax/3/lr_mc_control/probing_position/command_w"
    assert until(lambda: start("hli", "set", position, "5", "--connect", endpoint).end() == 0)
    do("hli", "set", f"{UNIT}/command_w", "TRUE", "--connect", endpoint, status=2)
    run.interrupt()
    assert run.end() == 130
    plc = [line.partition("plc ")[2].strip() for line in do("trace", "show", trace, "--channel", "plc")]
    assert [line for line in plc if line.startswith("client: ")] == [f"client: {position} = 5"]
    (refused,) = do("trace", "show", trace, "--channel", "refused")
    assert refused.endswith(f" client: {UNIT}/command_w: the unit belongs to PLC 'demo'")


@pytest.mark.req("M-237")
@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        (f"{UNIT}/state_r", "TRUE", "a client may only read it"),
        (f"{UNIT}/command_w", "7", "BOOL"),
        ("ax/3/lr_mc_control/probing_sgnal/command_w", "TRUE", "probing_sgnal"),
        ("io/probe/ch2/input", "TRUE", "is an input"),
    ],
)
def test_what_cannot_be_set_is_bad_input(
    bench: Any, do: Callable[..., list[str]], path: str, value: str, reason: str
) -> None:
    (said,) = do("hli", "set", path, value, "--connect", bench.endpoint, status=2)
    assert reason in said


def test_state_shows_axes_drives_terminals_and_plcs(serve: Any, do: Callable[..., list[str]]) -> None:
    bench = serve("--pace", "free")
    shown = "\n".join(do("state", "--connect", bench.endpoint))
    assert " 0x0237\n" in shown
    assert "ch2/input: FALSE" in shown
    assert "held_by: none" in shown
    for name in ("X2", "operation enabled", "probe", "cams", "late_cycles"):
        assert name in shown
    state = bench.state()
    assert [axis["name"] for axis in state["axes"]] == ["X", "Y", "Z", "X2", "A", "B", "S"]
    assert {axis["drive"] for axis in state["axes"]} == {"operation enabled"}
    assert state["axes"][2]["actual_mm"] == 300.0
    assert [plc["name"] for plc in state["plcs"]] == ["demo"]
    assert state["state"] == "ready"


def test_ctrl_c_in_a_program_ends_bench_plc_and_run(serve: Any, endless: Path) -> None:
    bench = serve("--plc", "none", "--pace", "real")
    plc, run = bench.plc(), bench.run(endless)
    assert bench.running()
    bench.command.interrupt()
    assert bench.command.end() == 0, bench.command.err
    assert plc.end() == 0
    assert run.end() == 3
    assert run.err[-1].startswith("the bench at")
    for command in (bench.command, plc, run):
        assert command.nothing_left()


def test_ctrl_c_of_run_ends_the_program_and_leaves_the_bench_up(
    serve: Any, endless: Path, tmp_path: Path, result: Any
) -> None:
    bench = serve("--pace", "real")
    run = bench.run(endless, "--result", tmp_path / "result.json")
    assert bench.running()
    run.interrupt()
    assert run.end() == 130
    assert run.err[0] == f"stopped: the bench at {bench.endpoint} has aborted {endless} and stays up"
    assert run.err[1].startswith(f"{endless}: aborted, ")
    assert result()["status"] == "aborted"
    assert bench.state()["state"] == "ready"


def test_a_second_program_is_refused_while_one_runs(
    serve: Any, endless: Path, do: Callable[..., list[str]]
) -> None:
    bench = serve("--pace", "real")
    bench.run(endless)
    assert bench.running()
    assert do("run", endless, "--connect", bench.endpoint, status=2) == [
        "a program is running; a CNC reset aborts it (hli-bench reset)"
    ]


def test_a_reset_aborts_a_program(serve: Any, endless: Path, do: Callable[..., list[str]]) -> None:
    bench = serve("--pace", "real")
    run = bench.run(endless)
    assert bench.running()
    assert do("reset", "--connect", bench.endpoint) == []
    assert bench.state()["state"] == "ready"
    assert run.end() == 130


def test_a_bench_that_stands_for_a_while_loses_no_client(serve: Any, program: Callable[[str], Path]) -> None:
    """Longer than a PLC may be silent: a computer that was suspended must not cost the result."""
    bench = serve("--plc", "none", "--pace", "real")
    run = bench.run(program('N10 G01 G90 Z280 F600\nN20 #MSG SYN["there"]\nN30 M30\n'))
    assert bench.running()
    os.kill(bench.command.process.pid, signal.SIGSTOP)
    Event().wait(1.5)
    os.kill(bench.command.process.pid, signal.SIGCONT)
    assert run.end() == 0, run.err
    assert run.out == ["there"]


def test_bad_input_in_a_program_is_told_by_file_and_line(
    bench: Any, program: Callable[[str], Path], probe: Path, do: Callable[..., list[str]]
) -> None:
    bad = program("N10 G01 G90 Z299 F6000\nN20 G01 Q7\nN30 M30\n")
    said = do("run", bad, "--connect", bench.endpoint, status=2)
    assert "short.nc:2:" in said[-1]
    assert do("run", program("N10 G01 G90 Z299 F6000\nN30 M30\n"), "--connect", bench.endpoint) == []


def test_workers_and_plc_of_a_killed_bench_end(serve: Any) -> None:
    bench = serve("--set", "plc.0.process=true")
    assert len(bench.command.session()) == 4
    os.kill(bench.command.process.pid, signal.SIGKILL)
    assert bench.command.nothing_left()


def test_a_worker_that_dies_ends_the_bench(serve: Any) -> None:
    bench = serve("--pace", "real")
    worker = next(pid for pid in bench.command.session() if _runs(pid, "hli_bench.bench.drives_process"))
    os.kill(worker, signal.SIGKILL)
    assert bench.command.end() == 3
    assert bench.command.err == ["process hli_bench.bench.drives_process has ended with status -9"]
    assert bench.command.nothing_left()


@pytest.mark.parametrize("pace", ["free", "real"])
def test_modules_in_the_current_directory_are_none_of_the_bench(
    serve: Any, probe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pace: str
) -> None:
    """But a script finds what lies beside it."""
    for name in ("can", "zenoh", "numpy", "json", "runpy"):
        (tmp_path / f"{name}.py").write_text("raise RuntimeError('a file of the user')\n")
    (tmp_path / "beside.py").write_text((SCRIPTS / "demo.py").read_text())
    (tmp_path / "mine.py").write_text("import beside\n\nclass Mine(beside.Demo):\n    pass\n")
    monkeypatch.chdir(tmp_path)
    own = ("--set", f"plc.0.script={tmp_path / 'mine.py'}", "--set", "plc.0.process=true")
    bench = serve("--pace", pace, *own)
    run = bench.run(probe)
    assert run.end() == 0, (run.err, bench.command.err)
    assert run.out == MEASURED
    assert bench.plcs() == ["mine"]
    bench.command.interrupt()
    assert bench.command.end() == 0
    assert not bench.command.err


def _runs(pid: int, module: str) -> bool:
    return module.encode() in Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")


def test_a_port_in_use(bench: Any, start: Any) -> None:
    second = start("serve", "--zenoh", bench.endpoint)
    assert second.end() == 3
    assert bench.endpoint in second.err[-1]
    assert second.nothing_left()


@pytest.mark.parametrize("command", [("hli", "ls"), ("state",), ("plc", "demo.py"), ("run", "meas1.nc")])
def test_nobody_listens(command: tuple[str, ...], endpoint: str, do: Callable[..., list[str]]) -> None:
    (said,) = do(*command, "--connect", endpoint, status=3)
    assert said.startswith(f"no bench listens on {endpoint}")
    assert "hli-bench serve" in said
