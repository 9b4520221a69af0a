"""Measurement run to a fixed stop (measurement manual 7.2): the CANopen example and the parts of it."""

import math
from pathlib import Path

import numpy as np
import pytest

from hli_bench import Bench
from hli_bench.kernel.records import MeasuredValue

PROGRAM = Path(__file__).resolve().parents[2] / "programs" / "meas_fixed_stop.nc"
STOP_MM = 105.0
AT_STOP = {"plant.stop.Z.at_mm": STOP_MM, "plant.stop.Z.side": "above", "axis.Z.start_mm": 90.0}
NODE_Z, Z = 3, 2
DETECT = "axis.Z.kenngr.measure.fixed_stop_detect"
RATED_NM = 15.0
STIFFNESS_N_PER_MM = 1e5
LIMITED = "#DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=10 WAIT]\n#DRIVE WR SYN [AX=Z KEY=MON_WINDOW VAL=4294967295 WAIT]\n"


def press_mm(permille: float) -> float:
    """How far a torque pushes the axis into the stop."""
    return RATED_NM * permille / 1000.0 * math.tau / 0.010 / STIFFNESS_N_PER_MM


def run(bench: Bench, block: str = "G100 Z110 F600"):
    return bench.run(f"%stop\n#MEAS MODE[7]\nG00 Z100\n{LIMITED}N50 {block}\nN60 M30\n")


@pytest.mark.req("M-031", "M-138", "M-140", "M-142", "M-146", "M-165", "M-166", "M-167", "M-168", "M-169")
def test_example_of_the_manual(make, recorder):
    bench = make(AT_STOP, recorder=recorder)
    result = bench.run(PROGRAM)

    assert result.completed
    assert not result.errors
    assert recorder.sdo_writes(NODE_Z, 0x6072) == [100, 50_000]
    assert recorder.sdo_writes(NODE_Z, 0x6065) == [4_294_967_295, 1_048_575]
    assert recorder.sdo_answers(NODE_Z, 0x6072) == [0x60, 0x60]
    assert recorder.sdo_answers(NODE_Z, 0x6065) == [0x60, 0x60]
    (value,) = result.measurements
    assert value.source == "FIXED_STOP"
    assert value.block == "N050"
    assert value.acs_mm == pytest.approx(STOP_MM + press_mm(100), abs=0.002)
    assert result.variables["V.A.MESS.Z"] == value.acs_mm
    bench.advance(300)
    assert bench.position_mm("Z") == pytest.approx(100.0, abs=1e-3)


@pytest.mark.req("M-167", "M-168", "M-169")
def test_drive_objects_change_at_the_right_blocks(make, recorder):
    """Torque limit and window before the run begins, back after the axis has moved away."""
    bench = make(AT_STOP, recorder=recorder)
    bench.run(PROGRAM)
    written = [
        (cycle, int.from_bytes(frame.data[1:3], "little"))
        for cycle, frame in recorder.bus
        if frame.cob_id == 0x600 + NODE_Z and frame.data[0] & 0xE0 == 0x20 and frame.data[2] == 0x60
    ]
    at = [cycle for cycle, index in written if index in (0x6072, 0x6065)]
    (found,) = recorder.cycle_of(MeasuredValue)
    command = recorder.column("command", Z)
    answered = [cycle for cycle, frame in recorder.bus if frame.cob_id == 0x580 + NODE_Z][-4:]

    assert at[0] < at[1] < found < at[2] < at[3]
    assert all(command[cycle - 1] == 1_000_000.0 for cycle in at), "Z stands at 100"
    assert all(0 < b - a <= 3 for a, b in zip(at, answered, strict=True)), "WAIT: the answer ends the block"


@pytest.mark.req("M-168")
def test_values_are_accepted_by_the_dictionary_of_the_drive(make):
    bench = make(AT_STOP)
    bench.run(PROGRAM)
    (drive,) = [one for one in bench.engine.link.drives if one.node_id == NODE_Z]

    assert drive.device.values.number(0x6065, 0) == 1_048_575
    assert drive.device.values.number(0x6072, 0) == 50_000


