"""Latched positions: 32-bit counts of the drive, taken to the count that goes on over the borders of 32 bits."""

from hli_bench.laws.integers import wrap32
from hli_bench.laws.rows import Rows


def unwrapped(row: Rows, raw: int) -> int:
    """Return the latched count `raw` as the one nearest to the actual position of the axis, increments."""
    feedback = int(row["feedback"])
    return feedback + int(wrap32(raw - feedback))
