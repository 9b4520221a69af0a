"""The words of the NC dialect: which are built, and of the others what is missing. The decoder reads these tables.

Sources: TF5200 programming manual 1.32 (G and M functions, '#' commands, '$' statements, axis commands, variables),
measurement, homing and fixed stop manuals, #MEAS page. A word that stands in no table is not one of the dialect.
"""

from collections.abc import Mapping
from typing import Final

from hli_bench.manual import nc_variables

BUILT: Final = ""
"""Stands for a word that is built; any other text says what a word that is not built belongs to."""

_CIRCLES = "circles"
_THREADS = "thread cutting and tapping"
_RADIUS = "tool radius compensation"
_SMOOTHING = "smoothing and polynomial contouring"
_WEIGHTING = "weighting of the dynamics by the program"
_OFFSETS = "zero offsets"
_MIRROR = "mirroring"
_MANUAL = "manual mode by the program"
_BANDING = "edge banding"
_JUMP = "measuring with a jump"
_SUBROUTINES = "subroutines and cycles"
_SPINDLES = "spindles"
_TOOLS = "tools"
_LINKS = "axis links and axis exchange"
_TRAFO = "kinematic transformations"
_LOOK_AHEAD = "settings of the look-ahead"
_ROTATION = "contour rotation"
_SPLINES = "splines"
_TURNING = "turning functions"
_GEAR = "gear steps"
_SYNCHRONISING = "synchronising channels and the program"
_MACRO = "macros and configuration by the program"
_PUNCHING = "punching and nibbling"
_STRINGS = "strings"

G_FUNCTIONS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("G0", "G1", "G4", "G74", "G90", "G91", "G92", "G100", "G101", "G102"), BUILT),
    **dict.fromkeys(("G17", "G40", "G71", "G94"), BUILT),
    **dict.fromkeys(("G2", "G3", "G161", "G162", "G163", "G164", "G165", "G303"), _CIRCLES),
    **dict.fromkeys(("G5", "G10", "G11", "G25", "G26", "G41", "G42", "G138", "G139"), _RADIUS),
    **dict.fromkeys(("G140", "G141", "G236", "G237", "G238", "G239"), _RADIUS),
    **dict.fromkeys(("G8", "G9", "G193", "G293", "G900", "G901"), "acceleration over block transitions"),
    **dict.fromkeys(("G12", "G13"), "corner deceleration"),
    **dict.fromkeys(("G18", "G19"), "other planes"),
    **dict.fromkeys(("G20", "G21", "G22", "G23", "G351"), _MIRROR),
    **dict.fromkeys(("G33", "G63", "G331", "G332"), _THREADS),
    "G43": "tool length compensation",
    **dict.fromkeys(("G51", "G52"), "diameter programming"),
    **dict.fromkeys((f"G{number}" for number in (*range(53, 60), 159, 160)), _OFFSETS),
    **dict.fromkeys(("G60", "G359", "G360"), "exact stop"),
    **dict.fromkeys(("G61", "G260", "G261"), _SMOOTHING),
    "G66": "synchronising a block's end with the cycle",
    **dict.fromkeys(("G68", "G69"), _ROTATION),
    "G70": "inch",
    "G75": "homing by drive",
    **dict.fromkeys((f"G{number}" for number in (*range(80, 90), *range(800, 840))), _SUBROUTINES),
    **dict.fromkeys(("G93", "G95", "G194"), "feed by time, by turn or in percent"),
    **dict.fromkeys(("G96", "G97", "G196"), "constant cutting speed"),
    **dict.fromkeys(("G98", "G99"), "software limits by the program"),
    "G106": "travelling on to the target in measurement type 3",
    **dict.fromkeys(("G107", "G108"), _BANDING),
    "G112": _GEAR,
    **dict.fromkeys(("G115", "G116", "G117"), _LOOK_AHEAD),
    **dict.fromkeys((f"G{number}" for number in (*range(127, 135), 230, 231, 233)), _WEIGHTING),
    **dict.fromkeys(("G333", "G334", "G338", "G339"), _WEIGHTING),
    **dict.fromkeys(("G135", "G136", "G137"), "feedforward"),
    **dict.fromkeys(("G150", "G151"), _SPLINES),
    **dict.fromkeys(("G166", "G167"), "override set to 100 %"),
    **dict.fromkeys(("G200", "G201", "G202"), _MANUAL),
    **dict.fromkeys(("G210", "G310"), _JUMP),
    **dict.fromkeys(("G301", "G302"), "chamfers and roundings"),
}
"""G functions without leading zeros."""