@pytest.mark.req("M-142", "M-155", "M-156")
def test_axis_returns_to_the_measured_position(make, recorder):
    """Without the block that moves away: set point and axis end where the stop was measured."""
    bench = make(AT_STOP, recorder=recorder)
    result = run(bench)
    measured = result.measurements[0].acs_mm

    assert result.completed, result.errors
    assert recorder.column("command", Z)[-1] == pytest.approx(measured * 1e4, abs=1e-6)
    bench.advance(300)
    assert bench.position_mm("Z") == pytest.approx(measured, abs=2e-3)
    command = recorder.column("command", Z)
    assert command.max() > (measured + 1.9) * 1e4, "it had pushed 2 mm ahead"
    (found,) = recorder.cycle_of(MeasuredValue)
    assert np.abs(np.diff(command[found - 5 :])).max() <= 170.0, "no jump: 1000 mm/min is 167 in a cycle"
    assert abs(recorder.column("lag", Z)[-1]) < 30.0


@pytest.mark.req("M-140", "M-155")
@pytest.mark.parametrize("percent", [5, 10, 20])
def test_torque_is_really_limited(make, recorder, percent):
    """The axis presses with the limited torque and no more: the depth in the stop's spring says so."""
    bench = make(AT_STOP | {f"{DETECT}.min_time": 200_000}, recorder=recorder)
    program = (
        f"%p\n#MEAS MODE[7]\nG00 Z100\n{LIMITED.replace('VAL=10 ', f'VAL={percent} ')}G100 Z120 F600\nM30\n"
    )
    result = bench.run(program)

    torque = recorder.column("torque_permille", Z)
    pressing = torque[recorder.cycle_of(MeasuredValue)[0] - 50 : recorder.cycle_of(MeasuredValue)[0]]
    assert set(pressing) == {percent * 10}
    assert result.measurements[0].acs_mm == pytest.approx(STOP_MM + press_mm(percent * 10), abs=1e-3)


@pytest.mark.req("M-154", "M-157")
def test_lag_monitoring_is_off_in_the_run_and_on_again_behind_it(make, errors):
    """Lag limit 1 mm, detection at 2 mm: only a run with the monitoring off gets there."""
    settings = AT_STOP | {"axis.Z.getriebe[0].slep_max": 10_000, "axis.Z.getriebe[0].slep_min": 10_000}
    bench = make(settings)
    assert run(bench).completed
    after = bench.run("%p\nN10 G01 Z110 F600\nN20 M30\n")

    assert errors(after) == [(70020, "Z", "N10")]
    assert after.status == "error"


@pytest.mark.req("M-145", "M-195")
def test_no_stop_is_error_50886(make, errors):
    result = run(make({"axis.Z.start_mm": 90.0}), "G100 Z101 F600")

    assert errors(result) == [(50886, "Z", "N50")]
    assert result.status == "error"
    assert not result.measurements


@pytest.mark.req("M-145", "M-195", "M-196")
def test_no_stop_without_error_when_the_channel_says_so(make, recorder):
    """The lag that the weak drive has left is taken away at the end all the same."""
    settings = AT_STOP | {"channel.meas_fixed_stop_no_error": 1, f"{DETECT}.pos_lag_limit": 100_000}
    bench = make(settings, recorder=recorder)
    result = run(bench, "G100 Z107 F600")

    assert result.completed, result.errors
    assert not result.measurements
    assert result.variables.get("V.A.MERF.Z", 0.0) == 0.0
    assert recorder.column("command", Z).max() == pytest.approx(1_070_000, abs=1e-6)
    assert recorder.column("command", Z)[-1] == pytest.approx((STOP_MM + press_mm(100)) * 1e4, abs=20.0)


@pytest.mark.req("M-138", "M-147")
@pytest.mark.parametrize("min_time_us", [5_000, 20_000, 100_000])
def test_criteria_must_hold_for_the_minimum_time(make, recorder, min_time_us):
    bench = make(AT_STOP | {f"{DETECT}.min_time": min_time_us}, recorder=recorder)
    run(bench)

    (found,) = recorder.cycle_of(MeasuredValue)
    lag = recorder.column("lag", Z)[: found - 1]
    over = next(i for i in range(len(lag) - 1, 0, -1) if abs(lag[i]) <= 20_000.0)
    assert found - 1 - over == min_time_us // 1000


