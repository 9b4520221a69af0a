"""The position an axis had at an instant: interpolation in the history of captured positions."""

from collections.abc import Sequence


def position_at(samples: Sequence[float], at: float) -> float:
    """Return the value at `at` (in cycles) of equidistant `samples`, sample i standing at i.

    A cubic through the four nearest samples, fewer at the ends: exact for constant velocity and for
    constant acceleration, so the result does not depend on where within a cycle the edge came.
    """
    count = len(samples)
    points = min(4, count)
    first = min(max(int(at) - 1, 0), count - points)
    total = 0.0
    for i in range(first, first + points):
        weight = 1.0
        for j in range(first, first + points):
            if j != i:
                weight *= (at - j) / (i - j)
        total += weight * samples[i]
    return total
