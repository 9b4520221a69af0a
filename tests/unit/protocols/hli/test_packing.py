import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.access import unfit
from hli_bench.protocols.hli.layout import Layout
from hli_bench.protocols.hli.packing import CommandsPacking, as_text, pack_image, unpack_image
from hli_bench.wire.hli import Commands, Write

LAYOUT = Layout([(1, "X", "linear")])
PACKING = CommandsPacking(LAYOUT)
PROBE = LAYOUT.element("ax/1/lr_mc_control/probing_signal/command_w")
TIME = LAYOUT.element("ax/1/lr_mc_control/timestamp/command_w")


def test_commands_are_a_cycle_and_entries_of_id_and_value() -> None:
    commands = Commands("plc", 7, (Write(TIME.path, -3), Write(PROBE.path, True)))
    message = PACKING.pack(commands)
    assert message == struct.pack("<QHqH?", 7, TIME.id, -3, PROBE.id, True)
    assert PACKING.unpack("plc", message) == commands
    assert PACKING.cycle(message) == 7


@given(st.integers(0, 2**64 - 1), st.lists(st.tuples(st.sampled_from([PROBE, TIME]), st.booleans())))
def test_commands_come_back_as_they_went(cycle: Any, entries: Any) -> None:
    commands = Commands("p", cycle, tuple(Write(element.path, value) for element, value in entries))
    assert PACKING.unpack("p", PACKING.pack(commands)) == commands


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        (b"\x01\x00", "8 bytes"),
        (struct.pack("<QH", 1, 60000), "no element with id 60000"),
        (struct.pack("<QHi", 1, TIME.id, 5), "cut off"),
        (struct.pack("<QB", 1, PROBE.id), "cut off"),
    ],
)
def test_a_malformed_message_is_told_with_its_place(message: Any, reason: Any) -> None:
    with pytest.raises(InputError, match=reason):
        PACKING.unpack("p", message)


def test_a_byte_that_is_no_bool_stays_what_it_is() -> None:
    for byte, value in ((0, False), (1, True), (7, 7)):
        (write,) = PACKING.unpack("p", struct.pack("<QHB", 1, PROBE.id, byte)).writes
        assert write.value is value or write.value == value == 7
        assert bool(unfit(PROBE, write.value)) == (byte > 1)


def test_a_command_that_does_not_fit_is_not_packed() -> None:
    with pytest.raises(InputError, match="SGN64"):
        PACKING.pack(Commands("p", 1, (Write(TIME.path, 2**63),)))


def test_the_image_message_carries_cycle_and_dc_time_in_front() -> None:
    message = pack_image(5, -1, b"abc")
    assert message == struct.pack("<Qq", 5, -1) + b"abc"
    assert unpack_image(message, 3) == (5, -1, b"abc")


def test_a_value_as_text() -> None:
    assert (as_text(True), as_text(12)) == ("true", "12")