@pytest.mark.req("M-139", "M-230")
def test_speed_criterion_alone_finds_the_stop(make, recorder):
    """Lag off, at most 0.02 mm in 50 ms: 10 mm/s is no stop, the wall is."""
    settings = AT_STOP | {
        f"{DETECT}.pos_lag_limit": 0,
        f"{DETECT}.min_time": 50_000,
        f"{DETECT}.max_delta_position_window": 200,
        f"{DETECT}.start_distance": 20_000,
    }
    bench = make(settings, recorder=recorder)
    result = run(bench)

    (found,) = recorder.cycle_of(MeasuredValue)
    actual = recorder.column("actual", Z)
    assert result.measurements[0].acs_mm == pytest.approx(STOP_MM + press_mm(100), abs=2e-3)
    assert abs(actual[found - 1] - actual[found - 51]) <= 200.0 < abs(actual[found - 2] - actual[found - 52])


@pytest.mark.req("M-139", "M-147")
def test_combined_criteria_must_both_hold(make, recorder):
    """The lag grows slowly behind a strong torque limit; only with the speed below the limit it is a stop."""
    settings = AT_STOP | {f"{DETECT}.max_delta_position_window": 50, f"{DETECT}.pos_lag_limit": 3_000}
    bench = make(settings, recorder=recorder)
    run(bench)

    (found,) = recorder.cycle_of(MeasuredValue)
    lag, actual = recorder.column("lag", Z), recorder.column("actual", Z)
    assert all(abs(one) > 3_000 for one in lag[found - 20 : found])
    assert abs(actual[found - 1] - actual[found - 21]) <= 50.0


ARMING = [
    pytest.param({"start_distance": 30_000}, 30_000, id="absolute"),
    pytest.param({"start_distance_per_mille": 400}, 40_000, id="per-mille"),
    pytest.param({"start_distance": 30_000, "start_distance_per_mille": 400}, 30_000, id="smaller-absolute"),
    pytest.param({"start_distance": 50_000, "start_distance_per_mille": 400}, 40_000, id="smaller-share"),
    pytest.param({"start_distance": 50_000, "start_distance_per_mille": 0}, 0, id="smaller-share-nothing"),
    pytest.param({}, 0, id="at-once"),
]


@pytest.mark.req("M-148", "M-149", "M-151", "M-226")
@pytest.mark.parametrize(("given", "armed_at"), ARMING)
def test_detection_is_armed_behind_its_way(make, recorder, given, armed_at):
    """Any lag is a stop here: so the run ends as soon as detection is armed."""
    settings = {"axis.Z.start_mm": 90.0, f"{DETECT}.pos_lag_limit": 1, f"{DETECT}.min_time": 1000}
    settings |= {f"{DETECT}.{key}": value for key, value in given.items()}
    bench = make(settings, recorder=recorder)
    run(bench, "G100 Z110 F6000")

    (found,) = recorder.cycle_of(MeasuredValue)
    done = recorder.column("command", Z)[found - 2] - 1_000_000.0
    before = recorder.column("command", Z)[found - 3] - 1_000_000.0
    if armed_at:
        assert before < armed_at <= done
    else:
        assert done < 3_000


@pytest.mark.req("M-150", "M-226")
def test_smallest_way_of_all_axes_arms_the_detection(make, recorder):
    settings = {f"axis.{axis}.kenngr.measure.fixed_stop_detect.pos_lag_limit": 1 for axis in "YZ"}
    settings |= {f"axis.{axis}.kenngr.measure.fixed_stop_detect.min_time": 1000 for axis in "YZ"}
    settings["axis.Y.kenngr.measure.fixed_stop_detect.start_distance"] = 60_000
    settings["axis.Z.kenngr.measure.fixed_stop_detect.start_distance"] = 20_000
    bench = make(settings | {"axis.Z.start_mm": 0.0}, recorder=recorder)
    bench.run("%p\n#MEAS MODE[7]\nN10 G100 Y30 Z40 F6000\nM30\n")

    found = recorder.cycle_of(MeasuredValue)[0]
    way = [math.hypot(*recorder.log["command"][found - back, 1:3]) for back in (3, 2)]
    assert way[0] < 20_000 <= way[1]


