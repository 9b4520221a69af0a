"""Messages of the position controller (70xxx): lag, homing, probing, fixed stop, drive objects."""

from typing import Final

from hli_bench.manual.errors.record import NOT_IN_BOOK, ErrorSheet, axis_error, message, warning

POSITION_LAG: Final[ErrorSheet] = message(
    "position_lag",
    70_020,
    "position lag of axis {0} is {2}, allowed {3}",
    "logical axis number",
    "drive type",
    "lag [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "block number",
    classes=(8, 6),
)
POSITIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = axis_error(
    "positive_software_limit",
    70_021,
    "axis {0} is beyond its positive software limit switch",
    "logical axis number",
    "drive type",
    "position [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "block number",
)
NEGATIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = axis_error(
    "negative_software_limit",
    70_022,
    "axis {0} is beyond its negative software limit switch",
    "logical axis number",
    "drive type",
    "position [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "block number",
)
MOTION_NEEDS_HOMING: Final[ErrorSheet] = axis_error(
    "motion_needs_homing",
    70_034,
    "axis {0} cannot move before homing",
    "logical axis number",
    "drive type",
    "current value",
    "block number",
)
CONTROLLER_RELEASE_MISSING: Final[ErrorSheet] = message(
    "controller_release_missing",
    70_049,
    "axis {0}: controller release is missing",
    "logical axis number",
    classes=(5, 6),
)
POSITION_LAG_AT_STANDSTILL: Final[ErrorSheet] = message(
    "position_lag_at_standstill",
    70_081,
    "position lag of axis {0} at standstill is {2}, allowed {3}",
    "logical axis number",
    "drive type",
    "lag [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "block number",
    classes=(5, 6),
)
NOT_IN_POSITION: Final[ErrorSheet] = message(
    "not_in_position",
    70_082,
    "axis {0} did not reach its exact stop window in time",
    "logical axis number",
    "drive type",
    "upper limit [µs]",
    "block number",
    "current value",
    classes=(5, 6),
)
GANTRY_DIFFERENCE: Final[ErrorSheet] = axis_error(
    "gantry_difference",
    70_090,
    "gantry difference of axis {2} to its master is too large",
    "difference [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "logical axis number",
    "position of the slave [0.1 µm, 0.0001°]",
    "position of the master [0.1 µm, 0.0001°]",
)
GANTRY_DIFFERENCE_LOCKED: Final[ErrorSheet] = axis_error(
    "gantry_difference_locked",
    70_100,
    "gantry difference of axis {2} is so large that no reset is possible",
    "difference [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "logical axis number",
    "position of the slave [0.1 µm, 0.0001°]",
    "position of the master [0.1 µm, 0.0001°]",
)
DRIVE_NOT_ENABLED: Final[ErrorSheet] = message(
    "drive_not_enabled",
    70_101,
    "axis {0} is to move but its drive is not enabled",
    "logical axis number",
    "drive type",
    "drive status",
    "block number",
    classes=(5, 6),
)
DRIVE_RELEASE_MISSING: Final[ErrorSheet] = message(
    "drive_release_missing",
    70_169,
    "axis {0}: no release of the drive amplifier",
    "logical axis number",
    "current value",
    classes=(8, 6),
)
FEED_RELEASE_MISSING: Final[ErrorSheet] = message(
    "feed_release_missing",
    70_171,
    "axis {0} is to move but its feed release is missing",
    "logical axis number",
    classes=(5, 6),
)
DRIVE_NOT_READY: Final[ErrorSheet] = message(
    "drive_not_ready",
    70_221,
    "axis {0}: its drive has left operation enabled, status word {2}",
    "logical axis number",
    "drive type",
    "status word of the drive",
    "block number",
    classes=(5, 6),
)
CANOPEN_DRIVE_ERROR: Final[ErrorSheet] = axis_error(
    "canopen_drive_error",
    70_222,
    "CANopen drive of axis {0} reports error {4}",
    "logical axis number",
    "drive type",
    "drive status",
    "block number",
    "drive error code",
    source="TF5200 diagnosis, ID 70222, which prints class 0, controlled or abrupt; controlled decided here",
)
GANTRY_HOMING_PATH: Final[ErrorSheet] = axis_error(
    "gantry_homing_path",
    70_230,
    "gantry slave {0} exceeds its path during homing",
    "logical axis number",
    "logical axis number 2",
    "current value [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "current value",
)
DRIVE_DATA_INVALID: Final[ErrorSheet] = message(
    "drive_data_invalid",
    70_231,
    "axis {0} moves but its drive supplies no valid data",
    "logical axis number",
    "drive type",
    "data of the drive are valid",
    "block number",
    classes=(5, 6),
)
GANTRY_HOMING_TYPES: Final[ErrorSheet] = warning(
    "gantry_homing_types",
    70_263,
    "homing types of master and slave {0} differ",
    "logical axis number",
    "logical axis number 2",
    "wrong value",
    "wrong value 2",
    "corrected value",
)
DRIVE_COMMAND_TIMEOUT: Final[ErrorSheet] = axis_error(
    "drive_command_timeout",
    70_275,
    "#DRIVE: no answer from the drive of axis {0}",
    "logical axis number",
    "time limit",
)
DRIVE_COMMAND_NOT_SUPPORTED: Final[ErrorSheet] = axis_error(
    "drive_command_not_supported",
    70_278,
    "#DRIVE is not supported by the drive type of axis {0}",
    "logical axis number",
    "drive type",
)
DRIVE_FUNCTION_UNKNOWN: Final[ErrorSheet] = axis_error(
    "drive_function_unknown", 70_285, "#DRIVE: axis {0} has no function {1}", "logical axis number", "key"
)
CAM_SIGNAL_NOT_IN_TELEGRAM: Final[ErrorSheet] = message(
    "cam_signal_not_in_telegram",
    70_292,
    "axis {0}: the cam signal is not in the cyclic telegram (P-AXIS-00321)",
    "logical axis number",
    "wrong value [0.1 µm, 0.0001°]",
    "drive type",
    classes=(5, 1),
)
PROBE_COMMAND_FAILED: Final[ErrorSheet] = axis_error(
    "probe_command_failed",
    70_293,
    "axis {0}: the probing command failed in the drive",
    "logical axis number",
    "current value",
    "current value 2",
    "current value 3",
    "block number",
)
ZERO_PULSE_TELEGRAM: Final[ErrorSheet] = message(
    "zero_pulse_telegram",
    70_295,
    "axis {0}: no zero pulse homing with this telegram",
    "logical axis number",
    "current value [0.1 µm, 0.0001°]",
    "current value 2 [0.1 µm, 0.0001°]",
    "current value 3 [0.1 µm, 0.0001°]",
    "corrected value [0.1 µm, 0.0001°]",
    classes=(7, 1),
)
DRIVE_HOMING_FAILED: Final[ErrorSheet] = message(
    "drive_homing_failed",
    70_300,
    "drive-controlled homing of axis {0} failed",
    "logical axis number",
    "drive type",
    "current value",
    "block number",
    classes=(5, 6),
)
PROBE_ALREADY_ON: Final[ErrorSheet] = axis_error(
    "probe_already_on",
    70_309,
    "axis {0}: the probe function of the drive is already on",
    "logical axis number",
    "drive type",
    "wrong value",
    "current value",
)
LEADSCREW_NOT_SELECTED: Final[ErrorSheet] = axis_error(
    "leadscrew_not_selected",
    70_310,
    "axis {0}: leadscrew compensation is not selected",
    "logical axis number",
    "wrong value",
)
ZERO_PULSE_PATH: Final[ErrorSheet] = axis_error(
    "zero_pulse_path",
    70_380,
    "axis {0}: no zero pulse while the cam was operated, or within the path of P-AXIS-00404",
    "logical axis number",
    "longest path",
    "path covered",
    "position [increments]",
    "start [increments]",
)
LIMIT_ABOVE_TYPE: Final[ErrorSheet] = warning(
    "limit_above_type",
    70_383,
    "axis {0}, {1}: scaled limit is above the largest value of its data type",
    "logical axis number",
    "object",
    "limit",
    "factor",
    "corrected value",
)
LIMIT_BELOW_TYPE: Final[ErrorSheet] = warning(
    "limit_below_type",
    70_384,
    "axis {0}, {1}: scaled limit is below the smallest value of its data type",
    "logical axis number",
    "object",
    "limit",
    "factor",
    "corrected value",
)
LIMITS_SWAPPED: Final[ErrorSheet] = warning(
    "limits_swapped",
    70_385,
    "axis {0}, {1}: largest value is below the smallest, they are swapped",
    "logical axis number",
    "object",
    "largest value",
    "smallest value",
)
REFERENCE_LOST_WITH_BUS: Final[ErrorSheet] = axis_error(
    "reference_lost_with_bus",
    70_389,
    "axis {0} has lost its reference with the bus",
    "logical axis number",
    "drive type",
    "referenced before",
    "referenced now",
    "telegrams that failed",
)
INPUT_NOT_CHANGEABLE: Final[ErrorSheet] = axis_error(
    "input_not_changeable",
    70_390,
    "axis {0}: the probing input cannot be changed for this drive",
    "logical axis number",
    "drive type",
    "probing method",
    "input",
    "corrected input",
)
EDGE_NOT_CHANGEABLE: Final[ErrorSheet] = axis_error(
    "edge_not_changeable",
    70_391,
    "axis {0}: the probing edge cannot be changed for this drive",
    "logical axis number",
    "drive type",
    "probing method",
    "input",
    "corrected input",
)
HOMING_PATH: Final[ErrorSheet] = axis_error(
    "homing_path",
    70_394,
    "axis {0}: homing has gone {2} from where it began, allowed {1}",
    "logical axis number",
    "longest path [0.1 µm, 0.0001°]",
    "path [0.1 µm, 0.0001°]",
    "set point [0.1 µm, 0.0001°]",
    "modulo range [0.0001°]",
)
REFERENCE_LOST: Final[ErrorSheet] = axis_error(
    "reference_lost",
    70_400,
    "axis {0} lost its reference",
    "logical axis number",
    "wrong value",
    "current value",
)
REFERENCE_SIGNAL_MISSING: Final[ErrorSheet] = message(
    "reference_signal_missing",
    70_401,
    "axis {0}: signal {1} of the reference monitoring is not in the cyclic data",
    "logical axis number",
    "name",
    classes=(5, 1),
)
MASK_TOO_LARGE: Final[ErrorSheet] = axis_error(
    "mask_too_large",
    70_403,
    "{1}: bit mask is too large for its data type",
    "current value",
    "object",
    "mask",
    "data type",
    "largest mask",
)
MASK_RESERVED: Final[ErrorSheet] = axis_error(
    "mask_reserved",
    70_404,
    "axis {0}, {1}: bit mask touches bits that the CNC uses",
    "logical axis number",
    "object",
    "mask",
    "data type",
    "largest mask",
)
COUPLED_NOT_HOMED: Final[ErrorSheet] = axis_error(
    "coupled_not_homed",
    70_434,
    "coupled axis {0} is not homed",
    "logical axis number",
    "logical axis number 2",
)
SERCOS_HOMING_TIMEOUT: Final[ErrorSheet] = axis_error(
    "sercos_homing_timeout",
    70_450,
    "homing of SERCOS axis {0} took too long",
    "logical axis number",
    "time limit [µs]",
    "state",
)
HOMING_ENCODER: Final[ErrorSheet] = axis_error(
    "homing_encoder",
    70_453,
    "axis {0}: homing encoder differs from the setting in the drive",
    "logical axis number",
    "current value",
    "wrong value",
)
MASTER_NOT_PROGRAMMED: Final[ErrorSheet] = axis_error(
    "master_not_programmed",
    70_516,
    "measuring: the master of axis {0} is not programmed",
    "logical axis number",
    "block number",
    "logical axis number 2",
    "logical axis number 3",
)
PATH_OFF_CAM: Final[ErrorSheet] = axis_error(
    "path_off_cam",
    70_523,
    "axis {0}: path off the cam is {1}, allowed {2}",
    "logical axis number",
    "path [0.1 µm, 0.0001°]",
    "longest path [0.1 µm, 0.0001°]",
    "set point [0.1 µm, 0.0001°]",
)
FIXED_STOP_ACTIVE: Final[ErrorSheet] = axis_error(
    "fixed_stop_active",
    70_538,
    "axis {0}: move to fixed stop is already active",
    details=("logical axis number",),
)
FIXED_STOP_DRIVE_TYPE: Final[ErrorSheet] = axis_error(
    "fixed_stop_drive_type",
    70_539,
    "axis {0}: drive type does not support move to fixed stop",
    details=("logical axis number",),
)
FIXED_STOP_OBJECTS: Final[ErrorSheet] = axis_error(
    "fixed_stop_objects",
    70_540,
    "axis {0}: drive objects of move to fixed stop are wrong",
    details=("logical axis number",),
)
FIXED_STOP_NO_TORQUE_LIMIT: Final[ErrorSheet] = axis_error(
    "fixed_stop_no_torque_limit",
    70_541,
    "axis {0}: no drive object TORQUE_LIMIT is configured",
    details=("logical axis number",),
)
FIXED_STOP_OBJECT_TIMEOUT: Final[ErrorSheet] = message(
    "fixed_stop_object_timeout",
    70_544,
    "axis {0}: no answer to the access to a drive object",
    "logical axis number",
    "drive type",
    "current value",
    classes=(6, 6),
)
FIXED_STOP_RELEASES: Final[ErrorSheet] = message(
    "fixed_stop_releases",
    70_546,
    "axis {0}: move to fixed stop aborted, drive releases are missing",
    classes=(6, 7),
    details=("logical axis number",),
)
FIXED_STOP_FOLLOW_UP: Final[ErrorSheet] = message(
    "fixed_stop_follow_up",
    70_547,
    "axis {0}: move to fixed stop aborted by follow-up operation",
    classes=(6, 6),
    details=("logical axis number",),
)
FIXED_STOP_WINDOW: Final[ErrorSheet] = message(
    "fixed_stop_window",
    70_548,
    "axis {0} left the window at its fixed stop",
    "logical axis number",
    "position [0.1 µm, 0.0001°]",
    "stop [0.1 µm, 0.0001°]",
    "lower limit [0.1 µm, 0.0001°]",
    "upper limit [0.1 µm, 0.0001°]",
    classes=(6, 7),
)
FIXED_STOP_RESET: Final[ErrorSheet] = message(
    "fixed_stop_reset",
    70_549,
    "axis {0}: move to fixed stop aborted by CNC reset",
    classes=(6, 7),
    details=("logical axis number",),
)
FIXED_STOP_STILL_ACTIVE: Final[ErrorSheet] = warning(
    "fixed_stop_still_active",
    70_550,
    "axis {0} stays at its fixed stop after the CNC reset",
    "logical axis number",
    "state of the function",
    "state of the detection",
    "stop [0.1 µm, 0.0001°]",
)
FIXED_STOP_READ_SCALING: Final[ErrorSheet] = axis_error(
    "fixed_stop_read_scaling",
    70_551,
    "axis {0}: read scaling of a drive object is too small",
    "logical axis number",
    "wrong value",
    "lower limit",
    "upper limit",
)
FIXED_STOP_TWO_TORQUE_LIMITS: Final[ErrorSheet] = axis_error(
    "fixed_stop_two_torque_limits",
    70_552,
    "axis {0}: two drive objects TORQUE_LIMIT",
    "logical axis number",
    "wrong value",
    "current value",
    "wrong value 2",
    "current value 2",
)
GANTRY_CHANGE_AT_STOP: Final[ErrorSheet] = axis_error(
    "gantry_change_at_stop",
    70_574,
    "axis {0}: gantry change at the fixed stop",
    "logical axis number",
    "wrong value",
    "current value",
    "current value 2",
    "logical axis number 2",
)
NO_DETECTION_CRITERION: Final[ErrorSheet] = warning(
    "no_detection_criterion",
    70_647,
    "axis {0}: no criterion for a fixed stop is configured",
    "logical axis number",
)
DETECTION_TORQUE: Final[ErrorSheet] = warning(
    "detection_torque",
    70_648,
    "axis {0}: detection torque is above its maximum, corrected",
    "logical axis number",
    "current value [0.1 %]",
    "upper limit",
    "corrected value",
)
DRIVE_DATA_INVALID_AT_STANDSTILL: Final[ErrorSheet] = message(
    "drive_data_invalid_at_standstill",
    70_643,
    "axis {0} stands and its drive supplies no valid data",
    "logical axis number",
    "drive type",
    "data of the drive are valid",
    "block number",
    classes=(5, 6),
)
TORQUE_HOMING_COUPLED: Final[ErrorSheet] = message(
    "torque_homing_coupled",
    70_649,
    "homing to a fixed stop of coupled axis {0}",
    "logical axis number",
    classes=(6, 6),
)
STOP_BEFORE_MINIMUM: Final[ErrorSheet] = message(
    "stop_before_minimum",
    70_650,
    "axis {0} met the stop before the smallest distance",
    "logical axis number",
    "limit [µm/s]",
    "limit",
    "limit [0.1 µm]",
    "limit 2 [0.1 µm]",
    classes=(5, 6),
)
RETRACTION_TOO_SMALL: Final[ErrorSheet] = warning(
    "retraction_too_small",
    70_651,
    "axis {0}: retraction is too small for the gantry axis",
    "logical axis number",
    "wrong value [0.1 µm]",
    "logical axis number 2",
    "wrong value 2 [0.1 µm]",
    "corrected value [0.1 µm]",
)
TIMESTAMP_NOT_AVAILABLE: Final[ErrorSheet] = message(
    "timestamp_not_available",
    70_689,
    "axis {0}: no position to be had for the timestamp: its unit is not enabled, or its time is not in the history",
    "logical axis number",
    classes=(7, 3),
    source=NOT_IN_BOOK,
)
