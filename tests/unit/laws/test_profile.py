"""The slope profile: never past the end, never above the feed, rates bounded, two stages, end velocity reached."""

from collections.abc import Iterator
from itertools import pairwise

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hli_bench.laws.profile import TINY, advance, braking_path, ramp

CYCLE = 1e-3
rates = st.floats(1e6, 5e7)
lengths = st.floats(1.0, 5e5)
feeds = st.floats(2e5, 6e6)
splits = st.just(0.0) | st.floats(10.0, 5e6)


def _run(
    length: float,
    feed: float,
    v_end: float,
    low: float,
    high: float,
    down_low: float,
    down_high: float,
    split: float,
    limit: int = 30_000,
) -> Iterator[tuple[float, float, float]]:
    """Walk a segment from rest; yield (path, velocity) a cycle."""
    s, v = 0.0, 0.0
    for _ in range(limit):
        s, v, left = advance(s, v, length, v_end, feed, low, high, down_low, down_high, split, CYCLE)
        yield s, v, left
        if s >= length:
            return
    raise AssertionError("the end was not reached")


@settings(max_examples=50, deadline=None)
@given(lengths, feeds, rates, rates, rates, rates, splits)
@example(27028.456575876073, 3518096.187349916, 3.38e7, 1.009e7, 6936835.581935832, 5674104.2336521875, 0.0)
@example(1.0000000000000002, 2e5, 1e6, 1e6, 1e6, 1e6, 0.0)  # the last step rounds to a hair behind the end
def test_to_a_standstill(
    length: float, feed: float, low: float, high: float, down_low: float, down_high: float, split: float
) -> None:
    """A rest of TINY counts as done: what could still brake within it, v^2 = 2 a TINY, may go in one jump."""
    s0, v0 = 0.0, 0.0
    up, down = max(low, high), max(down_low, down_high)
    jump = (2.0 * down * TINY) ** 0.5
    for s, v, left in _run(length, feed, 0.0, low, high, down_low, down_high, split):
        assert s0 <= s <= length
        assert 0.0 <= v <= feed * (1 + 1e-9)
        time = CYCLE - left
        assert v - v0 <= up * time * (1 + 1e-6) + 1e-3
        assert v0 - v <= down * time * (1 + 1e-6) + jump + 1e-3
        assert braking_path(v, 0.0, down_low, down_high, split) <= length - s + TINY + 1e-12 * length
        assert s - s0 <= max(v, v0, feed) * CYCLE * (1 + 1e-9)
        s0, v0 = s, v
    assert s0 == length
    # v = v0 - a t of the last step rounds to units in the last place of v0; the path itself ends at 0
    assert v0 <= 1e-12 * feed


@settings(max_examples=40, deadline=None)
@given(lengths, feeds, rates, st.floats(0.0, 1.0))
@example(1.0000000000000002, 2e5, 1e6, 0.0)  # the last step rounds to a hair behind the end
def test_an_end_velocity_is_kept_or_undercut_only_where_it_cannot_be_reached(
    length: float, feed: float, rate: float, part: float
) -> None:
    v_end = feed * part
    reachable = (2.0 * rate * length) ** 0.5
    *_, (s, v, _) = _run(length, feed, v_end, rate, rate, rate, rate, 0.0)
    assert s == length
    assert v == pytest.approx(min(v_end, reachable), rel=1e-6, abs=1.0)


@settings(max_examples=30, deadline=None)
@given(st.floats(1e4, 1e6), feeds, rates, rates)
@example(793495.0, 1478840.5, 1478840.5, 20677542.0)  # at its feed a hair before a whole number of cycles
def test_one_cycle_after_the_other_equals_one_long_step(
    length: float, feed: float, up: float, down: float
) -> None:
    s, v, elapsed = 0.0, 0.0, 0.0
    for s, v, left in _run(length, feed, 0.0, up, up, down, down, 0.0):  # noqa: B007 - the last one counts
        elapsed += CYCLE - left
    assert advance(0.0, 0.0, length, 0.0, feed, up, up, down, down, 0.0, elapsed + 1.0)[0] == s
    peak = min(feed, (2.0 * length * up * down / (up + down)) ** 0.5)
    cruise = length - peak * peak / 2.0 * (1.0 / up + 1.0 / down)
    expected = peak / up + peak / down + max(cruise, 0.0) / peak
    assert elapsed == pytest.approx(expected, rel=2e-5, abs=1e-5)


def test_two_stages_have_their_own_rates() -> None:
    split, low, high, down_low, down_high = 1e6, 1e7, 5e6, 2e7, 4e6
    states = [(0.0, 0.0)]
    states += [(s, v) for s, v, _ in _run(2e6, 2e6, 0.0, low, high, down_low, down_high, split)]
    changes = {}
    for (_, before), (_, after) in pairwise(states[:-1]):
        if before == after or (before - split) * (after - split) <= 0.0:
            continue
        changes.setdefault((before < split, after > before), set()).add(round((after - before) / CYCLE, -3))
    assert changes[True, True] == {low}
    assert changes[False, True] >= {high}
    assert changes[True, False] == {-down_low}
    assert -down_high in changes[False, False]


@settings(max_examples=40, deadline=None)
@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), rates, st.floats(1e-4, 1e-2))
def test_a_ramp_never_overshoots(v: float, wanted: float, rate: float, time: float) -> None:
    path, after = ramp(v, wanted, rate, time)
    assert min(v, wanted) <= after <= max(v, wanted)
    assert abs(after - v) <= rate * time * (1 + 1e-9)
    assert min(v, wanted) * time - 1e-6 <= path <= max(v, wanted) * time + 1e-6


def test_a_reduced_feed_slows_down_within_the_segment() -> None:
    s, v = 0.0, 1e6
    speeds = []
    for _ in range(200):
        s, v, _ = advance(s, v, 5e6, 0.0, 1e5, 1e7, 1e7, 1e7, 1e7, 0.0, CYCLE)
        speeds.append(v)
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[-1] == 1e5
    assert speeds[0] == pytest.approx(1e6 - 1e4)