@pytest.mark.req("M-141", "M-142")
def test_one_axis_at_its_stop_ends_the_path_and_all_return(make):
    """Y and Z move, Z meets its stop: both are latched at that instant and moved back to it."""
    settings = AT_STOP | {"axis.Z.start_mm": 100.0}
    bench = make(settings)
    result = bench.run(f"%p\n#MEAS MODE[7]\n{LIMITED}N50 G100 Y20 Z120 F600\nM30\n")
    values = {one.axis: one.acs_mm for one in result.measurements}
    bench.advance(200)

    assert result.completed, result.errors
    assert values["Z"] == pytest.approx(STOP_MM + press_mm(100), abs=0.003)
    assert 5.0 < values["Y"] < 10.0
    assert bench.position_mm("Y") == pytest.approx(values["Y"], abs=1e-3)
    assert bench.position_mm("Z") == pytest.approx(values["Z"], abs=3e-3)


@pytest.mark.req("M-227", "M-229")
def test_share_above_one_is_error_51026(make, errors):
    result = run(make(AT_STOP | {f"{DETECT}.start_distance_per_mille": 1001}))

    assert errors(result) == [(51026, "Z", "N50")]
    assert "1001" in result.errors[0].text


@pytest.mark.req("M-222", "M-231")
def test_without_any_criterion_no_stop_is_found_and_that_is_warned_of(make, errors):
    result = run(make(AT_STOP | {f"{DETECT}.pos_lag_limit": 0}))

    assert errors(result) == [(70647, "Z", "N50"), (50886, "Z", "N50")]
    assert not result.measurements


BY_SIGNAL = {"axis.Z.kenngr.measure.signal": "FIXED_STOP"}


@pytest.mark.parametrize("kind", [1, 2, 3, 4, 7])
def test_a_stop_by_its_source_is_relieved_whatever_the_type(make, kind):
    bench = make(AT_STOP | BY_SIGNAL | {"axis.Z.kenngr.vb_messen": 10_000})
    result = bench.run(f"%p\n#MEAS MODE[{kind}]\nG00 Z100\n{LIMITED}N50 G100 Z110 F600\nN60 M30\n")
    (value,) = result.measurements
    bench.advance(300)

    assert result.completed, result.errors
    assert value.acs_mm == pytest.approx(STOP_MM + press_mm(100), abs=0.01)
    command = bench.kernel.rows.axis["command"][Z] * 1e-4
    assert command == pytest.approx(value.acs_mm, abs=1e-3), (
        "the set point goes back to the measured position"
    )


@pytest.mark.req("E-020")
def test_several_axes_share_the_words_behind_them(make):
    bench = make(AT_STOP)
    settings = f"N40 #MEAS [AX=X AX=Z SIGNAL=FIXED_STOP]\nG00 Z100\n{LIMITED}"
    result = bench.run(f"{settings}N50 G100 Z110 F600\nN60 G100 X5 F600\nN70 M30\n")
    assert [(one.axis, one.source) for one in result.measurements] == [("Z", "FIXED_STOP")]
    assert [(one.id, one.axis, one.block) for one in result.errors] == [(50886, "X", "N60")]


def test_no_stop_by_its_source_is_an_error(make, errors):
    free = {"axis.Z.start_mm": 90.0} | BY_SIGNAL
    result = make(free).run("N50 G90 G100 Z110 F600\nN60 M30\n")
    assert errors(result) == [(50886, "Z", "N50")]
    result = make(free | {"channel.meas_fixed_stop_no_error": 1}).run("N50 G90 G100 Z110 F600\nN60 M30\n")
    assert result.completed
    assert [(one.axis, one.block) for one in result.unmeasured] == [("Z", "N50")]
    assert result.notes == ("N50: axis Z measured nothing: no fixed stop was found on its way",)


