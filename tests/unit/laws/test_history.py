"""The position at an instant: exact for constant velocity and acceleration, wherever the edge lies."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.laws.history import position_at


@given(
    st.integers(-(10**7), 10**7), st.integers(-(10**5), 10**5), st.integers(-1000, 1000), st.floats(0.0, 7.0)
)
def test_exact_on_a_parabola(a: int, b: int, c: int, at: float) -> None:
    samples = [a + b * i + c * i * i for i in range(8)]
    assert position_at(samples, at) == pytest.approx(a + b * at + c * at * at, abs=1e-5)


@given(st.lists(st.integers(-(10**9), 10**9), min_size=1, max_size=9), st.data())
def test_exact_on_the_samples(samples: list[int], data: Any) -> None:
    index = data.draw(st.integers(0, len(samples) - 1))
    assert position_at(samples, float(index)) == samples[index]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_few_samples_give_a_lower_degree(count: int) -> None:
    samples = [5.0, 7.0, 11.0][:count]
    assert position_at(samples, count - 1) == samples[-1]
