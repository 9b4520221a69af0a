"""The main job on a real CAN bus: kernel, drives, terminals and PLC as processes, others on the bus listening."""

import json
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import canopen
import pytest

from hli_bench import Bench
from hli_bench.base.loading import data_file
from hli_bench.bench.sources import parse_set
from hli_bench.shells.processes import free_endpoint
from hli_bench.shells.trace_file import TraceFile

PATIENCE_S = 120.0
HLI_BENCH = Path(sys.executable).with_name("hli-bench")
SETTINGS = ("plant.probe.Z.face_mm=298", "plant.probe.Z.material=below", "plc.0.process=true")
OPTIONS = [word for setting in SETTINGS for word in ("--set", setting)]
PROGRAM = """%main
N10 #MEAS MODE[1]
N20 G90 G01 Z299 F6000
N30 G100 Z290 F1000
N40 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=50 WAIT]
N50 #MSG SYN["V.A.MESS.Z=%f", V.A.MESS.Z]
N60 M30
"""
NODES = range(1, 8)

# What somebody writes who has python-can and knows CANopen: no word of hli_bench. Ends at a 29-bit frame.
LISTENER = """
import json, socket, struct
import can

counts, boot_ups, heartbeats, torque_limits = {}, [], {}, []
with can.Bus("vcan0", interface="socketcan") as bus:
    bus.socket.setsockopt(socket.SOL_SOCKET, getattr(socket, "SO_RCVBUFFORCE", 33), 32 << 20)
    print("ready", flush=True)
    for frame in bus:
        if frame.is_extended_id:
            break
        cob_id = frame.arbitration_id
        function, node = cob_id & 0x780, cob_id & 0x7F
        counts[cob_id] = counts.get(cob_id, 0) + 1
        if function == 0x700 and bytes(frame.data) == b"\\0":
            boot_ups.append(node)
        elif function == 0x700:
            heartbeats.setdefault(node, []).append(frame.data[0])
        elif function == 0x600:
            command, index, subindex, value = struct.unpack("<BHBI", frame.data)
            if index == 0x6072 and command & 0xE0 == 0x20:
                torque_limits.append((node, subindex, value))
print(json.dumps([counts, boot_ups, heartbeats, torque_limits]), flush=True)
"""


class Job:
    """The main job and what was seen of it."""

    def __init__(self, folder: Path, end_listener: Any) -> None:
        self.folder = folder
        program = folder / "main.nc"
        program.write_text(PROGRAM)
        listener = subprocess.Popen(
            [sys.executable, "-c", LISTENER], stdout=subprocess.PIPE, text=True, cwd=folder
        )
        files = ["--trace", folder / "can.mcap", "--result", folder / "can.json"]
        command = [HLI_BENCH, "run", program, "--can", "socketcan:vcan0", *OPTIONS, *files]
        with listener:
            try:
                assert listener.stdout is not None
                assert listener.stdout.readline() == "ready\n"
                self.run = subprocess.run(
                    command, capture_output=True, text=True, check=False, timeout=PATIENCE_S
                )
                end_listener()
                seen = json.loads(listener.stdout.readline())
            finally:
                listener.kill()
        self.counts = Counter({int(cob_id): count for cob_id, count in seen[0].items()})
        self.boot_ups: list[int] = seen[1]
        self.heartbeats: dict[int, list[int]] = {int(node): states for node, states in seen[2].items()}
        self.torque_limits: list[list[int]] = seen[3]

    @property
    def result(self) -> dict[str, Any]:
        return json.loads((self.folder / "can.json").read_text())


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    import can

    def end_listener() -> None:
        with can.Bus("vcan0", interface="socketcan") as bus:
            bus.send(can.Message(arbitration_id=0x1FFFFFFF, is_extended_id=True))

    return Job(tmp_path_factory.mktemp("main"), end_listener)


def test_the_job_is_done(job: Job) -> None:
    assert job.run.returncode == 0, job.run.stderr
    assert job.run.stdout == "V.A.MESS.Z=298.000000\n"
    (measured,) = job.result["measurements"]
    assert (measured["source"], measured["acs_mm"]) == ("PLC_TIMESTAMP", 298.0)


@pytest.mark.req("M-166", "M-167")
def test_a_listener_that_knows_nothing_of_the_bench_sees_canopen(job: Job) -> None:
    cycles = job.counts[0x80]
    assert cycles > job.result["cycles"] > 100
    assert sorted(job.boot_ups) == list(NODES)
    for node in NODES:
        # Before it was started a drive sends no PDO: some cycles at the beginning.
        for actual in (0x180, 0x280, 0x380, 0x480):
            assert cycles - 10 < job.counts[actual + node] < cycles
        for command in (0x200, 0x300):
            assert job.counts[command + node] == cycles
        # From the write of its producer time on; the next would be due after 1000 cycles.
        assert job.heartbeats[node] == [127]
    assert job.torque_limits == [[3, 0, 500]]


