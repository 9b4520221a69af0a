"""Kernel side of a cycle on bare rows: feedback, conditions, path, axes that move by themselves."""

import itertools
import math

import numpy as np
import pytest

from hli_bench.kernel import watches
from hli_bench.kernel.watches import Condition, Watches
from hli_bench.laws.control import act, ask_watches, sense, take_feedback
from hli_bench.laws.integers import wrap32
from hli_bench.laws.rows import (
    BRAKE,
    FOLLOW,
    HISTORY_CYCLES,
    IDLE,
    JOG,
    PATH,
    RUN,
    SEGMENTS,
    KernelRows,
)

CYCLE_NS = 1_000_000
T = 1e-3


@pytest.fixture
def rows() -> KernelRows:
    made = KernelRows.allocate(2, 8)
    made.axis["mode"] = PATH
    return made


def put(
    rows: KernelRows, length: float, v_end: float = 0.0, *, rapid: bool = False, feed: float = 1e6
) -> None:
    """Put a segment of the first axis: 1e7 units/s2 up and down, 2e7 at feedhold."""
    number = int(rows.path[0]["tail"])
    one = rows.segment[number % SEGMENTS]
    one["length"], one["feed"], one["v_end"], one["rapid"] = length, feed, v_end, rapid
    one["acceleration"] = one["deceleration"] = (1e7, 1e7)
    one["hold"] = (2e7, 2e7)
    begin = rows.leg[(number - 1) % SEGMENTS, 0]["end"] if number else rows.axis[0]["command"]
    rows.leg[number % SEGMENTS] = [(1, begin, 1.0, begin + length), (0, 0.0, 0.0, 0.0)]
    rows.path[0]["tail"] = number + 1
    if rows.path[0]["state"] == IDLE:
        rows.path[0]["state"], rows.path[0]["head"] = RUN, number


def step(rows: KernelRows, cycles: int = 1) -> None:
    for _ in range(cycles):
        act(rows.axis, rows.path, rows.segment, rows.leg, CYCLE_NS)


def met(rows: KernelRows, condition: Condition, cycles: int = 1, first: int = 1) -> bool:
    """Tell whether a condition is met after it was asked in some cycles."""
    watch = Watches(rows.watch)
    handle = watch.watch(condition)
    for cycle in range(first, first + cycles):
        ask_watches(rows.axis, rows.path, rows.watch, rows.history, cycle)
    found = watch.met(handle)
    watch.forget(handle)
    return found


@pytest.mark.parametrize(
    ("value", "wrapped"),
    [(0, 0), (2**31 - 1, 2**31 - 1), (2**31, -(2**31)), (-(2**31) - 1, 2**31 - 1), (2**33 + 5, 5)],
)
def test_wrap32(value, wrapped):
    assert wrap32(value) == wrapped


def test_feedback_is_unwrapped_and_kept(rows):
    """Two telegrams on both sides of the wrap: the axis has moved by 20, not by 2^32."""
    rows.axis[0]["increments_per_unit"] = 2.0
    rows.axis[0]["reference"] = 2**31 - 110
    for cycle, received in enumerate((2**31 - 10, -(2**31) + 10), start=1):
        rows.axis[0]["feedback"] = 2**31 - 10 if cycle == 1 else rows.axis[0]["feedback"]
        rows.axis[0]["received"] = received
        take_feedback(rows.axis[0], rows.history, 0, cycle)

    assert rows.axis[0]["feedback"] == 2**31 + 10
    assert list(rows.history[1:3, 0]) == [2**31 - 10, 2**31 + 10]
    assert rows.axis[0]["actual"] == 60.0


def test_lag_is_behind_the_set_point_that_is_due(rows):
    """The set point sent in the cycle before is where a drive without lag stands now."""
    rows.axis[0]["past"], rows.axis[0]["command"], rows.axis[0]["received"] = 90.0, 100.0, 85
    take_feedback(rows.axis[0], rows.history, 0, 1)

    assert rows.axis[0]["lag"] == 5.0


def test_following_set_point_takes_the_actual_position(rows):
    rows.axis[0]["mode"], rows.axis[0]["received"] = FOLLOW, 1234
    sense(rows.axis, rows.path, rows.watch, rows.history, 1)
    step(rows)

    assert rows.axis[0]["command"] == 1234.0
    assert rows.axis[0]["target"] == 1234
    assert rows.axis[0]["lag"] == 0.0


