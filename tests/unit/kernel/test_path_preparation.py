"""Segments from blocks: direction, dynamics, junctions, measuring runs."""

import math

import numpy as np
import pytest

from hli_bench.base.ids import AxisIndex, AxisNumber, NodeId
from hli_bench.kernel.blocks import Line, MeasuringRun, Source
from hli_bench.kernel.path_preparation.dynamics import Ramp, homing_rate, ramp_along
from hli_bench.kernel.path_preparation.preparation import Preparation
from hli_bench.kernel.setup import AxisSetup, KernelSetup
from hli_bench.laws.rows import KernelRows
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.trees import build

SOURCE = Source("N1", 1)
SLOPE = "getriebe[0].lslope_profil"


def axis(index: int, name: str, kind: str = "T", **more: int) -> AxisSetup:
    values: dict[str, object] = {
        "getriebe[0].vb_eilgang": 400_000,
        "getriebe[0].dynamik.vb_max": 500_000,
        "getriebe[0].dynamik.a_max": 4000,
        f"{SLOPE}.a_grenz_stufe_1": 2000,
        f"{SLOPE}.a_grenz_stufe_2": 1500,
        f"{SLOPE}.vb_grenz_stufe_1_2": 100_000,
        f"{SLOPE}.a_stufe_1": 1000,
        f"{SLOPE}.a_stufe_2": 1000,
    }
    params = build(AxisParams, values | more)
    return AxisSetup(
        index=AxisIndex(index),
        number=AxisNumber(index + 1),
        node=NodeId(index + 1),
        name=name,
        kind=kind,
        params=params,
    )


@pytest.fixture
def rows() -> KernelRows:
    return KernelRows.allocate(3, 4)


@pytest.fixture
def preparation(rows) -> Preparation:
    axes = [axis(0, "X"), axis(1, "Y"), axis(2, "A", "R")]
    setup = KernelSetup(axes=axes, channel=ChannelParams(), cycle_ns=1_000_000, dc_epoch_ns=0)
    made = Preparation(setup, rows)
    made.synchronise()
    return made


def line(rapid: bool = False, feed: float = 6000.0, **target: float) -> Line:
    names = {"x": 0, "y": 1, "a": 2}
    return Line(
        source=SOURCE,
        rapid=rapid,
        feed=feed,
        target={AxisIndex(names[name]): value for name, value in target.items()},
    )


def test_length_direction_and_end(preparation, rows):
    number = preparation.line(line(x=3, y=-4))
    one, leg = rows.segment[number], rows.leg[number]

    assert one["length"] == 50_000.0
    assert tuple(leg["direction"]) == (0.6, -0.8, 0.0)
    assert tuple(leg["end"]) == (30_000.0, -40_000.0, 0.0)
    assert list(leg["moves"]) == [1, 1, 0]
    assert one["feed"] == 1e6


def test_block_without_way_is_none(preparation, rows):
    preparation.line(line(x=3))

    assert preparation.line(line(x=3)) is None
    assert rows.path[0]["tail"] == 1


def test_feed_counts_the_linear_axes_when_one_moves(preparation, rows):
    together = preparation.line(line(x=10, a=90))
    assert rows.segment[together]["length"] == 100_000.0
    assert rows.leg[together, 2]["direction"] == 9.0
    alone = preparation.line(line(a=180))
    assert rows.segment[alone]["length"] == 900_000.0


def test_path_is_as_slow_as_its_slowest_axis_allows(preparation, rows):
    rapid = rows.segment[preparation.line(line(rapid=True, x=10, y=10))]

    assert rapid["feed"] == pytest.approx(4e6 * math.sqrt(2))
    assert rapid["acceleration"][0] == pytest.approx(2000e4 * math.sqrt(2))
    assert rapid["acceleration"][1] == pytest.approx(1500e4 * math.sqrt(2))


@pytest.mark.parametrize(
    ("second", "through"),
    [
        ({"x": 20}, 1e6),  # straight on: at feed
        ({"x": 0}, 1e7 * 1e-3 / 2),  # back: the axis jumps by twice the velocity
        ({"x": 10, "y": 10}, 1e7 * 1e-3),  # a right angle
    ],
)
def test_velocity_at_a_transition_jumps_by_no_more_than_a_cycle_of_acceleration(
    preparation, rows, second, through
):
    first = preparation.line(line(x=10))
    preparation.line(line(**second))

    assert rows.segment[first]["v_end"] == pytest.approx(through)


def test_path_can_always_brake_to_its_end(preparation, rows):
    """Short blocks: no transition is faster than what the way behind it can brake."""
    numbers = [preparation.line(line(x=n / 10)) for n in range(1, 21)]
    v = 0.0
    for number in reversed(numbers):
        one = rows.segment[number]
        assert one["v_end"] <= v + 1e-6
        v = math.sqrt(one["v_end"] ** 2 + 2.0 * one["deceleration"][0] * one["length"])
    assert rows.segment[numbers[0]]["v_end"] > 0.0


def run(feed: float = 600.0, **target: float) -> MeasuringRun:
    made = line(feed=feed, **target)
    return MeasuringRun(
        source=SOURCE, measuring_type=1, feed=feed, target=made.target, axes=tuple(sorted(made.target))
    )


@pytest.mark.req("M-217")
def test_travel_offset_lengthens_the_run_in_its_direction(preparation, rows):
    number, length = preparation.measuring_run(
        run(x=30, y=40), 1e5, {AxisIndex(0): 6_000.0, AxisIndex(1): 80_000.0}
    )

    assert length == 500_000.0
    assert rows.segment[number]["length"] == pytest.approx(510_000.0), "X may go 0.6 mm further"
    assert np.allclose(rows.leg[number, :2]["end"], (306_000.0, 408_000.0))


@pytest.mark.req("M-214")
@pytest.mark.parametrize(("stroke", "feed"), [(1e3, math.sqrt(2 * 2e7 * 1e3)), (1e9, 5e5)])
def test_feed_is_lowered_to_the_stroke(preparation, rows, stroke, feed):
    number, _ = preparation.measuring_run(run(x=30), 5e5, {})

    assert preparation.limit_feed(number, stroke) == (5e5, pytest.approx(feed))
    assert rows.segment[number]["feed"] == pytest.approx(feed)


def test_ramp_over_two_steps():
    ramp = Ramp(low=2e7, high=1e7, split=1e6)
    way = 1e6**2 / 4e7 + (2e6**2 - 1e6**2) / 2e7

    assert ramp.velocity_over(1e6**2 / 4e7) == pytest.approx(1e6)
    assert ramp.velocity_over(way) == pytest.approx(2e6)
    assert ramp_along([ramp, Ramp(1e7, 1e7, 1e6)], [0.5, -0.5]) == Ramp(2e7, 2e7, 2e6)


def test_homing_uses_the_smaller_rapid_acceleration_without_its_own():
    assert homing_rate(axis(0, "X")) == 1500e4
    assert homing_rate(axis(0, "X", **{"getriebe[0].a_ref": 300})) == 300e4
