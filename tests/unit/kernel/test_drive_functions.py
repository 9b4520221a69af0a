"""#DRIVE values on their way to the drive object: scaling, limits, ident; acyclic orders one at a time."""

import struct
from typing import Any

import pytest

from hli_bench.base.ids import NodeId
from hli_bench.base.time import Ns
from hli_bench.kernel.drive_manager.functions import ident, scaled
from hli_bench.kernel.drive_manager.objects import ATTEMPTS, ObjectChannel, Order
from hli_bench.manual.axis.antr import Function
from hli_bench.manual.axis.words import ScalingType
from hli_bench.protocols.canopen.aborts import AbortCode
from hli_bench.wire.can import CanFrame

LINEAR = ScalingType("LINEAR")
NODE = NodeId(3)


@pytest.mark.req("M-166", "M-167")
@pytest.mark.parametrize(
    ("given", "value", "raw"),
    [
        ({"scaling_type": LINEAR, "scaling_factor": 10.0}, 10.0, 100),
        ({"scaling_type": LINEAR, "scaling_factor": 10.0}, 5000.0, 50_000),
        ({"scaling_type": ScalingType("UNSCALED"), "scaling_factor": 10.0}, 10.0, 10),
        ({"min_limit": 0.0, "max_limit": 4_294_967_295.0}, 4_294_967_295.0, 4_294_967_295),
        ({"min_limit": 5.0}, 1.0, 5),
        ({"max_limit": 7.0}, 9.0, 7),
        ({}, -3.0, -3),
        ({}, 3.0, 3),
    ],
)
def test_scaled_and_limited(given, value, raw):
    """Limits that are not given (1.0e+199) are off, the smallest as well as the largest."""
    assert scaled(Function(**given), value) == raw


@pytest.mark.req("M-165")
@pytest.mark.parametrize(
    ("text", "parts"), [("6065_00", (0x6065, 0)), ("60D1_02", (0x60D1, 2)), ("6072", (0x6072, 0))]
)
def test_ident(text, parts):
    assert ident(Function(wr_ident=(text,))) == parts


def answer(index: int, command: int = 0x60) -> CanFrame:
    return CanFrame(0x580 + NODE, bytes((command, index & 0xFF, index >> 8, 0, 0, 0, 0, 0)))


def test_orders_to_a_node_go_one_after_the_other():
    channel = ObjectChannel([NODE, NodeId(4)])
    done: list[tuple[int, object]] = []
    for index in (0x6072, 0x6065):
        channel.write(
            NODE, Order(index, 0, b"\1\0", lambda refused, index=index: done.append((index, refused)))
        )
    first = channel.begin(Ns(0))
    assert [frame.cob_id for frame in first] == [0x603]
    assert channel.begin(Ns(1000)) == []
    channel.on_frame(answer(0x6072), Ns(2000))
    assert done == [(0x6072, None)]
    second = channel.begin(Ns(3000))
    assert second[0].data[1:3] == b"\x65\x60"
    channel.on_frame(answer(0x6065, 0x80), Ns(4000))

    assert done[1][0] == 0x6065
    assert done[1][1] is not None
    assert not channel.busy


def test_a_transfer_that_others_break_off_is_begun_again_and_the_third_time_said():
    channel = ObjectChannel([NODE])
    done: list[Any] = []
    channel.write(NODE, Order(0x6072, 0, b"\1\0", done.append))
    for attempt in range(ATTEMPTS):
        now = Ns(attempt * 1_000_000_000)
        asked = channel.begin(now)
        assert [frame.data[1:3] for frame in asked if frame.data[0] != 0x80] == [b"\x72\x60"]
        channel.on_frame(answer(0x6041, 0x4B), now)
    assert done == []
    channel.begin(Ns(ATTEMPTS * 1_000_000_000))
    (refused,) = done
    assert refused.collided
    assert "another SDO client used the same server" in str(refused)
    assert not channel.busy


def test_a_refusal_beside_others_is_a_refusal():
    channel = ObjectChannel([NODE])
    done: list[Any] = []
    channel.write(NODE, Order(0x6072, 0, b"\1\0", done.append))
    channel.begin(Ns(0))
    channel.on_frame(answer(0x6041, 0x4B), Ns(0))
    channel.on_frame(CanFrame(0x580 + NODE, struct.pack("<BHBI", 0x80, 0x6072, 0, AbortCode.RANGE)), Ns(0))
    (refused,) = done
    assert (refused.code, refused.collided) == (AbortCode.RANGE, False)


def test_nodes_have_a_channel_each_and_other_frames_are_left_alone():
    channel = ObjectChannel([NODE, NodeId(4)])
    for node in (NODE, NodeId(4)):
        channel.write(node, Order(0x6072, 0, b"\1\0", lambda _: None))

    assert sorted(frame.cob_id for frame in channel.begin(Ns(0))) == [0x603, 0x604]
    assert channel.on_frame(CanFrame(0x183, b"\0\0"), Ns(0)) == []


def test_reset_forgets_what_waits():
    channel = ObjectChannel([NODE])
    for index in (0x6072, 0x6065):
        channel.write(NODE, Order(index, 0, b"\1\0", lambda _: None))
    channel.begin(Ns(0))
    channel.clear()
    channel.on_frame(answer(0x6072), Ns(1000))

    assert channel.begin(Ns(2000)) == []
    assert not channel.busy
