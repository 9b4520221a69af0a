"""Messages of the HLI (40xxx): version and size of the interface, orders that cannot be taken."""

from typing import Final

from hli_bench.manual.errors.record import ErrorSheet, motion_error

SIZE_DIFFERS: Final[ErrorSheet] = motion_error(
    "size_differs", 40_005, "size of the HLI differs between PLC and CNC"
)
VERSION_DIFFERS: Final[ErrorSheet] = motion_error(
    "version_differs", 40_006, "version of the HLI differs between PLC and CNC"
)
PLATFORM_ORDER: Final[ErrorSheet] = motion_error(
    "platform_order", 40_086, "the platform cannot take an order"
)
AXIS_ORDER: Final[ErrorSheet] = motion_error(
    "axis_order", 40_087, "axis unit {0} cannot take an order", details=("logical axis number",)
)
CHANNEL_ORDER: Final[ErrorSheet] = motion_error(
    "channel_order", 40_088, "the channel unit cannot take an order"
)
PLC_STOPPED: Final[ErrorSheet] = motion_error(
    "plc_stopped", 40_011, "PLC {0} does not serve the HLI any more", details=("name of the PLC task",)
)
"""The catalogue's message for a PLC side that is not there; used for a PLC that died or froze (decided here)."""