M_FUNCTIONS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("M2", "M30"), BUILT),
    "M0": "stopping for the operator",
    "M1": "optional stop",
    **dict.fromkeys(("M3", "M4", "M5", "M19"), _SPINDLES),
    "M6": _TOOLS,
    **dict.fromkeys(("M17", "M29"), _SUBROUTINES),
    **dict.fromkeys((f"M{number}" for number in range(40, 46)), _GEAR),
}
TECHNOLOGY: Final = "technology functions"
"""What every other M and H function is."""

LETTERS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("F", "G", "M", "N", "P"), BUILT),
    **dict.fromkeys(("I", "J", "K", "R"), _CIRCLES),
    "E": "feed at the end of a block",
    "H": TECHNOLOGY,
    "L": _SUBROUTINES,
    "S": _SPINDLES,
    **dict.fromkeys(("T", "D"), _TOOLS),
}
"""Address letters beside the axes."""

SIGNS: Final[Mapping[str, str]] = {
    "@": "parameters of cycles",
    '"': "macros",
    "[": "labels",
    "/": "skipping blocks",
    "%L": _SUBROUTINES,
    "'": "numbers with another base",
}
"""What else a word can begin with."""

COMMANDS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("CHANNEL", "COMMENT", "CS", "DRIVE", "MEAS", "MSG"), BUILT),
    **dict.fromkeys(("ACHSE", "AX", "CALL", "DISABLE", "ENABLE", "PUT", "SET"), _LINKS),
    "GANTRY": "gantry by the program",
    "GEAR": "gear links by the program",
    **dict.fromkeys(("ACS", "BCS", "ECS", "MCS", "WCS"), "other coordinate systems"),
    **dict.fromkeys(("SHIFT", "TRACK", "TRANSFORM"), "calculating with coordinate systems"),
    **dict.fromkeys(("KIN", "RTCP", "TLC", "TRAFO", "ORI", "PTP", "SINGULARITY"), _TRAFO),
    **dict.fromkeys(("TOOL", "TLAX", "OTC", "FREE"), _TOOLS),
    **dict.fromkeys(("ADD", "ERROR", "STRING"), "texts and errors by the program"),
    **dict.fromkeys(("AKIMA", "SPLINE"), _SPLINES),
    **dict.fromkeys(("ANG", "CANG", "CHF", "CHR", "FRC", "RND"), "contours by angles, chamfers, roundings"),
    "BACKWARD": "moving backward on the path",
    **dict.fromkeys(("CAX", "CAXTRACK", "CYL", "FACE", "TURN", "TANGFEED"), _TURNING),
    **dict.fromkeys(("CLAMP", "CONTROL"), "monitoring by the program"),
    **dict.fromkeys(("CLEAR", "FILE", "INIT", "LOAD", "SAVE"), _MACRO),
    **dict.fromkeys(("COMMAND", "IDENT"), "SERCOS parameters and commands"),
    **dict.fromkeys(("CONTOUR", "CORNER", "FILTER", "HSC", "SEGMENTATION"), _SMOOTHING),
    "DEL": "delete distance to go by the program",
    **dict.fromkeys(("DELETE", "ENDVAR", "VAR"), "declaration of variables"),
    "DIST": "distance to go",
    **dict.fromkeys(("DYNAMIC", "SLOPE", "VECTOR", "VECTORACC", "VECTORVEL", "TRANSVELMIN"), _WEIGHTING),
    **dict.fromkeys(("EDGE", "EDM", "STROKE", "PUNCH", "NIBBLE"), _PUNCHING),
    "EXPL": "explicit synchronisation of M functions",
    "FF": "feedforward",
    "FGROUP": "feed groups",
    **dict.fromkeys(("FLUSH", "SEQUENCE", "SIGNAL", "SINGLE", "TIMER", "WAIT"), _SYNCHRONISING),
    "FRICTION": "friction compensation by the program",
    "GET": "positions into variables",
    **dict.fromkeys(("HANDWHEEL", "JOG", "MANUAL"), _MANUAL),
    "MACHINE": "parameters by the program",
    "MAIN": _SPINDLES,
    "OPTIONAL": "optional execution",
    "OVERRIDE": "override by the program",
    **dict.fromkeys(("PRESET", "PSET"), "position preset"),
    "RETAIN": _SUBROUTINES,
    "ROTATION": _ROTATION,
    "SCALE": "scaling of contours",
    "SUPPRESS": "suppressing offsets",
    "TIME": "waiting",
    "TRC": _RADIUS,
}
"""First words of '#' commands."""

