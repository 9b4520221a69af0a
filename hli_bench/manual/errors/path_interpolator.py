"""Messages of the path interpolator (50xxx and 51xxx): measuring, fixed stop, homing orders."""

from typing import Final

from hli_bench.manual.errors.record import SYSTEM, ErrorSheet, message, motion_error, warning

HOMING_WITHOUT_AXES: Final[ErrorSheet] = motion_error(
    "homing_without_axes", 50_003, "homing without an axis", source=SYSTEM
)
MEASURING_PATH_TOO_SMALL: Final[ErrorSheet] = message(
    "measuring_path_too_small",
    50_010,
    "edge banding: the path is too short to make the probe ready",
    classes=(6, 6),
)
MEASURING_NOT_INITIALISED: Final[ErrorSheet] = message(
    "measuring_not_initialised", 50_011, "edge banding: the probe was not made ready", classes=(6, 6)
)
POSITIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = motion_error(
    "positive_software_limit",
    50_041,
    "axis {0} would pass its positive software limit switch",
    "logical axis number",
    "current value [0.1 µm, 0.0001°]",
    "upper limit [0.1 µm, 0.0001°]",
    "current value 2 [0.1 µm, 0.0001°]",
    "current value 3 [0.1 µm, 0.0001°]",
)
NEGATIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = motion_error(
    "negative_software_limit",
    50_042,
    "axis {0} would pass its negative software limit switch",
    "logical axis number",
    "current value [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "current value 2 [0.1 µm, 0.0001°]",
    "current value 3 [0.1 µm, 0.0001°]",
)
PROBING_NOT_INITIALISED: Final[ErrorSheet] = motion_error(
    "probing_not_initialised",
    50_050,
    "the probe was not ready when the measuring block began",
    "block number",
    "current value",
)
PROBE_ALREADY_OPERATED: Final[ErrorSheet] = motion_error(
    "probe_already_operated",
    50_052,
    "the probing signal of axis {0} already is {2} before the run starts",
    "logical axis number",
    "block number",
    "level behind the edge",
)
PROBE_EVENT_TOO_EARLY: Final[ErrorSheet] = motion_error(
    "probe_event_too_early",
    50_053,
    "probe event of axis {4} before the measuring block",
    "upper limit",
    "upper limit 2",
    "block number",
    "upper limit 3",
    details=("logical axis number",),
)
NO_END_OF_SHORT_CUT: Final[ErrorSheet] = warning(
    "no_end_of_short_cut",
    50_810,
    "distance to go deleted, and no motion follows: the path ends where it stands",
    "current value",
)
SHORT_CUT_ENDED: Final[ErrorSheet] = warning(
    "short_cut_ended",
    51_036,
    "distance to go deleted, and a block follows that no short cut passes: the line leads to where it begins",
    "block number",
)
NO_MEASUREMENT: Final[ErrorSheet] = message(
    "no_measurement",
    50_057,
    "measuring run without probing signal, axis {0}",
    "logical axis number",
    classes=(6, 6),
)
MEASURING_ALREADY_SELECTED: Final[ErrorSheet] = motion_error(
    "measuring_already_selected", 50_058, "measuring is already selected for edge banding"
)
NOT_A_MEASUREMENT_AXIS: Final[ErrorSheet] = motion_error(
    "not_a_measurement_axis",
    50_059,
    "axis {0} is not a measurement axis (P-AXIS-00118)",
    "logical axis number",
)
TOO_MANY_MEASURING_AXES: Final[ErrorSheet] = motion_error(
    "too_many_measuring_axes",
    50_061,
    "{0} axes in the measuring block, type {2} allows {1}",
    "programmed axes",
    "allowed axes",
    "measurement type",
)
NO_MEASUREMENT_MODAL: Final[ErrorSheet] = warning(
    "no_measurement_modal", 50_063, "edge banding: no probing signal"
)
NO_MOTION_INFORMATION: Final[ErrorSheet] = motion_error(
    "no_motion_information", 50_067, "measuring run without motion"
)
SPEED_LIMIT: Final[ErrorSheet] = motion_error(
    "speed_limit",
    50_118,
    "axis {0} exceeds its largest speed",
    "logical axis number",
    "current value [µm/s, 0.001°/s]",
    "upper limit [µm/s, 0.001°/s]",
    "current value",
    "upper limit",
)
HOMING_BLOCK_SEARCH: Final[ErrorSheet] = warning("homing_block_search", 50_168, "homing during block search")
MEASURING_BLOCK_SEARCH: Final[ErrorSheet] = message(
    "measuring_block_search", 50_172, "measuring during block search", classes=(2, 1)
)
VIRTUAL_AND_REAL_AXES: Final[ErrorSheet] = motion_error(
    "virtual_and_real_axes",
    50_262,
    "virtual and other axes in one measuring run",
    "current value",
    "current value 2",
)
IDENT_NOT_WRITABLE: Final[ErrorSheet] = motion_error(
    "ident_not_writable",
    50_357,
    "drive parameter {1} of axis {0} cannot be changed",
    "logical axis number",
    "ident",
    "SERCOS value 1",
    "SERCOS value 2",
)
FIXED_STOP_REFERENCE_NOT_FOUND: Final[ErrorSheet] = message(
    "fixed_stop_reference_not_found",
    50_508,
    "homing to a fixed stop: no stop found by axis {0}",
    "logical axis number",
    "current value",
    "limit [0.1 µm, 0.0001°]",
    classes=(6, 6),
)
FIXED_STOP_PARAMETERS: Final[ErrorSheet] = motion_error(
    "fixed_stop_parameters",
    50_529,
    "{1} = {2} of axis {0} does not go with a run to a fixed stop (type {3}, {4} measuring axes)",
    "logical axis number",
    "parameter",
    "value",
    "measurement type",
    "measuring axes",
)
MODAL_MEASURING_OPEN: Final[ErrorSheet] = motion_error(
    "modal_measuring_open", 50_573, "modal measuring was not switched off"
)
MEAS_NOT_A_MEASUREMENT_AXIS: Final[ErrorSheet] = motion_error(
    "meas_not_a_measurement_axis",
    50_637,
    "#MEAS: axis {0} is not a measurement axis",
    "logical axis number",
    "wrong value",
    "current value",
    "current value 2",
    "current value 3",
)
MEAS_SIGNAL_NOT_SUPPORTED: Final[ErrorSheet] = motion_error(
    "meas_signal_not_supported",
    50_638,
    "#MEAS: the drive of axis {0} does not support this probing signal",
    "logical axis number",
    "drive type",
    "wrong value",
)
MEAS_INPUT_INVALID: Final[ErrorSheet] = motion_error(
    "meas_input_invalid",
    50_639,
    "#MEAS: probing input {2} of axis {0} is not valid",
    "logical axis number",
    "drive type",
    "input",
    "upper limit",
)
MEAS_RUN_ACTIVE: Final[ErrorSheet] = motion_error(
    "meas_run_active", 50_641, "#MEAS: a measuring run is active"
)
INDEPENDENT_NOT_INITIALISED: Final[ErrorSheet] = motion_error(
    "independent_not_initialised",
    50_664,
    "independent axis {0}: the measuring hardware was not ready in time",
    "logical axis number",
)
SYNCHRONISATION_ACCELERATION: Final[ErrorSheet] = warning(
    "synchronisation_acceleration",
    50_685,
    "the synchronisation axis would need too much acceleration",
    "acceleration path [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "limit [µm/s, 0.001°/s]",
    "identification",
)
HOMING_DISABLED: Final[ErrorSheet] = message(
    "homing_disabled",
    50_686,
    "axis {0} may not be homed (P-AXIS-00299 DISABLED)",
    "logical axis number",
    "drive type",
    "homing type",
    classes=(6, 6),
)
INDEPENDENT_NO_MEASUREMENT: Final[ErrorSheet] = message(
    "independent_no_measurement",
    50_706,
    "axis {0}: no probing signal on the way to the software limit (P-CHAN-00268)",
    "logical axis number",
    classes=(6, 6),
)
HOMING_BLOCK_SEARCH_2: Final[ErrorSheet] = message(
    "homing_block_search_2", 50_717, "G74 is not allowed during block search", "current value", classes=(2, 7)
)
MEASURING_BLOCK_SEARCH_2: Final[ErrorSheet] = message(
    "measuring_block_search_2",
    50_718,
    "G100 is not allowed during block search",
    "current value",
    classes=(2, 7),
)
MEASURING_ACTIVE_2: Final[ErrorSheet] = motion_error(
    "measuring_active_2", 50_833, "the measuring function is already active"
)
MEASURING_NOT_INITIALISED_2: Final[ErrorSheet] = message(
    "measuring_not_initialised_2", 50_834, "the measuring function was not initialised", classes=(4, 8)
)
FIXED_STOP_BACKWARD_OFF: Final[ErrorSheet] = message(
    "fixed_stop_backward_off",
    50_881,
    "move to fixed stop needs the backward memory (P-STUP-00033)",
    classes=(2, 7),
)
FIXED_STOP_DELETE_DISTANCE: Final[ErrorSheet] = message(
    "fixed_stop_delete_distance", 50_882, "no delete distance to go during move to fixed stop", classes=(6, 7)
)
FIXED_STOP_ACTUAL_POSITION: Final[ErrorSheet] = motion_error(
    "fixed_stop_actual_position",
    50_884,
    "no actual position request for axis {0}: it moves to a fixed stop",
    "logical axis number",
    "current value",
    "current value 2",
)
FIXED_STOP_ACTIVE: Final[ErrorSheet] = motion_error(
    "fixed_stop_active",
    50_885,
    "move to fixed stop is already active for axis {0}",
    details=("logical axis number",),
)
FIXED_STOP_NOT_FOUND: Final[ErrorSheet] = motion_error(
    "fixed_stop_not_found",
    50_886,
    "fixed stop not found by axis {0}",
    "logical axis number",
    "start [0.1 %]",
    "end [0.1 %]",
)
FIXED_STOP_PROGRAMMED_AGAIN: Final[ErrorSheet] = motion_error(
    "fixed_stop_programmed_again",
    50_889,
    "axis {0} stands at its fixed stop and may not be programmed",
    "logical axis number",
    "current value",
    "wrong value",
    "wrong value 2",
    "block number",
)
FIXED_STOP_START_TOO_LARGE: Final[ErrorSheet] = message(
    "fixed_stop_start_too_large",
    51_026,
    "start of the stop detection is {1} per mille of the block, axis {0}: more than 1000",
    "logical axis number",
    "start value [0.1 %]",
    "upper limit [0.1 %]",
    classes=(2, 3),
    source="measurement manual 8.2.2: the program is aborted; the diagnosis book prints a warning",
)
NO_SIGNAL_IGNORED: Final[ErrorSheet] = warning(
    "no_signal_ignored",
    51_058,
    "ERR_NO_SIGNAL does not act in a run that ended by delete distance to go",
)
MOTION_NEEDS_HOMING: Final[ErrorSheet] = message(
    "motion_needs_homing",
    51_082,
    "axis {0} is not homed and may not be moved by the program (P-AXIS-00277)",
    "logical axis number",
    classes=(6, 6),
)
