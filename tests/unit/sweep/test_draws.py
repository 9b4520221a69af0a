import numpy as np
import pytest

from hli_bench.sweep.draws import Choice, Integers, Normal, Uniform, distribution, share


def test_a_draw_depends_on_seed_run_and_key_only():
    assert share(1, 5, "a") == share(1, 5, "a")
    assert len({share(1, 5, "a"), share(2, 5, "a"), share(1, 6, "a"), share(1, 5, "b")}) == 4


def test_the_stream_is_fixed_for_all_times():
    assert share(0, 0, "k") == 0.9342192501050418


def test_shares_are_evenly_distributed_and_independent():
    first = np.array([share(7, run, "a") for run in range(4000)])
    second = np.array([share(7, run, "b") for run in range(4000)])
    assert first.min() > 0
    assert first.max() < 1
    counts = np.histogram(first, bins=10, range=(0, 1))[0]
    # Chi square of 9 degrees of freedom: 27.9 is passed once in a thousand.
    assert ((counts - 400) ** 2 / 400).sum() < 27.9
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.06


def test_figures_of_the_distributions():
    shares = [share(3, run, "x") for run in range(4000)]
    normal = np.array([Normal(10.0, 2.0).draw(at) for at in shares])
    assert normal.mean() == pytest.approx(10.0, abs=0.15)
    assert normal.std() == pytest.approx(2.0, rel=0.05)
    assert {Integers(-1, 1).draw(at) for at in shares} == {-1, 0, 1}
    assert {Choice(("a", "b")).draw(at) for at in shares} == {"a", "b"}
    assert all(5.0 <= Uniform(5.0, 6.0).draw(at) <= 6.0 for at in shares)


@pytest.mark.parametrize(
    ("name", "numbers"),
    [
        ("uniform", [2, 1]),
        ("uniform", [1]),
        ("uniform", ["a", 1]),
        ("uniform", [0, float("inf")]),
        ("uniform", [True, 2]),
        ("normal", [0, -1]),
        ("integers", [0.5, 2]),
        ("choice", []),
        ("choice", [[1]]),
    ],
)
def test_figures_that_do_not_fit_are_refused(name, numbers):
    with pytest.raises(ValueError, match=r".*"):
        distribution(name, numbers)
