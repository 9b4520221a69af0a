"""Addresses of the CiA 402 objects that the bench uses, and what of them a dictionary lacks."""

from collections.abc import Container, Iterable, Mapping
from typing import Final, NamedTuple


class ObjectAddress(NamedTuple):
    """Index and sub-index of an object."""

    object_index: int
    subindex: int = 0


ABORT_CONNECTION_OPTION: Final = ObjectAddress(0x6007)
ERROR_CODE: Final = ObjectAddress(0x603F)
CONTROLWORD: Final = ObjectAddress(0x6040)
STATUSWORD: Final = ObjectAddress(0x6041)
QUICK_STOP_OPTION: Final = ObjectAddress(0x605A)
SHUTDOWN_OPTION: Final = ObjectAddress(0x605B)
DISABLE_OPERATION_OPTION: Final = ObjectAddress(0x605C)
HALT_OPTION: Final = ObjectAddress(0x605D)
FAULT_REACTION_OPTION: Final = ObjectAddress(0x605E)
MODE: Final = ObjectAddress(0x6060)
MODE_DISPLAY: Final = ObjectAddress(0x6061)
POSITION_DEMAND: Final = ObjectAddress(0x6062)
POSITION_INTERNAL: Final = ObjectAddress(0x6063)
POSITION_ACTUAL: Final = ObjectAddress(0x6064)
FOLLOWING_WINDOW: Final = ObjectAddress(0x6065)
FOLLOWING_TIMEOUT: Final = ObjectAddress(0x6066)
VELOCITY_ACTUAL: Final = ObjectAddress(0x606C)
MAX_TORQUE: Final = ObjectAddress(0x6072)
RATED_TORQUE: Final = ObjectAddress(0x6076)
TORQUE_ACTUAL: Final = ObjectAddress(0x6077)
TARGET_POSITION: Final = ObjectAddress(0x607A)
ENCODER_INCREMENTS: Final = ObjectAddress(0x608F, 1)
PROFILE_DECELERATION: Final = ObjectAddress(0x6084)
QUICK_STOP_DECELERATION: Final = ObjectAddress(0x6085)
PROBE_FUNCTION: Final = ObjectAddress(0x60B8)
PROBE_STATUS: Final = ObjectAddress(0x60B9)
LATCHES: Final = tuple(ObjectAddress(index) for index in (0x60BA, 0x60BB, 0x60BC, 0x60BD))
"""Touch probe 1 positive and negative edge, touch probe 2 positive and negative edge."""
PROBE_SOURCES: Final = (ObjectAddress(0x60D0, 1), ObjectAddress(0x60D0, 2))
LATCH_TIMES: Final = tuple(ObjectAddress(index) for index in (0x60D1, 0x60D2, 0x60D3, 0x60D4))
"""Low 32 bits of the instant of each latch in ns, in the order of LATCHES."""
POSITIVE_TORQUE_LIMIT: Final = ObjectAddress(0x60E0)
NEGATIVE_TORQUE_LIMIT: Final = ObjectAddress(0x60E1)
FOLLOWING_ERROR: Final = ObjectAddress(0x60F4)
POSITION_DEMAND_INTERNAL: Final = ObjectAddress(0x60FC)
DIGITAL_INPUTS: Final = ObjectAddress(0x60FD)
SUPPORTED_MODES: Final = ObjectAddress(0x6502)

NEEDED: Final = (CONTROLWORD, STATUSWORD, MODE, MODE_DISPLAY)
"""What makes a device a CiA 402 drive."""
CYCLIC: Final = (TARGET_POSITION, POSITION_ACTUAL)
"""What a drive needs beside it to be moved by a CNC in cyclic synchronous position mode."""
_TOUCH_PROBE: Final = (PROBE_FUNCTION, PROBE_STATUS, LATCHES[0])
FEATURES: Final = (
    ("touch probe (measuring with the source DRIVE, homing on the zero pulse)", _TOUCH_PROBE),
    ("latches of the negative edge and of the second input", LATCHES[1:]),
    ("choice of the latch source", PROBE_SOURCES),
    ("time stamps of the latches", LATCH_TIMES),
    ("torque limit (fixed stop, #DRIVE)", (MAX_TORQUE,)),
    ("torque limit by direction", (POSITIVE_TORQUE_LIMIT, NEGATIVE_TORQUE_LIMIT)),
    ("actual torque and following error", (TORQUE_ACTUAL, FOLLOWING_ERROR)),
    ("following error monitoring", (FOLLOWING_WINDOW, FOLLOWING_TIMEOUT)),
    ("digital inputs (cam at the drive)", (DIGITAL_INPUTS,)),
    (
        "choice of how it stops",
        (
            QUICK_STOP_OPTION,
            HALT_OPTION,
            FAULT_REACTION_OPTION,
            PROFILE_DECELERATION,
            QUICK_STOP_DECELERATION,
        ),
    ),
)
"""Features of the bench, and the objects without which they are off."""
ABSENT: Final[Mapping[ObjectAddress, int]] = {
    ABORT_CONNECTION_OPTION: 1,
    QUICK_STOP_OPTION: 2,
    SHUTDOWN_OPTION: 0,
    DISABLE_OPERATION_OPTION: 1,
    HALT_OPTION: 1,
    FAULT_REACTION_OPTION: 2,
    PROFILE_DECELERATION: 262_144_000,
    QUICK_STOP_DECELERATION: 1_048_576_000,
    FOLLOWING_WINDOW: 0xFFFFFFFF,
    MAX_TORQUE: 0xFFFF,
    POSITIVE_TORQUE_LIMIT: 0xFFFF,
    NEGATIVE_TORQUE_LIMIT: 0xFFFF,
    PROBE_SOURCES[0]: 1,
    PROBE_SOURCES[1]: 2,
    SUPPORTED_MODES: 0x80,
}
"""How a drive acts whose dictionary lacks an object, where that is not 0: as the profile says, limits are off."""


def lacking(entries: Container[tuple[int, int]], needed: Iterable[ObjectAddress] = NEEDED) -> list[str]:
    """Return the objects that are needed and a dictionary with these entries lacks, as `6041:00`."""
    return [f"{index:04X}:{subindex:02X}" for index, subindex in needed if (index, subindex) not in entries]


def features_off(entries: Container[tuple[int, int]]) -> list[str]:
    """Return the features that are off with these entries, each with the objects that are lacking."""
    found = [(feature, lacking(entries, needed)) for feature, needed in FEATURES]
    return [f"{feature}: {', '.join(missing)}" for feature, missing in found if missing]
