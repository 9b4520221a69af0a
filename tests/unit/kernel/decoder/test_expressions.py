"""Values of expressions, parameters and own variables."""

import math
import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.base.errors import InputError
from hli_bench.kernel.blocks import Line
from hli_bench.kernel.records import CncError


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("X[1+2*3]", 7),
        ("X[[1+2]*3]", 9),
        ("X=7-2-1", 4),
        ("X[2**3**2]", 512),
        ("X[-2**2]", -4),
        ("X[2**-1]", 0.5),
        ("X[7 MOD 4]", 3),
        ("X[-[3]]", -3),
        ("X-10", -10),
        ("X.5", 0.5),
        ("X5.", 5),
        ("XSIN[30]", 0.5),
        ("XSIN[180]", 0),
        ("XCOS[90]", 0),
        ("XTAN[45]", 1),
        ("XASIN[1]", 90),
        ("XACOS[0]", 90),
        ("XATAN[1]", 45),
        ("XSQRT[16]", 4),
        ("XSQR[3]", 9),
        ("XABS[-3]", 3),
        ("XROUND[2.5]", 3),
        ("XROUND[-2.5]", -3),
        ("XFIX[2.7]", 2),
        ("XFUP[2.1]", 3),
        ("XEXP[0]", 1),
        ("XLN[1]", 0),
        ("X[3 > 2]", 1),
        ("X[3 <= 2]", 0),
        ("X[1 == 1 AND 2 != 2]", 0),
        ("X[FALSE || TRUE]", 1),
        ("X[!0]", 1),
        ("X[NOT[1]]", 0),
        ("x = sin[ 90 ]", 1),
    ],
)
def test_value(decode: Any, text: str, value: float) -> None:
    line = decode(f"G90 G00 {text}\nM30")[0]
    assert line.target[0] == pytest.approx(value, abs=1e-12)


def test_parameters_directly_by_expression_and_indirectly(decode: Any) -> None:
    program = "P1 = 5\nP[P1 + 1] = 40\nP7 = 6\nG00 X[P1] Y=P6 ZPP7 CP[3*2]\nM30"
    assert decode(program)[0].target == {0: 5.0, 1: 40.0, 2: 40.0, 3: 40.0}


def test_own_variables(decode: Any) -> None:
    program = "V.P.START = 3\nV.E.GO = TRUE\nV.P.LIST[2] = 7\nG00 XV.P.START YV.E.GO Z=v.p.list[1+1]\nM30"
    assert decode(program)[0].target == {0: 3.0, 1: 1.0, 2: 7.0}


def test_assignment_in_a_motion_block_counts_from_there_on(decode: Any) -> None:
    assert decode("P1=1\nG00 P1=2 X=P1\nM30")[0].target == {0: 2.0}


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        ("X[1/0]", 6, "cannot be computed"),
        ("X[SQRT[-1]]", 6, "cannot be computed"),
        ("X[LN[0]]", 6, "cannot be computed"),
        ("X[10**999]", 6, "cannot be computed"),
        ("X" + "9" * 400, 6, "cannot be computed"),
        ("X[" + "9" * 400 + "]", 6, "cannot be computed"),
        ("X[[-8]**0.5]", 6, "cannot be computed"),
        ("X[1+]", 9, "expected a number, a parameter or '['"),
        ("X[FOO[1]]", 7, "found 'FOO'"),
        ("X=P99", 7, "P99 has no value"),
        ("X=V.P.NOT", 7, "V.P.NOT has no value"),
        ("X[1 2]", 9, "expected ']'"),
        ("X=P[1.5]", 12, "whole, not negative"),
        ("X=SIN 30", 11, "expected '['"),
    ],
)
def test_error_names_the_place(decode: Any, text: str, column: int, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        decode(f"%p\nG00 {text}\nM30")
    assert (caught.value.file, caught.value.line, caught.value.column) == ("test.nc", 2, column)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("P1 = V.A.ABS.Q", 20092),
        ("V.A.ABS.X = 1", 20100),
        ("P1 = V.A.NOTHING.X", 20196),
        ("P1 = V.G.NOTHING_KNOWN", 20196),
        ("P1 = V.A.ABS[31]", 20197),
    ],
)
def test_variables_the_cnc_refuses(decode: Any, text: str, number: int) -> None:
    error = decode(text)[-1]
    assert isinstance(error, CncError)
    assert error.number == number


def test_a_variable_by_index_is_the_one_by_name(decode: Any, texts: Any) -> None:
    program = 'G00 Y12.5\n#MSG ["%f %f", V.A.ABS[1], V.A.ABS.Y]\nM30'
    assert texts(decode(program)) == ["12.500000 12.500000"]


def test_brackets_may_nest_only_so_deep(decode: Any) -> None:
    for opening, closing in (("[", "]"), ("P[", "]"), ("SIN[", "]"), ("!", "")):
        with pytest.raises(InputError, match="nested brackets"):
            decode("P1=1\nG00 X=" + opening * 500 + "1" + closing * 500)


@given(st.floats(-2e5, 2e5).map(lambda value: round(value, 4)))
def test_numbers_are_read_as_written(decode: Any, value: float) -> None:
    written = f"{value:.4f}"
    plain, bracketed = decode(f"G00 X{written}\nG00 Y[{written}]\nM30")[:2]
    assert isinstance(plain, Line)
    assert plain.target == {0: float(written)}
    assert bracketed.target == {1: float(written)}


@given(st.floats(-1e9, 1e9), st.integers(0, 9))
def test_messages_print_numbers_like_c(decode: Any, texts: Any, value: float, digits: int) -> None:
    program = f'P1 = {value:.6f}\n#MSG ["%f %.{digits}f %d", P1, P1, P1]\nM30'
    kept = float(f"{value:.6f}")
    assert texts(decode(program)) == [f"{kept:.6f} {kept:.{digits}f} {math.trunc(kept)}"]