STATEMENTS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("IF", "ELSEIF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "FOR", "ENDFOR"), BUILT),
    **dict.fromkeys(("BREAK", "CONTINUE"), BUILT),
    "GOTO": "jumps",
    **dict.fromkeys(("DO", "ENDDO", "REPEAT", "UNTIL"), "loops that are tested at their end"),
    **dict.fromkeys(("SWITCH", "CASE", "DEFAULT", "ENDSWITCH"), "choices by value"),
}
"""'$' statements."""

FUNCTIONS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "SQRT", "SQR", "ABS", "ROUND"), BUILT),
    **dict.fromkeys(("EXP", "LN", "NOT", "FIX", "FUP"), BUILT),
    **dict.fromkeys(("COT", "ACOT", "ATAN2", "LOG", "DEXP", "INV"), "this function"),
    **dict.fromkeys(("INT", "FRACT", "CEIL", "FLOOR", "MIN", "MAX", "SIGN"), "this function"),
    **dict.fromkeys(("EXIST", "SIZEOF", "IS_STRING", "IS_NUMBER"), "questions about variables"),
    **dict.fromkeys(("MACRO_LENGTH", "MACRO_CONTENT"), "macros"),
    **dict.fromkeys(("PROBE0", "PROBE1"), "probing inputs by name"),
    **dict.fromkeys(("ENCRYPT", "LEFT", "RIGHT", "MID", "LEN", "FIND", "DELETE", "INSERT"), _STRINGS),
    **dict.fromkeys(("REPLACE", "ORD", "FSTRING", "INT_TO_STR", "REAL_TO_STR"), _STRINGS),
    **dict.fromkeys(("STR_TO_INT", "STR_TO_REAL"), _STRINGS),
}
"""Words in expressions: functions, and names that stand for numbers."""

OPERATORS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("**", "*", "/", "MOD", "+", "-", "<=", ">=", "==", "<", ">", "!=", "="), BUILT),
    **dict.fromkeys(("&&", "AND", "||", "OR", "!"), BUILT),
    **dict.fromkeys(("&", "^", "|", "XOR"), "this operator"),
}
"""Operators in expressions."""

AXIS_COMMANDS: Final = (
    *("COMP", "COUPLE", "DIST_CTRL", "DIST_CTRL2", "FIXED_STOP", "INDP_ASYN", "INDP_SYN", "LIFT", "LIFT_END"),
    *("LIFT_START", "OFFSET", "OSC", "OVERRIDE", "PUNCH", "SYN_IN", "SYN_OUT", "SCALE", "DYNAMIC"),
    *(
        "CALLAX",
        "PUTAX",
        "POLY",
        "SET_POSITION",
        "SYNC",
        "POS_LIMIT",
        "MODULO",
        "FEED_LINK",
        "GET_DYNAMIC_DATA",
    ),
)
"""First words of axis commands, `X[...]`: none is built, nor are M, H and G functions of an axis."""

