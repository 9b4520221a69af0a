"""The same bits however the bench is stepped: strides, single cycles, frames; and run after run."""

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hli_bench import Bench
from hli_bench.laws.rows import HISTORY_CYCLES
from hli_bench.runtime.frames import actual_telegrams, command_telegrams

SETTINGS = {
    "plant.probe.Z.face_mm": 40.0,
    "plant.probe.Z.material": "below",
    "plant.probe.sigma_um": 0.7,
    "plant.probe.bounce_us": 1500.0,
    "axis.Z.start_mm": 60.0,
    "axis.X.kenngr.abs_pos_gueltig": 0,
    "plant.cam.X.from_mm": -90.0,
    "plant.cam.X.to_mm": -30.0,
    "axis.X.getriebe[0].pos_refpkt": -350_000,
    "axis.X.getriebe[0].vb_reflow": 20_000,
    "channel.meas_fixed_stop_no_error": 1,
}
RESTLESS = '''
import numpy as np
from hli_bench.plc import Plc

class Restless(Plc):
    """Forwards probe and cam; changes override, feedhold and releases as its seed says."""
    period_us = {period_us}

    def start(self, hli, io):
        self.random = np.random.default_rng({seed})
        self.n = 0
        hli.ch[1].head.plc_present_w = True
        channel = hli.ch[1].bahn_mc_control
        for unit in (channel.override_feedrate, channel.feedhold):
            unit.enable_w = True
        for n in (1, 2, 3):
            axis = hli.ax[n]
            axis.head.plc_present_w = True
            for unit in ("probing_signal", "timestamp", "reference_cam", "release_feedhold"):
                getattr(axis.lr_mc_control, unit).enable_w = True

    def cycle(self, hli, io):
        self.n += 1
        channel = hli.ch[1].bahn_mc_control
        if self.n % 50 == 1:
            channel.override_feedrate.command_w = int(self.random.integers(300, 1000))
            channel.feedhold.command_w = bool(self.random.random() < 0.1)
            hli.ax[1].lr_mc_control.release_feedhold.command_w = bool(self.random.random() < 0.9)
        for n in (2, 3):
            hli.ax[n].lr_mc_control.release_feedhold.command_w = True
        for n in (1, 2, 3):
            axis = hli.ax[n].lr_mc_control
            axis.probing_signal.command_w = io.probe.ch2.input
            axis.timestamp.command_w = io.probe.ch2.latch_pos
        hli.ax[1].lr_mc_control.reference_cam.command_w = io.cams.ch1.input
'''


def random_program(seed: int) -> str:
    """Return a program with homing, motion, dwells, texts and measuring runs, as a seed says."""
    random = np.random.default_rng(seed)
    blocks = ["%random", "N1 G74 X1", "N2 G01 X-20 F12000"]
    kinds = ("line", "line", "line", "rapid", "text", "dwell", "probe", "drive", "short", "stop")
    for number in range(3, 23):
        x, y, z = random.uniform(-15, 15), random.uniform(-20, 20), random.uniform(42, 60)
        feed = random.integers(500, 20_000)
        match random.choice(kinds):
            case "line":
                block = f"G01 X{x:.4f} Y{y:.3f} Z{z:.2f} F{feed}"
            case "rapid":
                block = f"G00 X{x:.3f} Z{z:.3f}"
            case "text":
                block = '#MSG SYN["%f", V.A.ABS.X]' if random.random() < 0.5 else f'#MSG SYN["at {number}"]'
            case "dwell":
                block = "G04 0.02"
            case "probe":
                source = random.choice(["PLC", "PLC_TIMESTAMP", "DRIVE"])
                block = f"#MEAS [AX=Z SIGNAL={source}]\nG01 Z{z:.3f} F9000\nG100 Z35 F{feed}\nG01 Z55 F20000"
            case "drive":
                block = f"#DRIVE WR SYN [AX=Y KEY=TORQUE_LIMIT VAL={random.integers(100, 300)} WAIT]"
            case "short":
                block = "\n".join(f"G01 X{x + i * 0.01:.3f} F{feed}" for i in range(30))
            case _:
                block = f"#MEAS MODE[7]\nG100 Y{y:.2f} F{feed}\n#MEAS MODE[1]"
        blocks.append(f"N{number} {block}" if "\n" not in block else block)
    return "\n".join([*blocks, "M30"]) + "\n"


