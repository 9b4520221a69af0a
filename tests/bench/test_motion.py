"""Path motion: junctions, override, feedhold, monitoring, history, software limits."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

import hli_bench
from hli_bench import Bench
from hli_bench.kernel.position_controller import history
from hli_bench.laws.rows import SEGMENTS

X, Y, Z = 0, 1, 2
FULL = 1000

OVERRIDE = '''
from hli_bench.plc import Plc

class Override(Plc):
    """Override as the test says, from the cycle it says."""
    steps = {steps}

    def start(self, hli, io):
        self.n = 0
        hli.ch[1].head.plc_present_w = True
        for n in (1, 2, 3):
            hli.ax[n].head.plc_present_w = True
        unit = hli.ch[1].bahn_mc_control
        unit.override_feedrate.enable_w = True
        unit.override_feedrate.command_w = 1000
        unit.feedhold.enable_w = True
        for n in (1, 2, 3):
            hli.ax[n].lr_mc_control.release_feedhold.enable_w = True
            hli.ax[n].lr_mc_control.release_feedhold.command_w = True

    def cycle(self, hli, io):
        self.n += 1
        channel, axes = hli.ch[1].bahn_mc_control, hli.ax
        for cycle, code in self.steps:
            if cycle == self.n:
                exec(code, dict(channel=channel, axes=axes))
'''


@pytest.fixture
def acts(script):
    """Return a maker of PLC scripts that do something in given PLC cycles."""
    return lambda *steps: script(OVERRIDE.replace("{steps}", repr(steps)), "acts")


def path_speed(recorder) -> np.ndarray:
    return np.hypot(recorder.velocity(X), recorder.velocity(Y))


def test_path_of_two_axes_is_straight_and_ends_exactly(make, recorder):
    bench = make(recorder=recorder)
    result = bench.run("%p\nN10 G01 X30 Y40 F6000\nN20 M30\n")
    x, y = recorder.column("command", X), recorder.column("command", Y)

    assert result.completed
    assert (x[-1], y[-1]) == (300_000.0, 400_000.0)
    assert np.max(np.abs(x * 4.0 - y * 3.0)) < 1e-4
    assert path_speed(recorder).max() == pytest.approx(100.0, abs=1e-6)
    bench.advance(300)
    assert bench.position_mm("X") == pytest.approx(30.0, abs=1e-4)
    assert bench.position_mm("Y") == pytest.approx(40.0, abs=1e-4)


def test_collinear_blocks_run_through(make, recorder):
    blocks = "".join(f"N{n} G01 X{n} Y{2 * n} F3000\n" for n in range(1, 21))
    bench = make(recorder=recorder)
    bench.run(f"%p\n{blocks}N99 M30\n")
    speed = path_speed(recorder)
    moving = np.flatnonzero(speed > 1e-6)
    cruise = speed[moving[0] : moving[-1] + 1]

    assert cruise[60:-60].min() == pytest.approx(50.0, abs=1e-6), "no dip at any of 19 block ends"


def test_corner_is_taken_no_faster_than_the_axes_can(make, recorder):
    bench = make(recorder=recorder)
    bench.run("%p\nN10 G01 X10 F3000\nN20 Y10\nN30 M30\n")
    y = recorder.column("command", Y)
    turn = int(np.flatnonzero(y > y[0])[0])
    rate = bench.config.axis("X").params.getriebe[0].lslope_profil.a_stufe_1

    assert path_speed(recorder)[turn - 2 : turn + 1].min() <= 1.5 * rate * 1e-3
    for axis in (X, Y):
        steps = np.abs(np.diff(recorder.velocity(axis))) / 1e-3
        assert steps.max() <= 2.0 * rate + 1e-3, "a transition may use one more cycle of acceleration"


def test_short_blocks_are_looked_ahead_over(make, recorder):
    """200 blocks of 0.1 mm: the path reaches its feed, because it may brake over many of them."""
    blocks = "".join(f"G01 X{n / 10:.1f} F6000\n" for n in range(1, 201))
    bench = make(recorder=recorder)
    result = bench.run(f"%p\n{blocks}M30\n")

    assert result.completed
    # the ring holds 63 blocks, 6.3 mm: enough to brake from sqrt(2 a s)
    rate = bench.config.axis("X").params.getriebe[0].lslope_profil.a_stufe_1
    least = min(100.0, 0.6 * math.sqrt(2 * rate * 6.3))
    assert path_speed(recorder).max() >= least
    assert recorder.column("command", X)[-1] == 200_000.0


@pytest.mark.parametrize(("override", "factor"), [(500, 0.5), (1000, 1.0), (100, 0.1)])
def test_channel_override_scales_the_feed(make, recorder, acts, override, factor):
    bench = make(recorder=recorder, plc=[acts((1, f"channel.override_feedrate.command_w = {override}"))])
    bench.advance(5)
    bench.run("%p\nN10 G01 X20 F3000\nN20 M30\n")

    assert path_speed(recorder).max() == pytest.approx(50.0 * factor, abs=1e-6)


def test_override_counts_only_while_it_is_enabled_and_acts_on_the_run(make, recorder, acts):
    steps = (
        (150, "channel.override_feedrate.command_w = 200"),
        (400, "channel.override_feedrate.enable_w = False"),
    )
    bench = make(recorder=recorder, plc=[acts(*steps)])
    bench.run("%p\nN10 G01 X40 F3000\nN20 M30\n")
    speed = path_speed(recorder)
    start = recorder.writes[0].cycle

    assert speed[start + 140] == pytest.approx(50.0, abs=1e-6)
    assert speed[start + 300] == pytest.approx(10.0, abs=1e-6)
    assert speed[start + 500] == pytest.approx(50.0, abs=1e-6)


@pytest.mark.req("M-190", "M-191")
@pytest.mark.parametrize(("current", "rate"), [(0, 1000.0), (1, 2500.0)])
def test_feedhold_of_the_channel_brakes_with_the_ramp_of_p_chan_00097(make, recorder, acts, current, rate):
    settings = {"channel.use_drive_curr_limit": current}
    for axis in "XY":
        slope = f"axis.{axis}.getriebe[0].lslope_profil"
        settings |= {f"{slope}.a_feedh": 2500, f"{slope}.a_stufe_1": 1000, f"{slope}.a_stufe_2": 1000}
    bench = make(
        settings,
        recorder=recorder,
        plc=[acts((200, "channel.feedhold.command_w = True"), (500, "channel.feedhold.command_w = False"))],
    )
    result = bench.run("%p\nN10 G01 X40 F3000\nN20 M30\n")
    speed = path_speed(recorder)
    start = recorder.writes[0].cycle
    change = np.diff(speed) / 1e-3
    held = change[start + 190 : start + 400]

    assert result.completed
    assert held.min() == pytest.approx(-rate, abs=1.0)
    assert speed[start + 300 : start + 490].max() == 0.0
    assert recorder.column("command", X)[-1] == 400_000.0


def test_missing_feed_release_of_a_moving_axis_stops_the_path(make, recorder, acts):
    off = "axes[1].lr_mc_control.release_feedhold.command_w = False"
    on = "axes[1].lr_mc_control.release_feedhold.command_w = True"
    bench = make(recorder=recorder, plc=[acts((200, off), (500, on))])
    bench.run("%p\nN10 G01 X40 Y40 F3000\nN20 M30\n")
    start = recorder.writes[0].cycle
    speed = path_speed(recorder)

    assert speed[start + 300 : start + 490].max() == 0.0
    assert recorder.column("command", Y)[-1] == 400_000.0


def test_missing_feed_release_of_a_standing_axis_does_not_stop_the_others(make, recorder, acts):
    off = "axes[2].lr_mc_control.release_feedhold.command_w = False"
    bench = make(recorder=recorder, plc=[acts((100, off))])
    result = bench.run("%p\nN10 G01 X40 F3000\nN20 M30\n")

    assert result.completed
    assert path_speed(recorder)[recorder.writes[0].cycle + 300] == pytest.approx(50.0, abs=1e-6)


@pytest.mark.parametrize("at_ms", [100, 700, 822], ids=["long before", "as braking would begin", "too late"])
def test_a_way_of_an_axis_that_is_not_released_is_entered_from_rest(make, recorder, acts, at_ms):
    """X runs on into the way of Y and Z at its feed; Y loses its release while X is on its own way.

    What it takes to stand at the border is the braking path of X; nearer than that, braking begins at once.
    """
    unit = "axes[2].lr_mc_control.release_feedhold.command_w"
    bench = make(recorder=recorder, plc=[acts((at_ms, f"{unit} = False"), (2000, f"{unit} = True"))])
    result = bench.run("%p\nN10 G01 X40 F3000\nN20 G01 X80 Y0.01\nN30 M30\n")
    held = slice(recorder.writes[0].cycle + 2, recorder.writes[-1].cycle - 3)
    x, y = recorder.column("command", X)[held], recorder.column("command", Y)[held]

    assert result.completed
    assert path_speed(recorder)[held][-1] == 0.0
    assert np.abs(np.diff(path_speed(recorder)) / 1e-3).max() <= 4000.0, "no rate beyond that of a feedhold"
    if at_ms == 822:
        assert 400_000.0 < x[-1] < 440_000.0
    else:
        assert (x[-1], y.min(), y.max()) == (400_000.0, 0.0, 0.0)
    assert recorder.column("command", X)[-1] == 800_000.0
    assert recorder.column("command", Y)[-1] == 100.0


WEAK = "#DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=1 WAIT]\n#DRIVE WR SYN [AX=X KEY=MON_WINDOW VAL=4294967295 WAIT]\n"


def test_lag_above_the_limit_ends_the_program_and_the_axis_stands(make, recorder, errors):
    """1 % torque cannot follow: 70020 (class 8), the axis brakes on P-AXIS-00003 = 4000, nothing moves any more."""
    bench = make({"axis.X.getriebe[0].slep_max": 30_000}, recorder=recorder)
    result = bench.run(f"%p\n{WEAK}N10 G01 X200 F6000\nN20 G01 X0\nN30 M30\n")
    lag = recorder.column("lag", X)
    over = int(np.flatnonzero(np.abs(lag) > 30_000)[0])
    change = np.diff(path_speed(recorder)) / 1e-3

    assert errors(result) == [(70020, "X", "N10")]
    assert result.status == "error"
    assert recorder.column("command", X)[-1] < 2_000_000
    assert change.min() == pytest.approx(-4000.0, abs=1.0), "braked, not cut off"
    assert recorder.records[-1][0] - 1 - over <= 10 + 1, "P-AXIS-00488: 10 ms"
    before = recorder.column("command", X)[-1]
    bench.advance(500)
    assert recorder.column("command", X)[-1] == before


def test_reset_after_a_lag_error_takes_up_the_actual_position(make, recorder):
    bench = make({"axis.X.getriebe[0].slep_max": 30_000}, recorder=recorder)
    bench.run(f"%p\n{WEAK}N10 G01 X200 F6000\nN30 M30\n")
    bench.reset()
    again = bench.run(
        "%p\nN10 #DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=300 WAIT]\nN20 G01 X5 F600\nN30 M30\n"
    )
    bench.advance(300)

    assert again.completed, again.errors
    assert bench.position_mm("X") == pytest.approx(5.0, abs=1e-3)
    assert np.abs(np.diff(recorder.column("actual", X))).max() < 1100.0, "no jump on the way back"
    weak = bench.run(f"%p\n{WEAK}N10 G01 X200 F6000\nN30 M30\n")
    assert [one.id for one in weak.errors] == [70020], "the monitoring is on again"


def test_program_after_a_lag_error_is_monitored_again(make, errors):
    """Without a reset the lag is still there: the next program ends with it too."""
    bench = make({"axis.X.getriebe[0].slep_max": 30_000})
    bench.run(f"%p\n{WEAK}N10 G01 X200 F6000\nN30 M30\n")
    again = bench.run("%p\nN10 G01 Y50 F600\nN20 M30\n")

    assert errors(again) == [(70020, "X", "N10")]


@pytest.mark.parametrize("cycles", range(1, 9))
def test_reset_during_start_up_does_not_keep_the_drives_from_operation(make, recorder, cycles):
    bench = make()
    bench.engine.power_on()
    while bench.engine.cycle < cycles:
        bench.engine.step(cycles)
    bench.reset()
    while not bench.kernel.drives.ready and bench.engine.cycle < 2000:
        bench.engine.step(2000)

    assert bench.kernel.drives.ready
    assert (bench.kernel.rows.axis["statusword"] & 0x6F == 0x27).all()


def test_lag_monitoring_can_be_suppressed(make):
    settings = {"axis.X.getriebe[0].slep_max": 30_000, "axis.X.lr_param.suppress_pos_lag_error": 1}
    result = make(settings).run(f"%p\n{WEAK}N10 G01 X20 F6000\nN30 M30\n")

    assert result.completed
    assert not result.errors


def test_drive_fault_comes_as_emcy_and_a_reset_brings_the_drive_back(make, recorder, errors):
    """Following error window 0.1 mm in the drive: EMCY 8611, error 70222, reset, then it moves again."""
    bench = make({"axis.X.lr_param.suppress_pos_lag_error": 1}, recorder=recorder)
    window = round(0.1 / 10 * 1_048_576)
    faulty = (
        "%p\n#DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=1 WAIT]\n"
        f"#DRIVE WR SYN [AX=X KEY=MON_WINDOW VAL={window} WAIT]\nN10 G01 X20 Y20 F6000\nN20 M30\n"
    )
    result = bench.run(faulty)
    emergencies = [frame for _, frame in recorder.bus if frame.cob_id == 0x81]

    assert errors(result) == [(70222, "X", "N10")]
    assert "0x8611" in result.errors[0].text
    assert emergencies[0].data[:2] == bytes((0x11, 0x86))
    bench.advance(1500)
    assert recorder.column("statusword", X)[-1] & 0x4F == 0x08
    y = recorder.velocity(Y)
    assert (np.diff(y) / 1e-3).min() > -2001.0, "the other axis brakes"
    bench.reset()
    again = bench.run(
        "%p\n#DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=300 WAIT]\n"
        "#DRIVE WR SYN [AX=X KEY=MON_WINDOW VAL=4294967295 WAIT]\nN10 G01 X7 F600\nN20 M30\n"
    )
    bench.advance(300)
    assert again.completed, again.errors
    assert recorder.column("statusword", X)[-1] & 0x6F == 0x27
    assert bench.position_mm("X") == pytest.approx(7.0, abs=1e-3)


def test_no_program_runs_while_a_drive_is_out_of_operation(make, errors):
    bench = make({"axis.X.lr_param.suppress_pos_lag_error": 1})
    window = round(0.1 / 10 * 1_048_576)
    bench.run(
        "%p\n#DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=1 WAIT]\n"
        f"#DRIVE WR SYN [AX=X KEY=MON_WINDOW VAL={window} WAIT]\nN10 G01 X20 F6000\nN20 M30\n"
    )
    others = bench.run('%p\nN5 #MSG["runs"]\nN10 G01 Y5 F600\nN20 M30\n')

    assert errors(others) == [(70101, "X", "")]
    assert not others.completed
    assert not others.messages
    assert bench.position_mm("Y") == pytest.approx(0.0, abs=1e-3)


def test_reset_in_full_motion_brakes_and_the_next_program_begins_at_rest(make, recorder):
    bench = make(recorder=recorder)
    bench.start_up()
    bench.kernel.start(["%p", "N10 G01 X100 Y50 F6000", "N20 M30"], "p")
    bench.engine.wake()
    bench.advance(400)
    bench.reset()
    result = bench.run("%p\nN10 G01 X0 Y0 F6000\nN20 M30\n")

    assert result.completed
    assert np.abs(np.diff(recorder.velocity(X)) / 1e-3).max() < 2001.0
    assert recorder.column("command", X)[-1] == recorder.column("command", Y)[-1] == 0.0


@pytest.mark.req("M-181")
def test_history_holds_the_positions_of_their_instants(make, recorder):
    """Every sample of the history is the position in the telegram of its SYNC; between them a cubic."""
    bench = make(recorder=recorder)
    bench.run("%p\nN10 G01 X10 Y-5 F6000\nN20 M30\n")
    core = bench.kernel.core
    actual, last = recorder.column("actual", X), bench.engine.cycle

    for cycle in range(last - 150, last - 3, 7):
        at = bench.kernel.setup.dc_epoch_ns + cycle * 1_000_000
        assert history.position(core, X, at) == pytest.approx(actual[cycle - 1], abs=1e-6)
        between = history.position(core, X, at + 500_000)
        assert min(actual[cycle - 1], actual[cycle]) - 0.2 <= between
        assert between <= max(actual[cycle - 1], actual[cycle]) + 0.2
    assert history.position(core, X, bench.kernel.setup.dc_epoch_ns + (last + 1) * 1_000_000) is None


@pytest.mark.req("H-005", "H-027")
@pytest.mark.parametrize(("start", "target", "number"), [(70, 90, 120002), (-510, -530, 120003)])
def test_software_limits_act_on_a_homed_axis_only(make, errors, start, target, number):
    limits = {"axis.X.kenngr.swe_pos": 800_000, "axis.X.kenngr.swe_neg": -5_200_000, "axis.X.start_mm": start}
    program = f"%p\nN10 G01 X{target} F6000\nN20 M30\n"
    bench = make(limits)
    absolute = bench.run(program)
    bench.advance(100)
    incremental = make(limits | {"axis.X.kenngr.abs_pos_gueltig": 0}).run(program)

    assert bench.position_mm("X") == pytest.approx(start, abs=1e-3), "not one step"
    assert errors(absolute) == [(number, "X", "N10")]
    assert incremental.completed


@pytest.mark.req("H-005")
def test_software_limits_act_on_a_measuring_run_too(make, errors):
    result = make({"axis.Z.start_mm": 0.0, "axis.Z.kenngr.swe_pos": 500_000}).run(
        "%p\nN10 G100 Z60 F6000\nN20 M30\n"
    )

    assert errors(result) == [(120002, "Z", "N10")]


def test_software_limits_hold_for_a_rotary_axis(make, errors):
    result = make({"axis.A.kenngr.swe_pos": 450_000}).run("N10 G01 A50 F6000\nN20 M30\n")
    assert errors(result) == [(120002, "A", "N10")]


def test_a_block_beyond_a_limit_is_not_executed_and_those_before_it_are(make, errors):
    bench = make({"axis.X.kenngr.swe_pos": 300_000})
    result = bench.run("N10 G01 X20 F6000\nN20 G01 X40 Y10\nN30 M30\n")
    assert errors(result) == [(120002, "X", "N20")]
    command = bench.kernel.rows.axis["command"]
    assert (command[X], command[Y]) == (200_000, 0)


def test_an_absolute_axis_that_homes_away_from_its_cam_stops_at_its_limit(make, errors):
    """The cam lies on the other side: 70021 with P-AXIS-00179, and the axis may move back."""
    settings = {"axis.X.kenngr.ref_richt": 1, "axis.X.kenngr.swe_pos": 300_000}
    bench = make(settings)
    assert errors(bench.run("N10 G74 X1\nN20 M30\n")) == [(70021, "X", "N10")]
    assert bench.kernel.core.at_rest
    assert 30.0 < bench.position_mm("X") < 35.0
    bench.reset()
    assert bench.run("N10 G01 X10 F6000\nN20 M30\n").completed


def test_motion_before_homing_can_be_forbidden(make, errors):
    settings = {"axis.X.kenngr.abs_pos_gueltig": 0, "axis.X.kenngr.prog_move_requires_homing": 1}

    assert errors(make(settings).run("%p\nN10 G01 X1 F600\nN20 M30\n")) == [(51082, "X", "N10")]


@pytest.mark.req("M-106")
def test_synchronous_text_comes_when_its_place_is_reached(make, recorder):
    """SYN waits for the interpolator, without it the text comes at decoding."""
    bench = make(recorder=recorder)
    bench.run('%p\nN10 G01 X10 F600\nN20 #MSG SYN["syn"]\nN30 #MSG["now"]\nN40 G01 X20\nN50 M30\n')
    at = {record.text: cycle for cycle, record in recorder.records}
    x = recorder.column("command", X)

    assert at["now"] < at["syn"]
    assert abs(x[at["syn"] - 2] - 100_000) <= 120
    assert x[at["now"] - 1] < 1_000


def test_axis_passes_the_wrap_of_its_32_bit_position(make, recorder):
    """20 480 mm are 2^31 increments: 6064 and 607A wrap, the CNC does not."""
    bench = make({"axis.X.start_mm": 20_475.0, "axis.X.kenngr.swe_pos": 300_000_000}, recorder=recorder)
    result = bench.run("%p\nN10 G91 G01 X10 F6000\nN20 M30\n")
    bench.advance(200)

    assert result.completed, result.errors
    assert bench.position_mm("X") == pytest.approx(20_485.0, abs=1e-3)
    assert recorder.column("position", X)[-1] < 0
    assert np.abs(recorder.column("lag", X)[20:]).max() < 5_000


def test_reset_in_short_blocks_brakes_over_their_ends(make, recorder):
    """0.1 mm blocks at 100 mm/s: the braking way is 25 blocks long."""
    bench = make({"axis.X.getriebe[0].vb_eilgang": 500_000}, recorder=recorder)
    blocks = [f"G01 X{n / 5:.1f} F6000" for n in range(1, 200)]
    bench.kernel.start(["%p", *blocks, "M30"], "p")
    bench.engine.wake()
    bench.advance(180)
    fastest = path_speed(recorder).max()
    bench.reset()
    bench.advance(300)
    change = np.diff(path_speed(recorder)) / 1e-3

    assert fastest > 60.0
    assert change.min() >= -1001.0
    assert bench.kernel.core.at_rest


@pytest.mark.parametrize(("largest", "factor"), [(1000, 1.0), (1200, 1.2), (600, 0.6)])
def test_override_is_limited_by_p_chan_00056(make, recorder, acts, largest, factor):
    plc = acts((1, "channel.override_feedrate.command_w = 1500"))
    bench = make({"channel.max_vb_override": largest}, recorder=recorder, plc=[plc])
    bench.run("%p\nN10 G01 X20 F3000\nN20 M30\n")

    assert path_speed(recorder).max() == pytest.approx(50.0 * factor, abs=1e-6)


def test_any_number_of_texts_may_wait_for_their_place(make, recorder):
    """Texts behind a motion wait in line: only the first of them needs to be watched."""
    bench = make(recorder=recorder)
    texts = "".join(f'#MSG SYN["{n}"]\n' for n in range(100))
    result = bench.run(f"%p\nN10 G01 X10 F6000\nN15 G01 X20\n{texts}N20 G01 X30\nN30 M30\n")
    at = [cycle for cycle, record in recorder.records]

    assert result.completed, result.errors
    assert [one.text for one in result.messages] == [str(n) for n in range(100)]
    assert at[0] > 100
    assert at[0] == at[-1], "they have the same place"


def test_many_axes_are_watched_at_the_same_time(tmp_path):
    """26 axes with their lag monitored: more conditions than a machine of six axes needs."""
    parameters = (Path(hli_bench.__file__).parent / "machines" / "demo" / "x.lis").read_text()
    lines = ["cycle_us = 1000"]
    for number in range(1, 27):
        text = re.sub(r"(?m)^(kopf\.achs_nr\s+)\d+", rf"\g<1>{number}", parameters)
        (tmp_path / f"x{number}.lis").write_text(text)
        lines += [f"[axis.X{number}]", f'list = "x{number}.lis"', 'drive = "drives.models.servo402"']
        lines += [f"node_id = {number}", f"[plant.axis.X{number}]", "pitch_mm = 10.0"]
    (tmp_path / "machine.toml").write_text("\n".join(lines) + "\n")
    words = " ".join(f"X{number}=5" for number in range(1, 27))
    with Bench(tmp_path, plc=[]) as bench:
        result = bench.run(f"%p\nN10 G01 {words} F60000\nN20 M30\n")

    assert result.completed, result.errors


@pytest.mark.parametrize(
    ("body", "rounds", "cycles"),
    [("P2 = P1 + 1", 10_000, 10), ('#MSG["%d", P1]', 1_000, 5), ("P2 = V.A.ABS.X", 1_000, 1)],
)
def test_loop_without_motion_takes_its_cycles(make, body, rounds, cycles):
    """2000 blocks without motion and 200 steps a cycle: time goes on while a program only computes."""
    result = make().run(f"%p\n$FOR P1 = 1, {rounds}\n{body}\n$ENDFOR\nM30\n")

    assert result.completed, result.errors
    assert cycles <= result.cycles <= 6 * cycles


def test_endless_loop_without_motion_can_be_ended(make):
    bench = make()
    endless = bench.run("%p\nP1 = 0\n$WHILE 1\nP1 = P1 + 1\n$ENDWHILE\nM30\n", limit_s=0.01)
    texts = bench.run('%p\nN5 G01 X1 F600\n$WHILE 1\n#MSG SYN["a"]\n$ENDWHILE\nM30\n', limit_s=0.05)

    assert not endless.completed
    assert not texts.completed
    assert not texts.messages, "their place is 100 ms away"
    assert bench.run("%p\nN10 G01 X2 F6000\nN20 M30\n").completed


def test_blocks_are_decoded_ahead_of_the_motion_and_no_further_than_the_look_ahead():
    """Bounded memory however long a program is: what has been read is at most the segment ring ahead."""
    read, ahead = [0], []

    def lines():
        for number in range(1, 2001):
            read[0] = number
            yield f'#MSG SYN["{number}"]' if number % 10 == 0 else f"G90 G01 X{number / 100:.2f} F6000"
        yield "M30"

    with Bench("demo", on_record=lambda record: ahead.append(read[0] - int(record.text)), plc=[]) as bench:
        result = bench.run(lines())

    assert result.completed
    assert len(ahead) == 200
    assert max(ahead) < 1.2 * SEGMENTS
    assert min(ahead[:-8]) >= SEGMENTS // 2, "the path never waits for the decoder"
