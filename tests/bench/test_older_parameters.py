"""Parameters that newer ones replace still decide a run when those are not set (measurement manual 8.2.2, 8.2.4)."""

import pytest

from hli_bench.kernel.records import MeasuredValue

Z = 2
KENNGR = "axis.Z.kenngr."
OWN = KENNGR + "measure.fixed_stop_detect."
COMMON = "axis.Z.antr.fixed_stop.detect."
UNSET_SIGNAL = {KENNGR + "measure.signal": ""}
STOP_MM = 105.0
AT_STOP = {"plant.stop.Z.at_mm": STOP_MM, "plant.stop.Z.side": "above", "axis.Z.start_mm": 100.0}
WEAK = "#DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=10 WAIT]\n#DRIVE WR SYN [AX=Z KEY=MON_WINDOW VAL=4294967295 WAIT]\n"


def to_the_stop(bench, feed: int = 600):
    return bench.run(f"%stop\n#MEAS MODE[7]\n{WEAK}N50 G100 Z115 F{feed}\nN60 M30\n")


@pytest.mark.req("M-036", "M-206", "M-245", "M-248")
@pytest.mark.parametrize(
    ("old", "source"),
    [({}, "DRIVE"), ({"meas_signal_drive": 1}, "DRIVE"), ({"probing_signal_via_plc": 1}, "PLC")],
)
def test_without_its_word_the_older_parameters_name_the_source(make, face, old, source):
    settings = face | UNSET_SIGNAL | {"axis.Z.start_mm": 110.0} | {KENNGR + key: 1 for key in old}
    result = make(settings).run("%p\nN10 G100 Z95 F6000\nN20 M30\n")

    assert [one.source for one in result.measurements] == [source]
    (value,) = [one.acs_mm for one in result.measurements]
    assert value == 100.0 if source == "DRIVE" else 99.7 < value < 99.95, (
        "the drive is exact, the PLC is late"
    )


@pytest.mark.req("M-038", "M-212", "M-240")
@pytest.mark.parametrize(("old", "new", "edge"), [(1, "", "NEG"), (0, "", "POS"), (1, "POS", "POS")])
def test_without_its_word_the_older_parameter_names_the_edge(make, face, old, new, edge):
    """Into the material and out again: each edge has its own of two runs."""
    settings = face | {"axis.Z.start_mm": 105.0, KENNGR + "measure.signal": "DRIVE"}
    bench = make(settings | {KENNGR + "measure.edge": new, KENNGR + "mess_neg_flanke": old})
    into = bench.run("%p\nN10 G100 Z95 F600\nN20 G01 Z95 F600\nN30 M30\n")
    out = bench.run("%p\nN10 G100 Z105 F600\nN30 M30\n")

    assert [len(into.measurements), len(out.measurements)] == ([1, 0] if edge == "POS" else [0, 1])


@pytest.mark.req("M-037", "M-211", "M-130")
@pytest.mark.parametrize(
    ("given", "wired"),
    [
        ({}, 1),
        ({"antr.probing_input_nbr": 2}, 2),
        ({"antr.canopen.probing_input_number": 2}, 2),
        ({"antr.probing_input_nbr": 2, "kenngr.measure.input": 1}, 1),
    ],
)
def test_without_its_number_the_older_parameters_name_the_input(make, face, recorder, given, wired):
    settings = face | {
        "axis.Z.start_mm": 105.0,
        KENNGR + "measure.signal": "DRIVE",
        KENNGR + "measure.input": 0,
    }
    settings |= {
        "axis.Z.probe_input_1": "",
        "axis.Z.probe_input_2": "",
        f"axis.Z.probe_input_{wired}": "probe",
    }
    bench = make(settings | {f"axis.Z.{key}": value for key, value in given.items()}, recorder=recorder)
    result = bench.run("%p\nN10 G100 Z95 F600\nN20 M30\n")

    assert [one.acs_mm for one in result.measurements] == [100.0]
    assert set(recorder.column("probe_function", Z)) == {0, 0x11 << 8 * (wired - 1)}


@pytest.mark.req("M-035", "M-217", "M-218")
@pytest.mark.parametrize(
    ("given", "kind", "beyond_mm"),
    [
        ({"mess_offset": 20_000}, 2, 2.0),
        ({"mess_offset": 20_000}, 1, 0.0),
        ({"mess_offset": 20_000}, 4, 0.0),
        ({"probing_offset": 10_000, "mess_offset": 20_000}, 2, 1.0),
        ({"probing_offset": 10_000}, 1, 1.0),
        ({"probing_offset": 10_000}, 4, 1.0),
        ({"probing_offset": 10_000}, 3, 0.0),
    ],
)
def test_how_far_past_the_target_an_axis_goes_by_type(make, recorder, given, kind, beyond_mm):
    """P-AXIS-00467 acts for all types but 3, P-AXIS-00114 for type 2 only and where 00467 is not set."""
    settings = {"axis.Z.start_mm": 20.0} | {KENNGR + key: value for key, value in given.items()}
    make(settings, recorder=recorder).run(f"%p\nN10 #MEAS MODE[{kind}]\nN20 G100 Z10 F600\nN30 M30\n")

    assert recorder.column("command", Z)[-1] == pytest.approx((10.0 - beyond_mm) * 1e4, abs=1e-3)


