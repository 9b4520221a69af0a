import re
from typing import Any

import pytest

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.access import Access, MemberWrite
from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.hli import Commands, Write

UNIT = "ax/1/lr_mc_control/probing_signal"
TIME = "ax/1/lr_mc_control/timestamp"


@pytest.fixture
def image() -> Image:
    return Image(Layout([(1, "X", "linear")]))


@pytest.fixture
def access(image: Any) -> Access:
    return Access(image)


def read(image: Any, path: Any) -> Any:
    return image.get(image.layout.element(path).id)


def test_commands_are_written_in_order(image: Any, access: Any) -> None:
    writes = (Write(f"{TIME}/command_w", 1), Write(f"{UNIT}/command_w", True), Write(f"{TIME}/command_w", 2))
    assert access.apply(Commands("plc", 1, writes)) == []
    assert (read(image, f"{TIME}/command_w"), read(image, f"{UNIT}/command_w")) == (2, True)


@pytest.mark.req("M-237")
@pytest.mark.parametrize("member", ["request_r", "state_r"])
def test_what_the_cnc_writes_is_refused(image: Any, access: Any, member: Any) -> None:
    (refusal,) = access.apply(Commands("plc", 1, (Write(f"{UNIT}/{member}", True),)))
    assert (refusal.path, refusal.writer) == (f"{UNIT}/{member}", "plc")
    assert "written by the CNC" in refusal.reason
    assert read(image, f"{UNIT}/{member}") is False


def test_one_refused_write_does_not_stop_the_others_and_all_are_counted(image: Any, access: Any) -> None:
    writes = (Write("ax/9/nothing", 1), Write(f"{UNIT}/command_w", True), Write(f"{UNIT}/state_r", True))
    assert [refusal.path for refusal in access.apply(Commands("plc", 1, writes))] == [
        "ax/9/nothing",
        f"{UNIT}/state_r",
    ]
    assert read(image, f"{UNIT}/command_w") is True


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        (f"{UNIT}/command_w", 2, "no BOOL"),
        (
            f"{TIME}/command_w",
            2**63,
            "a whole number in [-9223372036854775808, 9223372036854775807] expected",
        ),
        (f"{TIME}/command_w", True, "no SGN64"),
        ("ax/1/lr_mc_control/probing_position/command_w", -(2**31) - 1, "no SGN32"),
        (UNIT, 1, "whole unit"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(access: Any, path: Any, value: Any, reason: Any) -> None:
    (refusal,) = access.apply(Commands("plc", 1, (Write(path, value),)))
    assert reason in refusal.reason


@pytest.mark.req("M-238")
@pytest.mark.parametrize("value", [-(2**63), 2**63 - 1])
def test_the_timestamp_takes_the_whole_range(image: Any, access: Any, value: Any) -> None:
    assert access.apply(Commands("plc", 1, (Write(f"{TIME}/command_w", value),))) == []
    assert read(image, f"{TIME}/command_w") == value


def test_a_unit_belongs_to_the_first_plc_that_wrote_it_until_it_leaves(image: Any, access: Any) -> None:
    access.apply(Commands("first", 1, (Write(f"{UNIT}/enable_w", True),)))
    (refusal,) = access.apply(Commands("second", 1, (Write(f"{UNIT}/command_w", True),)))
    assert refusal.reason == "the unit belongs to PLC 'first'"
    assert access.apply(Commands("second", 1, (Write(f"{TIME}/command_w", 5),))) == []
    assert access.leave("first") == [UNIT]
    assert read(image, f"{UNIT}/enable_w") is False
    assert access.apply(Commands("second", 2, (Write(f"{UNIT}/command_w", True),))) == []
    assert access.owner(UNIT) == "second"


def test_a_client_without_a_name_owns_nothing_and_keeps_off_owned_units(image: Any, access: Any) -> None:
    commands = Commands("", 1, (access.write_of(MemberWrite(f"{UNIT}/command_w", b"\x01")),))
    assert access.apply(commands) == []
    assert access.owner(UNIT) == ""
    access.apply(Commands("plc", 1, (Write(f"{UNIT}/enable_w", True),)))
    assert [refusal.reason for refusal in access.apply(commands)] == ["the unit belongs to PLC 'plc'"]


def test_a_refused_write_gives_no_ownership(access: Any) -> None:
    access.apply(Commands("plc", 1, (Write(f"{UNIT}/state_r", True), Write(f"{UNIT}/command_w", 3))))
    assert access.owner(UNIT) == ""


@pytest.mark.parametrize(
    ("path", "payload", "is_text", "value"),
    [
        (f"{UNIT}/command_w", b"\x01", False, True),
        (f"{UNIT}/X_Command", b"TRUE", True, True),
        (f"{UNIT}/command_w", b"true", True, True),
        (f"{UNIT}/command_w", b"1", True, True),
        (f"{TIME}/command_w", b"-123", True, -123),
        (f"{TIME}/command_w", b"16#7F", True, 127),
        (f"{TIME}/command_w", (-2).to_bytes(8, "little", signed=True), False, -2),
    ],
)
def test_a_member_comes_packed_or_as_text(
    image: Any, access: Any, path: Any, payload: Any, is_text: Any, value: Any
) -> None:
    assert access.apply(Commands("", 1, (access.write_of(MemberWrite(path, payload, is_text)),))) == []
    assert read(image, path) == value


@pytest.mark.parametrize(
    ("path", "payload", "is_text", "reason"),
    [
        (f"{UNIT}/command_w", b"\x01\x00", False, "2 bytes, BOOL takes 1"),
        (f"{UNIT}/command_w", b"\x02", False, "2 is no BOOL: 0 or 1 expected"),
        (f"{TIME}/command_w", b"\x01", False, "1 bytes, SGN64 takes 8"),
        (f"{TIME}/command_w", b"soon", True, "'soon' is no SGN64"),
        (f"{TIME}/command_w", b"1.5", True, "'1.5' is no SGN64"),
        (f"{TIME}/command_w", b"\xff", True, "no SGN64"),
    ],
)
def test_a_member_of_wrong_size_or_text_is_bad_input(
    image: Any, access: Any, path: Any, payload: Any, is_text: Any, reason: Any
) -> None:
    with pytest.raises(InputError, match=re.escape(reason)):
        access.write_of(MemberWrite(path, payload, is_text))
    assert read(image, path) == 0
