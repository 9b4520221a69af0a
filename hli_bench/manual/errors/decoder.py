"""Messages of the decoder (20xxx to 22xxx): NC syntax, variables, measuring commands."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, message, program_error, warning

NO_AXIS_PROGRAMMED: Final[ErrorSheet] = warning(
    "no_axis_programmed", 20_003, "this G function needs a programmed axis", "current value"
)
FEED_ZERO: Final[ErrorSheet] = program_error("feed_zero", 20_008, "motion block without feed")
COORDINATE_FORMAT: Final[ErrorSheet] = program_error(
    "coordinate_format",
    20_011,
    "coordinate {3} of axis {0} is out of the data format",
    "logical axis number",
    "lower limit [0.1 µm, 0.0001°]",
    "upper limit [0.1 µm, 0.0001°]",
    "coordinate [0.1 µm, 0.0001°]",
    "further coordinate [0.1 µm, 0.0001°]",
)
DWELL_TIME_FORMAT: Final[ErrorSheet] = program_error(
    "dwell_time_format",
    20_015,
    "dwell time is out of the data format",
    "wrong value [µs]",
    "lower limit [µs]",
    "upper limit [µs]",
)
DWELL_TIME_NEGATIVE: Final[ErrorSheet] = warning(
    "dwell_time_negative", 20_017, "negative dwell time", "wrong value [µs]"
)
OFFSET_NOT_REQUESTED: Final[ErrorSheet] = program_error(
    "offset_not_requested",
    20_024,
    "G101 without a measured value: no measuring run has latched one for axis {0}",
    details=("axis name",),
)
MEASURING_UNDER_TRC: Final[ErrorSheet] = program_error(
    "measuring_under_trc", 20_049, "measuring while the tool radius compensation is active"
)
OFFSET_ALREADY_INCLUDED: Final[ErrorSheet] = program_error(
    "offset_already_included",
    20_050,
    "axis {1} still includes an older measured offset",
    "logical axis number",
    details=("axis name",),
)
HOMING_IN_MANUAL_MODE: Final[ErrorSheet] = program_error(
    "homing_in_manual_mode", 20_051, "homing of an axis in manual mode", "logical axis number"
)
COMMAND_NEEDS_AXES: Final[ErrorSheet] = program_error("command_needs_axes", 20_052, "the command needs axes")
OFFSET_FORMAT: Final[ErrorSheet] = program_error(
    "offset_format",
    20_075,
    "with the measured offset the coordinate of axis {3} is out of the data format",
    "logical axis number",
    "lower limit",
    "upper limit",
    details=("axis name",),
)
VARIABLE_UNKNOWN_AXIS: Final[ErrorSheet] = program_error(
    "variable_unknown_axis", 20_092, "variable {0}: unknown axis", details=("variable",)
)
VARIABLE_READ_DENIED: Final[ErrorSheet] = program_error(
    "variable_read_denied", 20_097, "variable {0} may not be read", details=("variable",)
)
VARIABLE_WRITE_DENIED: Final[ErrorSheet] = program_error(
    "variable_write_denied", 20_100, "variable {0} may not be written", details=("variable",)
)
BLOCK_NUMBER_TWICE: Final[ErrorSheet] = program_error(
    "block_number_twice", 20_105, "two block numbers in a block"
)
BLOCK_NUMBER_FORMAT: Final[ErrorSheet] = program_error(
    "block_number_format",
    20_106,
    "block number is out of the data format",
    "wrong value",
    "lower limit",
    "upper limit",
)
G_NUMBER_FORMAT: Final[ErrorSheet] = program_error(
    "g_number_format",
    20_107,
    "number of a G function is out of the data format",
    "wrong value",
    "lower limit",
    "upper limit",
)
MOTION_MODE_TWICE: Final[ErrorSheet] = program_error(
    "motion_mode_twice", 20_108, "two motion modes in a block", "wrong value"
)
MEASURING_FUNCTION_TWICE: Final[ErrorSheet] = program_error(
    "measuring_function_twice", 20_123, "two measuring functions in a block", "G function"
)
UNKNOWN_G_FUNCTION: Final[ErrorSheet] = program_error(
    "unknown_g_function", 20_131, "unknown G function {0}", "G function"
)
HOMING_WHILE_COUPLED: Final[ErrorSheet] = program_error(
    "homing_while_coupled", 20_137, "G74 while an axis coupling is active", "wrong value"
)
G100_WRONG_TYPE: Final[ErrorSheet] = program_error(
    "g100_wrong_type", 20_138, "G100 is not allowed with measurement type {0}", details=("measurement type",)
)
M_NUMBER_FORMAT: Final[ErrorSheet] = program_error(
    "m_number_format",
    20_154,
    "number of an M function is out of the data format",
    "wrong value",
    "limit",
    "limit 2",
)
UNKNOWN_M_FUNCTION: Final[ErrorSheet] = program_error(
    "unknown_m_function", 20_157, "unknown M function {0}", "M function"
)
PROGRAM_END_TWICE: Final[ErrorSheet] = program_error(
    "program_end_twice", 20_158, "two program ends in a block", "current value"
)
FEED_TWICE: Final[ErrorSheet] = program_error("feed_twice", 20_175, "two F words in a block")
FEED_NOT_POSITIVE: Final[ErrorSheet] = program_error(
    "feed_not_positive", 20_176, "feed {0} is zero or negative", "feed"
)
PERCENT_IN_MAIN_PROGRAM: Final[ErrorSheet] = program_error(
    "percent_in_main_program", 20_193, "percent sign inside the main program"
)
ASSIGNMENT_MISSING: Final[ErrorSheet] = program_error(
    "assignment_missing", 20_194, "an assignment is missing or unknown"
)
UNKNOWN_VARIABLE: Final[ErrorSheet] = program_error(
    "unknown_variable", 20_196, "unknown variable {0}", details=("variable",)
)
VARIABLE_INDEX: Final[ErrorSheet] = program_error(
    "variable_index",
    20_197,
    "index {0} of variable {3} is out of range",
    "index",
    "lower limit",
    "upper limit",
    details=("variable",),
)
VARIABLE_BRACKET_MISSING: Final[ErrorSheet] = program_error(
    "variable_bracket_missing", 20_198, "variable {0}: closing bracket missing", details=("variable",)
)
COMMAND_OR_AXIS_EXPECTED: Final[ErrorSheet] = program_error(
    "command_or_axis_expected", 20_200, "a command or an axis name is expected at {0}", details=("text",)
)
AXIS_TWICE: Final[ErrorSheet] = program_error(
    "axis_twice",
    20_203,
    "axis {1} is programmed twice in a block",
    "logical axis number",
    details=("axis name",),
)
DOLLAR_NOT_ALONE: Final[ErrorSheet] = program_error(
    "dollar_not_alone", 20_206, "a $ command must stand alone in its block"
)
HASH_NOT_ALONE: Final[ErrorSheet] = program_error(
    "hash_not_alone", 20_207, "a # command must stand alone in its block"
)
UNKNOWN_DOLLAR_COMMAND: Final[ErrorSheet] = program_error(
    "unknown_dollar_command", 20_209, "unknown control statement {0}", details=("text",)
)
NESTING_TOO_DEEP: Final[ErrorSheet] = program_error(
    "nesting_too_deep", 20_211, "control statements are nested too deeply", "limit"
)
IF_NOT_ALONE: Final[ErrorSheet] = program_error("if_not_alone", 20_212, "only the condition may follow $IF")
ELSE_UNEXPECTED: Final[ErrorSheet] = program_error("else_unexpected", 20_214, "$ELSE without $IF")
ELSE_NOT_ALONE: Final[ErrorSheet] = program_error(
    "else_not_alone", 20_215, "$ELSE must stand alone in its block"
)
ELSEIF_UNEXPECTED: Final[ErrorSheet] = program_error("elseif_unexpected", 20_216, "$ELSEIF without $IF")
ELSEIF_NOT_ALONE: Final[ErrorSheet] = program_error(
    "elseif_not_alone", 20_217, "only the condition may follow $ELSEIF"
)
ENDIF_UNEXPECTED: Final[ErrorSheet] = program_error("endif_unexpected", 20_218, "$ENDIF without $IF")
ENDIF_NOT_ALONE: Final[ErrorSheet] = program_error(
    "endif_not_alone", 20_219, "$ENDIF must stand alone in its block"
)
SWITCH_NOT_ALONE: Final[ErrorSheet] = program_error(
    "switch_not_alone", 20_220, "only the condition may follow $SWITCH"
)
CASE_UNEXPECTED: Final[ErrorSheet] = program_error("case_unexpected", 20_221, "$CASE without $SWITCH")
DEFAULT_UNEXPECTED: Final[ErrorSheet] = program_error(
    "default_unexpected", 20_223, "$DEFAULT without $SWITCH"
)
ENDSWITCH_UNEXPECTED: Final[ErrorSheet] = program_error(
    "endswitch_unexpected", 20_225, "$ENDSWITCH without $SWITCH"
)
FOR_COUNTER: Final[ErrorSheet] = program_error(
    "for_counter", 20_227, "$FOR counts with P or V variables only"
)
FOR_EQUALS_MISSING: Final[ErrorSheet] = program_error(
    "for_equals_missing", 20_228, "$FOR: an equals sign must follow the counter"
)
FOR_COMMA_MISSING: Final[ErrorSheet] = program_error("for_comma_missing", 20_229, "$FOR: a comma is expected")
FOR_NOT_ALONE: Final[ErrorSheet] = program_error(
    "for_not_alone", 20_230, "only counter and limits may follow $FOR"
)
ENDFOR_UNEXPECTED: Final[ErrorSheet] = program_error("endfor_unexpected", 20_232, "$ENDFOR without $FOR")
WHILE_NOT_ALONE: Final[ErrorSheet] = program_error(
    "while_not_alone", 20_235, "only the condition may follow $WHILE"
)
ENDWHILE_UNEXPECTED: Final[ErrorSheet] = program_error(
    "endwhile_unexpected", 20_237, "$ENDWHILE without $WHILE"
)
ENDDO_UNEXPECTED: Final[ErrorSheet] = program_error("enddo_unexpected", 20_240, "$ENDDO without $DO")
BREAK_UNEXPECTED: Final[ErrorSheet] = program_error(
    "break_unexpected", 20_243, "$BREAK outside a control statement"
)
CONTINUE_UNEXPECTED: Final[ErrorSheet] = program_error(
    "continue_unexpected", 20_244, "$CONTINUE outside a control statement"
)
SUBROUTINE_STACK: Final[ErrorSheet] = program_error(
    "subroutine_stack", 20_361, "too many local subroutines inside one another", "limit"
)
MAIN_PROGRAM_NOT_FOUND: Final[ErrorSheet] = message(
    "main_program_not_found", 20_368, "main program not found", classes=(2, 6)
)
GLOBAL_SUBROUTINE_NOT_FOUND: Final[ErrorSheet] = program_error(
    "global_subroutine_not_found", 20_369, "global subroutine {0} not found", details=("name",)
)
LOCAL_SUBROUTINE_NOT_FOUND: Final[ErrorSheet] = program_error(
    "local_subroutine_not_found", 20_373, "local subroutine {0} not found", details=("name",)
)
CONTROL_STATEMENT_OPEN: Final[ErrorSheet] = warning(
    "control_statement_open",
    20_375,
    "a control statement is open at the end of the program",
    "open control statements",
    "first keyword",
    "closing keyword",
)
SUBROUTINE_END_UNEXPECTED: Final[ErrorSheet] = warning(
    "subroutine_end_unexpected", 20_376, "M17 or M29 outside a subroutine"
)
PROGRAM_END_UNEXPECTED: Final[ErrorSheet] = warning(
    "program_end_unexpected", 20_377, "M02 or M30 outside the main program"
)
COMMAND_UNKNOWN_AXIS: Final[ErrorSheet] = program_error(
    "command_unknown_axis", 20_381, "# command: unknown axis {0}", details=("axis name",)
)
FUNCTION_BRACKET_EXPECTED: Final[ErrorSheet] = program_error(
    "function_bracket_expected", 20_387, "an opening bracket must follow a function name"
)
UNKNOWN_TERM: Final[ErrorSheet] = program_error(
    "unknown_term", 20_392, "unknown term in an expression at {0}", details=("text",)
)
VARIABLE_SYNTAX: Final[ErrorSheet] = program_error(
    "variable_syntax", 20_394, "variable cannot be identified: {0}", details=("text",)
)
DIVISION_BY_ZERO: Final[ErrorSheet] = program_error(
    "division_by_zero", 20_396, "division by zero", "wrong value"
)
FUNCTION_BRACKET_MISSING: Final[ErrorSheet] = program_error(
    "function_bracket_missing",
    20_397,
    "closing bracket after the argument of a function is missing",
    "current value",
)
NEGATIVE_ROOT: Final[ErrorSheet] = program_error(
    "negative_root", 20_398, "square root of a negative number", "wrong value"
)
LOGARITHM: Final[ErrorSheet] = program_error(
    "logarithm", 20_399, "logarithm of zero or a negative number", "wrong value"
)
P_PARAMETER_NUMBER: Final[ErrorSheet] = program_error(
    "p_parameter_number", 20_400, "number of a P parameter is out of range", "wrong value", "limit"
)
CHANNEL_MEASURING_TYPE: Final[ErrorSheet] = warning(
    "channel_measuring_type",
    20_437,
    "channel list: measurement type {0} is not allowed",
    "measurement type",
    "corrected value",
)
COUPLING_GROUP_RANGE: Final[ErrorSheet] = program_error(
    "coupling_group_range",
    20_461,
    "number of the coupling group is out of range",
    "wrong value",
    "lower limit",
    "upper limit",
)
COUPLING_GROUP_EMPTY: Final[ErrorSheet] = program_error(
    "coupling_group_empty", 20_464, "the coupling group has no coupling", "wrong value"
)
COUPLING_MASTER_MISSING: Final[ErrorSheet] = program_error(
    "coupling_master_missing",
    20_465,
    "master axis {1} is not in the channel",
    "logical axis number",
    details=("axis name",),
)
COUPLING_SLAVE_MISSING: Final[ErrorSheet] = program_error(
    "coupling_slave_missing",
    20_466,
    "slave axis {1} is not in the channel",
    "logical axis number",
    details=("axis name",),
)
COUPLING_MASTER_IS_SLAVE: Final[ErrorSheet] = program_error(
    "coupling_master_is_slave",
    20_475,
    "an axis cannot be coupled to itself",
    "logical axis number",
    "current value",
    "current value 2",
)
COUPLING_CHAIN: Final[ErrorSheet] = program_error(
    "coupling_chain", 20_477, "a master axis is a slave axis of another coupling", "logical axis number"
)
UNKNOWN_HASH_COMMAND: Final[ErrorSheet] = program_error(
    "unknown_hash_command", 20_509, "unknown # command {1}", "state", details=("text",)
)
COMMENT_BEGIN_NOT_ALONE: Final[ErrorSheet] = program_error(
    "comment_begin_not_alone", 20_566, "#COMMENT BEGIN must stand alone in its block"
)
COMMENT_END_UNEXPECTED: Final[ErrorSheet] = program_error(
    "comment_end_unexpected", 20_567, "#COMMENT END without #COMMENT BEGIN"
)
COMMENT_OPEN: Final[ErrorSheet] = program_error("comment_open", 20_568, "the file ends inside a comment")
CS_SYNTAX: Final[ErrorSheet] = program_error("cs_syntax", 20_675, "syntax of #CS: {0}", details=("text",))
CS_ANGLE: Final[ErrorSheet] = program_error(
    "cs_angle",
    20_676,
    "angle of #CS is not allowed",
    "wrong value [0.1 µm, 0.0001°]",
    "lower limit",
    "upper limit",
)
MESSAGE_QUOTES: Final[ErrorSheet] = program_error(
    "message_quotes", 20_715, "the text of #MSG must stand in quotation marks"
)
BRACKET_OR_COMMA_EXPECTED: Final[ErrorSheet] = program_error(
    "bracket_or_comma_expected", 20_716, "closing bracket or comma expected"
)
MESSAGE_RECEIVER: Final[ErrorSheet] = program_error(
    "message_receiver",
    20_718,
    "#MSG: unknown receiver {0}",
    "receiver",
    "receiver of the CNC",
    "receiver of the PLC",
    "receiver of the HMI",
)
MESSAGE_VALUES: Final[ErrorSheet] = program_error(
    "message_values", 20_721, "#MSG: number of values and of format specifiers differ", "format specifiers"
)
MESSAGE_TOO_MANY_VALUES: Final[ErrorSheet] = program_error(
    "message_too_many_values", 20_724, "#MSG: too many values", "limit", "current value"
)
MESSAGE_EXPRESSION_EXPECTED: Final[ErrorSheet] = program_error(
    "message_expression_expected", 20_726, "#MSG: an expression must follow a comma"
)
HASH_BRACKET_EXPECTED: Final[ErrorSheet] = program_error(
    "hash_bracket_expected", 20_743, "an opening bracket must follow the # command"
)
G_WRONG_TYPE: Final[ErrorSheet] = program_error(
    "g_wrong_type",
    20_772,
    "this G function is not allowed with measurement type {1}",
    "G function",
    "measurement type",
)
MEASURING_TYPE_RANGE: Final[ErrorSheet] = program_error(
    "measuring_type_range",
    20_773,
    "measurement type {0} is out of range",
    "measurement type",
    "lower limit",
    "upper limit",
)
OFFSET_NOT_INCLUDED: Final[ErrorSheet] = program_error(
    "offset_not_included",
    20_814,
    "G102: axis {1} includes no measured offset",
    "logical axis number",
    details=("axis name",),
)
HOMING_RANK_RANGE: Final[ErrorSheet] = program_error(
    "homing_rank_range",
    20_816,
    "rank of homing is out of range",
    "logical axis number",
    "rank",
    "lower limit",
    "upper limit",
)
CS_ID: Final[ErrorSheet] = program_error(
    "cs_id",
    20_820,
    "coordinate system number is not allowed",
    "wrong value",
    "lower limit",
    "upper limit",
    "upper limit 2",
)
CS_PARAMETERS_MISSING: Final[ErrorSheet] = program_error(
    "cs_parameters_missing", 20_822, "a coordinate system is defined without parameters"
)
CS_OFF_WITHOUT_ON: Final[ErrorSheet] = warning(
    "cs_off_without_on", 20_824, "no coordinate system to switch off"
)
CS_STACK: Final[ErrorSheet] = program_error(
    "cs_stack",
    20_826,
    "too many coordinate systems are stored",
    "most systems of #CS ON",
    "most systems of #ACS ON",
)
LABEL_LENGTH: Final[ErrorSheet] = message(
    "label_length", 20_833, "label is too long", "limit", classes=(1, 3)
)
LABEL_TWICE: Final[ErrorSheet] = program_error(
    "label_twice", 20_836, "label {0} is defined twice", details=("label",)
)
GOTO_LABEL_LENGTH: Final[ErrorSheet] = program_error(
    "goto_label_length", 20_837, "label after $GOTO is too long", "longest label"
)
GOTO_CHARACTER: Final[ErrorSheet] = program_error(
    "goto_character", 20_839, "character after $GOTO is not allowed"
)
LABEL_NOT_FOUND: Final[ErrorSheet] = program_error(
    "label_not_found", 20_840, "label {0} not found", details=("label",)
)
UNKNOWN_AXIS: Final[ErrorSheet] = program_error(
    "unknown_axis", 20_875, "unknown axis {0}", details=("axis name",)
)
VARIABLE_NOT_DECLARED: Final[ErrorSheet] = program_error(
    "variable_not_declared", 20_932, "variable {0} does not exist", "variable"
)
INTERRUPTIBLE_TWICE: Final[ErrorSheet] = program_error(
    "interruptible_twice", 20_953, "G310 twice in a block", "wrong value"
)
CIRCLE_WHILE_MEASURING: Final[ErrorSheet] = program_error(
    "circle_while_measuring", 20_954, "a circle in a measuring block"
)
INTERRUPTIBLE_COMMAND: Final[ErrorSheet] = program_error(
    "interruptible_command", 20_955, "the command is not allowed together with G310"
)
INTERRUPTIBLE_TYPE: Final[ErrorSheet] = program_error(
    "interruptible_type",
    20_956,
    "G310 with jump is not allowed with measurement type {0}",
    "measurement type",
)
INDEPENDENT_SYNTAX: Final[ErrorSheet] = program_error(
    "independent_syntax", 21_068, "syntax of an independent axis: {0}", details=("text",)
)
INDEPENDENT_TRANSFORMATION: Final[ErrorSheet] = program_error(
    "independent_transformation",
    21_071,
    "independent axes while a transformation is active",
    "logical axis number",
    "current value",
    "wrong value",
)
IDENT_TWICE: Final[ErrorSheet] = program_error("ident_twice", 21_089, "keyword twice in #IDENT")
IDENT_NUMBER: Final[ErrorSheet] = program_error(
    "ident_number", 21_090, "ident number of #IDENT: {0}", details=("text",)
)
COMMAND_INCOMPLETE: Final[ErrorSheet] = program_error(
    "command_incomplete", 21_104, "the command is not complete", "wrong value"
)
AXIS_COMMAND_SYNTAX: Final[ErrorSheet] = program_error(
    "axis_command_syntax", 21_107, "syntax of an axis command: {0}", details=("text",)
)
PROGRAM_END_MISSING: Final[ErrorSheet] = program_error("program_end_missing", 21_129, "M02 or M30 is missing")
SUBROUTINE_END_MISSING: Final[ErrorSheet] = program_error(
    "subroutine_end_missing", 21_130, "M17 or M29 is missing"
)
INDEPENDENT_DIMENSION_MISSING: Final[ErrorSheet] = program_error(
    "independent_dimension_missing", 21_164, "independent axis: G90 or G91 is missing"
)
INDEPENDENT_FEED_MISSING: Final[ErrorSheet] = program_error(
    "independent_feed_missing", 21_165, "independent axis: feed or time is missing"
)
COMPARISON_ASSIGNMENT: Final[ErrorSheet] = program_error(
    "comparison_assignment", 21_199, "a condition compares with '=' instead of '=='"
)
MEAS_KEYWORD_TWICE: Final[ErrorSheet] = program_error("meas_keyword_twice", 21_418, "keyword twice in #MEAS")
INDEPENDENT_MEASURING_TYPE: Final[ErrorSheet] = program_error(
    "independent_measuring_type",
    21_588,
    "independent axes measure with types 1, 2 and 7 only",
    "logical axis number",
    "wrong value",
)
TRIGGER_WITHOUT_EDGE_BANDING: Final[ErrorSheet] = program_error(
    "trigger_without_edge_banding", 21_608, "TRIGGER without modal edge banding"
)
MEAS_KEYWORDS_TYPE: Final[ErrorSheet] = program_error(
    "meas_keywords_type", 21_925, "keywords of #MEAS do not fit the measurement type", "wrong value"
)
FIXED_STOP_ACTUAL_POSITION: Final[ErrorSheet] = program_error(
    "fixed_stop_actual_position",
    21_964,
    "no actual position request for axis {0}: it moves to a fixed stop",
    details=("axis name",),
)
FIXED_STOP_NO_MOTION: Final[ErrorSheet] = program_error(
    "fixed_stop_no_motion", 21_966, "move to fixed stop without motion of axis {0}", details=("axis name",)
)
FIXED_STOP_PROGRAMMED_AGAIN: Final[ErrorSheet] = program_error(
    "fixed_stop_programmed_again",
    21_967,
    "axis {0} stands at its fixed stop and may not be programmed",
    details=("axis name",),
)
FIXED_STOP_START_END: Final[ErrorSheet] = program_error(
    "fixed_stop_start_end",
    21_968,
    "START and END of move to fixed stop are out of range",
    "value [0.1 %]",
    "lower limit [0.1 %]",
    "upper limit [0.1 %]",
)
FIXED_STOP_ACTIVE: Final[ErrorSheet] = program_error(
    "fixed_stop_active", 21_969, "move to fixed stop is already active for axis {0}", details=("axis name",)
)
FIXED_STOP_RELEASE: Final[ErrorSheet] = program_error(
    "fixed_stop_release",
    21_970,
    "axis {0} moves to a fixed stop and may not be released",
    details=("axis name",),
)
TRANSFORMED_VALUES: Final[ErrorSheet] = warning(
    "transformed_values",
    22_014,
    "axis {0} of the transformation delivered no signal: no measured value is taken over",
    "logical axis number",
)
HOMING_COUPLE_KINEMATICS: Final[ErrorSheet] = program_error(
    "homing_couple_kinematics",
    22_091,
    "G74 with couple kinematics",
    "wrong value",
    "logical axis number",
    "current value",
)
