"""Messages of the path preparation (120xxx): software limits, measuring in smoothed contours."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, message, warning

POSITIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = message(
    "positive_software_limit",
    120_002,
    "target of axis {0} is beyond its positive software limit switch",
    "logical axis number",
    "target [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "start of the block [0.1 µm, 0.0001°]",
    "end of the block [0.1 µm, 0.0001°]",
    classes=(2, 6),
)
NEGATIVE_SOFTWARE_LIMIT: Final[ErrorSheet] = message(
    "negative_software_limit",
    120_003,
    "target of axis {0} is beyond its negative software limit switch",
    "logical axis number",
    "target [0.1 µm, 0.0001°]",
    "limit [0.1 µm, 0.0001°]",
    "start of the block [0.1 µm, 0.0001°]",
    "end of the block [0.1 µm, 0.0001°]",
    classes=(2, 6),
)
MEASURING_FEED_CORRECTED: Final[ErrorSheet] = warning(
    "measuring_feed_corrected",
    120_213,
    "measuring feed {2} is lowered to {0} because of the probe stroke (P-AXIS-00086)",
    "corrected feed [µm/s, 0.001°/s]",
    "logical axis number",
    details=("feed",),
)
PROBE_STROKE_ZERO: Final[ErrorSheet] = message(
    "probe_stroke_zero", 120_215, "axis {0}: probe stroke is 0", "logical axis number", classes=(2, 6)
)
MEASURING_IN_CONTOURING: Final[ErrorSheet] = message(
    "measuring_in_contouring",
    120_652,
    "measuring while polynomial contouring is active",
    "block number",
    "current value",
    classes=(2, 6),
)
MEASURING_IN_ROUNDING: Final[ErrorSheet] = message(
    "measuring_in_rounding", 120_718, "measuring in a rounded profile", classes=(2, 6)
)