Drive = Callable[[Bench], None]


def by_strides(bench: Bench) -> None:
    """As the bench does it."""


def in_steps(bench: Bench, cycles: Callable[[], int]) -> None:
    """Let every step of the engine be no longer than so many cycles."""
    engine, step = bench.engine, bench.engine.step
    engine.step = lambda limit: step(min(limit, engine.cycle + cycles()))


def cycle_by_cycle(bench: Bench) -> None:
    in_steps(bench, lambda: 1)


def interrupted(seed: int) -> Drive:
    random = np.random.default_rng(seed)
    return lambda bench: in_steps(bench, lambda: int(random.integers(1, 40)))


def through_frames(bench: Bench) -> None:
    bench.engine.link.quiet = lambda _cycle: 0


@pytest.fixture
def trace(make, script, new_recorder):
    """Return what runs a program in one of the ways above and returns everything that was to be seen."""

    def run(drive: Drive, seed: int, period_us: int = 2000):
        recorder = new_recorder()
        plc = script(RESTLESS.replace("{seed}", str(seed)).replace("{period_us}", str(period_us)), "restless")
        bench = make(SETTINGS, plc=[plc])
        recorder.kernel = bench.kernel
        bench.engine.observers.append(recorder)
        drive(bench)
        result = bench.run(random_program(seed))
        bench.advance(20)
        machine = bench.engine.link.rows
        state = [
            bench.kernel.rows.axis.tobytes(),
            bench.kernel.rows.path.tobytes(),
            bench.kernel.rows.history.tobytes(),
            machine.servo.tobytes(),
            machine.channel.tobytes(),
            bytes(bench.kernel.image.data),
        ]
        seen = {
            "log": recorder.log.tobytes(),
            "frames": recorder.bus,
            "edges": recorder.signals,
            "records": recorder.records,
            "writes": recorder.writes,
            "state": state,
            "result": (result.status, result.messages, result.errors, result.variables, result.measurements),
        }
        return bench, recorder, seen

    return run


def same(one: dict, other: dict) -> None:
    for name, value in one.items():
        if isinstance(value, bytes):
            digests = [hashlib.sha256(each).hexdigest() for each in (value, other[name])]
            assert digests[0] == digests[1], name
        else:
            assert value == other[name], name


@pytest.mark.parametrize("seed", [1, 2])
def test_two_runs_are_the_same(trace, seed):
    same(trace(by_strides, seed)[2], trace(by_strides, seed)[2])


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_program_does_something(trace, seed):
    """The comparison is worth something: homing, probing and motion did take place."""
    _, recorder, seen = trace(by_strides, seed)

    assert seen["result"][0] == "completed", seen["result"][2]
    assert len(recorder.log) > 1000
    assert recorder.signals


@pytest.mark.parametrize("seed", [1, 2])
def test_cycle_by_cycle_gives_the_bits_of_strides(trace, seed):
    _, strides, wanted = trace(by_strides, seed, 50_000)
    _, cycles, found = trace(cycle_by_cycle, seed, 50_000)
    assert len(cycles.blocks) == len(cycles.log) > 5 * len(strides.blocks)
    same(wanted, found)


@pytest.mark.parametrize("seed", range(1, 7))
def test_interrupted_anywhere_gives_the_bits_of_strides(trace, seed):
    period_us = [2000, 7000, 20_000, 50_000][seed % 4]
    _, strides, wanted = trace(by_strides, seed, period_us)
    _, pieces, found = trace(interrupted(seed), seed, period_us)
    assert len(pieces.blocks) > len(strides.blocks)
    same(wanted, found)


