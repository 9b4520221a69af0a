"""NC text of any kind: blocks, an error of the CNC, `InputError` or `NotEmulated`, and never long.

A text that fails is printed with its seed; how many are tried, and from which seed on, says `inputs.py`.
"""

import random
import re
import time
from collections.abc import Callable

import pytest

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Flush, MachineState
from hli_bench.kernel.decoder import Decoder, DecoderAxis, DecoderDefaults
from hli_bench.kernel.records import CncError
from hli_bench.manual import dialect
from tests.fuzz.inputs import COUNT, FIRST

ITEMS = 3000
"""Items of a program at most: a loop may be endless."""
PROCESSOR_S = 20.0
"""Processor time of one text at most: a quadratic decoder needs minutes for the longest."""
PLACE = re.compile(r"(NotEmulated: )?fuzz\.nc:[0-9]+:")
KINDS = ("T", "T", "T", "R", "S")
AXES = tuple(
    DecoderAxis(AxisIndex(index), name, index + 1, kind, True)  # type: ignore[arg-type]
    for index, (name, kind) in enumerate(zip(("X", "Y", "Z", "A", "S"), KINDS, strict=True))
)
STATE = MachineState(
    command={axis.index: 1.5 for axis in AXES},
    actual={axis.index: 1.5 for axis in AXES},
    measured={axis.index: 2.5 for axis in AXES},
    delivered={},
    latched={axis.index: True for axis in AXES},
    referenced={axis.index: True for axis in AXES},
)

WORDS = (
    *("G00", "G01", "G1", "G04", "G74", "G90", "G91", "G92", "G100", "G101", "G102", "M30", "F1000", "F"),
    *(
        "X",
        "Y",
        "Z",
        "A",
        "S",
        "X1",
        "Y=-2.5",
        "Z[",
        "]",
        "[",
        "(",
        ")",
        ";",
        "\\",
        "\n",
        "\n\n",
        '"',
        "%",
        "/",
        "=",
        ",",
    ),
    *(
        "#MEAS",
        "#MEAS MODE",
        "[TYPE=2]",
        "#MEAS [AX=X SIGNAL=",
        "PLC",
        "DRIVE",
        "EDGE=NEG",
        "INPUT=",
        "#MEAS DEFAULT",
    ),
    *(
        "#CS ON",
        "#CS OFF",
        "#CS OFF ALL",
        "[0,0,0,",
        "45]",
        '#MSG ["',
        "%f",
        "%d",
        "%s",
        "%99.99f",
        "#CHANNEL INIT",
    ),
    *(
        "#DRIVE WR SYN [AX=Z KEY=K VAL=",
        "WAIT]",
        "#COMMENT BEGIN",
        "#COMMENT END",
        "$IF ",
        "$ELSE",
        "$ELSEIF ",
        "$ENDIF",
    ),
    *(
        "$WHILE ",
        "$ENDWHILE",
        "$FOR P1=",
        "1,3,1",
        "$ENDFOR",
        "$BREAK",
        "$CONTINUE",
        "P1",
        "P[",
        "PP1",
        "V.P.A",
        "V.A.",
    ),
    *(
        "V.A.MESS.X",
        "V.A.ABS[0]",
        "V.G.MEAS_TYPE",
        "SIN[",
        "SQRT[",
        "/0",
        "**",
        "*",
        "+",
        "-",
        "<",
        "==",
        "&&",
        "!",
        "0.5",
    ),
    *(
        "1e9",
        "1e300",
        "9" * 30,
        "9" * 400,
        ".",
        "..",
        "\x00",
        "\x03",
        "\ufeff",
        "\u2028",
        "\u0130",
        "\u017f",
        "\U0001f600",
        "\x1b[2J",
    ),
    *dialect.G_FUNCTIONS,
    *(f"#{word}" for word in dialect.COMMANDS),
    *(f"${word}" for word in dialect.STATEMENTS),
    *(f"V.G.{word}" for word in dialect.GLOBAL_VARIABLES),
)
VALID = """%p
N10 G00 G90 X10 Y[5*2+SIN[30]] (comment (nested) ) Z0
N20 P1 = 3
$FOR P2 = 1, 3, 1
  N30 G01 X=[P2*P1] F1000 ; remark
  $IF P2 == 2
    $CONTINUE
  $ELSE
    N40 #MSG SYN ["P2 is %d %f", P2, V.A.ABS.X]
  $ENDIF
$ENDFOR
#CS ON [0,0,5,0,30,\\
        0]
N50 #MEAS [AX=X SIGNAL=PLC EDGE=NEG AX=Y INPUT=2]
N60 G100 X20 F500
N70 V.P.A = V.A.MESS.X - V.A.MOFFS.X
N80 G101 X1
#CS OFF ALL
N90 M30
"""


