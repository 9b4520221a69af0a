import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout

LAYOUT = Layout([(1, "X", "linear"), (2, "Y", "linear")])
TIMESTAMP = LAYOUT.element("ax/2/lr_mc_control/timestamp/command_w")
PROBE = LAYOUT.element("ax/2/lr_mc_control/probing_signal/command_w")


def test_a_value_lies_in_the_bytes_where_the_layout_says() -> None:
    image = Image(LAYOUT)
    image.set(TIMESTAMP.id, -5)
    assert image.data[TIMESTAMP.offset : TIMESTAMP.offset + 8] == (-5).to_bytes(8, "little", signed=True)
    assert image.get(TIMESTAMP.id) == -5
    assert sum(image.data[: TIMESTAMP.offset]) == 0


@given(st.lists(st.integers(0, len(LAYOUT.elements) - 1)), st.randoms())
def test_setting_one_element_leaves_the_others(ids: Any, random: Any) -> None:
    image, expected = Image(LAYOUT), {element.id: 0 for element in LAYOUT.elements}
    for number in ids:
        expected[number] = random.randint(0, 1)
        image.set(number, expected[number])
    assert {element.id: image.get(element.id) for element in LAYOUT.elements} == expected


def test_only_changed_units_are_handed_out_and_once() -> None:
    image = Image(LAYOUT)
    image.set(PROBE.id, False)
    assert image.take_changed() == []
    image.set(TIMESTAMP.id, 7)
    image.set(PROBE.id, True)
    image.set(TIMESTAMP.id, 8)
    changed = dict(image.take_changed())
    assert list(changed) == sorted(changed, key=list(LAYOUT.groups).index)
    assert changed == {
        "ax/2/lr_mc_control/probing_signal": struct.pack("<????", False, False, True, False),
        "ax/2/lr_mc_control/timestamp": struct.pack("<q?qq", 0, False, 8, 0),
    }
    assert image.take_changed() == []


def test_what_the_plc_side_wrote_is_remembered_even_without_a_change() -> None:
    image = Image(LAYOUT)
    image.write(PROBE.id, False)
    image.set(TIMESTAMP.id, 1)
    assert image.take_written() == [PROBE.id]
    assert image.take_written() == []


def test_a_value_that_does_not_fit_is_no_silent_wrap() -> None:
    with pytest.raises(struct.error):
        Image(LAYOUT).set(TIMESTAMP.id, 2**63)
