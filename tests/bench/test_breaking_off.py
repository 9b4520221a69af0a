"""Whatever breaks off, whoever raised it: every axis brakes, in that cycle, and the bench goes on."""

import random

import numpy as np
import pytest

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.position_controller.homing import default
from hli_bench.kernel.position_controller.probing import plc
from hli_bench.laws.rows import JOG, W_FREE, W_NONE
from hli_bench.manual.errors import ErrorSheet, ReactionClass

X, Y, Z, A = 0, 1, 2, 4
LONG = "N10 G01 X100 Y50 F6000\nN20 M30\n"
CYCLE_S = 1e-3
EMERGENCY = {f"axis.{name}.getriebe[0].dynamik.a_emergency": 3500 for name in "XYZA"}
FEEDHOLD: dict[str, object] = {f"axis.{name}.getriebe[0].lslope_profil.a_feedh": 1500 for name in "XYZA"}
FEEDHOLD["channel.use_drive_curr_limit"] = 1
INCREMENTAL = {f"axis.{name}.kenngr.abs_pos_gueltig": 0 for name in "XYZ"}


def stands(bench, cycles: int = 600) -> bool:
    """Tell whether no set point moves, now and for some time."""
    before = bench.kernel.rows.axis["command"].copy()
    bench.advance(cycles)
    return bench.kernel.core.at_rest and np.array_equal(before, bench.kernel.rows.axis["command"])


def watched(bench) -> int:
    return int(np.isin(bench.kernel.rows.watch["kind"], (W_NONE, W_FREE), invert=True).sum())


def begin(bench, text: str, cycles: int) -> None:
    """Begin a program and let so many cycles of it pass."""
    bench.start_up()
    bench.kernel.start(text.splitlines(), "p")
    bench.engine.wake()
    bench.advance(cycles)


class At:
    """Observer that does something behind one cycle."""

    def __init__(self, cycle: int, what) -> None:
        self.cycle = cycle
        self.what = what

    def cycles(self, first: int, count: int) -> None:
        if self.what is not None and first + count > self.cycle:
            what, self.what = self.what, None
            what()

    def frames(self, *_: object) -> None: ...

    edges = emitted = commands = refused = frames


def test_homing_of_a_spindle_is_refused_before_an_axis_moves(make, recorder):
    bench = make(INCREMENTAL, recorder=recorder)
    with pytest.raises(NotEmulated, match=r"h\.nc:2:.*.*G74: homing of spindle S"):
        bench.run("%h\nN10 G74 Y1 S1\nN20 M30\n", "h.nc")
    assert np.ptp(recorder.column("target", Y)[20:]) == 0
    assert stands(bench)
    assert bench.run("N10 G01 Y5 F6000\nN20 M30\n").completed


@pytest.mark.parametrize("words", ["Z1 Y1", "Y1 Z1", "X1 Z1 Y1"])
def test_an_error_of_one_axis_stops_the_others_in_the_cycle_in_which_it_comes(make, recorder, words):
    """No PLC wakes the kernel here."""
    bench = make(INCREMENTAL | {"axis.Z.kenngr.homing.homing_type": "DISABLED"}, recorder=recorder, plc=[])
    result = bench.run(f"N10 G74 {words}\nN20 M30\n")
    assert [error.id for error in result.errors] == [50686]
    for axis in (X, Y):
        assert np.ptp(recorder.column("target", axis)[20:]) == 0
    assert stands(bench)


def test_a_late_error_of_one_homing_axis_brakes_the_other_at_once(make, recorder):
    settings = INCREMENTAL | {
        "axis.X.lr_hw[0].zero_pulse_search_max_dist": 1_000,
        "plant.cam.X.from_mm": -10_000,
        "plant.cam.X.to_mm": -2,
        "plant.axis.X.zero_pulse_offset_mm": 5.0,
        "plant.cam.Y.from_mm": -10_000,
        "plant.cam.Y.to_mm": -9_000,
    }
    bench = make(settings, recorder=recorder)
    result = bench.run("N10 G74 X1 Y1\nN20 M30\n")
    assert [(error.id, error.axis) for error in result.errors] == [(70380, "X")]
    error = recorder.records[-1][0]
    speed = np.abs(np.diff(recorder.column("target", Y).astype(np.int64)))
    assert speed[error - 3] > 0
    assert (np.diff(speed[error - 1 : error + 20]) <= 1).all()
    assert speed[error + 1] < speed[error - 3]
    assert stands(bench)


