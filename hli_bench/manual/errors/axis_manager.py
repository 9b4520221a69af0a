"""Messages of the axis manager (110xxx): checks of axis lists at start-up."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, message, warning

TRANSLATORY_AXIS_MODE: Final[ErrorSheet] = warning(
    "translatory_axis_mode",
    110_051,
    "axis {0}: axis mode {1} is not allowed for a translatory axis",
    "logical axis number",
    "mode",
    "corrected mode",
)
MODULO_RANGE: Final[ErrorSheet] = warning(
    "modulo_range",
    110_052,
    "axis {0}: modulo range is zero or negative",
    "logical axis number",
    "wrong value [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "corrected value [0.1 µm, 0.0001°]",
    "corrected value 2 [0.1 µm, 0.0001°]",
)
AXIS_MODE: Final[ErrorSheet] = warning(
    "axis_mode",
    110_053,
    "axis {0}: axis mode {1} is not allowed",
    "logical axis number",
    "mode",
    "corrected mode",
)
UNKNOWN_DRIVE_TYPE: Final[ErrorSheet] = message(
    "unknown_drive_type",
    110_060,
    "axis {0}: unknown drive type {1}",
    "logical axis number",
    "drive type",
    classes=(3, 7),
)
AXIS_NUMBER_TWICE: Final[ErrorSheet] = warning(
    "axis_number_twice",
    110_064,
    "logical axis number {0} is used twice",
    "logical axis number",
    "current value",
    "corrected value",
)
AXIS_NUMBER_ZERO: Final[ErrorSheet] = message(
    "axis_number_zero", 110_076, "logical axis number 0 is not allowed", "wrong value", classes=(3, 7)
)
RESOLUTION_DENOMINATOR: Final[ErrorSheet] = warning(
    "resolution_denominator",
    110_086,
    "axis {0}: denominator of the path resolution is 0",
    "logical axis number",
    "value",
    "corrected value",
)
SOFTWARE_LIMITS: Final[ErrorSheet] = warning(
    "software_limits",
    110_110,
    "axis {0}: no path between the software limit switches",
    "logical axis number",
    "current value [0.1 µm, 0.0001°]",
    "current value 2 [0.1 µm, 0.0001°]",
    "wrong value [0.1 µm, 0.0001°]",
    "corrected value [0.1 µm, 0.0001°]",
)
MEASURING_FEED_ZERO: Final[ErrorSheet] = warning(
    "measuring_feed_zero",
    110_113,
    "axis {0}: measuring feed is 0",
    "logical axis number",
    "feed [µm/s, 0.001°/s]",
    "corrected feed [µm/s, 0.001°/s]",
)
MEASURING_FEED_LIMIT: Final[ErrorSheet] = warning(
    "measuring_feed_limit",
    110_114,
    "axis {0}: measuring feed {1} is above {2}",
    "logical axis number",
    "feed [µm/s, 0.001°/s]",
    "limit [µm/s, 0.001°/s]",
    "corrected feed [µm/s, 0.001°/s]",
)
SERCOS_MEASURING: Final[ErrorSheet] = warning(
    "sercos_measuring",
    110_117,
    "axis {0}: measuring by SERCOS needs a SERCOS drive",
    "logical axis number",
    "current value",
    "drive type",
    "corrected value",
)
NO_MEASURING_METHOD: Final[ErrorSheet] = warning(
    "no_measuring_method",
    110_118,
    "axis {0}: no measuring method is chosen",
    "logical axis number",
    "drive type",
    "corrected P-AXIS-00117",
)
HOMING_FAST_LIMIT: Final[ErrorSheet] = warning(
    "homing_fast_limit",
    110_147,
    "axis {0}: fast homing speed is above the largest speed",
    "logical axis number",
    "current value [µm/s, 0.001°/s]",
    "limit [µm/s, 0.001°/s]",
    "corrected value [µm/s, 0.001°/s]",
)
HOMING_SLOW_LIMIT: Final[ErrorSheet] = warning(
    "homing_slow_limit",
    110_148,
    "axis {0}: slow homing speed is above the largest speed",
    "logical axis number",
    "current value [µm/s, 0.001°/s]",
    "limit [µm/s, 0.001°/s]",
    "corrected value [µm/s, 0.001°/s]",
)
HOMING_SLOW_ABOVE_FAST: Final[ErrorSheet] = warning(
    "homing_slow_above_fast",
    110_149,
    "axis {0}: slow homing speed is above the fast one",
    "logical axis number",
    "current value [µm/s, 0.001°/s]",
    "limit [µm/s, 0.001°/s]",
    "corrected value [µm/s, 0.001°/s]",
)
DRIVE_MEASURING: Final[ErrorSheet] = warning(
    "drive_measuring",
    110_344,
    "axis {0}: measuring in the drive needs a digital drive",
    "logical axis number",
    "current value",
    "drive type",
    "corrected value",
)
FIXED_STOP_LAG_LIMIT: Final[ErrorSheet] = warning(
    "fixed_stop_lag_limit",
    110_364,
    "axis {0}: homing to a fixed stop, list value is wrong",
    "logical axis number",
    "current value [0.1 µm, 0.0001°]",
    "current value 2 [0.1 µm, 0.0001°]",
)
TORQUE_HOMING_DRIVE_TYPE: Final[ErrorSheet] = warning(
    "torque_homing_drive_type",
    110_371,
    "axis {0}: drive type does not allow homing to a fixed stop",
    "logical axis number",
    "drive type",
    "wrong value",
    "wrong value 2",
    "corrected value",
)
HOMING_TYPE: Final[ErrorSheet] = warning(
    "homing_type",
    110_384,
    "axis {0}: drive type {1} does not support homing type {3}",
    "logical axis number",
    "drive type",
    "current value",
    "homing type",
    "corrected type",
)
RESOLUTION_NUMERATOR: Final[ErrorSheet] = warning(
    "resolution_numerator",
    110_386,
    "axis {0}: numerator of the path resolution is 0",
    "logical axis number",
    "value",
    "corrected value",
)
SEVERAL_MEASURING_METHODS: Final[ErrorSheet] = warning(
    "several_measuring_methods",
    110_399,
    "axis {0}: more than one measuring method is chosen",
    "logical axis number",
    "current value",
    "current value 2",
    "current value 3",
    "corrected value",
)
HOMING_OVERFLOW_RANGE: Final[ErrorSheet] = warning(
    "homing_overflow_range",
    110_482,
    "axis {0}: bits of the encoder overflow (P-AXIS-00355) out of range, corrected to 0",
    "logical axis number",
    "wrong value",
    "lower limit",
    "upper limit",
    "corrected value",
)
ZERO_PULSE_HOMING: Final[ErrorSheet] = warning(
    "zero_pulse_homing",
    110_512,
    "axis {0}: homing on the zero pulse and on the encoder overflow at once",
    "logical axis number",
    "current value",
    "current value 2",
    "corrected value",
)
HOMING_PATH_LINEAR: Final[ErrorSheet] = message(
    "homing_path_linear",
    110_545,
    "axis {0}: the homing path is watched for spindles and rotary axes only",
    "logical axis number",
    "wrong value",
    "corrected value",
    classes=(3, 1),
)
REFERENCE_MONITORING: Final[ErrorSheet] = warning(
    "reference_monitoring",
    110_548,
    "axis {0}: drive type does not support reference monitoring",
    "logical axis number",
    "wrong value",
    "current value",
    "corrected value",
)
REFERENCE_BIT: Final[ErrorSheet] = message(
    "reference_bit",
    110_549,
    "axis {0}: bit {1} of the reference monitoring is not valid",
    "logical axis number",
    "bit",
    "limit",
    "corrected bit",
    classes=(3, 1),
)
REFERENCE_RESTART: Final[ErrorSheet] = warning(
    "reference_restart",
    110_550,
    "axis {0}: P-AXIS-00426 needs a restart",
    "logical axis number",
    "current value",
    "corrected value",
)
IGNORE_ABS_POS: Final[ErrorSheet] = warning(
    "ignore_abs_pos",
    110_584,
    "axis {0}: IGNORE_ABS_POS needs an absolute measuring system",
    "logical axis number",
    "drive type",
    "absolute measuring system",
    "homing type",
    "corrected type",
)
PROBING_SIGNAL: Final[ErrorSheet] = warning(
    "probing_signal",
    110_585,
    "axis {0}: probing signal source is not valid",
    "logical axis number",
    "drive type",
    "wrong value",
    "corrected value",
)
PROBING_SIGNAL_DRIVE_TYPE: Final[ErrorSheet] = warning(
    "probing_signal_drive_type",
    110_586,
    "axis {0}: drive type {1} does not support probing signal {2}, taken is {3}",
    "logical axis number",
    "drive type",
    "source",
    "corrected source",
)
PROBING_INPUT: Final[ErrorSheet] = warning(
    "probing_input",
    110_587,
    "axis {0}: probing input {2} is not supported",
    "logical axis number",
    "source",
    "input",
    "upper limit",
    "corrected input",
)
PROBING_EDGE: Final[ErrorSheet] = warning(
    "probing_edge",
    110_588,
    "axis {0}: probing edge is not valid",
    "logical axis number",
    "drive type",
    "current value",
    "wrong value",
    "corrected value",
)
PROBE_KEYWORD_INPUT: Final[ErrorSheet] = warning(
    "probe_keyword_input",
    110_622,
    "axis {0}: input of PROBE0 or PROBE1 is not valid",
    "logical axis number",
    "current value",
    "wrong value",
    "upper limit",
    "corrected value",
)
MEASURING_START_PER_MILLE: Final[ErrorSheet] = warning(
    "measuring_start_per_mille",
    110_657,
    "axis {0}: start of the stop detection {1} (P-AXIS-00777) is above 1000",
    "logical axis number",
    "start value [0.1 %]",
    "upper limit [0.1 %]",
)
FIXED_STOP_START_PER_MILLE: Final[ErrorSheet] = warning(
    "fixed_stop_start_per_mille",
    110_658,
    "axis {0}: start of the stop detection {1} (P-AXIS-00772) is above 1000",
    "logical axis number",
    "start value [0.1 %]",
    "upper limit [0.1 %]",
)
TORQUE_HOMING_SPEED: Final[ErrorSheet] = warning(
    "torque_homing_speed",
    110_682,
    "axis {0}: speed limit of homing to a fixed stop is above 100 %",
    "logical axis number",
    "current value [0.1 %]",
    "corrected value [0.1 %]",
)
TORQUE_HOMING_TORQUE: Final[ErrorSheet] = warning(
    "torque_homing_torque",
    110_683,
    "axis {0}: torque limit of homing to a fixed stop is above 100 %",
    "logical axis number",
    "current value [0.1 %]",
    "corrected value [0.1 %]",
)
DETECTION_TORQUE_DEFAULT: Final[ErrorSheet] = warning(
    "detection_torque_default",
    110_684,
    "axis {0}: default detection torque is above 1000",
    "logical axis number",
    "value",
    "corrected value",
)
REFERENCE_MONITORING_2: Final[ErrorSheet] = warning(
    "reference_monitoring_2",
    110_691,
    "axis {0}: reference monitoring is not supported by this drive type",
    "logical axis number",
)
