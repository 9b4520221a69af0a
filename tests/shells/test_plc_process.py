"""What a PLC of its own may do to a bench: die, freeze, quarrel with another, write nonsense."""

import json
import os
import re
import signal
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from time import sleep
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.base.errors import BenchError, EnvironmentLacks, InputError, NotEmulated
from hli_bench.base.loading import data_file
from hli_bench.bench import door, plc_ports
from hli_bench.bench.door import result_reply
from hli_bench.protocols.hli.layout import Layout
from hli_bench.protocols.hli.packing import IMAGE_HEADER
from hli_bench.shells.plc_process import ScriptClient, main
from hli_bench.shells.processes import Deadline, PlcProcess, Worker
from hli_bench.shells.zenoh_client import Terms
from hli_bench.shells.zenoh_requests import RunProgram
from hli_bench.shells.zenoh_session import connect, listen, on_network_thread, payload

UNIT = "ax/3/lr_mc_control/probing_signal"
PLC_STOPPED = 40011
PATIENCE_S = 60.0
PLAIN_PLC = Path(__file__).with_name("plain_zenoh_plc.py")
CRASHING = """
from hli_bench.plc import Plc

class Crashing(Plc):
    period_us = 1000

    def start(self, hli, io):
        hli.ax[3].lr_mc_control.release_feedhold.enable_w = True
        self.cycles = 0

    def cycle(self, hli, io):
        self.cycles += 1
        if self.cycles == 50:
            raise ValueError("no idea what to do")
"""
SECOND = """
from hli_bench.plc import Plc

class Second(Plc):
    period_us = 1000

    def cycle(self, hli, io):
        units = hli.ax[3].lr_mc_control
        units.probing_signal.command_w = not units.probing_signal.command_w
        units.timestamp.command_w = units.timestamp.command_w + 1
"""


def kill(plc: Any) -> None:
    os.kill(plc.process.pid, signal.SIGKILL)


def freeze(plc: Any) -> None:
    os.kill(plc.process.pid, signal.SIGSTOP)


@pytest.mark.parametrize("pace", ["free", "real"])
@pytest.mark.parametrize("end", [kill, freeze])
def test_a_plc_that_goes_ends_the_program_but_not_the_bench(
    serve: Any, endless: Path, tmp_path: Path, result: Any, pace: str, end: Callable[[Any], None]
) -> None:
    bench = serve("--plc", "none", "--pace", pace)
    plc, run = bench.plc(), bench.run(endless, "--result", tmp_path / "result.json")
    assert bench.running()
    with bench.client() as client:
        assert client.get(f"{UNIT}/enable_w") is True
        end(plc)
        assert run.end() == 1
        assert [(error["id"], error["severity"]) for error in result()["errors"]] == [(PLC_STOPPED, "error")]
        assert run.err[0].startswith(f"P-ERR-{PLC_STOPPED}")
        assert "demo" in run.err[0]
        assert client.get(f"{UNIT}/enable_w") is False
        assert client.get("ax/3/lr_mc_control/release_feedhold/enable_w") is False
        assert client.state()["plcs"] == []
        client.reset()
        assert client.state()["state"] == "ready"
    # On a busy computer a PLC of 1 ms does not keep its period, and that is told too.
    said = [line for line in bench.command.err if "keep its period" not in line]
    assert said == ["PLC demo has gone in a program: its session has ended, or was silent"]


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_new_plc_takes_the_place_of_one_that_was_killed(serve: Any, probe: Path, pace: str) -> None:
    bench = serve("--plc", "none", "--pace", pace)
    kill(bench.plc())
    bench.settled(lambda state: state["plcs"] == [])
    with bench.client() as client:
        assert client.get(f"{UNIT}/enable_w") is False
    bench.plc()
    run = bench.run(probe)
    assert run.end() == 0, run.err
    assert run.out == ["V.A.MESS.Z=298.000000"]


def test_a_plc_that_thaws_attaches_again(serve: Any, endless: Path, program: Any) -> None:
    bench = serve("--plc", "none", "--pace", "real")
    plc, run = bench.plc(), bench.run(endless)
    assert bench.running()
    freeze(plc)
    assert run.end() == 1
    os.kill(plc.process.pid, signal.SIGCONT)
    bench.settled(lambda state: [one["name"] for one in state["plcs"]] == ["demo"])
    with bench.client() as client:
        client.reset()
    assert bench.run(program("N10 G01 G90 Z299 F6000\nN20 M30\n")).end() == 0