AXIS_VARIABLES: Final[Mapping[str, str]] = {
    **{row.name: BUILT for row in nc_variables.emulated("A")},
    **dict.fromkeys(("-SWE", "+SWE", "-SWE_MDS", "+SWE_MDS"), "software limits"),
    **dict.fromkeys(("WCS", "MCS", "WCS.ABS", "MCS.ABS", "TRANSFORM", "ACS.ACT_POS"), "other systems"),
    **dict.fromkeys(("MANUAL_OFFSETS", "SOFFS"), _MANUAL),
    **dict.fromkeys(("DIAMETER_PROG.ABS", "DIAMETER_PROG.REL"), _TURNING),
    "MENT": _MIRROR,
    "MIRROR": _MIRROR,
    "REF": "the reference position",
    "PZV": "clamp offsets",
    **dict.fromkeys(
        ("MODE", "MODULO_VALUE", "LOG_AX_NR", "AX_LIST_NAME", "ANTR_TYP", "TORQUE_NOM"), "axis data"
    ),
    **dict.fromkeys(("AXIS_DEACTIVATED", "ENCODER2_VALUE", "GEAR_LINK_ACTIVE"), "states of the axis"),
    **dict.fromkeys(("RETRACT_ACS_POS", "RETRACT_APPR_START_MCS_POS"), "electrode retraction"),
    **{
        f"{kind}_COMP_{what}": "compensations"
        for kind in ("CROSS", "PLANE", "LEAD", "TEMP", "FRICT", "CROSSTALK", "BACKLASH")
        for what in ("INIT", "ACTIVE", "CURR")
    },
}
"""Names behind `V.A.`, without the axis."""

