"""One process or several, script here or there, free or paced: the same run to the bit, or the same NC results."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.base.errors import BenchError, EnvironmentLacks, InputError
from hli_bench.base.loading import data_file
from hli_bench.bench.remote import UNASKED
from hli_bench.bench.result import Result
from hli_bench.shells.pipe import Pipe
from hli_bench.shells.plc_process import start as start_plc
from hli_bench.shells.processes import Worker, free_endpoint, work
from hli_bench.shells.trace_file import AxesBlock, TraceEvent, TraceFile, TraceReader, read

PATIENCE_S = 60.0
MACHINE = {
    "plant.probe.Z.face_mm": 298.0,
    "plant.probe.Z.material": "below",
    "axis.X.start_mm": -499.0,
}
PROGRAM = """%several
N10 #MEAS MODE[1]
N20 G90 G01 Z299 F6000
N30 G100 Z290 F2000
N40 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=500 WAIT]
N50 #MSG SYN["V.A.MESS.Z=%f", V.A.MESS.Z]
N60 G74 X1
N70 M30
"""
SERVING = """
import json, signal, sys
from contextlib import closing
from pathlib import Path
from tempfile import NamedTemporaryFile
from hli_bench import Bench
from hli_bench.shells.trace_file import TraceFile

signal.signal(signal.SIGINT, signal.default_int_handler)
settings, endpoint, trace = json.loads(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
with Bench("demo", settings, plc=[], zenoh=endpoint, processes=True) as bench:
    recorder = TraceFile(trace, bench.kernel.setup, bench.kernel.rows.log, bench.config.name)
    bench.engine.observers.append(recorder)
    bench.start_up()
    print("up", flush=True)
    with closing(recorder):
        try:
            bench.serve()
        except KeyboardInterrupt:
            pass
"""

Run = tuple[bytes, dict[str, Any]]


def nc_results(result: Mapping[str, Any]) -> dict[str, Any]:
    """What the NC program got: all but real time, and remarks for people."""
    not_of_it = (
        "program",
        "notes",
        "wall_s",
        "late_cycles",
        "worst_lateness_us",
        "lateness_histogram",
        "plcs",
    )
    return {key: value for key, value in result.items() if key not in not_of_it}


@pytest.fixture
def traced(tmp_path: Path) -> Callable[..., Run]:
    """Return what runs the program and gives its trace and its results."""

    def run(name: str, settings: Mapping[str, object], **options: Any) -> Run:
        trace = tmp_path / f"{name}.mcap"
        with Bench("demo", settings, **options) as bench:
            setup, log = bench.kernel.setup, bench.kernel.rows.log
            with closing(TraceFile(trace, setup, log, bench.config.name)) as recorder:
                bench.engine.observers.append(recorder)
                result: Result = bench.run(PROGRAM)
        return trace.read_bytes(), nc_results(result.to_dict())

    return run


@pytest.fixture
def ashore(tmp_path: Path) -> Callable[[Mapping[str, object]], Run]:
    """Return what does the same with a bench that stays up, `hli-bench plc` and `hli-bench run --connect`."""

    def run(settings: Mapping[str, object]) -> Run:
        endpoint, trace = free_endpoint(), tmp_path / "served.mcap"
        program, answer = tmp_path / "several.nc", tmp_path / "result.json"
        program.write_text(PROGRAM)
        command = [sys.executable, "-c", SERVING, json.dumps(settings), endpoint, str(trace)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, process_group=0) as bench:
            assert bench.stdout is not None
            assert bench.stdout.readline() == "up\n"
            hli_bench = Path(sys.executable).with_name("hli-bench")
            connect = ["--connect", endpoint]
            plc = subprocess.Popen([hli_bench, "plc", "demo.py", *connect])
            while (
                b"demo" not in subprocess.check_output([hli_bench, "state", *connect]).partition(b"plcs")[2]
            ):
                assert plc.poll() is None
            subprocess.run([hli_bench, "run", program, "--result", answer, *connect], check=True)
            bench.send_signal(signal.SIGINT)
            assert bench.wait(PATIENCE_S) == 0
            assert plc.wait(PATIENCE_S) == 0
        return trace.read_bytes(), nc_results(json.loads(answer.read_text()))

    return run


@pytest.mark.parametrize("source", ["PLC", "PLC_TIMESTAMP", "DRIVE"])
def test_kernel_drives_and_terminals_in_processes_of_their_own_give_the_same_trace(
    traced: Callable[..., Run], source: str
) -> None:
    settings = {**MACHINE, "axis.Z.kenngr.measure.signal": source}
    one = traced("one", settings)
    assert one[1]["status"] == "completed"
    assert one[1]["messages"]
    assert traced("several", settings, processes=True) == one


@pytest.mark.parametrize(
    "terminal",
    [
        {"terminal.probe.delay_ns": 2_500_000},
        {"terminal.probe.delay_ns": 150_000_000},
        {"terminal.probe.mode": "single_event"},
        {"terminal.probe.period_us": 4000},
        {"plant.probe.bounce_us": 700.0},
    ],
    ids=str,
)
def test_terminals_that_are_not_asked_in_every_cycle_show_the_same(
    traced: Callable[..., Run], terminal: Mapping[str, Any]
) -> None:
    """What changes in an image without an edge: an input delay that is over, a status, a later refresh."""
    settings = {**MACHINE, "axis.Z.kenngr.measure.signal": "PLC", **terminal}
    assert traced("several", settings, processes=True) == traced("one", settings)


def test_a_plc_of_its_own_in_lock_step_gives_the_same_trace(
    traced: Callable[..., Run], ashore: Callable[..., Run]
) -> None:
    one = traced("one", MACHINE)
    assert one[1]["measurements"][0]["acs_mm"] == 298.0
    assert [axis["axis"] for axis in one[1]["homing"] if axis["referenced"]] != []
    assert traced("process", {**MACHINE, "plc.0.process": True}) == one
    served = ashore(MACHINE)
    assert served[1] == one[1]
    assert served[0] == one[0]


def test_all_together_in_processes_give_the_same_trace(traced: Callable[..., Run]) -> None:
    one = traced("one", MACHINE)
    assert traced("all", {**MACHINE, "plc.0.process": True}, processes=True) == one


def test_the_trace_that_is_compared_shows_frames_edges_writes_and_records(
    traced: Callable[..., Run], tmp_path: Path
) -> None:
    traced("one", MACHINE)
    seen = list(read(tmp_path / "one.mcap"))
    assert {event.topic for event in seen if isinstance(event, TraceEvent)} == {
        "meta",
        "can",
        "edges",
        "plc",
        "cnc",
    }
    assert sum(len(block.rows) for block in seen if not isinstance(block, TraceEvent)) > 500


def told(trace: bytes) -> list[object]:
    """Return what a trace holds beside overruns, in its order within each topic."""
    with NamedTemporaryFile(suffix=".mcap") as file:
        file.write(trace)
        file.flush()
        entries = list(TraceReader(Path(file.name)).entries())
    rows = b"".join(entry.rows.tobytes() for entry in entries if isinstance(entry, AxesBlock))
    events = [entry for entry in entries if isinstance(entry, TraceEvent) and entry.topic != "overruns"]
    return [rows, *sorted(events, key=lambda event: event.topic)]


@pytest.mark.parametrize("process", [False, True])
def test_paced_runs_give_the_same_nc_results(traced: Callable[..., Run], process: bool) -> None:
    """By the clock an attached PLC is not waited for: instants may shift by cycles, what is measured does not."""
    _, free = traced("free", MACHINE)
    trace, paced = traced("paced", {**MACHINE, "plc.0.process": process}, pace="real")
    if not process:
        assert paced == free
        # A busy computer lets the script overrun, and the trace tells: all but that is the same.
        assert told(trace) == told(traced("again", MACHINE)[0])
        return
    for key in ("status", "messages", "errors", "variables", "homing"):
        assert paced[key] == free[key], key
    (measured,), (expected,) = paced["measurements"], free["measurements"]
    for key in ("axis", "block", "source", "acs_mm", "pcs_mm", "edge"):
        assert measured[key] == expected[key], key


def test_a_drive_model_that_is_not_there_is_bad_input_in_a_process_too(
    capfd: pytest.CaptureFixture[str],
) -> None:
    settings = {"axis.Z.drive": "drives.models.nonsuch"}
    with pytest.raises(InputError, match="nonsuch"), Bench("demo", settings) as bench:
        bench.start_up()
    with pytest.raises(BenchError) as caught, Bench("demo", settings, processes=True) as bench:
        bench.start_up()
    assert caught.value.exit_status == 2
    assert "nonsuch" in str(caught.value) + capfd.readouterr().err


def test_a_can_interface_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(EnvironmentLacks, match=r"no CAN interface nonsuch .*hli-bench doctor"):
        Bench("demo", can="socketcan:nonsuch")
    command = [Path(sys.executable).with_name("hli-bench"), "run", "meas1.nc", "--can", "socketcan:nonsuch"]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert run.returncode == 3
    assert run.stderr.startswith("no CAN interface nonsuch (")
    assert "hli-bench doctor" in run.stderr
    assert "Traceback" not in run.stderr


@pytest.mark.parametrize("can", ["socketcan:", "vcan0", "pcan:1"])
def test_a_bus_that_is_no_bus(can: str) -> None:
    with pytest.raises(InputError, match="socketcan:INTERFACE"):
        Bench("demo", can=can)


def test_a_bench_that_cannot_be_built_leaves_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[Worker] = []
    begin = Worker.__init__

    def noted(self: Worker, *arguments: Any) -> None:
        begin(self, *arguments)
        started.append(self)

    monkeypatch.setattr(Worker, "__init__", noted)
    with pytest.raises(EnvironmentLacks):
        Bench("demo", processes=True, zenoh="tcp/192.0.2.1:1")
    assert [worker._process.returncode for worker in started] == [0, 0]


def test_a_worker_that_dies_is_named() -> None:
    with Bench("demo", processes=True) as bench:
        bench.start_up()
        worker = bench.engine.link._terminals  # type: ignore[attr-defined]
        os.kill(worker._process.pid, signal.SIGKILL)
        with pytest.raises(EnvironmentLacks, match="terminals_process has ended with status -9"):
            bench.advance(2 * UNASKED)


def test_a_worker_whose_bench_closes_while_it_answers_ends_in_order(
    capsys: pytest.CaptureFixture[str],
) -> None:
    ours, theirs = socket.socketpair()

    def answer(pipe: Pipe, _: object) -> None:
        ours.close()
        pipe.send(b"numbers of a cycle that nobody waits for")

    assert work(answer, [str(theirs.detach())]) == 0
    assert capsys.readouterr().err == ""


def test_settings_of_tasks_that_other_scripts_replace_are_remarked() -> None:
    notes: list[str] = []
    script = data_file("plc_scripts", "probing.py")
    with Bench("demo", {"plc.0.process": True}, plc=[script], on_note=notes.append):
        pass
    assert [note for note in notes if "plc.0.process has no effect" in note]


def test_a_plc_process_that_ends_before_it_attached_is_told(tmp_path: Path) -> None:
    script = tmp_path / "broken.py"
    script.write_text("import nonsuch\n")
    settings = {"plc.0.script": str(script), "plc.0.process": True}
    with pytest.raises(BenchError, match=r"broken\.py"), Bench("demo", settings) as bench:
        bench.start_up()


def test_a_script_as_a_process_without_a_bench_ends_with_status_3() -> None:
    plc = start_plc(data_file("plc_scripts", "demo.py"), free_endpoint())
    assert plc.wait(PATIENCE_S) == 3