@pytest.mark.req("M-186", "M-222", "M-223")
@pytest.mark.parametrize(
    ("given", "limit"),
    [
        ({KENNGR + "fixed_stop_pos_lag_limit": 7_000}, 7_000),
        ({KENNGR + "fixed_stop_pos_lag_limit": 7_000, COMMON + "pos_lag_limit": 9_000}, 9_000),
        ({KENNGR + "fixed_stop_pos_lag_limit": 7_000, OWN + "pos_lag_limit": 12_000}, 12_000),
        ({COMMON + "pos_lag_limit": 9_000, OWN + "pos_lag_limit": 12_000}, 12_000),
    ],
)
def test_lag_that_means_a_stop(make, recorder, given, limit):
    settings = AT_STOP | {OWN + "pos_lag_limit": -1, OWN + "min_time": 1_000} | given
    bench = make(settings, recorder=recorder)
    result = to_the_stop(bench)

    assert result.completed, result.errors
    (found,) = recorder.cycle_of(MeasuredValue)
    lag = abs(recorder.column("lag", Z))
    assert lag[found - 2] <= limit < lag[found - 1] <= limit + 150, "within a cycle's way of 10 um"


@pytest.mark.req("M-186", "M-224", "M-232", "M-233", "M-251")
@pytest.mark.parametrize(
    ("given", "cycles"),
    [
        ({KENNGR + "fixed_stop_nbr_cycles": 40}, 40),
        ({KENNGR + "fixed_stop_nbr_cycles": 40, COMMON + "min_time": 25_000}, 25),
        ({COMMON + "min_time": 25_000, OWN + "min_time": 60_000}, 60),
    ],
)
def test_time_for_which_it_must_last(make, recorder, given, cycles):
    settings = AT_STOP | {OWN + "min_time": 0} | given
    settings |= {OWN + "pos_lag_limit": -1, KENNGR + "fixed_stop_pos_lag_limit": 20_000}
    bench = make(settings, recorder=recorder)
    assert to_the_stop(bench).completed

    (found,) = recorder.cycle_of(MeasuredValue)
    lag = abs(recorder.column("lag", Z)[: found - 1])
    over = next(i for i in range(len(lag) - 1, 0, -1) if lag[i] <= 20_000.0)
    assert found - 1 - over == cycles


@pytest.mark.req("M-225", "M-227")
@pytest.mark.parametrize(
    ("given", "armed_at"),
    [
        ({OWN + "start_distance": -1, COMMON + "start_distance": 30_000}, 30_000),
        ({OWN + "start_distance": 50_000, COMMON + "start_distance": 30_000}, 50_000),
        ({OWN + "start_distance_per_mille": -1, COMMON + "start_distance_per_mille": 200}, 30_000),
        ({OWN + "start_distance_per_mille": 400, COMMON + "start_distance_per_mille": 200}, 60_000),
        ({OWN + "start_distance": -1, COMMON + "start_distance": -1}, 0),
    ],
)
def test_way_behind_which_detection_is_armed(make, recorder, given, armed_at):
    """Any lag is a stop here: the run ends where detection begins."""
    settings = {"axis.Z.start_mm": 100.0, OWN + "pos_lag_limit": 1, OWN + "min_time": 1_000} | given
    make(settings, recorder=recorder).run("%p\n#MEAS MODE[7]\nN50 G100 Z115 F6000\nN60 M30\n")

    (found,) = recorder.cycle_of(MeasuredValue)
    before, done = recorder.column("command", Z)[[found - 3, found - 2]] - 1_000_000.0
    assert before < armed_at - 1e-6 <= done if armed_at else done < 3_000


@pytest.mark.req("M-230", "M-231")
@pytest.mark.parametrize(
    ("given", "window"),
    [
        ({OWN + "max_delta_position_window": -1, COMMON + "max_delta_position_window": 300}, 300),
        ({OWN + "max_delta_position_window": 100, COMMON + "max_delta_position_window": 300}, 100),
        ({OWN + "max_delta_position_window": 0, COMMON + "max_delta_position_window": 300}, 0),
    ],
)
def test_way_within_the_time_that_means_a_stop(make, recorder, given, window):
    settings = AT_STOP | given
    settings |= {OWN + "pos_lag_limit": 0, OWN + "min_time": 50_000, OWN + "start_distance": 20_000}
    assert to_the_stop(make(settings, recorder=recorder)).completed

    (found,) = recorder.cycle_of(MeasuredValue)
    actual = recorder.column("actual", Z)
    assert abs(actual[found - 1] - actual[found - 51]) <= window < abs(actual[found - 2] - actual[found - 52])


@pytest.mark.req("M-246")
def test_fixed_stop_as_the_older_source_of_a_run_of_type_7(make):
    settings = AT_STOP | UNSET_SIGNAL | {KENNGR + "meas_signal_fixed_stop": 1}
    result = to_the_stop(make(settings))

    assert [one.source for one in result.measurements] == ["FIXED_STOP"]
    assert result.measurements[0].acs_mm == pytest.approx(STOP_MM + 0.0094, abs=0.002)


@pytest.mark.req("M-031")
@pytest.mark.parametrize("feed", [300, 900])
def test_run_to_a_stop_takes_the_f_word(make, recorder, feed):
    to_the_stop(make(AT_STOP, recorder=recorder), feed)

    assert recorder.velocity(Z).max() == pytest.approx(feed / 60.0, abs=1e-6)