GLOBAL_VARIABLES: Final[Mapping[str, str]] = {
    **{row.name: BUILT for row in nc_variables.emulated("G")},
    **dict.fromkeys(("I", "J", "K", "R", "MERR", "CIRCLE_CP_ABS", "CIRCLE_CPC_ACTIVE"), _CIRCLES),
    **dict.fromkeys(("BLOCK_NR", "MASS_MM", "MASS_360", "PROG_ABS", "ACT_PLANE"), "modal states"),
    **dict.fromkeys(("FEEDRATE_MODE", "FEEDRATE_SCALE"), "modal states"),
    **dict.fromkeys(("WZ", "WZ_AKT", "T_AKT", "D_AKT", "TOOL_COMP", "TRC_ACTIVE", "OTC_ACTIVE"), _TOOLS),
    **dict.fromkeys(("NP", "NP_AKT", "NP_DEFAULT", "AKT_PLATZ"), _OFFSETS),
    **{
        f"{kind}{what}": "coordinate systems in variables"
        for kind in ("", "A", "B")
        for what in ("CS_COUNT_DEF", "CS_COUNT_FREE_DEF", "CS_COUNT_ACTIVE")
    },
    **dict.fromkeys(
        (
            *("COORD_SYS_BCS_COUNT_DEF", "COORD_SYS_ACS_COUNT_DEF", "COORD_SYS_CS_COUNT_DEF"),
            *("COORD_SYS_COUNT_ALL_DEF", "COORD_SYS_COUNT_ALL_ACTIVE", "SELECTED_CS", "TRACK_CS"),
            *("WCS_POSLIMIT_1", "WCS_POSLIMIT_2", "WCS_POSLIMIT_3"),
        ),
        "coordinate systems in variables",
    ),
    **dict.fromkeys(("AX_LINK", "AX_LINK_GROUP", "GEAR_LINK_ACTIVE"), _LINKS),
    **dict.fromkeys(("ROT_ACTIVE", "ROT_ANGLE", "ROT_CENTER1", "ROT_CENTER2"), _ROTATION),
    "MIRROR_ACTIVE": _MIRROR,
    **dict.fromkeys(("KIN", "KIN_STEP", "KIN_ID", "KIN_TYPE", "KIN_ID_STEP", "KIN_TYPE_STEP"), _TRAFO),
    **dict.fromkeys(("TOTAL_KIN_OFFSET", "TRAFO_PCS", "TRAFO_PCS_ID", "TRAFO_PCS_TYPE"), _TRAFO),
    **dict.fromkeys(("TRAFO_ACTIVE", "MCS_ACTIVE", "LIMIT", "SINGUL_AVOID_ACTIVE"), _TRAFO),
    **dict.fromkeys(
        ("HSC_ACTIVE", "HSC_SURFACE_ACTIVE", "CONT_MODE_ACTIVE", "SEGMENTATION_ACTIVE"), _SMOOTHING
    ),
    **dict.fromkeys(("STROKE_DEF_ACTIVE", "PUNCH_ACTIVE", "NIBBLE_ACTIVE", "EDM_ACTIVE"), _PUNCHING),
    **dict.fromkeys(("CAXTRACK_ACTIVE", "DIAMETER_PROG_ACTIVE", "DIAMETER_PROG"), _TURNING),
    **dict.fromkeys(("FRICTION_ACTIVE", "VECTOR_OFFSET_ACTIVE", "LIFT_ACTIVE"), "states of functions"),
    **dict.fromkeys(
        ("TIMER", "SIGNAL_READ", "IPO_COUNT", "TIME_STAMP", "TIME_STAMP_FILE_NAME"), _SYNCHRONISING
    ),
    **dict.fromkeys(
        ("MAIN_FILE_NAME", "MAIN_PROG_NAME", "MAIN_PROG_NR", "FILE_NAME", "PROG_NAME"), "program data"
    ),
    **dict.fromkeys(("PROG_NR", "PROG_LEVEL", "PROG_VERSION", "PATH_NR", "FILE_OFFSET"), "program data"),
    **dict.fromkeys(("FILE_EXIST", "CNC_CHANNEL", "CNC_RELEASE", "CNC_VERSION"), "program data"),
    **dict.fromkeys(("EXECUTION_MODE", "ACTIVE_MODE", "BLOCK_SEARCH_ACTIVE"), "modes of the control"),
    **dict.fromkeys(("CYCLE_ACTIVE", "CYCLE_CHANGES_MODAL", "@P"), _SUBROUTINES),
    **dict.fromkeys(("M_FCT", "H_FCT"), TECHNOLOGY),
    **dict.fromkeys(
        ("SPEED_LIMIT", "MAX_NC_BLOCKS_AHEAD", "MAX_MOTION_BLOCKS_AHEAD", "MAX_TIME_AHEAD"), _LOOK_AHEAD
    ),
    **dict.fromkeys(
        (
            *("CHAN_LIST_INVOKE", "CLAMP_LIST_INVOKE", "TOOL_LIST_INVOKE", "VE_VAR_LIST_INVOKE"),
            "ZERO_POINT_LIST_INVOKE",
        ),
        "counters of the lists",
    ),
    "RW": _BANDING,
}
"""Names behind `V.G.`, the first part of those with several."""

VARIABLE_AREAS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("A", "G", "P", "S", "L", "E"), BUILT),
    **dict.fromkeys(("SPDL", "SPDL_PROG"), _SPINDLES),
    "CYC": _SUBROUTINES,
    "I": "variables shared between channels",
    **dict.fromkeys(("TOOL", "TLM"), _TOOLS),
    **dict.fromkeys(("RTA", "RTG"), "values of the interpolator"),
    "C": "variables of the channel",
}
"""What stands between `V.` and the name."""


def missing(table: Mapping[str, str], word: str) -> str:
    """Return what a word of the dialect that is not built belongs to, "" for a built one and for an unknown one."""
    return table.get(word, BUILT)