def drain(text: str) -> int:
    """Decode a text; return how many items came. Raises what the decoder raises."""
    blocks = Decoder(text.splitlines(keepends=True), "fuzz.nc", AXES, DecoderDefaults()).blocks()
    answer: MachineState | None = None
    count = 0
    try:
        while count < ITEMS:
            item = blocks.send(answer)
            answer = STATE if isinstance(item, Flush) else None
            count += 1
            if isinstance(item, CncError) and item.severity == "error":
                break
    except StopIteration:
        pass
    blocks.close()
    return count


def said(text: str, seed: object) -> str:
    """Return what the decoder says of a text that it does not take, "" of one that it takes."""
    try:
        drain(text)
    except (InputError, NotEmulated) as error:
        return str(error)
    except Exception as error:
        raise AssertionError(f"{type(error).__name__}: {error}, seed {seed}: {text[:2000]!r}") from error
    return ""


def check(text: str, seed: object = "") -> None:
    begin = time.process_time()
    told = said(text, seed)
    assert not told or PLACE.match(told), f"{told!r} without a place, seed {seed}: {text[:2000]!r}"
    assert len(told) < 1000
    assert time.process_time() - begin < PROCESSOR_S, f"seed {seed}: {text[:200]!r}"


def soup(draw: random.Random) -> str:
    """Words of the language in any order."""
    joint = draw.choice(("", " ", " ", "\n"))
    return joint.join(draw.choice(WORDS) for _ in range(draw.randrange(1, 40))) + "\nM30\n"


def damaged(draw: random.Random) -> str:
    """A valid program with a few characters changed, cut out, doubled, or words put in."""
    text = VALID
    for _ in range(draw.randrange(1, 6)):
        at = draw.randrange(len(text) + 1)
        match draw.randrange(4):
            case 0:
                text = text[:at] + draw.choice(WORDS) + text[at:]
            case 1:
                text = text[:at] + text[at + draw.randrange(1, 20) :]
            case 2:
                text = text[:at] + chr(draw.randrange(1, 0x250)) + text[at + 1 :]
            case _:
                text = text[:at] + text[max(at - draw.randrange(1, 60), 0) : at] + text[at:]
    return text


def noise(draw: random.Random) -> str:
    """Characters without sense."""
    alphabet = "GXYZMNFPV0123456789.-+*/[]()=#$%;,\"'\\@!<>&|^ \t\n" + "\u00e4\u0130\u017f\x1c\x85\u2028"
    return "".join(draw.choice(alphabet) for _ in range(draw.randrange(1, 200)))


@pytest.mark.parametrize("make", [soup, damaged, noise])
def test_any_text(make: Callable[[random.Random], str]) -> None:
    for seed in range(FIRST, FIRST + COUNT):
        check(make(random.Random(f"{make.__name__} {seed}")), seed)


