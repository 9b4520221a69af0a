"""Every word of the dialect is built, or says where it is read that it is not; no other word is taken for one."""

from typing import Any

import pytest

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.kernel.decoder.commands import COMMANDS
from hli_bench.kernel.decoder.expressions import FUNCTIONS
from hli_bench.manual import dialect

TABLES = {
    "G": (dialect.G_FUNCTIONS, "N10 {0}"),
    "M": (dialect.M_FUNCTIONS, "N10 {0}"),
    "#": (dialect.COMMANDS, "N10 #{0} ON"),
    "$": (dialect.STATEMENTS, "N10 ${0} 1"),
    "function": (dialect.FUNCTIONS, "N10 P1 = {0}[1]"),
    "operator": (dialect.OPERATORS, "N10 P1 = 1 {0} 1"),
    "axis command": (
        dict.fromkeys((*dialect.AXIS_COMMANDS, "M20", "H3", "MC_Power"), "axis"),
        "N10 X[{0} A=1]",
    ),
    "V.A": (dialect.AXIS_VARIABLES, "N10 P1 = V.A.{0}.X"),
    "V.G": (dialect.GLOBAL_VARIABLES, "N10 P1 = V.G.{0}"),
    "V.G written": (dialect.GLOBAL_VARIABLES, "N10 V.G.{0} = 1"),
    "V": (dialect.VARIABLE_AREAS, "N10 P1 = V.{0}.ANY"),
}
UNBUILT = [
    pytest.param(form.format(word), id=f"{kind} {word}")
    for kind, (table, form) in TABLES.items()
    for word, what in table.items()
    if what != dialect.BUILT
]
SAID = [
    ("N10 LL PART", 5, "LL: subroutines"),
    ("N10 L CYCLE [NAME=a.cyc @P1=1]", 5, "L: subroutines"),
    ("N10 @P1 = 5", 5, "parameters of cycles"),
    ("N10 G01 X@P1 F1", 10, "parameters of cycles"),
    ("N10 G08", 5, "G08: acceleration"),
    ("N10 G09 X1", 5, "G09: acceleration"),
    ("N10 G43", 5, "G43: tool length"),
    ("N10 G90 G98 Z-5", 9, "G98: software limits"),
    ("N10 G131 = 70", 5, "G131: weighting"),
    ("N10 G231 = 70", 5, "G231: weighting"),
    ("N10 #PTP ON", 5, "#PTP: kinematic"),
    ("N10 #TOOL DATA", 5, "#TOOL: tools"),
    ("N10 #COMMAND WR", 5, "#COMMAND: SERCOS"),
    ("N10 T5 D1", 5, "T5: tools"),
    ("N10 M6", 5, "M6: tools"),
    ("N10 M123", 5, "M123: technology"),
    ("N10 H7", 5, "H7: technology"),
    ("N10 S1000", 5, "S1000: spindles"),
    ('N10 "MACRO" = "X1"', 5, "macros"),
    ("N10 [LABEL]", 5, "labels"),
    ("N10 P1 = '16#FF'", 10, "another base"),
    ("/N10 X1", 1, "skipping"),
    ("/2 N10 X1", 1, "skipping"),
    ("%L PART", 1, "subroutines"),
    ("N10 #CHANNEL SET [A=1]", 14, "#CHANNEL SET"),
    ("N10 #DRIVE WR [AX=X MOTOR=2 KEY=A VAL=1]", 21, "#DRIVE MOTOR"),
    ("N10 #MEAS [AX=X INPUT=PROBE0]", 23, "PROBE0: probing inputs by name"),
    ("N10 V.G.WZ[3].R = 5", 5, "V.G.WZ: tools"),
    ("N10 P1 = V.A.-SWE.X", 10, "software limits"),
    ("N10 P1 = V.G.@P[2].VALID", 10, "subroutines"),
]


@pytest.mark.parametrize("program", UNBUILT)
def test_a_word_that_is_not_built_says_so_where_it_stands(decode: Any, program: str) -> None:
    with pytest.raises(NotEmulated, match=r"NotEmulated: test\.nc:2:[0-9]+: .* not built"):
        decode(f"%p\n{program}\nM30\n")


@pytest.mark.parametrize(("program", "column", "text"), SAID)
def test_line_and_column_are_those_of_the_word(decode: Any, program: str, column: int, text: str) -> None:
    with pytest.raises(NotEmulated, match=rf"test\.nc:2:{column}: .*{text}"):
        decode(f"%p\n{program}\nM30\n")


def test_words_marked_as_built_are_those_that_the_decoder_knows(decode: Any) -> None:
    assert {word for word, what in dialect.COMMANDS.items() if not what} == {*COMMANDS, "COMMENT"}
    assert {word for word, what in dialect.FUNCTIONS.items() if not what} == set(FUNCTIONS)
    for word, what in dialect.G_FUNCTIONS.items():
        if not what:
            decode(f"{word} {'1' if word == 'G4' else '' if word == 'G102' else 'X1'} F100\nM30")
    for word in ("V.A.ABS.X", "V.A.MESS.X", "V.G.FEEDRATE", "V.G.MEAS_TYPE"):
        decode(f"P1 = {word}\nM30")


@pytest.mark.parametrize(
    "program",
    [
        "N10 G64",
        "N10 G1000",
        "N10 G7",
        "N10 #NOTHING",
        "N10 #CHANNEL FOO",
        "N10 $NEVER",
        "N10 P1 = FOO[1]",
        "N10 WORD",
        "N10 ?",
    ],
)
def test_a_word_of_no_table_is_bad_input_that_names_what_was_expected(decode: Any, program: str) -> None:
    with pytest.raises(InputError, match="expected") as caught:
        decode(f"%p\n{program}\nM30\n")
    assert (caught.value.line, caught.value.column > 0) == (2, True)


def test_exponents_have_a_small_letter(decode: Any) -> None:
    (line, *_) = decode("G00 X1.5e2 Y[2e-1]\nM30")
    assert line.target == {0: 150.0, 1: 0.2}