@pytest.mark.parametrize("seed", [3, 4])
def test_frames_in_every_cycle_give_the_bits_of_strides(trace, seed):
    same(trace(by_strides, seed)[2], trace(through_frames, seed)[2])


@pytest.mark.parametrize("seed", [1])
def test_frames_made_from_the_log_are_those_that_passed(trace, seed):
    """With frames in every cycle what really went over the bus is what the log says."""
    passed: dict[int, tuple[list, list]] = {}

    def drive(bench: Bench) -> None:
        through_frames(bench)
        telegrams = bench.engine.link.telegrams

        def taken(cycle, inbox):
            frames = telegrams(cycle, inbox)
            passed[cycle] = (list(inbox), frames)
            return frames

        bench.engine.link.telegrams = taken

    bench, recorder, _ = trace(drive, seed)
    nodes = [axis.node for axis in bench.kernel.setup.axes]
    log = recorder.log
    actual, command = actual_telegrams(nodes), command_telegrams(nodes)
    payloads = {telegram.cob_id: telegram.payload(log) for telegram in (*actual, *command)}
    first = 20

    assert len(passed) == len(log)
    for cycle in range(first, len(log)):
        inbox, frames = passed[cycle]
        sent = {frame.cob_id: frame.data for frame in frames}
        wanted = {one.cob_id: payloads[one.cob_id][cycle - 1].tobytes() for one in actual}
        assert wanted.items() <= sent.items(), cycle
        ordered = {frame.cob_id: frame.data for frame in inbox}
        wanted = {one.cob_id: payloads[one.cob_id][cycle - 2].tobytes() for one in command}
        assert wanted.items() <= ordered.items(), cycle


def test_run_longer_than_the_history_is_the_same(trace):
    _, recorder, strides = trace(by_strides, 11, 50_000)
    same(strides, trace(interrupted(5), 11, 50_000)[2])
    assert len(recorder.log) > HISTORY_CYCLES


WHOLE = """
import hashlib, json, sys
from hli_bench import Bench

with Bench(sys.argv[1], json.loads(sys.argv[2]), plc=[]) as bench:
    result = bench.run(sys.argv[3]).to_dict()
    del result["wall_s"]
    rows = bench.kernel.rows, bench.engine.link.rows
    parts = [getattr(one, name).tobytes() for one in rows for name in one.__slots__]
print(json.dumps(result, sort_keys=True), hashlib.sha256(b"".join(parts)).hexdigest())
"""
"""A whole bench; prints its result and a digest of every row."""


def test_a_whole_bench_compiled_or_not_gives_the_same_bits(tmp_path):
    """Homing over a cam, motion over corners, a measuring run: all that the laws do."""
    machine = Path(__file__).parents[2] / "benchmarks" / "machines" / "three_axes"
    settings = {
        "axis.Z.kenngr.measure.signal": "DRIVE",
        "axis.X.kenngr.abs_pos_gueltig": 0,
        "axis.X.antr.reference_cam_signal": "STATUS_DIG_INPUTS",
        "axis.X.input.home": "cam.X",
        "axis.X.getriebe[0].vb_reflow": 80_000,
        "plant.probe.Z.face_mm": 290.0,
        "plant.probe.Z.material": "below",
        "plant.probe.sigma_um": 0.7,
        "plant.probe.bounce_us": 1500.0,
    }
    program = "%p\nN10 G74 X1\nN20 G90 G01 X10 Y5 Z295 F20000\nX11 Y4\nN30 G100 Z280 F2000\nN40 M30\n"
    words = [sys.executable, "-c", WHOLE, str(machine), json.dumps(settings), program]

    def said(disabled: str) -> str:
        environment = {**os.environ, "NUMBA_DISABLE_JIT": disabled}
        return subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout

    compiled = said("0")
    assert json.loads(compiled.rsplit(" ", 1)[0])["status"] == "completed"
    assert said("1") == compiled
