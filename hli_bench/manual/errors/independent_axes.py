"""Messages of single axis interpolation and spindles (60xxx)."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, motion_error

SPINDLE_NOT_HOMED: Final[ErrorSheet] = motion_error(
    "spindle_not_homed", 60_142, "positioning of spindle {0} before homing", "logical axis number"
)
POSITIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = motion_error(
    "positive_software_limit",
    60_158,
    "single axis {0} would pass its positive software limit switch",
    "logical axis number",
)
NEGATIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = motion_error(
    "negative_software_limit",
    60_159,
    "single axis {0} would pass its negative software limit switch",
    "logical axis number",
)
AUTOMATIC_HOMING_DIRECTION: Final[ErrorSheet] = motion_error(
    "automatic_homing_direction",
    60_162,
    "automatic homing of {0} against the direction of motion",
    "logical axis number",
)
NO_MEASURED_VALUE: Final[ErrorSheet] = motion_error(
    "no_measured_value", 60_203, "independent axis {0}: no measured value", "logical axis number"
)
MEASURING_ALREADY_ACTIVE: Final[ErrorSheet] = motion_error(
    "measuring_already_active",
    60_207,
    "independent axis {0}: measuring is already active",
    "logical axis number",
)
AXIS_EXCHANGE_WHILE_MEASURING: Final[ErrorSheet] = motion_error(
    "axis_exchange_while_measuring",
    60_209,
    "axis {0} may not be exchanged while it measures",
    "logical axis number",
)
HOMING_WHILE_MOVING: Final[ErrorSheet] = motion_error(
    "homing_while_moving", 60_214, "homing of axis {0} while it moves", "logical axis number"
)
TORQUE_HOMING_NOT_FOUND: Final[ErrorSheet] = motion_error(
    "torque_homing_not_found",
    60_235,
    "homing to a fixed stop: no reference position, axis {0}",
    "logical axis number",
)
HOMING_DISABLED: Final[ErrorSheet] = motion_error(
    "homing_disabled",
    60_313,
    "single axis {0} may not be homed (P-AXIS-00299 DISABLED)",
    "logical axis number",
)
