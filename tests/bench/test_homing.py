"""NC-controlled homing, default strategy, cam through terminal, PLC and HLI (homing manual 2 to 2.3.1, 4.2)."""

import itertools

import numpy as np
import pytest

from hli_bench.base.errors import NotEmulated
from hli_bench.kernel.records import Homed
from hli_bench.laws.rows import JOG

X, Y, Z = 0, 1, 2
CAM_EDGE_MM = -50.0
PITCH_MM = 10.0
ZERO_PULSE_MM = -55.0
"""Half a turn behind the cam's edge."""
TO_THE_INCREMENT = 7e-5
"""mm: two increments, and positions are told in whole tenths of a µm."""
REFERENCE = -550_000
SETTLE = 400
FAST_UM, SLOW_UM = 50_000, 5_000


def axis(name: str, start_mm: float, **more: object) -> dict[str, object]:
    """Return an incremental axis with its cam below -50 and the zero pulse at -55 (both machine coordinates)."""
    values: dict[str, object] = {
        f"axis.{name}.start_mm": start_mm,
        f"axis.{name}.kenngr.abs_pos_gueltig": 0,
        f"axis.{name}.kenngr.ref_richt": 0,
        f"axis.{name}.getriebe[0].vb_refmax": FAST_UM,
        f"axis.{name}.getriebe[0].vb_reflow": SLOW_UM,
        f"axis.{name}.getriebe[0].a_ref": 1000,
        f"axis.{name}.getriebe[0].pos_refpkt": REFERENCE,
        f"plant.cam.{name}.from_mm": -200.0,
        f"plant.cam.{name}.to_mm": CAM_EDGE_MM,
        f"plant.axis.{name}.zero_pulse_offset_mm": 5.0,
    }
    return values | {f"axis.{name}.{key}": value for key, value in more.items()}


def home(bench, words: str = "X1"):
    return bench.run(f"%home\nN10 G74 {words}\nN20 M30\n")


def truth_mm(bench, number: int) -> float:
    """Where the axis really stands: the plant's, not the CNC's, position."""
    return float(bench.engine.link.rows.servo[number]["angle"]) / (2 * np.pi) * PITCH_MM


def jog_speed(recorder, number: int) -> np.ndarray:
    """Speed of the actual position in mm/s: it does not care for the shift of the axis system."""
    return np.diff(recorder.column("position", number).astype(np.int64)) * PITCH_MM / 1_048_576 / 1e-3


def phases(recorder, number: int) -> list[float]:
    """Return the steady speeds of the set point one after the other, mm/s."""
    target = recorder.column("target", number).astype(np.int64)
    speed = np.round(np.diff(target) * PITCH_MM / 1_048_576 / 1e-3, 1)
    found: list[float] = []
    for i in range(30, len(speed) - 20):
        if np.ptp(speed[i : i + 20]) <= 0.11 and (not found or abs(speed[i] - found[-1]) > 0.3):
            found.append(float(np.round(np.mean(speed[i : i + 20]), 1)))
    return [one for one in found if abs(one) > 0.2]


@pytest.mark.req(
    "H-001",
    "H-009",
    "H-020",
    "H-031",
    "H-036",
    "H-037",
    "H-040",
    "H-041",
    "H-043",
    "H-044",
    "H-046",
    "H-048",
    "H-049",
    "H-159",
    "H-202",
)
def test_three_phases_with_zero_pulse(make, recorder):
    """To the cam fast, off it, onto it slowly, then the zero pulse: the axis knows where it is to one increment."""
    bench = make(axis("X", 3.21), recorder=recorder)
    result = home(bench)
    bench.advance(SETTLE)

    assert result.completed, result.errors
    assert phases(recorder, X) == pytest.approx([-FAST_UM / 1e3, SLOW_UM / 1e3, -SLOW_UM / 1e3], abs=0.15)
    assert [(one.axis, one.position_mm, one.referenced) for one in result.homing] == [("X", -55.0, True)]
    assert bench.position_mm("X") == pytest.approx(truth_mm(bench, X), abs=TO_THE_INCREMENT)
    done = bench.kernel.image.layout.element("ax/1/lr_state/homing_done_r").id
    assert bench.kernel.image.get(done)
    assert bench.kernel.core.referenced[X]
    assert recorder.column("probe_function", X)[-1] == 0, "the latch is switched off again"


