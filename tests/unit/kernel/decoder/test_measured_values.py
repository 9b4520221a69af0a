"""G100, G101, G102 and the variables of measured values, apart from the manual's examples."""

from typing import Any

import pytest

from hli_bench.kernel.blocks import Line, MeasuringRun
from hli_bench.kernel.records import CncError

SHOW = '#MSG ["%.2f %.2f %.2f %.2f", V.A.MESS.Z, V.A.MEAS.ACS.VALUE.Z, V.A.MEAS.PCS.VALUE.Z, V.A.MOFFS.Z]\n'


@pytest.fixture
def hit(state: Any) -> Any:
    return state((0.0, 0.0, 99.0, 0.0), measured={"Z": 100.0}, latched={"Z": True})


def run(axis_words: str) -> str:
    return f"G90 G01 Z200 F1000\nG100 {axis_words} F500\n"


@pytest.mark.req("M-061", "M-062", "M-063")
@pytest.mark.parametrize(("factor", "target"), [("1", 90.0), ("0.5", 50.0), ("-1", -70.0), ("[1/4]", 30.0)])
def test_g101_includes_factor_times_measured_offset(
    decode: Any, hit: Any, factor: str, target: float
) -> None:
    items = decode(run("Z20") + f"G101 Z{factor}\nG01 Z10\nM30", [hit])
    assert items[-2].target == {2: target}


@pytest.mark.req("M-061", "M-066")
def test_g101_and_g102_do_not_stay_in_force(decode: Any, hit: Any) -> None:
    items = decode(run("Z20") + "G101 Z1\nZ10\nG102 Z77\nZ10\nM30", [hit])
    assert [item.target for item in items if isinstance(item, Line)][1:] == [{2: 90.0}, {2: 10.0}]


@pytest.mark.req("M-064")
def test_g101_without_measured_value_is_an_error(decode: Any, hit: Any) -> None:
    assert decode("G101 Z1\nM30", [hit])[-1].number == 20024
    assert decode(run("Z20") + "G101 X1\nM30", [hit])[-1].number == 20024


def test_reading_a_value_that_was_never_measured_gives_zero(decode: Any, texts: Any, hit: Any) -> None:
    items = decode(run("Z20") + '#MSG["%f %d", V.A.MESS.X, V.A.MERF.X]\nM30', [hit])
    assert texts(items) == ["0.000000 0"]


def test_a_run_without_a_value_leaves_the_axis_what_it_had(decode: Any, texts: Any, state: Any) -> None:
    """Value, target and offset stay those of the run that delivered them."""
    first = state((0.0, 0.0, 99.0, 0.0), measured={"Z": 100.0}, delivered={"Z": 1}, latched={"Z": True})
    second = state((0.0, 0.0, 150.0, 0.0), measured={"Z": 100.0}, delivered={"Z": 1}, latched={"Z": False})
    shown = '#MSG["%f %f %d", V.A.MESS.Z, V.A.MOFFS.Z, V.A.MERF.Z]\n'
    items = decode(run("Z20") + shown + run("Z150") + shown + "M30", [first, second])
    assert texts(items) == ["100.000000 80.000000 1", "100.000000 80.000000 0"]


@pytest.mark.req("M-065")
def test_offset_stays_until_g102_and_waits_for_an_absolute_position(decode: Any, hit: Any) -> None:
    program = run("Z20") + "G01 Z0\nG101 Z1\nG91 Z5\nG90 X1\nZ0\nZ1\nG102\nG91 Z1\nG90 Z0\nM30"
    lines = [item.target for item in decode(program, [hit]) if isinstance(item, Line)]
    assert lines[1:] == [{2: 0.0}, {2: 5.0}, {0: 1.0}, {2: 80.0}, {2: 81.0}, {2: 82.0}, {2: 0.0}]


def test_a_second_offset_waits_for_g102(decode: Any, hit: Any) -> None:
    error = decode(run("Z20") + "G101 Z1\nG101 Z1\nM30", [hit])[-1]
    assert isinstance(error, CncError)
    assert (error.number, error.axis) == (20050, "Z")