@pytest.mark.parametrize(
    ("fields", "condition", "holds"),
    [
        ({"lag": -11.0}, watches.lag_over(0, 10.0), True),
        ({"lag": 10.0}, watches.lag_over(0, 10.0), False),
        ({"lag": 10.0}, watches.lag_within(0, 10.0), True),
        ({"lag": 11.0}, watches.lag_within(0, 10.0), False),
        ({"lag": 11.0, "velocity": 1.0}, watches.standstill_lag_over(0, 10.0), False),
        ({"lag": 11.0}, watches.standstill_lag_over(0, 10.0), True),
        ({"statusword": 0x0237}, watches.statusword(0, 0x6F, 0x27), True),
        ({"statusword": 0x0208}, watches.statusword(0, 0x6F, 0x27), False),
        ({"probe_status": 0x03}, watches.probe_status(0, 0x02, 0x02), True),
        ({"digital_inputs": 0x04}, watches.digital_input(0, 0x04, 0), False),
        ({"velocity": 0.0, "jog_velocity": 0.0}, watches.jog_stopped(0), True),
        ({"velocity": 0.0, "jog_velocity": 5.0}, watches.jog_stopped(0), False),
        ({"actual": 130.0}, watches.moved(0, 30.0, 100.0), True),
        ({"actual": 75.0}, watches.moved(0, 30.0, 100.0), False),
        ({}, watches.cycle_reached(1), True),
        ({}, watches.cycle_reached(2), False),
        ({}, watches.path_done(), True),
        ({}, watches.segment_reached(3), True),
    ],
)
def test_condition(rows, fields, condition, holds):
    for name, value in fields.items():
        rows.axis[0][name] = value

    assert met(rows, condition) is holds


def test_condition_must_hold_without_a_gap(rows):
    watch = Watches(rows.watch)
    handle = watch.watch(watches.lag_over(0, 10.0, cycles=3))
    seen = []
    for cycle, lag in enumerate([11, 11, 9, 11, 11, 11], start=1):
        rows.axis[0]["lag"] = lag
        ask_watches(rows.axis, rows.path, rows.watch, rows.history, cycle)
        seen.append(watch.met(handle))

    assert seen == [False, False, False, False, False, True]


def test_condition_fires_once(rows):
    Watches(rows.watch).watch(watches.cycle_reached(2))

    fired = [ask_watches(rows.axis, rows.path, rows.watch, rows.history, cycle) for cycle in range(1, 5)]
    assert fired == [0, 1, 0, 0]


def stop_found(rows: KernelRows, positions, lag: float, condition: Condition) -> int | None:
    """Return the cycle in which a fixed stop is seen while the axis goes through positions."""
    watch = Watches(rows.watch)
    rows.axis[0]["lag"] = lag
    handle = watch.watch(condition)
    for cycle, position in enumerate(positions, start=1):
        rows.history[cycle % HISTORY_CYCLES, 0] = position
        ask_watches(rows.axis, rows.path, rows.watch, rows.history, cycle)
        if watch.met(handle):
            return cycle
    return None


@pytest.mark.req("M-139", "M-147", "M-230")
@pytest.mark.parametrize(
    ("lag", "limit", "window", "found"),
    [
        (60.0, 50.0, -1.0, 5),  # lag alone
        (40.0, 50.0, -1.0, None),
        (0.0, 0.0, 3.0, 15),  # speed alone: 10 a cycle up to cycle 10, then 0
        (60.0, 50.0, 3.0, 15),  # both
        (40.0, 50.0, 3.0, None),
        (60.0, 50.0, 45.0, 6),  # 50 over the first five cycles, then 40
    ],
)
def test_fixed_stop_criteria(rows, lag, limit, window, found):
    """Five cycles of minimum time; the way is that of the last five cycles."""
    positions = [*range(100, 200, 10), *[190] * 10]
    if window == 45.0:
        positions = [100, 110, 120, 130, 140, 140, 140]

    assert stop_found(rows, positions, lag, watches.fixed_stop(0, limit, window, 5, 0)) == found


@pytest.mark.req("M-147", "M-233")
def test_counting_starts_again_when_the_lag_falls_below_its_limit(rows):
    """Four cycles above the limit, one below: the fifth and sixth above it are the first and second of anew."""
    watch = Watches(rows.watch)
    handle = watch.watch(watches.fixed_stop(0, 50.0, -1.0, 5, 0))
    met = []
    for cycle, lag in enumerate([60.0, 60.0, 60.0, 60.0, 40.0, *[60.0] * 6], start=1):
        rows.axis[0]["lag"] = lag
        ask_watches(rows.axis, rows.path, rows.watch, rows.history, cycle)
        met.append(watch.met(handle))

    assert met.index(True) + 1 == 10


@pytest.mark.req("M-148", "M-151")
@pytest.mark.parametrize(("done", "found"), [(99.0, None), (100.0, 3)])
def test_fixed_stop_counts_only_behind_its_way(rows, done, found):
    rows.path[0]["s"] = done

    assert stop_found(rows, [0] * 9, 60.0, watches.fixed_stop(0, 50.0, -1.0, 3, 100)) == found


def test_path_ends_exactly_and_the_axis_is_where_it_should(rows):
    put(rows, 12_345.678)
    step(rows, 200)

    assert rows.path[0]["state"] == IDLE
    assert rows.axis[0]["command"] == 12_345.678
    assert rows.axis[0]["target"] == 12_346
    assert rows.axis[0]["velocity"] == 0.0
    assert rows.axis[1]["command"] == 0.0


