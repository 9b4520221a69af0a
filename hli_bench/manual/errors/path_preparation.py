"""Messages of the path preparation (120xxx): software limits, measuring in smoothed contours."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, motion_error, warning

POSITIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = motion_error(
    "positive_software_limit",
    120_002,
    "target of axis {0} is beyond its positive software limit switch",
    "logical axis number",
    "target [0.1 um]",
    "limit [0.1 um]",
)
NEGATIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = motion_error(
    "negative_software_limit",
    120_003,
    "target of axis {0} is beyond its negative software limit switch",
    "logical axis number",
    "target [0.1 um]",
    "limit [0.1 um]",
)
FEED_NOT_POSITIVE: Final[ErrorSheet] = motion_error(
    "feed_not_positive", 120_022, "programmed feed is zero or negative"
)
MEASURING_FEED_CORRECTED: Final[ErrorSheet] = warning(
    "measuring_feed_corrected",
    120_213,
    "measuring feed {0} is lowered to {1} because of the probe stroke (P-AXIS-00086)",
    "feed",
    "corrected feed",
)
PROBE_STROKE_ZERO: Final[ErrorSheet] = motion_error(
    "probe_stroke_zero", 120_215, "axis {0}: probe stroke is 0", "logical axis number"
)
MEASURING_IN_CONTOURING: Final[ErrorSheet] = motion_error(
    "measuring_in_contouring", 120_652, "measuring while polynomial contouring is active"
)
MEASURING_IN_ROUNDING: Final[ErrorSheet] = motion_error(
    "measuring_in_rounding", 120_718, "measuring in a rounded profile"
)
