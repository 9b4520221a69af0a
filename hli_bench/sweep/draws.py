"""Random draws that depend on nothing but the campaign's seed, the number of the run and the key."""

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from statistics import NormalDist
from typing import Final

Plain = bool | int | float | str

BITS: Final = 53
"""Bits of a draw: as many as a float64 between 0 and 1 has."""


def share(seed: int, run: int, key: str) -> float:
    """Return a number in (0, 1), evenly distributed; a hash, so that no library's stream can change it."""
    digest = blake2b(f"{seed}\n{run}\n{key}".encode(), digest_size=8).digest()
    return (int.from_bytes(digest, "little") >> (64 - BITS) | 1) / (1 << BITS)


@dataclass(frozen=True, slots=True)
class Uniform:
    """Evenly between `low` and `high`."""

    low: float
    high: float

    def draw(self, at: float) -> Plain:
        """Return the value at a share in (0, 1)."""
        return self.low + (self.high - self.low) * at


@dataclass(frozen=True, slots=True)
class Normal:
    """Normally distributed with `mean` and `sigma`."""

    mean: float
    sigma: float

    def draw(self, at: float) -> Plain:
        """Return the value at a share in (0, 1)."""
        return self.mean + self.sigma * NormalDist().inv_cdf(at)


@dataclass(frozen=True, slots=True)
class Integers:
    """Whole numbers `low` .. `high`, both included."""

    low: int
    high: int

    def draw(self, at: float) -> Plain:
        """Return the value at a share in (0, 1)."""
        return min(self.low + int((self.high - self.low + 1) * at), self.high)


@dataclass(frozen=True, slots=True)
class Choice:
    """One of `values`."""

    values: tuple[Plain, ...]

    def draw(self, at: float) -> Plain:
        """Return the value at a share in (0, 1)."""
        return self.values[int(len(self.values) * at)]


Distribution = Uniform | Normal | Integers | Choice
FORMS: Final = {
    "uniform": "[low, high]",
    "normal": "[mean, sigma]",
    "integers": "[low, high]",
    "choice": "[value, ...]",
}
"""What follows the name of a distribution in a campaign."""
RULES: Final = {
    "uniform": ", low up to high",
    "normal": ", sigma from 0 on",
    "integers": ", whole numbers, low up to high",
    "choice": "",
}
"""What must be true of it besides."""


def distribution(name: str, numbers: Sequence[object]) -> Distribution:
    """Return the distribution `name` with these figures. Raises ValueError when they do not fit it."""
    if name == "choice":
        plain = tuple(item for item in numbers if isinstance(item, bool | int | float | str))
        if not plain or len(plain) != len(numbers):
            raise ValueError(numbers)
        return Choice(plain)
    figures = [item for item in numbers if isinstance(item, int | float) and not isinstance(item, bool)]
    if len(numbers) != 2 or len(figures) != 2 or not all(abs(item) < float("inf") for item in figures):
        raise ValueError(numbers)
    first, second = figures
    if name == "normal":
        if second < 0:
            raise ValueError(numbers)
        return Normal(float(first), float(second))
    if first > second:
        raise ValueError(numbers)
    if name == "uniform":
        return Uniform(float(first), float(second))
    if isinstance(first, int) and isinstance(second, int):
        return Integers(first, second)
    raise ValueError(numbers)
