"""Which branch is executed and how often a loop runs."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st


def moves(items: Any) -> list[float]:
    return [next(iter(item.target.values())) for item in items[:-1]]


@pytest.mark.parametrize(("value", "expected"), [(1, [1, 9]), (2, [2, 9]), (3, [3, 9]), (4, [4, 9])])
def test_exactly_one_branch(decode: Any, value: int, expected: list[float]) -> None:
    program = f"""P1 = {value}
$IF P1 == 1
G00 X1
$ELSEIF P1 == 2
G00 X2
$IF 1
$ELSE
G00 X99
$ENDIF
$ELSEIF P1 = 3
G00 X3
$ELSE
G00 X4
$ENDIF
G00 X9
M30"""
    assert moves(decode(program)) == expected


@given(st.floats(-2, 2))
def test_a_condition_holds_from_a_half_on(decode: Any, value: float) -> None:
    program = f"G00 X0\n$IF {value:.3f}\nG00 X1\n$ENDIF\nM30"
    assert len(decode(program)) == 2 + (abs(float(f"{value:.3f}")) >= 0.5)


@pytest.mark.parametrize(
    ("head", "expected"),
    [
        ("1, 3", [1, 2, 3]),
        ("1, 3, 2", [1, 3]),
        ("3, 1, -1", [3, 2, 1]),
        ("3, 1", []),
        ("1, 2, 0.5", [1, 1.5, 2]),
    ],
)
def test_for(decode: Any, head: str, expected: list[float]) -> None:
    assert moves(decode(f"$FOR P1 = {head}\nG00 X[P1]\n$ENDFOR\nM30")) == expected


def test_nested_loops_and_a_comment_with_words_of_loops(decode: Any) -> None:
    program = """$FOR P1 = 1, 2
$FOR P2 = 1, 2 ; $ENDFOR
G00 X[10 * P1 + P2] \\
    Y0
( $BREAK )
$ENDFOR
$ENDFOR
M30"""
    assert moves(decode(program)) == [11, 12, 21, 22]


def test_break_leaves_the_inner_loop_only(decode: Any) -> None:
    program = """$FOR P1 = 1, 2
P2 = 0
$WHILE 1
P2 = P2 + 1
$IF P2 > 1
$BREAK
$ENDIF
G00 X[10 * P1 + P2]
$ENDWHILE
$ENDFOR
M30"""
    assert moves(decode(program)) == [11, 21]


def test_a_loop_over_measured_values_asks_each_time(decode: Any, state: Any) -> None:
    answers = [state(latched={"X": False}), state(latched={"X": False}), state(latched={"X": True})]
    program = "P1 = 0\n$WHILE V.A.MERF.X == 0\nP1 = P1 + 1\nG100 X[P1] F1\n$ENDWHILE\nG00 X[-P1]\nM30"
    assert decode(program, answers)[-2].target == {0: -2.0}
