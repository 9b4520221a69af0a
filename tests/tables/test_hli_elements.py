"""HLI elements and NC variables as the manuals print them."""

import pytest

from hli_bench.base.errors import InputError
from hli_bench.manual.control_units import (
    AXIS_ELEMENTS,
    CHANNEL_ELEMENTS,
    HliType,
    Kind,
    Writer,
    numbered,
)
from hli_bench.manual.nc_variables import NC_VARIABLES, Access
from hli_bench.manual.sheet import DataType
from hli_bench.protocols.hli.layout import layout_of

LAYOUT = layout_of(((1, "X", "linear"), (2, "Y", "linear"), (3, "Z", "linear")))
LATCH = "ax/1/lr_mc_control/ext_latch_control"
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
        ("ax/1/ext_latch/X_Please", f"{LATCH}/please_rw"),
        ("ax/1/ext_latch/done_w", f"{LATCH}/done_w"),
        ("gpAx[1]^.ext_latch_control.ext_latch_order_r.order_id", f"{LATCH}/ext_latch_order_r/order_id"),
        ("ax/1/ext_latch/order_type_r", f"{LATCH}/ext_latch_order_r/order_id"),
        ("ax/2/lr_state/active_position_r", "ax/2/lr_state/current_position_acs_r"),
        ("ax/2/lr_state/command_position_r", "ax/2/lr_state/active_position_acs_r"),
        ("ax/2/lr_state/position_lag_r", "ax/2/lr_state/following_error_r"),
        ("ax/2/StateLR_Data/W_AxisState", "ax/2/lr_state/axis_state_r"),
        ("gpCh[1]^.channel_state.mode_r", "ch/1/channel_mc_control/mode_and_state/state_r/mode"),
        ("ch/1/channel_state/block_number_r", "ch/1/bahn_state/block_nr_r"),
        ("ch/1/mc_error/remedy_r", "ch/1/mc_error/satz_r/kopf/behebungs_klasse"),
        ("ch/1/bahn_mc_control/override/X_Enable", "ch/1/bahn_mc_control/override_feedrate/enable_w"),
        ("ch/1/bahn_mc_control/override_valid", None),
        ("ax/1/lr_mc_control/nothing", None),
        ("ax/q/lr_mc_control/timestamp", None),
        ("gp/1/lr_mc_control/timestamp", None),
        ("ax/1", None),
    ],
)
def test_old_names(old: str, new: str | None) -> None:
    if new is None:
        with pytest.raises(InputError):
            LAYOUT.resolve(old)
    else:
        assert LAYOUT.resolve(old) == new


def test_paths_are_unique_and_say_who_writes() -> None:
    paths = [element.path for element in (*AXIS_ELEMENTS, *CHANNEL_ELEMENTS)]
    assert len(paths) == len(set(paths))
    for element in (*AXIS_ELEMENTS, *CHANNEL_ELEMENTS):
        if element.kind is Kind.VALUE:
            named = [part for part in element.path.split("/") if part.endswith(("_r", "_w", "_rw"))]
            assert named[-1].endswith(f"_{element.writer}")
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


BOOK = """
ax head/plc_present_w BOOL w
ax head/log_ax_n_r UNS16 r
ax head/axis_type_r UNS16 r
ax head/error_r BOOL r
ax lr_state/active_position_acs_r SGN32 r
ax lr_state/current_position_acs_r SGN32 r
ax lr_state/following_error_r SGN32 r
ax lr_state/axis_state_r UNS16 r
ax lr_state/homing_done_r BOOL r
ax lr_state/drive_type_r UNS16 r
ax lr_state/ready_for_power_on_r BOOL r
ax lr_state/ready_for_control_loop_on_r BOOL r
ax lr_state/measure_value_ok_r BOOL r
ax lr_state/probe_actuated_r BOOL r
ax lr_state/measurement_active_r BOOL r
ax lr_state/measure_equipment_active_r BOOL r
ax lr_mc_control/release_feedhold BOOL unit
ax lr_mc_control/reference_cam BOOL unit
ax lr_mc_control/probing_signal BOOL unit
ax lr_mc_control/probing_position SGN32 unit
ax lr_mc_control/timestamp SGN64 unit
ax ipo_mc_control/feedhold BOOL unit
ax ipo_mc_control/override UNS16 unit
ax ipo_mc_control/override_valid BOOL unit
ax lr_mc_control/ext_latch_control/please_rw BOOL rw
ax lr_mc_control/ext_latch_control/done_w BOOL w
ax lr_mc_control/ext_latch_control/ext_latch_order_r/order_id UNS32 r
ax lr_mc_control/ext_latch_control/ext_latch_order_r/input SGN32 r
ax lr_mc_control/ext_latch_control/ext_latch_order_r/edge UNS32 r
ch head/plc_present_w BOOL w
ch bahn_state/block_nr_r UNS32 r
ch bahn_mc_control/feedhold BOOL unit
ch bahn_mc_control/override_feedrate UNS16 unit
ch bahn_mc_control/delete_distance_to_go BOOL unit
ch channel_mc_control/mode_and_state/state_r/mode UNS32 r
ch channel_mc_control/mode_and_state/state_r/state UNS32 r
ch mc_error/enable_w BOOL w
ch mc_error/semaphor_rw BOOL rw
ch mc_error/satz_r/kopf/error_id UNS32 r
ch mc_error/satz_r/kopf/behebungs_klasse UNS16 r
ch mc_error/satz_r/kopf/reaktions_klasse UNS16 r
ch mc_error/satz_r/kopf/cnc_channel UNS16 r
"""
"""What the HLI book says of the elements that stand in a layout: UINT is UNS16, UDINT UNS32, DINT SGN32, LINT SGN64."""
NAMED_HERE = {"ch mc_error/axis_r", "ch mc_error/block_r"}


def test_names_types_and_access_are_those_of_the_book() -> None:
    book = {
        f"{area} {path}": (kind, access)
        for area, path, kind, access in map(str.split, BOOK.split("\n")[1:-1])
    }
    built = {}
    for element in LAYOUT.elements:
        area, number, path = element.path.split("/", 2)
        if number == "1" and f"{area} {path}" not in NAMED_HERE:
            built[f"{area} {path}"] = element
    for name, (kind, access) in book.items():
        if access != "unit":
            element = built.pop(name)
            assert (element.type, element.access) == (kind, access), name
            continue
        for member, own in (
            ("request_r", kind),
            ("enable_w", "BOOL"),
            ("command_w", kind),
            ("state_r", kind),
        ):
            element = built.pop(f"{name}/{member}")
            assert (element.type, element.access) == (own, member.rpartition("_")[2]), name
    assert not built
