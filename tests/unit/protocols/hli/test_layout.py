import json
import struct
from typing import Any

import pytest

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.images import size_of

AXES = [(1, "X", "linear"), (2, "Y", "linear"), (5, "A", "rotary"), (7, "S", "spindle")]


@pytest.fixture(scope="module")
def layout() -> Layout:
    return Layout(AXES)


def test_every_element_lies_aligned_and_none_overlaps(layout: Any) -> None:
    end = 0
    for number, element in enumerate(layout.elements):
        assert element.id == number
        assert element.size == size_of(element.type) == struct.calcsize("<" + element.code)
        assert element.offset % element.size == 0
        assert element.offset >= end
        end = element.offset + element.size
    assert layout.size >= end
    assert layout.size % 8 == 0


def test_paths_are_unique_and_the_order_depends_on_the_axes_only(layout: Any) -> None:
    assert len({element.path for element in layout.elements}) == len(layout.elements)
    assert layout.to_json() == Layout(list(AXES)).to_json()


@pytest.mark.req("M-235", "M-237")
def test_the_probing_signal_is_a_bool_unit_of_which_the_plc_writes_two_members(layout: Any) -> None:
    members = layout.group("gpAx[2]^.lr_mc_control.probing_signal").elements
    assert [(e.member, e.type, e.access) for e in members] == [
        ("request_r", "BOOL", "r"),
        ("enable_w", "BOOL", "w"),
        ("command_w", "BOOL", "w"),
        ("state_r", "BOOL", "r"),
    ]


@pytest.mark.req("M-238")
def test_the_timestamp_is_a_64_bit_unit_in_ns(layout: Any) -> None:
    command = layout.element("gpAx[2]^.lr_mc_control.timestamp.command_w")
    assert (command.type, command.unit, command.access) == ("SGN64", "ns", "w")
    assert layout.element("gpAx[2]^.lr_mc_control.timestamp.enable_w").type == "BOOL"


def test_positions_of_rotary_axes_count_in_degrees(layout: Any) -> None:
    assert layout.element("ax/1/lr_mc_control/probing_position/command_w").unit == "0.1 µm"
    assert layout.element("ax/5/lr_mc_control/probing_position/command_w").unit == "0.0001°"


@pytest.mark.req("H-195")
@pytest.mark.parametrize(
    ("name", "path"),
    [
        ("ax/2/lr_mc_control/probing_signal/command_w", "ax/2/lr_mc_control/probing_signal/command_w"),
        ("gpAx[2]^.lr_mc_control.probing_signal", "ax/2/lr_mc_control/probing_signal"),
        ("gpax[2]^.LR_MC_Control.Probing_Signal.Command_W", "ax/2/lr_mc_control/probing_signal/command_w"),
        ("ax/2/MCControlBoolUnit_ProbingSignal", "ax/2/lr_mc_control/probing_signal"),
        ("ax/2/MCControlBoolUnit_ProbingSignal/X_Command", "ax/2/lr_mc_control/probing_signal/command_w"),
        (
            "ax/2/MCControlSGN32Unit_ProbingPosition/D_Command",
            "ax/2/lr_mc_control/probing_position/command_w",
        ),
        (
            "pAC[2]^.addr^.McControlLr_Data.MCControlBoolUnit_ReferenceCam.X_Command",
            "ax/2/lr_mc_control/reference_cam/command_w",
        ),
        ("ax/2/lr_mc_control/timestamp/X_Enable", "ax/2/lr_mc_control/timestamp/enable_w"),
        ("gpCh[1]^.head.plc_present_w", "ch/1/head/plc_present_w"),
    ],
)
def test_a_name_may_be_a_path_its_st_form_or_an_old_name(layout: Any, name: Any, path: Any) -> None:
    assert layout.resolve(name) == path


def test_an_unknown_name_is_told_with_near_ones(layout: Any) -> None:
    with pytest.raises(InputError, match=r"near names: .*ax/2/lr_mc_control/probing_signal/command_w"):
        layout.element("ax/2/lr_mc_control/probing_sginal/command_w")


def test_an_axis_that_the_machine_does_not_have_is_unknown(layout: Any) -> None:
    with pytest.raises(InputError, match="gpAx\\[3\\]"):
        layout.resolve("gpAx[3]^.lr_mc_control.probing_signal")


def test_a_unit_is_no_element_and_an_element_no_unit(layout: Any) -> None:
    with pytest.raises(InputError, match="request_r, enable_w, command_w, state_r"):
        layout.element("ax/2/lr_mc_control/timestamp")
    with pytest.raises(InputError, match="one element"):
        layout.group("ax/2/lr_mc_control/timestamp/command_w")


def test_json_carries_the_whole_layout_there_and_back(layout: Any) -> None:
    again = Layout.from_json(layout.to_json())
    assert again.elements == layout.elements
    assert again.size == layout.size
    assert again.resolve("ax/1/MCControlBoolUnit_ProbingSignal/X_Command").endswith(
        "probing_signal/command_w"
    )
    assert {"path", "type", "unit", "offset", "size", "access"} <= set(json.loads(layout.to_json())[0])


@pytest.mark.parametrize("text", ["{}", "[{}]", "no json", '[{"path": 1}]'])
def test_json_of_something_else_is_refused(text: Any) -> None:
    if text == "{}":
        assert Layout.from_json(text).elements == ()
        return
    with pytest.raises(InputError, match="not a layout"):
        Layout.from_json(text)


def test_a_unit_packs_without_gaps(layout: Any) -> None:
    image = bytearray(layout.size)
    unit = layout.group("ax/1/lr_mc_control/timestamp")
    for element, value in zip(unit.elements, (5, True, -(2**63), 2**63 - 1), strict=True):
        struct.pack_into("<" + element.code, image, element.offset, value)
    assert unit.pack(image) == struct.pack("<q?qq", 5, True, -(2**63), 2**63 - 1)
    assert unit.values(unit.pack(image))["command_w"] == -(2**63)
    assert len(unit.pack(bytes(layout.size))) == 25