LONG = 1_000_000
"""Characters of the longest attacks."""
ATTACKS = {
    "backslashes": "\\" * 1200,
    "many backslashes": "\\" * LONG,
    "backslash lines": "N10 X1 \\\n" * 100_000,
    "comments": "()" * (LONG // 2),
    "open comments": "(" * LONG,
    "closed comments": ")" * LONG,
    "comments in short lines": "()()()\n" * 30_000,
    "brackets": "X" + "[" * LONG,
    "brackets over lines": "X[\n" * 100_000,
    "nested brackets": "X=" + "[" * 3000 + "1" + "]" * 3000,
    "nested functions": "P1=" + "SIN[" * 800 + "1" + "]" * 800,
    "powers": "P1=" + "2**" * 1300 + "2",
    "signs": "P1=" + "-" * 3900 + "1",
    "negations": "P1=" + "!" * 3900 + "1",
    "sums": "P1=1" + "+1" * 1900,
    "digits": "X" + "9" * LONG,
    "digits in a block": "X" + "9" * 3900,
    "decimals": "X0." + "9" * 3900,
    "block number": "N" + "9" * 3900 + " X1 F1",
    "g number": "G" + "9" * 3900,
    "m number": "M" + "9" * 3900,
    "parameter number": "P" + "9" * 3900 + "=1",
    "indirect": "P" * 3900 + "1=1",
    "name": "A" * 300,
    "long name": "A" * LONG,
    "program name": "%" + "A" * 3900,
    "variable name": "V.P." + "A" * 3900 + "=1",
    "variable parts": "V.A." + "A." * 1900 + "X=1",
    "own indices": "V.P.A" + "[1]" * 1200 + "=1",
    "command": "#" + "A" * LONG,
    "statement": "$" + "A" * LONG,
    "quotes": '"' * LONG,
    "text": '#MSG ["' + "A" * LONG + '"]',
    "conversions": '#MSG ["' + "%f" * 1900 + '"]',
    "values": '#MSG ["' + "%d" * 900 + '"' + ",1" * 900 + "]",
    "ifs": "$IF 1\n" * 100_000,
    "skipped ifs": "$IF 0\n" * 100_000,
    "loops": "$FOR P1=1,2,1\n" * 100_000,
    "ifs with a loop": "$IF 1\n" * 60 + "$FOR P1=1,5000,1\n$FOR P2=1,1,1\n$ENDFOR\n$ENDFOR\n",
    "labels": "".join(f"N{number}:\n" for number in range(100_000)),
    "settings": "#MEAS [" + "AX=X EDGE=POS " * 250 + "]",
    "axes": "X1 " * 1300,
    "g words": "G90 " * 1000,
    "assignments": "P1=1 " * 800,
    "parameters": "$FOR P1=2,1000000,1\nP[P1]=1\n$ENDFOR",
    "open comment block": "#COMMENT BEGIN\n" + "X1\n" * 300_000,
    "blanks": " " * LONG,
    "blank lines": "\n" * 200_000,
    "nothing": "\x00" * LONG,
    "far": "G00 X99999999999999999999",
    "far by steps": "G91 G00 X200000\nX200000",
    "dwell": "G04 99999999999999999999",
    "systems": "#CS ON [0,0,0,0,0,1]\n" * 1000,
}


@pytest.mark.parametrize("name", ATTACKS)
def test_attack(name: str) -> None:
    check(ATTACKS[name] + "\nM30\n", name)
    check("N10 " + ATTACKS[name], name)


def test_what_cannot_be_decoded_is_told_with_its_place() -> None:
    for text, line, column in (
        ("M30 \\ X1", 1, 7),
        ("G00\nN20 X[1\nN30", 2, 6),
        ("G00\n#COMMENT BEGIN\nX1", 2, 1),
        ('N10 #MSG ["open', 1, 11),
    ):
        with pytest.raises(InputError) as caught:
            drain(text)
        assert (caught.value.line, caught.value.column) == (line, column)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("G04 1e300", 20015),
        ("G00 X1e300", 20011),
        ("G92 X1e308\nG91 G92 X1e308\nG90 G00 X0", 20011),
        ("#CS ON [1e308,1e308,1e308,45,45,45]\nG00 X1 Y1 Z1", 20011),
        ("G90 G100 X300000 F1", 20011),
    ],
)
def test_numbers_beyond_the_format_are_errors_of_the_cnc(text: str, number: int) -> None:
    blocks = Decoder(text.splitlines(), "fuzz.nc", AXES, DecoderDefaults()).blocks()
    (error,) = (item for item in blocks if isinstance(item, CncError))
    assert error.number == number
