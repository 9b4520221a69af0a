"""Positions to a byte image: what the PLC sees of every axis, rounded to whole units."""

import math

from hli_bench.laws.compiled import law
from hli_bench.laws.rows import Rows

LIMIT = float((1 << 31) - 1)


@law
def put_sgn32(image: Rows, offset: int, value: float) -> None:
    """Write a rounded and limited value as SGN32, little-endian."""
    number = int(math.floor(min(max(value, -LIMIT), LIMIT) + 0.5)) & 0xFFFFFFFF
    for byte in range(4):
        image[offset + byte] = (number >> (8 * byte)) & 0xFF


@law
def publish_positions(axis: Rows, image: Rows, offsets: Rows) -> None:
    """Write actual position, set point and lag (0.1 um) of every axis, next to each other from its offset on."""
    for number in range(axis.shape[0]):
        offset = offsets[number]
        put_sgn32(image, offset, axis[number]["actual"])
        put_sgn32(image, offset + 4, axis[number]["command"])
        put_sgn32(image, offset + 8, axis[number]["lag"])