def test_the_trace_is_that_of_one_process(job: Job) -> None:
    """Positions, lags, words of all axes in all cycles, frames, edges, PLC writes, records: bit by bit."""
    trace = job.folder / "one.mcap"
    settings = parse_set(SETTINGS[:2])
    with Bench("demo", settings) as bench:
        setup, log = bench.kernel.setup, bench.kernel.rows.log
        with closing(TraceFile(trace, setup, log, "demo", parse_set(SETTINGS))) as recorder:
            bench.engine.observers.append(recorder)
            result = bench.run(PROGRAM).to_dict()
    same = ("status", "messages", "errors", "variables", "measurements", "homing", "sim_s", "cycles")
    assert {key: result[key] for key in same} == {key: job.result[key] for key in same}
    assert trace.read_bytes() == (job.folder / "can.mcap").read_bytes()


def test_an_interface_that_is_not_there_is_a_lack_of_this_computer(tmp_path: Path) -> None:
    command = [HLI_BENCH, "run", "meas1.nc", "--can", "socketcan:nonsuch"]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert run.returncode == 3
    assert run.stderr.startswith("no CAN interface nonsuch (")
    assert "hli-bench doctor" in run.stderr


@pytest.fixture(scope="module")
def served() -> Iterator[str]:
    """The endpoint of a bench that is up on vcan0, by the clock as well as it can."""
    endpoint = free_endpoint()
    command = [HLI_BENCH, "serve", "--can", "socketcan:vcan0", "--zenoh", endpoint, "--pace", "real"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, process_group=0) as bench:
        assert bench.stdout is not None
        assert f"is up on {endpoint}" in bench.stdout.readline()
        try:
            yield endpoint
            bench.send_signal(signal.SIGINT)
            assert bench.wait(PATIENCE_S) == 0
        finally:
            bench.kill()


def test_a_canopen_master_reads_a_drive_while_the_bench_runs(served: str) -> None:
    """python-canopen as a second master: it reads and writes by SDO, and hears the heartbeat it asked for."""
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    try:
        drive = canopen.RemoteNode(3, str(data_file("eds", "servo402.eds")))
        drive.sdo.RESPONSE_TIMEOUT = PATIENCE_S / 10
        network.add_node(drive)
        identity = drive.sdo[0x1018]
        assert [identity[number].raw for number in range(5)] == [4, 0xFF0402, 0x402, 0x10000, 3]
        # Z stands at 300 mm: 10 mm and 1048576 increments a turn.
        assert abs(drive.sdo[0x6064].raw - 30 * 1048576) < 100
        assert drive.sdo[0x6041].raw & 0x6F == 0x27
        drive.sdo[0x1017].raw = 20
        assert drive.nmt.wait_for_heartbeat(PATIENCE_S) == "OPERATIONAL"
    finally:
        network.disconnect()
    shown = subprocess.run(
        [HLI_BENCH, "state", "--json", "--connect", served], capture_output=True, text=True, check=True
    )
    state = json.loads(shown.stdout)
    assert state["state"] == "ready"
    assert {axis["drive"] for axis in state["axes"]} == {"operation enabled"}


def _told(endpoint: str) -> dict[str, Any]:
    shown = subprocess.run(
        [HLI_BENCH, "state", "--json", "--connect", endpoint], capture_output=True, text=True, check=True
    )
    state: dict[str, Any] = json.loads(shown.stdout)
    return state


def test_a_node_that_somebody_reboots_is_noticed_and_back_after_a_reset(served: str, tmp_path: Path) -> None:
    """python-canopen as a foreign NMT master, then `hli-bench reset`, then a program."""
    program = tmp_path / "move.nc"
    program.write_text("%move\nN10 G01 G90 Z299.9 F6000\nN20 M30\n")
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    try:
        for command, sign in ((0x81, "it has booted again"), (0x02, "its telegrams stay out")):
            before = _told(served)["cycle"]
            network.send_message(0x000, bytes((command, 3)))
            while (state := _told(served))["state"] != "error":
                assert state["cycle"] < before + 20_000
            drives = {axis["name"]: axis["drive"] for axis in state["axes"]}
            assert drives.pop("Z") == f"no telegrams: {sign}"
            assert set(drives.values()) == {"operation enabled"}
            run = [HLI_BENCH, "run", program, "--connect", served]
            refused = subprocess.run(run, capture_output=True, text=True, check=False)
            assert (refused.returncode, "70101" in refused.stderr) == (1, True)
            subprocess.run([HLI_BENCH, "reset", "--connect", served], check=True)
            assert {axis["drive"] for axis in _told(served)["axes"]} == {"operation enabled"}
            subprocess.run(run, check=True)
    finally:
        network.disconnect()


def test_a_foreign_sync_does_not_shift_the_cycle(served: str, tmp_path: Path) -> None:
    """Behind it the drives still stand where they are told with each SYNC of the CNC: the lag stays what it was."""
    program = tmp_path / "measure.nc"
    program.write_text("%move\nN10 G01 G90 Z299 F600\nN20 G01 G90 Z299.5 F600\nN30 M30\n")
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    try:
        before = _told(served)["foreign_syncs"]
        for _ in range(3):
            network.send_message(0x080, b"")
        while (state := _told(served))["foreign_syncs"] != before + 3:
            assert state["foreign_syncs"] < before + 3
        subprocess.run([HLI_BENCH, "run", program, "--connect", served], check=True)
        subprocess.run([HLI_BENCH, "reset", "--connect", served], check=True)
        assert abs(next(axis["lag_mm"] for axis in _told(served)["axes"] if axis["name"] == "Z")) < 0.01
    finally:
        network.disconnect()