@pytest.mark.parametrize("failing", [1, 2])
def test_a_strategy_that_fails_leaves_a_bench_that_stands_and_goes_on(make, monkeypatch, failing):
    """The first or second axis of a group; the error comes out of the run when everything stands."""
    bench = make(INCREMENTAL)
    bench.start_up()
    before = watched(bench)
    calls, table = [], default.table

    def broken(run):
        calls.append(run.axis)
        if len(calls) == failing:
            raise KeyError("a fault in a strategy")
        return table(run)

    monkeypatch.setattr(default, "table", broken)
    with pytest.raises(KeyError, match="a fault in a strategy"):
        bench.run("N10 G74 X1 Y1\nN20 M30\n")
    assert bench.kernel.core.at_rest
    assert stands(bench)
    assert watched(bench) == before
    assert bench.state()["state"] == "error"
    bench.reset()
    assert bench.state()["state"] == "ready"
    assert bench.run("N10 G01 X5 Y-5 F6000\nN20 M30\n").completed


def test_a_strategy_that_fails_in_mid_motion_brakes_all_axes(make, monkeypatch, recorder):
    bench = make(INCREMENTAL, recorder=recorder)

    def broken(run):
        raise RuntimeError("a fault on the cam")

    monkeypatch.setattr(default, "_stop", broken)
    with pytest.raises(RuntimeError, match="a fault on the cam"):
        bench.run("N10 G74 X1 Y1\nN20 M30\n")
    assert stands(bench)
    for axis in (X, Y):
        assert np.abs(np.diff(recorder.velocity(axis))).max() <= 1.01, "a ramp of P-AXIS-00285"
    monkeypatch.undo()
    assert bench.run("N10 G74 X1 Y1\nN20 M30\n").completed


def test_a_source_that_fails_switches_off_and_the_next_run_measures(make, monkeypatch, face, recorder):
    bench = make(face, recorder=recorder)

    def broken(*_):
        raise IndexError("a fault at the edge")

    monkeypatch.setattr("hli_bench.kernel.position_controller.probing.plc_timestamp.latched", broken)
    with pytest.raises(IndexError, match="a fault at the edge"):
        bench.run("N10 G90 G00 Z110\nN20 G100 Z90 F3000\nN30 M30\n")
    assert stands(bench)
    image = bench.kernel.image
    assert not image.get(image.layout.element("ax/3/lr_state/measurement_active_r").id)
    monkeypatch.undo()
    assert plc.UNIT
    assert bench.run("N10 G90 G00 Z110\nN20 G100 Z90 F3000\nN30 M30\n").measurements


def test_text_that_is_wrong_in_mid_run_is_told_when_everything_stands(make, recorder):
    bench = make(recorder=recorder)
    with pytest.raises(InputError, match=r"p\.nc:2:"):
        bench.run("N10 G01 X100 F6000\nN20 X 1 ?\nM30\n", "p.nc")
    assert bench.kernel.core.at_rest
    assert stands(bench)


def test_a_division_by_zero_behind_motion_leaves_nothing_moving(make):
    bench = make()
    with pytest.raises((InputError, NotEmulated)):
        bench.run("N10 G01 X20 F6000\nN20 P1=1/0\nN30 M30\n")
    assert stands(bench)


def test_an_error_of_the_program_lets_run_out_what_is_prepared(make, recorder):
    """Class 2: the interpolator executes the blocks prepared, with their texts; the block itself is not executed."""
    bench = make(recorder=recorder)
    result = bench.run('N10 G01 X20 F6000\nN20 #MSG SYN["there"]\nN30 G01 X30\nN40 G101 X1\nN50 X0\nM30\n')
    assert result.status == "error"
    assert bench.kernel.rows.axis[X]["command"] == 300_000
    assert [message.text for message in result.messages] == ["there"]


def sheet(reaction: ReactionClass) -> ErrorSheet:
    return ErrorSheet(
        number=70_999,
        name="test",
        text="test",
        reaction_class=reaction,
        remedy_class=6,
    )


