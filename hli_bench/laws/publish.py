"""Rows to a byte image: what the PLC sees of every axis and of the path."""

import math

from hli_bench.laws.compiled import law
from hli_bench.laws.control import path_held
from hli_bench.laws.rows import FEEDHOLD, FOLLOW, IDLE, JOG, PATH, SEGMENTS, Row, Rows

LIMIT = float((1 << 31) - 1)
READY = 1
ACTIVE = 3
HELD = 5
ERROR = 7


@law
def put(image: Rows, offset: int, number: int, size: int) -> None:
    """Write a whole number, little-endian."""
    for byte in range(size):
        image[offset + byte] = (number >> (8 * byte)) & 0xFF


@law
def put_position(image: Rows, offset: int, value: float) -> None:
    """Write a rounded and limited value as SGN32."""
    put(image, offset, int(math.floor(min(max(value, -LIMIT), LIMIT) + 0.5)) & 0xFFFFFFFF, 4)


@law
def axis_state(row: Row, on_path: bool, path_stands: bool, feedhold: bool) -> int:
    """Return the state of an axis without an error: hold is also an axis whose drive is not in operation."""
    if row["mode"] == FOLLOW:
        return HELD
    jogs = row["mode"] == JOG and row["jog_velocity"] != 0.0
    if row["velocity"] != 0.0:
        return ACTIVE
    if jogs:
        return HELD if feedhold or row["released"] == 0 else ACTIVE
    if on_path:
        return HELD if path_stands else ACTIVE
    return READY


@law
def publish(axis: Rows, path: Rows, segment: Rows, leg: Rows, image: Rows, offsets: Rows) -> None:
    """Write what a cycle has changed.

    Of every axis from its offset on: set point, actual position, lag (SGN32, 0.1 um), its state (UNS16), whether the
    drive is in operation, and ready for its control loop (BOOL). Behind those of the axes stand the offsets of their
    error flags, then that of the number of the block in execution.
    """
    count = axis.shape[0]
    running = path[0]["state"] != IDLE
    slot = path[0]["head"] % SEGMENTS
    held = running and path_held(axis, path[0], leg, slot)
    feedhold = path[0]["hold"] & FEEDHOLD != 0
    for number in range(count):
        row = axis[number]
        offset = offsets[number]
        put_position(image, offset, row["command"])
        put_position(image, offset + 4, row["actual"])
        put_position(image, offset + 8, row["lag"])
        on_path = running and row["mode"] == PATH and leg[slot, number]["moves"] != 0
        state = ERROR if image[offsets[count + number]] else axis_state(row, on_path, held, feedhold)
        put(image, offset + 12, state, 2)
        image[offset + 14] = (row["statusword"] & 0x6F) == 0x27
        image[offset + 15] = (row["statusword"] & 0x4F) != 0
    put(image, offsets[2 * count], segment[slot]["block"] if running else path[0]["block"], 4)
