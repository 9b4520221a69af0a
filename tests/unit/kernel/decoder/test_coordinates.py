"""Frames, offsets and the position after measuring and homing."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Flush, Home, Line, MeasuringRun
from hli_bench.kernel.decoder.coordinates import Coordinates, frame

LENGTH = st.floats(-1000, 1000)
ANGLE = st.floats(-360, 360)
POINT = st.tuples(LENGTH, LENGTH, LENGTH)
FRAME = st.tuples(LENGTH, LENGTH, LENGTH, ANGLE, ANGLE, ANGLE).map(frame)
X, Y, Z, C = (AxisIndex(i) for i in range(4))


@pytest.mark.parametrize(
    ("values", "point", "acs"),
    [
        ((1, 2, 3, 0, 0, 0), (10, 20, 30), (11, 22, 33)),
        ((0, 0, 0, 0, 0, 90), (1, 0, 0), (0, 1, 0)),
        ((0, 0, 0, 0, 90, 0), (1, 0, 0), (0, 0, -1)),
        ((0, 0, 0, 90, 0, 0), (0, 1, 0), (0, 0, 1)),
        ((0, 0, 0, 0, 90, 90), (1, 0, 0), (0, 0, -1)),
        ((0, 0, 0, 90, 0, 90), (0, 1, 0), (0, 0, 1)),
        ((0, 0, 0, 90, 0, 90), (0, 0, 1), (1, 0, 0)),
    ],
)
def test_turns_are_right_handed_and_z_comes_first(values: Any, point: Any, acs: Any) -> None:
    assert frame(values).to_acs(point) == acs


@pytest.mark.req("M-105")
def test_positive_turn_about_y_lowers_z_along_x() -> None:
    assert frame((0, 0, 75, 0, 15, 0)).to_acs((150, 0, 20))[2] == pytest.approx(55.4957, abs=1e-4)


@given(FRAME, POINT)
def test_there_and_back(system: Any, point: Any) -> None:
    assert system.from_acs(system.to_acs(point)) == pytest.approx(point, abs=1e-8)


@given(FRAME, FRAME, POINT)
def test_stacked_frames_act_one_after_the_other(outer: Any, inner: Any, point: Any) -> None:
    assert outer.then(inner).to_acs(point) == pytest.approx(outer.to_acs(inner.to_acs(point)), abs=1e-6)


@given(FRAME, POINT)
def test_changing_the_frame_does_not_move(system: Any, point: Any) -> None:
    where = Coordinates(3, (X, Y, Z))
    where.move(list(zip((X, Y, Z), point, strict=True)), absolute=True)
    where.push(system)
    assert [where.acs(axis) for axis in (X, Y, Z)] == pytest.approx(point, abs=1e-8)
    where.pop(everything=False)
    assert where.absolute == pytest.approx(point, abs=1e-8)


def test_frames_stack_and_leave_one_by_one(decode: Any) -> None:
    program = """G00 X0 Y0 Z0
