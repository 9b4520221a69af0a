"""Modes of operation (object 0x6060) and the bits that advertise them (0x6502)."""

from enum import IntEnum, IntFlag


class Mode(IntEnum):
    """Values of 0x6060 and 0x6061."""

    NONE = 0
    PROFILE_POSITION = 1
    VELOCITY = 2
    PROFILE_VELOCITY = 3
    PROFILE_TORQUE = 4
    HOMING = 6
    INTERPOLATED_POSITION = 7
    CYCLIC_SYNC_POSITION = 8
    CYCLIC_SYNC_VELOCITY = 9
    CYCLIC_SYNC_TORQUE = 10


class SupportedModes(IntFlag):
    """Bits of 0x6502."""

    PROFILE_POSITION = 0x001
    VELOCITY = 0x002
    PROFILE_VELOCITY = 0x004
    PROFILE_TORQUE = 0x008
    HOMING = 0x020
    INTERPOLATED_POSITION = 0x040
    CYCLIC_SYNC_POSITION = 0x080
    CYCLIC_SYNC_VELOCITY = 0x100
    CYCLIC_SYNC_TORQUE = 0x200


def is_supported(mode: int, supported: int) -> bool:
    """Whether 0x6502 = `supported` advertises `mode`."""
    return mode > 0 and bool(supported >> (mode - 1) & 1)
