"""Programs of any kind on a bench: a result, `InputError` or `NotEmulated`, and the bench goes on.

A program that fails is printed with its seed; how many are tried, and from which seed on, says `inputs.py`.
"""

import random
from typing import Final

from hli_bench import Bench
from hli_bench.base.errors import InputError, NotEmulated
from tests.fuzz.inputs import COUNT, FIRST
from tests.fuzz.test_nc_text import damaged, soup

PER_BENCH: Final = 15
"""Programs that one bench runs, each after whatever the one before has left behind."""
LIMIT_S: Final = 1.0
"""Machine time of a program at most."""
SOURCES: Final = ("PLC", "PLC_TIMESTAMP", "DRIVE", "FIXED_STOP")
FIXED: Final = {
    "plant.probe.Z.face_mm": 100,
    "plant.probe.Z.material": "below",
    "plant.stop.Y.at_mm": 60,
    "plant.stop.Y.side": "above",
}
REFERENCE: Final = 'N10 G90 G00 X1 Y1\nN20 #MSG ["%f", V.A.ABS.X]\nN30 M30\n'
BLOCKS: Final = (
    *("G00 X{0}", "G01 Y{0} F6000", "G100 Z{0} F3000", "G100 X{0} Y{1} F2000", "G100 A{0} F100", "G00 B{1}"),
    *(
        "G74 X1 Y2",
        "G74 Z1",
        "G74 S1",
        "G04 0.05",
        "G91",
        "G90",
        "F{0}",
        "F99999999",
        "G92 X{0}",
        "G101 Z1",
        "G102",
    ),
    *(
        "#MEAS MODE[{2}]",
        "#MEAS [TYPE={2} ERR_NO_SIGNAL=0]",
        "#MEAS [AX=Z SIGNAL=DRIVE INPUT={3}]",
        "#MEAS DEFAULT",
    ),
    *(
        "#MEAS [AX=X AX=Y SIGNAL=FIXED_STOP]",
        "#MEAS [AX=Z SIGNAL=PLC EDGE=NEG]",
        "#CS ON[{0},0,{1},0,{1},0]",
        "#CS OFF",
    ),
    *(
        "#CS OFF",
        "#CS OFF ALL",
        "#CHANNEL INIT [ACTPOS AX=X]",
        "#DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL={0} WAIT]",
    ),
    *(
        "#DRIVE WR [AX=Z KEY=FOO VAL=1]",
        "P1=V.A.MESS.Z",
        '#MSG SYN ["%f", V.A.MOFFS.Z]',
        "G01 X200000 F1e9",
        "G00 Z-500",
    ),
)


def regular(draw: random.Random) -> str:
    """Blocks that are right by themselves, in any order."""

    def block(number: int) -> str:
        values = (
            round(draw.uniform(-400, 400), 3),
            round(draw.uniform(-90, 90), 1),
            draw.randrange(9),
            draw.randrange(4),
        )
        return f"N{number * 10} {draw.choice(BLOCKS).format(*values)}"

    return "\n".join(block(number) for number in range(1, draw.randrange(3, 14))) + "\nM30\n"


def run(bench: Bench, text: str, seed: object) -> None:
    try:
        result = bench.run(text, limit_s=LIMIT_S)
    except (InputError, NotEmulated):
        return
    except Exception as error:
        raise AssertionError(f"{type(error).__name__}: {error}, seed {seed}: {text!r}") from error
    assert result.status in ("completed", "error", "aborted")


def test_any_program() -> None:
    for first in range(FIRST, FIRST + COUNT, PER_BENCH):
        draw = random.Random(f"bench {first}")
        settings = FIXED | {f"axis.{axis}.kenngr.measure.signal": draw.choice(SOURCES) for axis in "XYZ"}
        with Bench("demo", settings) as bench:
            for seed in range(first, min(first + PER_BENCH, FIRST + COUNT)):
                draw = random.Random(f"program {seed}")
                run(bench, draw.choice((soup, damaged, regular, regular, regular))(draw), seed)
                bench.reset()
            assert bench.run(REFERENCE).messages[0].text == "1.000000"
