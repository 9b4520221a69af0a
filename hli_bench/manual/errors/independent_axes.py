"""Messages of single axis interpolation and spindles (60xxx)."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, axis_error, message

SPINDLE_NOT_HOMED: Final[ErrorSheet] = message(
    "spindle_not_homed",
    60_142,
    "positioning of spindle {0} before homing",
    "logical axis number",
    classes=(6, 6),
)
POSITIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = axis_error(
    "positive_software_limit",
    60_158,
    "single axis {0} would pass its positive software limit switch",
    "logical axis number",
    "position [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "position of standstill [0.1 µm, 0.0001°]",
)
NEGATIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = axis_error(
    "negative_software_limit",
    60_159,
    "single axis {0} would pass its negative software limit switch",
    "logical axis number",
    "position [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "position of standstill [0.1 µm, 0.0001°]",
)
AUTOMATIC_HOMING_DIRECTION: Final[ErrorSheet] = message(
    "automatic_homing_direction",
    60_162,
    "automatic homing of {0} against the direction of motion",
    "logical axis number",
    "current value",
    classes=(6, 6),
)
MEASURING_ALREADY_ACTIVE: Final[ErrorSheet] = message(
    "measuring_already_active",
    60_207,
    "independent axis {0}: measuring is already active",
    "logical axis number",
    "current value",
    classes=(6, 6),
)
AXIS_EXCHANGE_WHILE_MEASURING: Final[ErrorSheet] = message(
    "axis_exchange_while_measuring",
    60_209,
    "axis {0} may not be exchanged while it measures",
    "logical axis number",
    classes=(6, 6),
)
HOMING_WHILE_MOVING: Final[ErrorSheet] = message(
    "homing_while_moving", 60_214, "homing of axis {0} while it moves", "logical axis number", classes=(6, 6)
)
TORQUE_HOMING_NOT_FOUND: Final[ErrorSheet] = message(
    "torque_homing_not_found",
    60_235,
    "homing to a fixed stop: no reference position, axis {0}",
    "logical axis number",
    "limit [0.1 µm, 0.0001°]",
    classes=(6, 6),
)
HOMING_DISABLED: Final[ErrorSheet] = message(
    "homing_disabled",
    60_313,
    "single axis {0} may not be homed (P-AXIS-00299 DISABLED)",
    "logical axis number",
    "drive type",
    "homing type",
    classes=(5, 6),
)
