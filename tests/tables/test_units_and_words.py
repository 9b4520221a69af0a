"""Dimensions and permitted words of the parameters of the manuals, typed a second time from them."""

import pytest

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import catalogue
from hli_bench.manual.sheet import Units

LENGTH = ("0.1 µm", "0.0001°")
SPEED = ("µm/s", "0.001°/s")
ACCELERATION = ("mm/s²", "°/s²")
TIME = ("µs", "µs")
SHARE = ("0.1 %", "0.1 %")
CYCLES = ("cycles", "cycles")

# dimension of linear and rotary axes, parameters, requirement lines
UNITS = [
    (LENGTH, (86,), pytest.mark.req("M-213")),
    (LENGTH, (467,), pytest.mark.req("M-217")),
    (SPEED, (215,), pytest.mark.req("M-220")),
    (LENGTH, (774,), pytest.mark.req("M-222")),
    (TIME, (775, 770), pytest.mark.req("M-224")),
    (LENGTH, (776, 771), pytest.mark.req("M-225")),
    (SHARE, (777, 772), pytest.mark.req("M-227")),
    (LENGTH, (778, 773), pytest.mark.req("M-230")),
    (LENGTH, (331,), pytest.mark.req("M-232")),
    (CYCLES, (332,), pytest.mark.req("M-233", "M-251")),
    (LENGTH, (152,), pytest.mark.req("H-165", "H-199")),
    (LENGTH, (161,), pytest.mark.req("H-203")),
    (SPEED, (218,), pytest.mark.req("H-204")),
    (SPEED, (219,), pytest.mark.req("H-205")),
    (LENGTH, (412,), pytest.mark.req("H-227")),
    (LENGTH, (494,), pytest.mark.req("H-233")),
    (ACCELERATION, (285,), ()),
    (SPEED, (333,), pytest.mark.req("H-125")),
    (ACCELERATION, (334,), pytest.mark.req("H-125")),
    (SHARE, (342, 343), pytest.mark.req("H-126")),
    (LENGTH, (344, 345), pytest.mark.req("H-088", "H-089")),
    (SHARE, (347, 817), pytest.mark.req("H-122")),
    (LENGTH, (348, 349), pytest.mark.req("H-123")),
    (TIME, (350,), pytest.mark.req("H-124")),
    (LENGTH, (712,), pytest.mark.req("F-076")),
    (LENGTH, (713,), pytest.mark.req("F-077")),
    (CYCLES, (714,), pytest.mark.req("F-118")),
    (("", ""), (118, 517, 518, 60, 14, 38, 64, 84, 157, 158), ()),
]

# parameter, permitted words besides the empty one, requirement lines
WORDS = [
    (
        516,
        (
            "DRIVE_TYPE_DEFAULT PLC FIXED_STOP DRIVE PLC_EXT_LATCH_CONTROL PLC_FIRST_EVENT PLC_TIMESTAMP "
            "EXT_PROBE_WITH_DRIVE"
        ),
        pytest.mark.req("M-199", "M-200", "M-201", "M-202", "M-203", "M-204", "M-205"),
    ),
    (518, "POS NEG", pytest.mark.req("M-212")),
    (
        299,
        "CNC_CONTROLLED DRIVE_CONTROLLED DISABLED IGNORE_ABS_POS TORQ NONE",
        pytest.mark.req("H-208", "H-234"),
    ),
    (321, "PLC RT_STATUS_BIT_1 RT_STATUS_BIT_2 STATUS_DIG_INPUTS", pytest.mark.req("H-215", "H-216")),
    (346, "POSITIVE NEGATIVE", pytest.mark.req("H-121")),
    (720, "CYCLIC ACYCLIC IGNORE", pytest.mark.req("F-087")),
    (722, "SGN16 SGN32 UNS16 UNS32 BITARRAY_16 BITARRAY_32", pytest.mark.req("F-092")),
    (724, "UNSCALED LINEAR TORQUE_DRIVE_SIDE", pytest.mark.req("F-094")),
    (763, "ERROR WARNING NONE", pytest.mark.req("F-114")),
]


def sheet(number: int) -> object:
    return catalogue(AxisParams).by_number[f"P-AXIS-{number:05d}"].sheet


@pytest.mark.parametrize(
    ("dimension", "numbers"), [pytest.param(*row[:2], id=str(row[1]), marks=row[2]) for row in UNITS]
)
def test_dimension(dimension: tuple[str, str], numbers: tuple[int, ...]) -> None:
    units: list[Units] = [sheet(number).units for number in numbers]
    assert [(unit.t, unit.r) for unit in units] == [dimension] * len(numbers)


@pytest.mark.parametrize(
    ("number", "words"), [pytest.param(*row[:2], id=str(row[0]), marks=row[2]) for row in WORDS]
)
def test_permitted_words(number: int, words: str) -> None:
    permitted = {str(word) for word in sheet(number).choices} - {""}
    assert permitted == set(words.split())
