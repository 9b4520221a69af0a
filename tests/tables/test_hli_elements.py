"""HLI elements and NC variables as the manuals print them."""

import pytest

from hli_bench.manual.control_units import (
    AXIS_ELEMENTS,
    CHANNEL_ELEMENTS,
    HliType,
    Kind,
    Writer,
    canonical,
    numbered,
)
from hli_bench.manual.nc_variables import NC_VARIABLES, Access
from hli_bench.manual.sheet import DataType

BY_PATH = dict(numbered(AXIS_ELEMENTS, 2)) | dict(numbered(CHANNEL_ELEMENTS, 1))


@pytest.mark.req("M-235", "M-237")
def test_probing_signal_unit() -> None:
    unit = BY_PATH["ax/2/lr_mc_control/probing_signal"]
    assert (unit.kind, unit.data_type) == (Kind.UNIT, HliType.BOOL)
    members = [(member.name, member.data_type, member.writer) for member in unit.members()]
    assert members == [
        ("request_r", HliType.BOOL, Writer.CNC),
        ("enable_w", HliType.BOOL, Writer.PLC),
        ("command_w", HliType.BOOL, Writer.PLC),
        ("state_r", HliType.BOOL, Writer.CNC),
    ]


@pytest.mark.req("M-238")
def test_timestamp_unit() -> None:
    unit = BY_PATH["ax/2/lr_mc_control/timestamp"]
    assert (unit.kind, unit.data_type, unit.unit) == (Kind.UNIT, HliType.SGN64, "ns")
    assert {member.data_type for member in unit.members() if member.name != "enable_w"} == {HliType.SGN64}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("ax/2/lr_mc_control/MCControlBoolUnit_ProbingSignal", "ax/2/lr_mc_control/probing_signal"),
        (
            "ax/2/lr_mc_control/MCControlBoolUnit_ReferenceCam/X_Command",
            "ax/2/lr_mc_control/reference_cam/command_w",
        ),
        (
            "ax/3/lr_mc_control/MCControlSGN32Unit_ProbingPosition/D_Command",
            "ax/3/lr_mc_control/probing_position/command_w",
        ),
        pytest.param(
            "ax/1/McControlLr_Data/MCControlBoolUnit_ReferenceCam/X_Command",
            "ax/1/lr_mc_control/reference_cam/command_w",
            marks=pytest.mark.req("H-195"),
        ),
        ("ax/1/lr_mc_control/timestamp/X_Enable", "ax/1/lr_mc_control/timestamp/enable_w"),
        ("ax/1/ext_latch/X_Please", "ax/1/ext_latch/please_rw"),
        ("ax/1/ext_latch/done_w", "ax/1/ext_latch/done_w"),
        ("ax/1/ext_latch/done_w/command_w", None),
        ("ax/1/lr_mc_control/nothing", None),
        ("ax/z/lr_mc_control/timestamp", None),
        ("gp/1/lr_mc_control/timestamp", None),
        ("ax/1", None),
    ],
)
def test_old_names(old: str, new: str | None) -> None:
    assert canonical(old) == new


def test_paths_are_unique_and_say_who_writes() -> None:
    paths = [element.path for element in (*AXIS_ELEMENTS, *CHANNEL_ELEMENTS)]
    assert len(paths) == len(set(paths))
    for element in (*AXIS_ELEMENTS, *CHANNEL_ELEMENTS):
        if element.kind is Kind.VALUE:
            assert element.path.endswith(f"_{element.writer}")
        else:
            assert all(member.name.endswith(f"_{member.writer}") for member in element.members())


def test_measuring_variables() -> None:
    rows = {row.pattern: row for row in NC_VARIABLES}
    assert len(rows) == len(NC_VARIABLES)
    for name in ("MESS", "MERF", "MOFFS", "MEAS.ACS.VALUE", "MEAS.PCS.VALUE"):
        row = rows[f"V.A.{name}.<axis>"]
        assert row.flush
        assert row.access is Access.READ
    assert rows["V.A.MERF.<axis>"].data_type is DataType.BOOLEAN
    assert rows["V.RTA.FIXED_STOP.ACS.POS.<axis>"].data_type is DataType.SGN64
    assert rows["V.E.<name>"].access is Access.READ_WRITE