@pytest.mark.req("M-054", "M-058", "M-073")
def test_values_stay_those_of_the_run_when_offsets_change_after_it(decode: Any, hit: Any, texts: Any) -> None:
    program = "G92 Z33\n" + run("Z20") + "G92 Z1\n" + SHOW + "G01 Z50\n" + SHOW + "M30"
    assert texts(decode(program, [hit])) == ["100.00 100.00 67.00 47.00"] * 2


def test_values_stay_those_of_the_frame_of_the_run(decode: Any, state: Any, texts: Any) -> None:
    measured = {"X": 0.0, "Y": 0.0, "Z": 100.0}
    program = "#CS ON[0,0,33]\nG01 Z200 F1\nG100 Z20\n#CS OFF\n" + SHOW + "M30"
    assert texts(decode(program, [state(measured=measured)])) == ["67.00 100.00 67.00 47.00"]


def test_offset_and_frame_together(decode: Any, state: Any, texts: Any) -> None:
    measured = {"X": 0.0, "Y": 0.0, "Z": 100.0}
    program = "#CS ON[0,0,33]\nG92 Z7\nG01 Z200 F1\nG100 Z20\n" + SHOW + "M30"
    assert texts(decode(program, [state(measured=measured)])) == ["67.00 100.00 60.00 40.00"]


def test_a_run_of_an_axis_whose_offset_is_included_is_an_error(decode: Any, hit: Any, texts: Any) -> None:
    """P-ERR-20050: the offset is to be taken out with G102 before the axis measures again."""
    again = "G01 Z200\nG100 Z20\n" + SHOW + "M30"
    error = decode(run("Z20") + "G101 Z1\n" + again, [hit])[-1]
    assert isinstance(error, CncError)
    assert (error.number, error.axis) == (20050, "Z")
    assert texts(decode(run("Z20") + "G101 Z1\nG102 Z1\n" + again, [hit])) == ["100.00 100.00 100.00 80.00"]
    assert decode(run("Z20") + "G101 Z1\nG100 X5\nM30", [hit])[-1].source.line == 5


@pytest.mark.req("M-053", "M-067")
def test_merf_of_an_axis_outlives_runs_of_others(decode: Any, state: Any, texts: Any) -> None:
    show = '#MSG ["%d %d", V.A.MERF.X, V.A.MERF.Y]\n'
    answers = [
        state(measured={"X": 1.0}, latched={"X": True}),
        state(measured={"X": 1.0, "Y": 2.0}, latched={"Y": False}),
    ]
    items = decode("G100 X5 F1\n" + show + "G100 Y5\n" + show + "M30", answers)
    assert texts(items) == ["1 0", "1 0"]


def test_measured_numbers_carry_no_dust(decode: Any, state: Any, texts: Any) -> None:
    answer = state(measured={"Z": 0.1 + 0.2})
    program = "G01 Z1 F1\nG100 Z0.1\nP1 = V.A.MOFFS.Z == 0.2\n" + '#MSG ["%d", P1]\nM30'
    assert texts(decode(program, [answer])) == ["1"]


@pytest.mark.req("M-056")
def test_meas_type_is_readable(decode: Any, texts: Any) -> None:
    program = '#MSG ["%d", V.G.MEAS_TYPE]\n#MEAS MODE[7]\n#MSG ["%d", V.G.MEAS_TYPE]\nM30'
    assert texts(decode(program, measuring_type=3)) == ["3", "7"]


def test_type_2_takes_its_feed_from_the_axis(decode: Any) -> None:
    item = decode("G100 X5\nM30", measuring_type=2)[0]
    assert isinstance(item, MeasuringRun)
    assert (item.measuring_type, item.feed) == (2, 0.0)


@pytest.mark.req("M-042")
def test_axes_that_do_not_move_need_no_signal(decode: Any) -> None:
    run_of = [
        item
        for item in decode("G00 X1 Y1\nG100 X1 Y2 F1\nG00 X1\nG100 X1\nM30")
        if isinstance(item, MeasuringRun)
    ]
    assert [(item.target, item.axes) for item in run_of] == [({0: 1.0, 1: 2.0}, (1,)), ({0: 1.0}, ())]


def test_motion_word_before_a_run_stays_in_force(decode: Any) -> None:
    lines = [item for item in decode("G00 X1\nG100 X9 F5\nX2\nM30") if isinstance(item, Line)]
    assert [line.rapid for line in lines] == [True, True]
