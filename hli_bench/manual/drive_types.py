"""Axis types (P-AXIS-00018), axis modes (P-AXIS-00015), drive types (P-AXIS-00020) and their numbers."""

from enum import IntEnum, IntFlag


class AxisType(IntEnum):
    """P-AXIS-00018. Source: TF5200 axis parameters, `kenngr.achs_typ`."""

    TRANSLATOR = 0x1
    ROTATOR = 0x2
    SPINDEL = 0x4


class DriveType(IntEnum):
    """P-AXIS-00020. Source: homing manual 3.1.1 (1..7), TF5200 axis parameters (the rest)."""

    CONVENTIONAL = 1
    SERCOS = 2
    PROFIDRIVE = 3
    SIMULATION = 4
    LIGHTBUS = 5
    TERMINAL = 6
    RT_ETHERNET = 7
    CANOPEN = 8
    VIRTUAL = 16
    CAN = 32


class AxisMode(IntFlag):
    """P-AXIS-00015, ACHSMODE_* bits; exactly one of LINEAR and MODULO. Source: homing manual 4.2."""

    LINEAR = 0x00000001
    MODULO = 0x00000004
    PLANDREHEN = 0x00000040
    LAENGSDREHEN = 0x00000080
    KEINE_AUTO_RPF = 0x00000100
    CAX = 0x00000200
    MODULO_LINEAR = 0x00000400
    CLAMPABLE = 0x00000800
    ROT_TABLE = 0x00001000
    COLL_CHECK = 0x00008000
    GANTRY_MASTER = 0x00010000
    GANTRY_SLAVE = 0x00020000
    SPINDLE_EXT_CTRL = 0x00040000
    EXT_CTRL_INPUT = 0x00080000
    COUNTER = 0x00100000
    LEAD_AXIS = 0x00200000
    ALLOW_RESOLUTION_CHANGE = 0x00400000
    DYNAMIC_WEIGHTING = 0x00800000
    PATH_LENGTH_TCP = 0x02000000
    PATH_LENGTH_CONTOUR = 0x04000000
    VIRT_LEAD_AXIS = 0x08000000
    LAH_OFFSET_AXIS = 0x10000000
