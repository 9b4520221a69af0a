"""Error codes (0x603F, EMCY) that CiA 301/402 drives report, with their bits of the error register."""

from enum import IntEnum
from typing import Final

from hli_bench.protocols.canopen.emcy import ErrorRegister


class Fault(IntEnum):
    """EMCY codes by their profile meaning."""

    SHORT_CIRCUIT_INPUT = 0x2110
    INTERNAL_CURRENT_1 = 0x2211
    CONTINUOUS_OVER_CURRENT = 0x2310
    SHORT_CIRCUIT_MOTOR = 0x2320
    I2T = 0x2350
    I2T_WARNING = 0x2351
    MAINS_OVER_VOLTAGE = 0x3110
    MAINS_UNDER_VOLTAGE = 0x3120
    PHASE_FAILURE = 0x3130
    DC_LINK_OVER_VOLTAGE = 0x3210
    DC_LINK_UNDER_VOLTAGE = 0x3220
    AMBIENT_TEMPERATURE = 0x4110
    DEVICE_TEMPERATURE = 0x4210
    DRIVE_TEMPERATURE = 0x4310
    LOW_SUPPLY = 0x5110
    POWER_SECTION = 0x5400
    ENCODER = 0x7305
    COMMUNICATION = 0x8100
    EXCESS_TORQUE = 0x8311
    SPEED_CONTROLLER = 0x8400
    POSITION_CONTROLLER = 0x8500
    POSITIONING_CONTROLLER = 0x8600
    FOLLOWING_ERROR = 0x8611
    REFERENCE_LIMIT = 0x8612
    SYNC_CONTROLLER = 0x8700
    PROCESS_DATA_MONITORING = 0x8900
    DECELERATION = 0xF001


_BITS: Final = {
    0x20: ErrorRegister.CURRENT,
    0x30: ErrorRegister.VOLTAGE,
    0x40: ErrorRegister.TEMPERATURE,
    0x81: ErrorRegister.COMMUNICATION,
    0x82: ErrorRegister.COMMUNICATION,
    0x83: ErrorRegister.PROFILE,
    0x84: ErrorRegister.PROFILE,
    0x85: ErrorRegister.PROFILE,
    0x86: ErrorRegister.PROFILE,
    0x87: ErrorRegister.PROFILE,
    0x89: ErrorRegister.PROFILE,
    0xF0: ErrorRegister.VENDOR,
}


def error_register(code: int) -> ErrorRegister:
    """Return the bits of 0x1001 for an error code: by its group, always with the generic bit."""
    high = code >> 8
    return ErrorRegister.GENERIC | _BITS.get(high, _BITS.get(high & 0xF0, ErrorRegister.GENERIC))