@pytest.mark.parametrize(
    ("reaction", "named", "other"),
    [
        (ReactionClass.ABORT_PROGRAM, None, None),
        (ReactionClass.FEEDHOLD_GROUP, 1500, 750),
        (ReactionClass.STOP_AXIS, 3500, 750),
        (ReactionClass.STOP_ALL, 3500, 3500),
        (ReactionClass.CONTROLLED_STOP, 1500, 750),
        (ReactionClass.OPEN_LOOP_STOP, 3500, 750),
    ],
)
def test_each_class_has_its_ramp(make, recorder, reaction, named, other):
    """X is named by the error, Y is not: it moves half as fast, with half the path's deceleration along the path."""
    bench = make(EMERGENCY | FEEDHOLD, recorder=recorder)
    begin(bench, LONG, 0)
    core = bench.kernel.core
    at = bench.engine.cycle + 500

    def fail() -> None:
        core.report(sheet(reaction), Source("N10", 1), axis=X)
        bench.engine.wake()

    bench.engine.observers.append(At(at, fail))
    while bench.engine.cycle < at:
        bench.advance(at - bench.engine.cycle)
    bench.advance(3000)
    ends = {axis: float(core.row(axis)["command"]) for axis in (X, Y)}
    assert core.at_rest
    assert not bench.kernel.channel.running
    if named is None:
        assert ends == {X: 1_000_000, Y: 500_000}
        return
    for axis, rate in ((X, named), (Y, other)):
        slowest = (np.diff(recorder.velocity(axis)) / CYCLE_S).min()
        assert slowest == pytest.approx(-rate, rel=1e-3)
    first = recorder.velocity(X)[at - 1 : at + 3]
    assert first[1] < first[0] - 1.0, "in the cycle behind the report"
    assert bench.run("N10 G01 X0 Y0 F6000\nN20 M30\n").completed


def test_what_is_aborted_stands_when_the_run_returns(make):
    bench = make()
    assert bench.run(LONG, limit_s=0.5).cycles == 500
    assert stands(bench)


def test_an_interrupt_in_the_middle_of_a_decision_stops_the_axes(make, monkeypatch):
    bench = make(INCREMENTAL)

    def interrupted(run):
        raise KeyboardInterrupt

    monkeypatch.setattr(default, "_stop", interrupted)
    with pytest.raises(KeyboardInterrupt):
        bench.run("N10 G74 X1 Y1\nN20 M30\n")
    assert bench.interrupted is not None
    assert bench.interrupted.status == "aborted"
    assert stands(bench)


@pytest.mark.parametrize("seed", range(12))
def test_a_reset_at_any_instant_of_homing_leaves_a_bench_that_stands_and_homes(make, seed):
    """Also with the axis held, and with two axes in different phases."""
    rng = random.Random(seed)
    bench = make(INCREMENTAL | {"axis.X.start_mm": 5, "axis.Y.start_mm": rng.choice([-60, -300, 40])})
    begin(bench, "N10 G74 X1 Y1\nN20 M30\n", rng.randrange(1, 9000))
    bench.reset()
    bench.advance(400)
    assert stands(bench)
    assert not (bench.kernel.rows.axis["mode"] == JOG).any() or bench.kernel.core.at_rest
    assert not bench.kernel.rows.axis["probe_function"].any()
    assert bench.run("N10 G74 X1 Y1\nN20 M30\n").completed


HOLDING = """
from hli_bench.plc import Plc

class Holding(Plc):
    def start(self, hli, io):
        self.n = 0
        for n in (1, 2):
            axis = hli.ax[n]
            axis.head.plc_present_w = True
            axis.lr_mc_control.release_feedhold.enable_w = True
            axis.lr_mc_control.release_feedhold.command_w = True
            axis.lr_mc_control.reference_cam.enable_w = True
    def cycle(self, hli, io):
        self.n += 1
        for n, cam in ((1, io.cams.ch1), (2, io.cams.ch2)):
            hli.ax[n].lr_mc_control.release_feedhold.command_w = self.n < 300
            hli.ax[n].lr_mc_control.reference_cam.command_w = cam.input
        if self.n == {dies}:
            raise ValueError("gone")
"""


@pytest.mark.parametrize("program", ["N10 G74 X1 Y1\nN20 M30\n", LONG])
def test_axes_that_were_held_do_not_go_on_when_their_plc_dies_or_the_program_is_reset(make, script, program):
    """Its units fall back to released: nothing may move for that."""
    from hli_bench.base.errors import BenchError

    held = make(INCREMENTAL, plc=[script(HOLDING.format(dies=900))])
    with pytest.raises(BenchError):
        held.run(program)
    assert stands(held)
    aborted = make(INCREMENTAL, plc=[script(HOLDING.format(dies=-1), "alive")])
    assert aborted.run(program, limit_s=1.0).status == "aborted"
    assert stands(aborted)
