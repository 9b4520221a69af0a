"""What a CANopen master knows of CiA 402: the objects it configures, controlword commands, states."""

from enum import IntEnum
from typing import Final

PRODUCER_HEARTBEAT: Final = (0x1017, 0)
MODE_OF_OPERATION: Final = (0x6060, 0)
CYCLIC_SYNCHRONOUS_POSITION: Final = 8


class Command(IntEnum):
    """Controlwords that walk through the states."""

    DISABLE_VOLTAGE = 0x00
    QUICK_STOP = 0x02
    SHUT_DOWN = 0x06
    SWITCH_ON = 0x07
    ENABLE_OPERATION = 0x0F
    RESET_FAULT = 0x80


STATES: Final = {
    "not ready to switch on": (0x4F, 0x00),
    "switch on disabled": (0x4F, 0x40),
    "ready to switch on": (0x6F, 0x21),
    "switched on": (0x6F, 0x23),
    "operation enabled": (0x6F, 0x27),
    "quick stop active": (0x6F, 0x07),
    "fault reaction active": (0x4F, 0x0F),
    "fault": (0x4F, 0x08),
}
"""State by name: mask of the statusword, and what it must be behind the mask."""


def state_of(statusword: int) -> str:
    """Return the name of the state that a statusword shows."""
    return next((name for name, (mask, value) in STATES.items() if statusword & mask == value), "unknown")