@pytest.mark.parametrize(
    ("words", "no_error", "numbers"),
    [
        ("[TYPE=7 ERR_NO_SIGNAL=0]", 0, []),
        ("[TYPE=7 ERR_NO_SIGNAL=1]", 1, [50886]),
        ("[TYPE=7]", 1, []),
        ("[TYPE=7]", 0, [50886]),
    ],
)
def test_the_word_of_the_program_goes_before_the_channel(make, words, no_error, numbers):
    bench = make({"axis.Z.start_mm": 90.0, "channel.meas_fixed_stop_no_error": no_error})
    result = bench.run(f"N40 #MEAS {words}\nN50 G90 G100 Z110 F600\nN60 M30\n")
    assert [one.id for one in result.errors] == numbers
    assert [(one.axis, one.block) for one in result.unmeasured] == [("Z", "N50")]


def test_a_stop_beside_another_source_is_an_impermissible_setting(make, errors):
    result = make(AT_STOP | BY_SIGNAL).run("N50 G90 G100 X10 Z110 F600\nN60 M30\n")
    assert errors(result) == [(50529, "X", "N50")]
    assert result.errors[0].values["parameter"] == "kenngr.measure.signal"
    assert result.errors[0].values["value"] == "PLC_TIMESTAMP"


@pytest.mark.req("M-165")
def test_key_that_no_function_has_is_an_error(make, errors):
    result = make().run("%p\nN10 #DRIVE WR SYN [AX=Z KEY=NOTHING VAL=1 WAIT]\nN20 M30\n")

    assert errors(result) == [(70285, "Z", "N10")]


@pytest.mark.req("M-166", "M-167")
def test_drive_value_above_its_type_is_warned_of_and_limited(make, recorder):
    bench = make(recorder=recorder)
    result = bench.run("%p\nN10 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=7000 WAIT]\nN20 M30\n")

    assert result.completed
    assert [(one.id, one.severity) for one in result.errors] == [(70383, "warning")]
    assert recorder.sdo_writes(NODE_Z, 0x6072) == [65_535]


@pytest.mark.req("M-165")
@pytest.mark.parametrize("value", ["1e308", "-1e308"])
def test_drive_value_beyond_all_numbers_is_limited(make, value):
    bench = make({"axis.Z.antr.function[0].max_limit": "1e308"})
    assert bench.run(f"N10 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL={value} WAIT]\nN20 M30\n").completed


def test_value_that_the_drive_refuses_is_an_error(make, errors, recorder):
    bench = make({"axis.Z.antr.function[0].wr_ident[0]": "5FFF_00"}, recorder=recorder)
    result = bench.run("%p\nN10 #DRIVE WR SYN [AX=Z KEY=MON_WINDOW VAL=1 WAIT]\nN20 M30\n")

    assert errors(result) == [(70278, "Z", "N10")]
    assert recorder.sdo_answers(NODE_Z, 0x5FFF) == [0x80]


def test_drive_that_does_not_answer_is_a_timeout(make, errors):
    bench = make()
    bench.start_up()
    telegrams = bench.engine.link.telegrams
    bench.engine.link.telegrams = lambda cycle, inbox: [
        frame for frame in telegrams(cycle, inbox) if frame.cob_id != 0x580 + NODE_Z
    ]
    result = bench.run("%p\nN10 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=1 WAIT]\nN20 M30\n")

    assert errors(result) == [(70275, "Z", "N10")]


def test_write_without_syn_goes_out_while_the_path_runs(make, recorder):
    """Without SYN the value is written at decoding, with SYN when the motion before it is done."""
    bench = make(recorder=recorder)
    bench.run(
        "%p\nN10 G01 X10 F600\nN20 #DRIVE WR [AX=Z KEY=TORQUE_LIMIT VAL=20]\n"
        "N30 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=30 WAIT]\nN40 M30\n"
    )
    x = recorder.column("command", 0)
    at = [
        cycle
        for cycle, frame in recorder.bus
        if frame.cob_id == 0x600 + NODE_Z and frame.data[1:3] == b"\x72\x60" and frame.data[0] & 0xE0 == 0x20
    ]

    assert recorder.sdo_writes(NODE_Z, 0x6072) == [200, 300]
    assert x[at[0] - 1] < 1_000
    assert x[at[1] - 1] == 100_000