def test_a_script_that_fails_is_bad_input_of_its_process_and_a_plc_stop_for_the_cnc(
    serve: Any, endless: Path, tmp_path: Path
) -> None:
    script = tmp_path / "crashing.py"
    script.write_text(CRASHING)
    bench = serve("--plc", "none", "--pace", "free")
    plc = bench.plc(script)
    run = bench.run(endless)
    assert run.end() == 1
    assert run.err[0].startswith(f"P-ERR-{PLC_STOPPED}")
    assert plc.end() == 2
    assert "crashing.py" in plc.err[-1]
    assert "no idea what to do" in plc.err[-1]


def test_the_second_plc_on_a_unit_is_refused_and_reported(serve: Any, probe: Path, tmp_path: Path) -> None:
    script = tmp_path / "second.py"
    script.write_text(SECOND)
    bench = serve("--plc", "none", "--pace", "free")
    bench.plc()
    second = bench.plc(script)
    run = bench.run(probe)
    assert run.end() == 0, run.err
    assert run.out == ["V.A.MESS.Z=298.000000"]
    with bench.client() as client:
        reported = client.hli_errors()
    assert reported["refused"] > 0
    last = reported["last"][-2:]
    assert [one["path"].rsplit("/", 2)[1] for one in last] == ["probing_signal", "timestamp"]
    assert {one["writer"] for one in last} == {"second"}
    assert {one["reason"] for one in last} == {"the unit belongs to PLC 'demo'"}
    assert second.process.poll() is None
    bench.command.interrupt()
    assert bench.command.end() == 0
    assert bench.command.err == [f"plc second: {UNIT}/command_w and 1 more: the unit belongs to PLC 'demo'"]
    assert second.end() == 0
    refused = [line for line in second.out if line.startswith("refused: ")]
    assert refused == [f"refused: {UNIT}/command_w: the unit belongs to PLC 'demo'"]


def test_a_second_plc_of_the_same_name_is_turned_away(serve: Any, start: Any) -> None:
    bench = serve("--pace", "free")
    second = start("plc", "demo.py", "--connect", bench.endpoint)
    assert second.end() == 2
    assert second.err == ["a PLC called 'demo' is attached already"]
    assert bench.plcs() == ["demo"]


@pytest.fixture(scope="module")
def session(bench: Any) -> Iterator[Any]:
    """A Zenoh session as any client opens one."""
    session = connect(bench.endpoint)
    yield session
    session.close()


@pytest.mark.parametrize(
    ("path", "payload", "reason"),
    [
        (f"{UNIT}/command_w", b"\1\0", "2 bytes, BOOL takes 1"),
        (f"{UNIT}/command_w", b"", "0 bytes, BOOL takes 1"),
        ("ax/3/lr_mc_control/timestamp/command_w", b"\1\0\0\0", "4 bytes, SGN64 takes 8"),
        (f"{UNIT}/state_r", b"\1", "a client may only read it"),
        (f"{UNIT}/comand_w", b"\1", "comand_w"),
        ("ax/99/lr_mc_control/probing_signal/command_w", b"\1", "ax/99"),
    ],
)
def test_a_put_that_is_wrong_changes_nothing_and_is_reported(
    bench: Any, session: Any, path: str, payload: bytes, reason: str
) -> None:
    with bench.client() as client:
        before, values = client.hli_errors()["refused"], client.get(UNIT)
        session.put(f"demo/hli/unit/{path}", payload)
        bench.settled(lambda _: client.hli_errors()["refused"] == before + 1)
        last = client.hli_errors()["last"][-1]
        assert last["path"].removeprefix("hli/unit/") == path
        assert reason in last["reason"]
        assert client.get(UNIT) == values


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        (b"\1\2\3", "bytes"),
        (struct.pack("<QHB", 0, 65000, 1), "65000"),
        (struct.pack("<QH", 0, 0), "byte"),
    ],
)
def test_commands_of_a_wrong_size_are_refused_and_the_plc_stays(
    bench: Any, session: Any, message: bytes, reason: str
) -> None:
    """Attached by hand: the bench asks nothing of a PLC while time stands still, so that all comes from here."""
    token = session.liveliness().declare_token("demo/plc/hand/alive")
    with bench.client() as client:
        client.ask_packed("plc/hand/attach", json.dumps({"period_us": 1000}))
        before = client.hli_errors()["refused"]
        terms = client.state()
        session.put("demo/plc/hand/commands", message)
        session.put("demo/plc/hand/commands", struct.pack("<Q", terms["cycle"] + 1))
        client.set("ax/3/head/plc_present_w", "FALSE")
        assert client.hli_errors()["refused"] == before + 1
        last = client.hli_errors()["last"][-1]
        assert last["path"] == "plc/hand/commands"
        assert reason in last["reason"]
        assert bench.plcs() == ["hand"]
    token.undeclare()
    bench.settled(lambda state: state["plcs"] == [])