@pytest.mark.req("H-007", "H-020", "H-165", "H-199")
@pytest.mark.parametrize("slow_um", [2_000, 5_000, 20_000])
def test_axis_stands_the_braking_distance_behind_its_reference(make, recorder, slow_um):
    """It goes on while the latch travels to the CNC, then brakes with P-AXIS-00285."""
    bench = make(axis("X", 3.21, **{"getriebe[0].vb_reflow": slow_um}), recorder=recorder)
    home(bench)
    bench.advance(SETTLE)
    way = -55.0 - bench.position_mm("X")
    v = slow_um / 1e3
    braking = v * v / (2.0 * 1000.0)

    assert braking <= way <= braking + v * 0.003
    assert truth_mm(bench, X) == pytest.approx(bench.position_mm("X"), abs=TO_THE_INCREMENT)


@pytest.mark.req("H-015", "H-016", "H-041", "H-157", "H-198")
@pytest.mark.parametrize("slow_um", [1_000, 5_000, 20_000, 40_000])
def test_zero_pulse_reference_does_not_depend_on_the_speed(make, slow_um):
    bench = make(axis("X", 3.21, **{"getriebe[0].vb_reflow": slow_um}))
    assert home(bench).completed
    bench.advance(SETTLE)

    assert bench.position_mm("X") == pytest.approx(truth_mm(bench, X), abs=TO_THE_INCREMENT)


@pytest.mark.req("H-010", "H-014", "H-042", "H-050", "H-051", "H-157", "H-198")
@pytest.mark.parametrize("slow_um", [1_000, 5_000, 15_000, 40_000])
def test_cam_reference_is_off_by_speed_times_sampling(make, slow_um):
    """Seen by the PLC's next cycle, acted on one kernel cycle later: (T, 2T] times the speed."""
    settings = axis("X", 3.21, **{"getriebe[0].vb_reflow": slow_um, "kenngr.homing_without_zero_pulse": 1})
    settings["axis.X.getriebe[0].pos_refpkt"] = -500_000
    bench = make(settings)
    result = home(bench)
    bench.advance(SETTLE)
    off_mm = bench.position_mm("X") - truth_mm(bench, X)
    per_cycle = slow_um / 1e3 * 1e-3

    assert result.completed, result.errors
    assert result.homing[0].method == "cam"
    assert per_cycle - 5e-4 <= off_mm <= 2.0 * per_cycle + 5e-4


@pytest.mark.req("H-014")
def test_figure_of_the_manual_6_m_per_min_and_2_ms(make, script):
    """100 mm/s with a PLC of 1 ms in cycles of 1 ms: never more than 0.2 mm."""
    worst = 0.0
    for start in (0.0, 0.013, 0.037, 0.062, 0.088):
        settings = axis(
            "X",
            start,
            **{
                "getriebe[0].vb_reflow": 100_000,
                "getriebe[0].vb_refmax": 100_000,
                "kenngr.homing_without_zero_pulse": 1,
                "getriebe[0].pos_refpkt": -500_000,
            },
        )
        bench = make(settings)
        assert home(bench).completed
        bench.advance(SETTLE)
        worst = max(worst, bench.position_mm("X") - truth_mm(bench, X))

    assert 0.1 <= worst <= 0.2 + 2e-3


@pytest.mark.req("H-045")
def test_axis_on_the_cam_begins_with_phase_two(make, recorder):
    bench = make(axis("X", -60.0), recorder=recorder)
    result = home(bench)
    bench.advance(SETTLE)

    assert result.completed, result.errors
    assert phases(recorder, X) == pytest.approx([SLOW_UM / 1e3, -SLOW_UM / 1e3], abs=0.15)
    assert bench.position_mm("X") == pytest.approx(truth_mm(bench, X), abs=TO_THE_INCREMENT)