def test_axis_without_release_holds_the_path_and_lets_it_go_on(rows):
    put(rows, 50_000.0)
    step(rows, 30)
    rows.axis[0]["released"] = 0
    v = rows.path[0]["v"]
    step(rows)
    assert rows.path[0]["v"] == pytest.approx(v - 2e7 * T)
    step(rows, 100)
    held = rows.axis[0]["command"]
    assert rows.path[0]["v"] == 0.0
    step(rows, 10)
    assert rows.axis[0]["command"] == held
    rows.axis[0]["released"] = 1
    step(rows, 300)

    assert rows.axis[0]["command"] == 50_000.0


def test_axis_that_does_not_move_holds_nothing(rows):
    put(rows, 50_000.0)
    rows.axis[1]["released"] = 0
    step(rows, 10)

    assert rows.axis[0]["command"] > 0.0


@pytest.mark.parametrize(
    ("rapid", "override", "factor"), [(0, 0.5, 0.5), (0, 1.2, 1.2), (1, 0.5, 0.5), (1, 1.2, 1.0)]
)
def test_override_acts_on_rapid_traverse_only_downwards(rows, rapid, override, factor):
    put(rows, 500_000.0, rapid=bool(rapid), feed=1e5)
    rows.path[0]["override"] = override
    step(rows, 100)

    assert rows.path[0]["v"] == pytest.approx(1e5 * factor)


def test_brake_drops_the_distance_to_go(rows):
    put(rows, 500_000.0)
    put(rows, 500_000.0)
    step(rows, 60)
    v, s = float(rows.path[0]["v"]), float(rows.path[0]["s"])
    rows.path[0]["state"] = BRAKE
    rows.path[0]["brake"] = (5e7, 5e7)
    step(rows, 100)

    assert rows.path[0]["state"] == IDLE
    assert rows.axis[0]["command"] == pytest.approx(s + v * v / 1e8)
    assert rows.axis[0]["velocity"] == 0.0


def test_brake_goes_on_over_the_ends_of_short_segments(rows):
    """Blocks shorter than the braking way: no jump of the velocity at the end of one."""
    for _ in range(40):
        put(rows, 1000.0, v_end=4e5)
    rows.segment["v_end"][39] = 0.0
    rows.path[0]["v"] = 4e5
    rows.path[0]["state"] = BRAKE
    rows.path[0]["brake"] = (1e7, 1e7)
    speeds = [4e5]
    while rows.path[0]["state"] == BRAKE:
        step(rows)
        speeds.append(float(rows.path[0]["v"]))

    assert rows.axis[0]["command"] == pytest.approx(4e5**2 / 2e7)
    assert all(before - after <= 1e7 * T * (1 + 1e-9) for before, after in itertools.pairwise(speeds))


def test_next_segment_begins_in_the_middle_of_a_cycle(rows):
    """A transition takes no time: two halves are as fast as one whole."""
    whole = KernelRows.allocate(2, 8)
    whole.axis["mode"] = PATH
    put(whole, 40_000.0)
    put(rows, 20_000.0, v_end=math.sqrt(2 * 1e7 * 20_000.0))
    put(rows, 20_000.0)
    for _ in range(200):
        step(whole)
        step(rows)
        assert rows.axis[0]["command"] == pytest.approx(whole.axis[0]["command"], abs=1e-6)


def test_velocity_a_hair_below_the_wanted_one_ends_a_cycle(rows):
    """Left over by rounding at the end of a segment; the profile must neither hang nor accelerate."""
    below = math.nextafter(1e6, 0.0)
    put(rows, 2000.0, v_end=1e6)
    put(rows, 60_000.0)
    rows.path[0]["v"] = below
    step(rows)
    assert rows.axis[0]["command"] == pytest.approx(1000.0)
    step(rows, 200)

    assert rows.axis[0]["command"] == 62_000.0


def test_jog_ramps_to_its_velocity_and_back(rows):
    rows.axis[0]["mode"] = JOG
    rows.axis[0]["jog_velocity"], rows.axis[0]["jog_acceleration"] = -1000.0, 1e5
    step(rows, 5)
    assert rows.axis[0]["velocity"] == pytest.approx(-500.0)
    step(rows, 20)
    assert rows.axis[0]["velocity"] == -1000.0
    rows.axis[0]["jog_velocity"] = 0.0
    before = float(rows.axis[0]["command"])
    step(rows, 20)

    assert rows.axis[0]["velocity"] == 0.0
    assert rows.axis[0]["command"] == pytest.approx(before - 1000.0**2 / 2e5)


def test_jog_without_release_brakes(rows):
    rows.axis[0]["mode"] = JOG
    rows.axis[0]["jog_velocity"], rows.axis[0]["jog_acceleration"] = 1000.0, 1e5
    step(rows, 20)
    rows.axis[0]["released"] = 0
    step(rows, 11)

    assert rows.axis[0]["velocity"] == 0.0


def test_negative_counting_direction(rows):
    rows.axis[0]["increments_per_unit"] = -2.0
    put(rows, 1000.0)
    step(rows, 100)

    assert rows.axis[0]["target"] == -2000
    rows.axis[0]["received"] = -2000
    take_feedback(rows.axis[0], rows.history, 0, 1)
    assert rows.axis[0]["actual"] == 1000.0
    assert np.isclose(rows.axis[0]["lag"], 0.0)