DWELLS = "".join(
    f"N{10 * n} G04 0.0{n % 9 + 1}\nN{10 * n + 5} G01 G90 Z{299 + n % 2} F6000\n" for n in range(1, 40)
)
SLOW = """
from hli_bench.plc import Plc

class Slow(Plc):
    period_us = 4000

    def start(self, hli, io):
        hli.ax[3].lr_mc_control.release_feedhold.enable_w = True
        hli.ax[3].lr_mc_control.release_feedhold.command_w = True

    def cycle(self, hli, io):
        hli.ax[3].lr_mc_control.timestamp.command_w += 1
"""


@pytest.mark.parametrize("lag", [0, 1, 3])
def test_a_slow_plc_stays_in_lock_step_through_many_decisions(
    serve: Any, program: Any, tmp_path: Path, lag: int
) -> None:
    """Decisions and writes of others put images in cycles that are none of the PLC's; so does its attaching."""
    script = tmp_path / "slow.py"
    script.write_text(SLOW)
    bench = serve("--plc", "none", "--pace", "free")
    with bench.client() as client:
        for _ in range(lag):
            client.set("ax/1/head/plc_present_w", "FALSE")
        bench.plc(script)
        first = client.state()["cycle"] // 4
        run = bench.run(program(DWELLS + "N900 M30\n"))
        assert run.end() == 0, run.err
        state = client.state()
        assert state["plcs"] == [{"name": "slow", "period_cycles": 4}]
        assert client.get("ax/3/lr_mc_control/timestamp/command_w") == state["cycle"] // 4 - first
        assert client.hli_errors()["refused"] == 0


def test_a_plain_plc_of_4_ms_probes(start: Any, serve: Any, probe: Path) -> None:
    bench = serve("--plc", "none", "--pace", "free")
    plc = start(bench.endpoint, "demo", "3", "4000", program=[sys.executable, "-I", PLAIN_PLC])
    bench.settled(lambda state: state["plcs"] == [{"name": "plain", "period_cycles": 4}])
    run = bench.run(probe)
    assert run.end() == 0, run.err
    assert run.out == ["V.A.MESS.Z=298.000000"]
    assert plc.process.poll() is None


@pytest.mark.parametrize("given", [["a", "b", "c", "soon"], ["a"], ["a", "b", "c", "1", "2"]])
def test_arguments_that_make_no_sense(given: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(given) == 2
    assert "PERIOD_US" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["a/b", "a*", "a$b", "a?", "#"])
def test_a_name_that_can_be_no_part_of_a_key_is_bad_input(name: str, do: Callable[..., list[str]]) -> None:
    (said,) = do("plc", "demo.py", "--name", name, status=2)
    assert f"a PLC is called {name!r}, which can be no part of a Zenoh key" in said


def test_a_period_that_is_given_replaces_the_scripts_own(serve: Any) -> None:
    bench = serve("--plc", "none", "--pace", "free")
    script = data_file("plc_scripts", "demo.py")
    with PlcProcess(script, bench.endpoint, "given", 3000), PlcProcess(script, bench.endpoint, "own", None):
        bench.settled(lambda state: len(state["plcs"]) == 2)
        periods = {plc["name"]: plc["period_cycles"] for plc in bench.state()["plcs"]}
    assert periods == {"given": 3, "own": 1}


MUTE = """
import sys
from threading import Event
from hli_bench.shells.zenoh_session import connect

with connect(sys.argv[1]) as session:
    token = session.liveliness().declare_token("demo/plc/mute/alive")
    let_go = Event()
    session.declare_subscriber("demo/plc/mute/detached", lambda _: let_go.set())
    list(session.get("demo/plc/mute/attach", payload='{"period_us": 1000}', timeout=30.0))
    print(let_go.wait(30.0))
"""


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_plc_that_lives_and_does_not_answer_is_named(
    endpoint: str, monkeypatch: pytest.MonkeyPatch, pace: str
) -> None:
    """Its session says that it is there: only the time that it may be silent ends it."""
    monkeypatch.setattr(plc_ports, "ANSWER_S", 0.3)
    notes: list[str] = []
    with Bench("demo", plc=[], zenoh=endpoint, pace=pace, on_note=notes.append) as bench:
        bench.start_up()
        with subprocess.Popen([sys.executable, "-c", MUTE, endpoint], stdout=subprocess.PIPE) as mute:
            deadline = Deadline(PATIENCE_S)
            while not bench._door.attached("mute"):
                assert not deadline.over
                sleep(0.02)
            result = bench.run("N10 G01 X20 F600\nN20 M30\n")
            assert mute.communicate()[0] == b"True\n"
        assert [error.id for error in result.errors] == [PLC_STOPPED]
        assert not bench._door.attached("mute")
        (note,) = notes
        assert re.fullmatch(r"PLC mute is alive and has not answered for 0\.3 s, up to cycle \d+: .*", note)


