"""Numbers of drive types, axis types, axis modes and the drive types of single parameters."""

import pytest

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import catalogue
from hli_bench.manual.drive_types import AxisMode, AxisType, DriveType
from hli_bench.manual.sheet import Sheet

SIMULATION, CONVENTIONAL, SERCOS = DriveType.SIMULATION, DriveType.CONVENTIONAL, DriveType.SERCOS
TERMINAL, LIGHTBUS, PROFIDRIVE = DriveType.TERMINAL, DriveType.LIGHTBUS, DriveType.PROFIDRIVE
CANOPEN = DriveType.CANOPEN


def sheet(number: int) -> Sheet:
    return catalogue(AxisParams).by_number[f"P-AXIS-{number:05d}"].sheet


@pytest.mark.req("H-141")
def test_drive_type_numbers() -> None:
    printed = {1: "CONVENTIONAL", 2: "SERCOS", 3: "PROFIDRIVE", 4: "SIMULATION", 5: "LIGHTBUS", 6: "TERMINAL"}
    printed |= {7: "RT_ETHERNET", 8: "CANOPEN", 16: "VIRTUAL", 32: "CAN"}
    assert {kind.value: kind.name for kind in DriveType} == printed


def test_axis_type_numbers() -> None:
    assert (AxisType.TRANSLATOR, AxisType.ROTATOR, AxisType.SPINDEL) == (1, 2, 4)


@pytest.mark.req("H-185", "H-188", "H-189", "H-190", "H-192")
def test_axis_mode_bits() -> None:
    printed = {
        0x1: "LINEAR",
        0x4: "MODULO",
        0x40: "PLANDREHEN",
        0x80: "LAENGSDREHEN",
        0x100: "KEINE_AUTO_RPF",
        0x200: "CAX",
        0x400: "MODULO_LINEAR",
        0x800: "CLAMPABLE",
        0x1000: "ROT_TABLE",
        0x8000: "COLL_CHECK",
        0x10000: "GANTRY_MASTER",
        0x20000: "GANTRY_SLAVE",
        0x40000: "SPINDLE_EXT_CTRL",
        0x80000: "EXT_CTRL_INPUT",
        0x100000: "COUNTER",
        0x200000: "LEAD_AXIS",
        0x400000: "ALLOW_RESOLUTION_CHANGE",
        0x800000: "DYNAMIC_WEIGHTING",
        0x2000000: "PATH_LENGTH_TCP",
        0x4000000: "PATH_LENGTH_CONTOUR",
        0x8000000: "VIRT_LEAD_AXIS",
        0x10000000: "LAH_OFFSET_AXIS",
    }
    assert {mode.value: mode.name for mode in AxisMode} == printed


@pytest.mark.parametrize(
    ("numbers", "drive_types"),
    [
        pytest.param(
            (36, 38, 156, 157, 219),
            {CONVENTIONAL, TERMINAL, LIGHTBUS, PROFIDRIVE},
            marks=pytest.mark.req("H-239"),
        ),
        pytest.param(
            (158, 218),
            {SIMULATION, CONVENTIONAL, TERMINAL, LIGHTBUS, PROFIDRIVE},
            marks=pytest.mark.req("H-240"),
        ),
        pytest.param(
            (152,),
            {SIMULATION, CONVENTIONAL, TERMINAL, LIGHTBUS, PROFIDRIVE, CANOPEN},
            marks=pytest.mark.req("H-241"),
        ),
        pytest.param((161,), {SIMULATION}, marks=pytest.mark.req("H-242")),
        pytest.param((294,), {LIGHTBUS}, marks=pytest.mark.req("H-242")),
        pytest.param((321, 354, 355), {SERCOS, LIGHTBUS, CANOPEN}, marks=pytest.mark.req("H-243")),
        pytest.param((386, 387, 388, 425, 426), {SERCOS}, marks=pytest.mark.req("H-244")),
        pytest.param(
            (494,),
            {CONVENTIONAL, SERCOS, TERMINAL, LIGHTBUS, PROFIDRIVE, CANOPEN},
            marks=pytest.mark.req("H-245"),
        ),
        pytest.param(
            (331, 332),
            {CONVENTIONAL, SERCOS, TERMINAL, LIGHTBUS, PROFIDRIVE, CANOPEN},
            marks=pytest.mark.req("M-234"),
        ),
        pytest.param(
            (774,), {SERCOS, TERMINAL, LIGHTBUS, PROFIDRIVE, CANOPEN}, marks=pytest.mark.req("M-249")
        ),
        pytest.param((*range(712, 732), 746, 762, 763), {SERCOS, CANOPEN}, marks=pytest.mark.req("F-115")),
        ((14,), {SIMULATION, SERCOS, CANOPEN}),
    ],
)
def test_drive_types_of_parameters(numbers: tuple[int, ...], drive_types: set[DriveType]) -> None:
    for number in numbers:
        assert set(sheet(number).drive_types) == drive_types, number


@pytest.mark.req("H-246")
def test_axis_types_of_homing_parameters() -> None:
    assert {sheet(number).axis_types for number in (64, 74, 84)} == {"TR"}
    assert sheet(412).axis_types == "RS"
    rest = (
        14,
        15,
        36,
        38,
        152,
        156,
        157,
        158,
        161,
        218,
        219,
        294,
        299,
        321,
        354,
        355,
        386,
        387,
        388,
        425,
        426,
        494,
    )
    assert {sheet(number).axis_types for number in rest} == {"TRS"}


@pytest.mark.req("F-115")
def test_axis_types_of_fixed_stop_parameters() -> None:
    assert {sheet(number).axis_types for number in (*range(712, 732), 746, 762, 763)} == {"TR"}