#CS ON[10,0,0,0,0,90]
#CS ON[5,0,0]
X1 Y0
#CS OFF
X1
#CS ON[,,7]
#CS OFF ALL
X1
M30"""
    targets = [item.target for item in decode(program) if isinstance(item, Line)]
    assert targets == [{0: 0.0, 1: 0.0, 2: 0.0}, {0: 10.0, 1: 6.0}, {1: 1.0}, {0: 1.0}]


def test_an_axis_outside_the_frame_moves_on_its_own(decode: Any, state: Any) -> None:
    items = decode("#CS ON[1,2,3]\nG00 C5\nX1 C6\nM30", [state((0, 0, 0, 0))])
    assert [type(item) for item in items[:3]] == [Line, Flush, Line]
    assert items[0].target == {3: 5.0}
    assert items[2].target == {0: 2.0, 3: 6.0}


def test_positions_that_do_not_change_are_no_motion(decode: Any) -> None:
    items = decode("G00 X1 Y1\nX1\nX1.0000000001 Y2\nG91 X0\nM30")
    assert [item.target for item in items[:-1]] == [{0: 1.0, 1: 1.0}, {1: 2.0}]


def test_many_increments_do_not_drift(decode: Any) -> None:
    program = "G00 X0\nG91\n" + "X0.1\n" * 1000 + "M30"
    assert decode(program)[-2].target == {0: 100.0}


@pytest.mark.req("M-011")
def test_after_a_run_only_named_axes_move_and_nothing_is_asked(decode: Any) -> None:
    items = decode("N30 G100 X10 Y10 F500\nN40 G01 X7\nM30")
    assert [type(item) for item in items[:2]] == [MeasuringRun, Line]
    assert items[1].target == {0: 7.0}


@pytest.mark.parametrize(
    "program",
    [
        "G91 G00 X1\nM30",
        "P1 = V.A.ABS.X\nM30",
        "P1 = V.A.ABS[0]\nM30",
        "P1 = V.A.ACT_POS.X\nM30",
        "P1 = V.A.MERF.X\nM30",
        "P1 = V.A.RERF.X\nM30",
        "$IF V.A.MERF.X\n$ENDIF\nM30",
        "$IF 0\n$ELSEIF V.A.MERF.X\n$ENDIF\nM30",
        "#CS ON[1]\nG00 X1\nM30",
        "#CHANNEL INIT [ACTPOS]\nM30",
        "#CHANNEL INIT\nM30",
    ],
)
def test_what_only_the_machine_knows_is_asked_once(decode: Any, program: str) -> None:
    assert sum(isinstance(item, Flush) for item in decode(program)) == 1


@pytest.mark.parametrize(
    "program",
    [
        "G00 X1\nP1 = V.A.ABS.X + V.A.PROG.X\nM30",
        "P1 = V.A.MEIN.X + V.A.BZP.X + V.G.MEAS_TYPE\nM30",
        '#MSG ["V.A.MESS.X"]\nM30',
        "$IF 0\nP1 = V.A.MESS.X\n$ENDIF\nM30",
        "#CS ON[1]\nG00 X1 Y1 Z1\nM30",
    ],
)
def test_what_the_decoder_knows_is_not_asked(decode: Any, program: str) -> None:
    assert not any(isinstance(item, Flush) for item in decode(program))


def test_one_answer_serves_until_the_machine_moves(decode: Any, state: Any) -> None:
    read = "P1 = V.A.MERF.X\n"
    items = decode("G100 X1 F1\n" + read * 3 + "G00 X5\n" + read * 2 + "M30", [state(latched={"X": True})])
    assert sum(isinstance(item, Flush) for item in items) == 2


def test_homing_voids_the_position(decode: Any, state: Any) -> None:
    items = decode("G00 X5 Y5\nG74 X1\nG91 X1 Y1\nM30", [state((3.0, 99.0, 0.0, 0.0))])
    assert isinstance(items[1], Home)
    assert isinstance(items[2], Flush)
    assert items[3].target == {0: 4.0, 1: 6.0}


def test_channel_init_takes_command_or_actual_positions(decode: Any, state: Any, texts: Any) -> None:
    answer = state((1.0, 2.0, 3.0, 4.0), actual=(1.5, 2.5, 3.5, 4.5))
    read = '\n#MSG ["%.1f %.1f", V.A.ABS.X, V.A.ABS.Y]\n'
    program = (
        "#CHANNEL INIT [CMDPOS]"
        + read
        + "#CHANNEL INIT [ACTPOS]"
        + read
        + "#CHANNEL INIT [ACTPOS AX=Y]"
        + read
        + "M30"
    )
    assert texts(decode(program, [answer])) == ["1.0 2.0", "1.5 2.5", "1.0 2.5"]


def test_actual_position_is_told_without_offsets(decode: Any, state: Any, texts: Any) -> None:
    program = 'G92 X3\nG00 X1\n#MSG ["%.1f", V.A.ACT_POS.X]\nM30'
    assert texts(decode(program, [state((4.0, 0, 0, 0), actual=(4.2, 0, 0, 0))])) == ["1.2"]
