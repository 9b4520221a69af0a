"""Whole numbers as they stand in the objects of a drive."""

from hli_bench.laws.compiled import law


@law
def wrap32(value: int) -> int:
    """Return `value` as it shows in a signed 32-bit object."""
    return (int(value) + 0x80000000) % 0x100000000 - 0x80000000