@pytest.mark.req("H-047", "H-161", "H-196")
@pytest.mark.parametrize(("fast", "speed"), [(0, SLOW_UM), (1, FAST_UM)])
def test_way_off_the_cam_is_fast_or_slow(make, recorder, fast, speed):
    bench = make(axis("X", -100.0, **{"kenngr.fast_from_cam": fast}), recorder=recorder)
    assert home(bench).completed

    assert phases(recorder, X)[0] == pytest.approx(speed / 1e3, abs=0.15)


@pytest.mark.req("H-043", "H-159", "H-202")
def test_positive_homing_direction(make, recorder):
    settings = axis("X", -3.21, **{"kenngr.ref_richt": 1, "getriebe[0].pos_refpkt": 550_000})
    settings |= {"plant.cam.X.from_mm": 50.0, "plant.cam.X.to_mm": 200.0}
    bench = make(settings, recorder=recorder)
    result = home(bench)
    bench.advance(SETTLE)

    assert result.completed, result.errors
    assert phases(recorder, X) == pytest.approx([FAST_UM / 1e3, -SLOW_UM / 1e3, SLOW_UM / 1e3], abs=0.15)
    assert bench.position_mm("X") == pytest.approx(truth_mm(bench, X), abs=TO_THE_INCREMENT)
    assert bench.position_mm("X") > 55.0


@pytest.mark.req("H-031", "H-155")
def test_normally_closed_cam_is_told_by_its_level(make, recorder):
    """P-AXIS-00038 = 0: the signal is there off the cam. The switch closes everywhere but below -50."""
    settings = axis("X", 3.21, **{"lr_hw[0].cam_level": 0})
    settings |= {"plant.cam.X.from_mm": CAM_EDGE_MM, "plant.cam.X.to_mm": 400.0}
    bench = make(settings, recorder=recorder)
    result = home(bench)
    bench.advance(SETTLE)

    assert result.completed, result.errors
    assert phases(recorder, X) == pytest.approx([-FAST_UM / 1e3, SLOW_UM / 1e3, -SLOW_UM / 1e3], abs=0.15)
    assert bench.position_mm("X") == pytest.approx(truth_mm(bench, X), abs=TO_THE_INCREMENT)


