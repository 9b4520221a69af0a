"""What is refused, and how exactly the place is named; what is accepted in which spelling."""

from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Line, ProgramEnd, Text
from hli_bench.kernel.decoder import DecoderAxis
from hli_bench.kernel.records import CncError


@pytest.mark.parametrize(
    ("program", "line", "column", "message"),
    [
        ("%p\nN10 G777 X1", 2, 5, "found 'G777'"),
        ("N10 G01 Q5", 1, 9, "found 'Q5'"),
        ("N10 G01 X", 1, 10, "expected a position after X"),
        ("N10 G00 X1 X2", 1, 12, "axis X once in a block"),
        ("N10 G01 X5", 1, 5, r"no feed \(F\) programmed"),
        ("N10 G00 X5\nN20 G100 X5", 2, 5, r"no feed \(F\) programmed"),
        ("N10 G100 F100", 1, 5, "expected an axis word in the block of G100"),
        ("N10 G101", 1, 5, "expected an axis word"),
        ("N10 G74", 1, 5, "expected an axis word"),
        ("N10 G00 G01 X1", 1, 9, "one of G00 and G01"),
        ("N10 G92 G100 X1", 1, 9, "one of G92 and G100"),
        ("N10 F-5", 1, 5, "feed from 0 on"),
        ("N10 G04", 1, 8, "seconds of G04"),
        ("N10 G04 X-1", 1, 10, "seconds from 0 on"),
        ("N10 G00 X1 N20", 1, 12, "at the beginning of its block"),
        ("N10 #FOO [1]", 1, 5, "unknown command #FOO"),
        ("N10 #MEAS [NONSENSE=1]", 1, 12, "found 'NONSENSE'"),
        ("N10 #MEAS [AX=Q EDGE=POS]", 1, 12, "AX=Q: expected an axis"),
        ("N10 #MEAS [AXNR=9 EDGE=POS]", 1, 12, "AXNR=9: expected an axis number"),
        ("N10 #MEAS [AX=X SIGNAL=FOO]", 1, 17, "SIGNAL=FOO: expected one of"),
        ("N10 #MEAS [AX=X EDGE=UP]", 1, 17, "EDGE=UP: expected one of POS, NEG"),
        ("N10 #MEAS [AX=X INPUT=1.5]", 1, 17, "INPUT=1.5: expected a whole number"),
        ("N10 #MEAS [AX=X]", 1, 12, "expected SIGNAL, EDGE or INPUT for axis X"),
        ("N10 #MEAS []", 1, 13, "expected one of TYPE, ERR_NO_SIGNAL"),
        ("N10 #MEAS [EDGE=POS]", 1, 12, "expected AX= or AXNR= before EDGE"),
        ("N10 #MEAS MODE[1] X1", 1, 19, "end of the block after #MEAS"),
        ("N10 #DRIVE WR [AX=Z KEY=A]", 1, 15, "KEY= and VAL="),
        ("N10 #CS ON[1,2,3,4,5,6,7]", 1, 26, "at most 6 values"),
        ("N10 #CS SOMEWHERE", 1, 18, "expected ON or OFF"),
        ('N10 #MSG SYN["abc]', 1, 14, "closing quote"),
        ("N10 #MSG SYN[abc]", 1, 14, "expected a text"),
        ('N10 #MSG SYN["%q", 1]', 1, 14, "found %q"),
        ("N10 G00 X[1+\nN20 Y1", 1, 10, r"expected '\]' for this '\['"),
        ("N10 G00 X[1 +\n  2 Y7\nM30", 2, 5, r"expected '\]', found 'Y7'"),
        ("N10 G00 X1 \\ Y2", 1, 14, "end of the line after"),
        ("N10 G00 X1 \\\nN20 Y2 Q3", 2, 8, "found 'Q3'"),
        ("#COMMENT BEGIN\nX1", 1, 1, "expected #COMMENT END"),
        ("N10 $ENDIF", 1, 5, r"open \$IF before \$ENDIF"),
        ("N10 $BREAK", 1, 5, "inside a loop"),
        ("N10 $WHAT", 1, 5, r"expected one of \$IF"),
        ("$IF 1 X2\n$ENDIF", 1, 7, "alone in its block"),
        ("N10 G00 X1 ]", 1, 12, "expected a word"),
    ],
)
def test_input_error(decode: Any, program: str, line: int, column: int, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        decode(program)
    assert (caught.value.file, caught.value.line, caught.value.column) == ("test.nc", line, column)


@pytest.mark.parametrize(
    ("program", "word"),
    [
        ("N10 G02 X1 Y1 I5", "G02: circles"),
        ("N10 G310 G01 F1 X1", "G310"),
        ("N10 G41", "G41: tool radius"),
        ("N10 X[FIXED_STOP ON TORQUE_LIMIT=10]", r"X\[FIXED_STOP"),
        ("N10 S100 M3", "S100: spindles"),
        ("N10 M3", "M3: spindles"),
        ("N10 M00", "M00: stopping"),
        ("N10 #IDENT RD [AXNR 1]", "#IDENT"),
        ("N10 #TRAFO ON", "#TRAFO"),
        ("N10 #SET AX LINK[1, [X2=X,G]]", "#SET"),
        ("N10 #MEAS ON", "#MEAS ON"),
        ("N10 #MEAS [AX=X SIGNAL=PLC_FIRST_EVENT]", "SIGNAL=PLC_FIRST_EVENT"),
        ("N10 #MEAS [AX=X SIGNAL=PLC_EXT_LATCH_CONTROL]", "SIGNAL=PLC_EXT_LATCH_CONTROL"),
        ("N10 #MEAS [AX=X SIGNAL=EXT_PROBE_WITH_DRIVE INPUT=1]", "SIGNAL=EXT_PROBE_WITH_DRIVE"),
        ("N10 #MEAS [TRIGGER]", "TRIGGER"),
        ("N10 #MEAS MODE[8]", "type 8"),
        ('N10 #MSG ACK ["a"]', "ACK"),
        ("N10 $GOTO N20", "GOTO"),
        ("N10 $IF 1 $GOTO N20", "GOTO"),
        ("%L sub", "subroutines"),
        ("/N10 X1", "skipping"),
        ("N10 P1 = V.RTA.FIXED_STOP.DETECTED.X", "V.RTA"),
        ("N10 P1 = V.A.REF.X", "V.A.REF"),
    ],
)
def test_known_but_not_built(decode: Any, program: str, word: str) -> None:
    with pytest.raises(NotEmulated, match=rf"NotEmulated: test\.nc:1:[0-9]+: .*{word}"):
        decode(program)


def test_independent_axes_are_named_as_not_built(decode: Any) -> None:
    program = "N20 X[INDP_SYN G100 G90 POS100 FEED500] \\\n      Y[INDP_SYN G100 G90 POS100 FEED1000]"
    with pytest.raises(NotEmulated, match="INDP_SYN"):
        decode(program)


@pytest.mark.parametrize(
    ("program", "number"),
    [
        ("G00 X1", 21129),
        ("$IF 1\nG00 X1", 21129),
        ("$IF 0\nG00 X1", 21129),
        ("%one\nG00 X1\n%two\nM30", 20193),
        ("G100 G100 X1 F1", 20123),
        ("#MEAS MODE[5]\nG100 X1 F1", 20138),
        ("#MEAS MODE[9]", 20773),
        ("#MEAS MODE[0]", 20773),
        ("#MEAS MODE[1.5]", 20773),
        ("#MEAS [AX=X EDGE=POS EDGE=NEG]", 21418),
        ("#MEAS [AX=X INPUT=0]", 50639),
        ("#MEAS [AX=X INPUT=256]", 50639),
        ('#MSG ["%f"]', 20721),
        ('#MSG ["text", 1]', 20721),
        ("G74 X0", 20816),
        ("G102 X1", 20814),
        ("#CS ON[1]\n" * 6, 20826),
    ],
)
def test_errors_by_number_end_the_program(decode: Any, program: str, number: int) -> None:
    error = decode(program)[-1]
    assert isinstance(error, CncError)
    assert (error.number, error.severity) == (number, "error")
    assert "?" not in error.text


@pytest.mark.parametrize(
    ("program", "values"),
    [
        ("N010 $IF 1\nG00 X1", (1, "$IF", "$ENDIF")),
        ("$IF 1\nN010 $WHILE 1 < 2\nG00 X1", (2, "$WHILE", "$ENDWHILE")),
        ("N010 $IF 0\nG00 X1", (1, "$IF", "$ENDIF")),
    ],
)
def test_an_open_control_statement_is_a_warning(
    decode: Any, program: str, values: tuple[object, ...]
) -> None:
    warning, error = [item for item in decode(program) if isinstance(item, CncError)]
    assert (warning.number, warning.severity, warning.source.number) == (20375, "warning", "N010")
    assert tuple(warning.values.values()) == values
    assert (error.number, error.severity) == (21129, "error")


def test_a_warning_does_not_end_the_program(decode: Any) -> None:
    warning, end = decode("#CS OFF\nM30")
    assert (warning.number, warning.severity) == (20824, "warning")
    assert isinstance(end, ProgramEnd)


def test_error_tells_block_and_axis(decode: Any) -> None:
    error = decode("%p\nN050 G101 Z1")[-1]
    assert (error.number, error.axis, error.source.number, error.source.line) == (20024, "Z", "N050", 2)


@pytest.mark.parametrize(
    "spelling",
    [
        "N050 G01 X10 Y-2.5 F100",
        "n050g1x10y-2.5f100",
        "N050 G01 X = 10 Y=-2.5 F = 100",
        "N050 ( move ) G01 (* to *) X10 Y-2.5 F100 ; there",
        "  N050\tG01  X 10 Y -2.5 F100\r",
        "N050 G01 \\\n X10 \\ ; on\n N060 Y-2.5 F100",
        "N050: G01 X[10] Y[-2.5] F[100]",
        "N050 F100 Y-2.5 X10 G01",
    ],
)
def test_spellings_of_one_block(decode: Any, spelling: str) -> None:
    line = decode(spelling + "\nM30")[0]
    assert isinstance(line, Line)
    assert (line.source.number.upper(), line.source.line) == ("N050", 1)
    assert (line.rapid, line.feed, line.target) == (False, 100.0, {0: 10.0, 1: -2.5})


def test_block_number_stays_as_written(decode: Any) -> None:
    items = decode("N050 G00 X1\nN050 X2\nn7 X3\nX4\nN100 M30")
    assert [item.source.number for item in items] == ["N050", "N050", "n7", "", "N100"]


def test_an_axis_name_with_a_digit_needs_equals(decode: Any) -> None:
    axes = [
        DecoderAxis(AxisIndex(0), "X", 1, "T", True),
        DecoderAxis(AxisIndex(1), "X2", 2, "T", True),
        DecoderAxis(AxisIndex(2), "S", 3, "S", False),
    ]
    assert decode("G00 X2=100\nX2\nX1 X2=3\nM30", axes=axes)[0].target == {1: 100.0}
    assert decode("G00 X2\nM30", axes=axes)[0].target == {0: 2.0}
    with pytest.raises(NotEmulated, match="spindles"):
        decode("S100", axes=axes)
    with pytest.raises(NotEmulated, match="homing of spindle S"):
        decode("G74 X1 S3\nM30", axes=axes)


@pytest.mark.req("M-106")
@pytest.mark.parametrize(
    ("block", "text", "synchronous"),
    [
        ('#MSG SYN["a=%f", 1/3]', "a=0.333333", True),
        ('#MSG ["100%% (;) %d|%5.1f|%s", 2.9, 2.25, "end"]', "100% (;) 2|  2.2|end", False),
        ('#msg syn [ "x" ]', "x", True),
        ('#MSG SYN["a=%f",\n      5]', "a=5.000000", True),
        ('#MSG SYN["a=%f",\n\n  ; why\n   -> a = 5.0\n  5]', "a=5.000000", True),
        ('#MSG SYN["%f %d", -2.5, -3]', "-2.500000 -3", True),
    ],
)
def test_message(decode: Any, block: str, text: str, synchronous: bool) -> None:
    item = decode(block + "\nM30")[0]
    assert isinstance(item, Text)
    assert (item.text, item.synchronous) == (text, synchronous)


WORDS = """
    N10 G00 G01 G90 G91 G92 G100 G101 G102 G74 G04 X1 Y-2.5 Z[ ] [ C= P1 =5 PP1 V.A.MESS.X V.A.ABS[ V.P.A
    #MEAS MODE [1] #CS ON OFF #MSG SYN["%f", "a ( ) ; \\ $IF $ELSE $ENDIF $FOR $ENDFOR F100 M30 SIN[30]
    + - * / ** == , -> % #COMMENT BEGIN END AX=Z KEY=K VAL=1 #DRIVE WR 1e9 99999999999999999999 \u00e9 \u0664
"""
BLOCKS = st.lists(st.sampled_from(WORDS.split()), max_size=7).map(" ".join)


@settings(max_examples=400, deadline=None)
@given(st.lists(BLOCKS, max_size=6).map("\n".join))
@example("X\u0664")
def test_any_order_of_words_is_decoded_or_refused(decode: Any, program: str) -> None:
    try:
        items = decode(program)
    except (InputError, NotEmulated):
        return
    assert isinstance(items[-1], ProgramEnd | CncError)


@settings(max_examples=400, deadline=None)
@given(st.text(alphabet='NGXYZPVFM#$%[](){};"\\=+-*/.,0123456789 \n\tAES', max_size=60))
def test_any_text_is_decoded_or_refused_with_its_place(decode: Any, program: str) -> None:
    place = (1, 1)
    try:
        decode(program)
    except InputError as error:
        place = error.line, error.column
    except NotEmulated as error:
        place = (1, 1) if "test.nc:" in str(error) else (0, 0)
    assert min(place) >= 1