STARTS_SLOWLY = """
from time import sleep
from hli_bench.plc import Plc

class StartsSlowly(Plc):
    def start(self, hli, io):
        sleep(1.6)
        hli.ax[3].lr_mc_control.timestamp.enable_w = True

    def cycle(self, hli, io):
        hli.ax[3].lr_mc_control.timestamp.command_w = 7
"""


def test_a_plc_may_take_its_time_to_start_in_real_pace(serve: Any, tmp_path: Path) -> None:
    script = tmp_path / "slow.py"
    script.write_text(STARTS_SLOWLY)
    bench = serve("--plc", "none", "--pace", "real")
    plc = bench.plc(script)
    with bench.client() as client:
        values = client.watch("ax/3/lr_mc_control/timestamp/command_w", timeout_s=PATIENCE_S)
        assert 7 in values
    assert plc.process.poll() is None
    assert not bench.command.err


def test_a_reset_says_which_drives_stay_out(
    endpoint: str, start: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(door, "RESET_CYCLES", 5)
    with Bench("demo", plc=[], zenoh=endpoint) as bench:
        bench.start_up()
        monkeypatch.setattr(type(bench.kernel.drives), "ready", property(lambda _: False))
        monkeypatch.setattr(type(bench.kernel.drives), "out", lambda _: ["X", "Z"])
        command = start("reset", "--connect", endpoint)
        # Between the calls of a script the bench answers by itself; cycles pass in its calls only.
        while command.process.poll() is None:
            bench.advance(1)
            sleep(0.02)
    assert command.end() == 1
    assert command.err == ["still out of operation: X, Z"]


def test_a_worker_that_is_stuck_is_named_and_ended() -> None:
    worker = Worker("hli_bench.bench.terminals_process", ["demo", "{}"])
    worker.pipe.limit(0.2)
    os.kill(worker._process.pid, signal.SIGSTOP)
    try:
        for _ in range(2):
            with pytest.raises(EnvironmentLacks, match=r"terminals_process does not answer"):
                worker.ask(b"x")
    finally:
        worker._process.kill()
        worker.close()


def test_errors_of_the_bench_end_it_and_those_of_a_program_do_not() -> None:
    told: list[str] = []
    lines: list[str] = []
    request = RunProgram(key="demo/cnc/run", report=lambda of: told.append(of[0].reason), packed=b"", name="")

    def failing(error: Exception) -> Any:
        raise error

    result_reply(lambda: failing(InputError("no word")), request, lines.append)
    result_reply(lambda: failing(NotEmulated("G33")), request, lines.append)
    for error in (EnvironmentLacks("a worker has ended"), BenchError("broken")):
        with pytest.raises(type(error)):
            result_reply(partial(failing, error), request, lines.append)
    assert told == [
        "no word",
        "NotEmulated: G33",
        "the bench ends: a worker has ended",
        "the bench ends: broken",
    ]
    assert lines == []


def test_what_a_program_does_to_the_bench_is_its_answer_and_told() -> None:
    told: list[str] = []
    lines: list[str] = []
    request = RunProgram(key="demo/cnc/run", report=lambda of: told.append(of[0].reason), packed=b"", name="")

    def failing() -> Any:
        raise RecursionError("too deep")

    result_reply(failing, request, lines.append)
    assert told == ["the bench failed at this program: RecursionError: too deep"]
    assert "in failing" in lines[0]


def test_a_deadline_passes() -> None:
    assert Deadline(0).over
    assert not Deadline(1000).over


COUNTING = """
from hli_bench.plc import Plc

class Counting(Plc):
    period_us = {period_us}

    def start(self, hli, io):
        hli.ax[{axis}].lr_mc_control.timestamp.enable_w = True

    def cycle(self, hli, io):
        hli.ax[{axis}].lr_mc_control.timestamp.command_w += 1
"""


def test_plcs_inside_and_outside_of_the_process_each_have_their_period(
    serve: Any, program: Any, tmp_path: Path
) -> None:
    """In lock-step each runs once in its period, however many there are."""
    periods = {1: 1, 2: 3, 3: 7}
    scripts = {axis: tmp_path / f"plc{axis}.py" for axis in periods}
    for axis, script in scripts.items():
        script.write_text(COUNTING.format(axis=axis, period_us=1000 * periods[axis]))
    bench = serve("--plc", scripts[1], "--pace", "free")
    with bench.client() as client:
        for axis in (2, 3):
            bench.plc(scripts[axis])
        assert {plc["name"]: plc["period_cycles"] for plc in client.state()["plcs"]} == {
            "plc1": 1, "plc2": 3, "plc3": 7,
        }  # fmt: skip
        begin = client.state()["cycle"]
        counts = {axis: client.get(f"ax/{axis}/lr_mc_control/timestamp/command_w") for axis in periods}
        run = bench.run(program(DWELLS + "N900 M30\n"))
        assert run.end() == 0, run.err
        end = client.state()["cycle"]
        assert end - begin > 3000
        for axis, period in periods.items():
            runs = client.get(f"ax/{axis}/lr_mc_control/timestamp/command_w") - counts[axis]
            assert runs == end // period - begin // period, axis


STUCK = """
from hli_bench.plc import Plc

class Stuck(Plc):
    def cycle(self, hli, io):
        print("stuck", flush=True)
        while True:
            pass
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_script_that_never_returns_is_ended_like_any_other(
    serve: Any, start: Any, endless: Path, tmp_path: Path, pace: str, number: signal.Signals
) -> None:
    script = tmp_path / "stuck.py"
    script.write_text(STUCK)
    bench = serve("--plc", "none", "--pace", pace)
    plc = bench.plc(script)
    bench.run(endless)
    assert "is attached" in plc.line()
    assert plc.line() == "stuck"
    os.kill(plc.process.pid, number)
    assert plc.end() == 0, plc.err


BOUND = """
import sqlite3
from threading import current_thread, get_ident, local, main_thread
from hli_bench.plc import Plc

OF_THIS_THREAD = local()
OF_THIS_THREAD.cycles = 0

class Bound(Plc):
    def __init__(self):
        self.numbers = sqlite3.connect(":memory:")

    def start(self, hli, io):
        hli.ax[3].lr_mc_control.timestamp.enable_w = True
        self.numbers.execute("create table numbers (number)")

    def cycle(self, hli, io):
        assert current_thread() is main_thread()
        self.numbers.execute("insert into numbers values (1)")
        OF_THIS_THREAD.cycles += 1
        hli.ax[3].lr_mc_control.timestamp.command_w = OF_THIS_THREAD.cycles
"""


@pytest.mark.parametrize("pace", ["free", "real"])
def test_all_of_a_script_happens_in_one_thread(serve: Any, program: Any, tmp_path: Path, pace: str) -> None:
    script = tmp_path / "bound.py"
    script.write_text(BOUND)
    bench = serve("--plc", "none", "--pace", pace)
    plc = bench.plc(script)
    run = bench.run(program("N10 G04 0.3\nN20 M30\n"))
    assert run.end() == 0, (run.err, plc.err)
    with bench.client() as client:
        assert client.get("ax/3/lr_mc_control/timestamp/command_w") > 0
    assert plc.process.poll() is None, plc.err


class _HandedOut:
    """What a client asks: the first to attach is let go of between two images, the next is turned away."""

    def __init__(self, session: Any) -> None:
        self.session = session
        self.machine, self.endpoint = "by_hand", "nowhere"
        self.layout, self.terminals = Layout(()), ()
        self._attached = 0

    def attach(self, plc: str, period_us: int) -> Terms:
        self._attached += 1
        if self._attached == 2:
            raise InputError("turned away")
        for key, message in (
            ("hli/image", IMAGE_HEADER.pack(7, 0) + bytes(self.layout.size)),
            ("plc/hand/detached", b""),
            ("hli/image", IMAGE_HEADER.pack(8, 0) + bytes(self.layout.size)),
        ):
            self.session.put(f"{self.machine}/{key}", message)
        return Terms(7, 1000, 1000, True)


def test_images_behind_the_end_of_an_attachment_are_not_answered(endpoint: str, tmp_path: Path) -> None:
    script = tmp_path / "idle.py"
    script.write_text("class Idle:\n    period_us = 1000\n    def cycle(self, hli, io):\n        pass\n")
    answered: list[int] = []
    with listen(endpoint) as session:
        session.declare_subscriber(
            "by_hand/plc/hand/commands",
            on_network_thread(lambda sample: answered.append(int.from_bytes(payload(sample), "little"))),
        )
        with pytest.raises(InputError, match="turned away"):
            ScriptClient(_HandedOut(session), script, "hand").run()
    assert answered == [7]