@pytest.mark.req("H-044")
def test_cam_signal_goes_over_terminal_plc_and_hli(make, recorder):
    """The cam's edge, then the PLC's write of reference_cam at its next tick, then the CNC brakes."""
    bench = make(axis("X", 0.0), recorder=recorder)
    home(bench)
    edge = next(one for one in recorder.signals if one.signal == "cam.X" and one.level)
    write = next(
        commands.cycle
        for commands in recorder.writes
        for write in commands.writes
        if write.path == "ax/1/lr_mc_control/reference_cam/command_w" and write.value
    )
    target = recorder.column("target", X).astype(np.int64)
    slowing = np.flatnonzero(np.diff(target, 2)[write - 3 :] > 0)[0] + write - 3 + 2

    assert write == -(-edge.at_ns // 1_000_000)
    assert slowing + 1 == write + 1, "the write counts in the next kernel cycle"


@pytest.mark.req("H-023", "H-024", "H-035")
def test_ranks_one_after_the_other(make, recorder):
    settings = axis("X", 0.0) | axis("Y", -20.0) | axis("Z", -10.0)
    bench = make(settings, recorder=recorder)
    result = home(bench, "Z1 X2 Y3")
    order = [(record.axis, cycle) for cycle, record in recorder.records if isinstance(record, Homed)]

    assert result.completed, result.errors
    assert [name for name, _ in order] == [Z, X, Y]
    for (_, done), (following, _) in itertools.pairwise(order):
        target = recorder.column("target", following).astype(np.int64)
        moves = np.flatnonzero(np.abs(np.diff(target)[20:]) > 2)[0] + 20
        assert moves + 2 >= done, "the next rank moves when the one before is done"


@pytest.mark.req("H-023", "H-025")
def test_equal_ranks_at_the_same_time(make, recorder):
    bench = make(axis("X", 0.0) | axis("Y", -20.0), recorder=recorder)
    result = home(bench, "X1 Y1")
    starts = [
        np.flatnonzero(np.abs(np.diff(recorder.column("target", one).astype(np.int64))[20:]) > 2)[0]
        for one in (X, Y)
    ]

    assert result.completed, result.errors
    assert starts[0] == starts[1]
    assert {one.axis for one in result.homing} == {"X", "Y"}


@pytest.mark.req("H-006", "H-162")
def test_homing_uses_the_linear_slope_of_p_axis_00285(make, recorder):
    bench = make(axis("X", 0.0, **{"getriebe[0].a_ref": 400}), recorder=recorder)
    home(bench)
    target = recorder.column("target", X).astype(np.float64) * PITCH_MM / 1_048_576
    rate = np.diff(target, 2)[25:] / 1e-6

    assert np.percentile(np.abs(rate[np.abs(rate) > 300]), 50) == pytest.approx(400.0, abs=12.0)
    assert np.abs(rate).max() < 420.0


@pytest.mark.req("H-163")
def test_homing_without_its_own_acceleration_takes_the_smaller_of_rapid_traverse(make, recorder):
    """P-AXIS-00285 = 0: P-AXIS-00005 or 00006, whichever is less."""
    slope = {
        "getriebe[0].lslope_profil.a_grenz_stufe_1": 900,
        "getriebe[0].lslope_profil.a_grenz_stufe_2": 600,
    }
    bench = make(axis("X", 0.0, **{"getriebe[0].a_ref": 0}, **slope), recorder=recorder)
    assert home(bench).completed
    target = recorder.column("target", X).astype(np.float64) * PITCH_MM / 1_048_576
    rate = np.diff(target, 2)[25:] / 1e-6

    assert np.percentile(np.abs(rate[np.abs(rate) > 300]), 50) == pytest.approx(600.0, abs=12.0)
    assert np.abs(rate).max() < 620.0


@pytest.mark.req("H-001", "H-002", "H-004", "H-008", "M-006", "M-129", "M-181", "M-202", "M-205")
@pytest.mark.parametrize("source", ["PLC_TIMESTAMP", "DRIVE"])
def test_incremental_axis_measures_the_truth_after_homing(make, source):
    """Before homing its zero is where it was switched on; after it the face is where it is."""
    settings = axis("Z", 30.0) | {
        "plant.probe.Z.face_mm": 12.3456,
        "plant.probe.Z.material": "below",
        "plant.cam.Z.from_mm": 60.0,
        "plant.cam.Z.to_mm": 200.0,
        "axis.Z.kenngr.measure.signal": source,
        "axis.Z.kenngr.ref_richt": 1,
        "axis.Z.getriebe[0].pos_refpkt": 650_000,
    }
    bench = make(settings)
    before = bench.run("%p\nN10 G100 Z-25 F600\nN20 G01 Z0 F3000\nN30 M30\n")
    assert before.measurements[0].acs_mm == pytest.approx(12.3456 - 30.0, abs=1e-4)
    after = bench.run("%p\nN10 G74 Z1\nN20 G01 Z20 F3000\nN30 G100 Z5 F600\nN40 M30\n")

    assert after.completed, after.errors
    assert after.measurements[0].acs_mm == pytest.approx(12.3456, abs=1e-4)


@pytest.mark.req("H-210")
def test_homing_disabled_is_error_50686(make, errors):
    result = home(make({"axis.X.kenngr.homing.homing_type": "DISABLED"}))

    assert errors(result) == [(50686, "X", "N10")]


@pytest.mark.req("H-211")
def test_absolute_axis_can_be_passed_over(make, recorder):
    bench = make({"axis.X.kenngr.homing.homing_type": "IGNORE_ABS_POS"} | axis("Y", 0.0), recorder=recorder)
    result = home(bench, "X1 Y2")

    assert result.completed
    assert [one.axis for one in result.homing] == ["Y"]
    assert np.ptp(recorder.column("target", X)[20:]) == 0


@pytest.mark.req("H-211")
def test_incremental_axis_that_is_to_be_passed_over_is_a_warning(make, recorder):
    settings = axis("X", 0.0) | {"axis.X.kenngr.homing.homing_type": "IGNORE_ABS_POS"}
    result = home(make(settings, recorder=recorder))

    assert result.completed
    assert [(one.id, one.axis, one.severity) for one in result.errors] == [(110584, "X", "warning")]
    assert not result.homing
    assert np.ptp(recorder.column("target", X)[20:]) == 0


def test_drive_out_of_operation_may_not_home(make, errors):
    bench = make(axis("X", 0.0) | {"axis.X.lr_param.suppress_pos_lag_error": 1})
    bench.run(
        "%p\n#DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=1 WAIT]\n"
        "#DRIVE WR SYN [AX=X KEY=MON_WINDOW VAL=10000 WAIT]\nG01 X20 F6000\nM30\n"
    )

    assert errors(home(bench)) == [(70101, "X", "")]


@pytest.mark.req("H-049")
def test_missing_zero_pulse_ends_at_the_longest_way(make, errors, recorder):
    """The pulse is 5 mm behind the cam, the search ends after 2 mm: error, no reference, the axis stands."""
    bench = make(axis("X", 0.0, **{"lr_hw[0].zero_pulse_search_max_dist": 20_000}), recorder=recorder)
    result = home(bench)
    bench.advance(SETTLE)

    assert errors(result) == [(70380, "X", "N10")]
    assert not result.homing
    assert -52.5 < truth_mm(bench, X) < -52.0
    assert recorder.column("probe_function", X)[-1] == 0


@pytest.mark.parametrize(
    "never",
    [
        {"plant.cam.X.from_mm": -5000.0, "plant.cam.X.to_mm": -4000.0},
        {"plant.cam.X.from_mm": -5000.0, "axis.X.kenngr.shift_offset_zero_pulse_activation": 10_000_000},
    ],
    ids=["cam", "zero pulse"],
)
def test_what_never_comes_ends_at_the_way_between_the_software_limits(make, errors, never):
    """100 mm between the limits and a tenth more from the begin of the homing, then the axis brakes."""
    limits = {"axis.X.kenngr.swe_neg": -600_000, "axis.X.kenngr.swe_pos": 400_000}
    settings = axis("X", 0.0, **{"getriebe[0].vb_reflow": FAST_UM}) | limits | never
    bench = make(settings)
    result = home(bench)
    bench.advance(SETTLE)

    assert errors(result) == [(70394, "X", "N10")]
    assert not result.homing
    assert "has not come" in result.errors[0].text
    assert -112.0 < truth_mm(bench, X) < -110.0
    assert bench.kernel.core.at_rest
    assert bench.run("%p\nN10 G01 X-150 F6000\nN20 M30\n").completed
    bench.advance(SETTLE)
    assert truth_mm(bench, X) == pytest.approx(-150.0, abs=1e-3), "the path has the axis again"


@pytest.mark.req("H-227")
@pytest.mark.parametrize(("longest", "degrees"), [(450_000, 45.0), (0, 3600.0)])
def test_longest_way_of_a_rotary_axis(make, errors, longest, degrees):
    """P-AXIS-00412, without it ten turns."""
    settings = {
        "axis.A.start_mm": 0.0,
        "axis.A.kenngr.abs_pos_gueltig": 0,
        "axis.A.kenngr.homing_max_movement_dist": longest,
        "plant.cam.A.from_mm": -9000.0,
        "plant.cam.A.to_mm": -8900.0,
        "axis.A.getriebe[0].vb_refmax": 200_000,
        "axis.A.getriebe[0].a_ref": 4_000,
    }
    bench = make(settings)
    result = home(bench, "A1")
    bench.advance(SETTLE)

    assert errors(result) == [(70394, "A", "N10")]
    assert degrees < abs(bench.position_mm("A")) < degrees + 6.0


@pytest.mark.req("H-016", "H-137")
def test_late_activation_takes_the_next_zero_pulse(make):
    """P-AXIS-00494: 6 mm behind the cam the pulse at 5 mm is over, the next is a turn further."""
    settings = axis("X", 3.21, **{"kenngr.shift_offset_zero_pulse_activation": 60_000})
    bench = make(settings)
    assert home(bench).completed
    bench.advance(SETTLE)

    assert bench.position_mm("X") - truth_mm(bench, X) == pytest.approx(PITCH_MM, abs=TO_THE_INCREMENT)


@pytest.mark.req("H-049", "H-137")
@pytest.mark.parametrize("number", [1, 2])
def test_zero_pulse_is_latched_by_the_probing_input_of_the_axis(make, recorder, number):
    bench = make(axis("X", 3.21, **{"kenngr.measure.input": number}), recorder=recorder)
    assert home(bench).completed
    bench.advance(SETTLE)

    assert set(recorder.column("probe_function", X)) == {0, 0x15 << 8 * (number - 1)}
    assert bench.position_mm("X") == pytest.approx(truth_mm(bench, X), abs=TO_THE_INCREMENT)


@pytest.mark.req("H-016")
def test_zero_pulse_is_not_searched_before_the_cam(make, recorder):
    """Four zero pulses lie on the way to the cam: none of them is taken, the function is not even armed."""
    bench = make(axis("X", 0.0), recorder=recorder)
    home(bench)
    armed = np.flatnonzero(recorder.column("probe_function", X))
    position = recorder.column("position", X).astype(np.int64) * PITCH_MM / 1_048_576

    assert position[armed[0]] <= CAM_EDGE_MM
    assert position[armed[-1]] >= ZERO_PULSE_MM - 0.2


@pytest.mark.req("H-016", "H-049")
def test_zero_pulse_is_not_searched_behind_the_cam(make, errors, recorder):
    """A cam of 3 mm, the pulse 2 mm behind its end: nobody may take it, the search is over with the cam."""
    settings = axis("X", 0.0, **{"getriebe[0].vb_refmax": 20_000}) | {"plant.cam.X.from_mm": -53.0}
    bench = make(settings, recorder=recorder)
    result = home(bench)
    bench.advance(SETTLE)

    assert errors(result) == [(70380, "X", "N10")]
    assert not result.homing
    assert not bench.kernel.core.referenced[X]
    assert -53.2 < truth_mm(bench, X) < -53.0
    assert recorder.column("probe_function", X)[-1] == 0


def test_feed_release_holds_the_homing_axis(make, script, recorder):
    text = """
from hli_bench.plc import Plc

class Holding(Plc):
    def start(self, hli, io):
        self.n = 0
        axis = hli.ax[1]
        axis.head.plc_present_w = True
        axis.lr_mc_control.release_feedhold.enable_w = True
        axis.lr_mc_control.release_feedhold.command_w = True
        axis.lr_mc_control.reference_cam.enable_w = True

    def cycle(self, hli, io):
        self.n += 1
        axis = hli.ax[1].lr_mc_control
        axis.release_feedhold.command_w = not 200 < self.n < 500
        axis.reference_cam.command_w = io.cams.ch1.input
"""
    bench = make(axis("X", 0.0), recorder=recorder, plc=[script(text)])
    result = home(bench)
    target = recorder.column("target", X)
    start = recorder.writes[0].cycle

    assert result.completed
    assert np.ptp(target[start + 300 : start + 490]) == 0


def test_aborted_homing_brakes_and_leaves_no_reference(make):
    bench = make(axis("X", 0.0))
    bench.start_up()
    bench.kernel.start(["%p", "N10 G74 X1", "N20 M30"], "p")
    bench.engine.wake()
    bench.advance(bench.engine.cycle + 300 if bench.engine.cycle > 300 else 300)
    assert bench.kernel.rows.axis[X]["mode"] == JOG
    bench.reset()
    bench.advance(200)

    assert not bench.kernel.core.referenced[X]
    assert bench.kernel.core.at_rest
    assert home(bench).completed


@pytest.mark.req("H-009", "H-020")
def test_rotary_axis_homes_as_a_linear_one(make):
    """36 degrees a turn, zero pulse half a turn behind the cam's edge."""
    settings = {
        "axis.A.start_mm": 7.0,
        "axis.A.kenngr.abs_pos_gueltig": 0,
        "plant.cam.A.from_mm": -90.0,
        "plant.cam.A.to_mm": -45.0,
        "plant.axis.A.zero_pulse_offset_mm": 9.0,
        "axis.A.getriebe[0].pos_refpkt": -630_000,
    }
    bench = make(settings)
    result = home(bench, "A1")
    bench.advance(SETTLE)
    truth = float(bench.engine.link.rows.servo[4]["angle"]) / (2 * np.pi) * 36.0

    assert result.completed, result.errors
    assert bench.position_mm("A") == pytest.approx(truth, abs=1e-4)


def test_spindle_homing_is_not_built(make):
    with pytest.raises(NotEmulated, match="spindle S"):
        home(make(), "S1")


INVERTED = """
from hli_bench.plc import Plc

class Inverted(Plc):
    def start(self, hli, io):
        axis = hli.ax[1]
        axis.head.plc_present_w = True
        axis.lr_mc_control.reference_cam.enable_w = True
        axis.lr_mc_control.reference_cam.command_w = True

    def cycle(self, hli, io):
        hli.ax[1].lr_mc_control.reference_cam.command_w = not io.cams.ch1.input
"""
LIMITS = {"axis.X.kenngr.swe_neg": -600_000, "axis.X.kenngr.swe_pos": 400_000}


def test_an_inverted_cam_signal_ends_at_the_same_guard(make, errors, script):
    """Off the cam it never comes: away from it, 110 mm from the begin, and no further."""
    bench = make(axis("X", 0.0) | LIMITS, plc=[script(INVERTED)])
    result = home(bench)
    bench.advance(SETTLE)

    assert errors(result) == [(70394, "X", "N10")]
    assert "the cam is operated" in result.errors[0].text
    assert 110.0 < truth_mm(bench, X) < 112.0
    assert bench.kernel.core.at_rest


def test_the_way_off_the_cam_is_limited_by_p_axis_00531(make, errors, script):
    settings = axis("X", 0.0, **{"lr_hw[0].move_from_cam_max_dist": 50_000})
    bench = make(settings | LIMITS, plc=[script(INVERTED)])
    result = home(bench)
    bench.advance(SETTLE)

    assert errors(result) == [(70523, "X", "N10")]
    assert 5.0 < truth_mm(bench, X) < 5.5
    assert not bench.kernel.core.referenced[X]


def test_a_cam_that_is_run_over_is_an_error_and_not_the_begin_of_an_endless_search(make, errors):
    bench = make(axis("X", 0.0) | {"plant.cam.X.from_mm": -51.0})
    result = home(bench)
    bench.advance(SETTLE)

    assert errors(result) == [(70523, "X", "N10")]
    assert "too short" in result.errors[0].text
    assert truth_mm(bench, X) > -60.0


FADING = """
from hli_bench.plc import Plc

class Fading(Plc):
    def start(self, hli, io):
        self.seen = 0
        axis = hli.ax[1]
        axis.head.plc_present_w = True
        axis.lr_mc_control.reference_cam.enable_w = True

    def cycle(self, hli, io):
        cam = io.cams.ch1.input
        self.seen += bool(cam)
        hli.ax[1].lr_mc_control.reference_cam.command_w = cam and self.seen < {cycles}
"""


@pytest.mark.parametrize("cycles", [200, 300, 400])
def test_a_cam_that_does_not_come_back_ends_the_search_where_it_must_be(make, errors, script, cycles):
    """Whatever the instant at which the signal is lost: an error, no reference, never past the cam by much."""
    bench = make(axis("X", 0.0), plc=[script(FADING.format(cycles=cycles))])
    result = home(bench)
    bench.advance(SETTLE)

    assert len(result.errors) == 1
    assert result.errors[0].id in (70380, 70394, 70523)
    assert truth_mm(bench, X) > -60.0
    assert bench.kernel.core.at_rest
    assert not bench.kernel.core.referenced[X]
