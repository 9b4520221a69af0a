"""Words that stand as values in axis lists."""

from enum import StrEnum


class ProbingSignal(StrEnum):
    """P-AXIS-00516: where the probing signal comes from. Source: measurement manual 8.2.2."""

    UNSET = ""
    """The older parameters decide: `fallbacks.effective_signal`."""
    DRIVE_TYPE_DEFAULT = "DRIVE_TYPE_DEFAULT"
    PLC = "PLC"
    FIXED_STOP = "FIXED_STOP"
    DRIVE = "DRIVE"
    PLC_EXT_LATCH_CONTROL = "PLC_EXT_LATCH_CONTROL"
    PLC_FIRST_EVENT = "PLC_FIRST_EVENT"
    PLC_TIMESTAMP = "PLC_TIMESTAMP"
    EXT_PROBE_WITH_DRIVE = "EXT_PROBE_WITH_DRIVE"


class Edge(StrEnum):
    """P-AXIS-00518: the edge of the probing signal that latches."""

    UNSET = ""
    """P-AXIS-00113 decides: `fallbacks.effective_edge`."""
    POS = "POS"
    NEG = "NEG"


class HomingType(StrEnum):
    """P-AXIS-00299. Source: homing manual 4.2 and 4.3."""

    CNC_CONTROLLED = "CNC_CONTROLLED"
    DRIVE_CONTROLLED = "DRIVE_CONTROLLED"
    DISABLED = "DISABLED"
    IGNORE_ABS_POS = "IGNORE_ABS_POS"
    TORQ = "TORQ"
    NONE = "NONE"


class HomingDirection(StrEnum):
    """P-AXIS-00346: direction of the search for the fixed stop."""

    NEGATIVE = "NEGATIVE"
    POSITIVE = "POSITIVE"


class ReferenceCamSignal(StrEnum):
    """P-AXIS-00321: where the reference cam signal comes from."""

    PLC = "PLC"
    RT_STATUS_BIT_1 = "RT_STATUS_BIT_1"
    RT_STATUS_BIT_2 = "RT_STATUS_BIT_2"
    STATUS_DIG_INPUTS = "STATUS_DIG_INPUTS"


class TriggerSource(StrEnum):
    """P-AXIS-00702: who chooses the trigger of the drive's touch probe."""

    DEFAULT = "DEFAULT"
    CNC_DEFINED = "CNC_DEFINED"
    DRIVE_DEFINED = "DRIVE_DEFINED"


class Communication(StrEnum):
    """P-AXIS-00397, P-AXIS-00720: how a drive object is reached."""

    CYCLIC = "CYCLIC"
    ACYCLIC = "ACYCLIC"
    IGNORE = "IGNORE"


class ObjectDataType(StrEnum):
    """P-AXIS-00399, P-AXIS-00722: data type of a drive object."""

    SGN16 = "SGN16"
    SGN32 = "SGN32"
    UNS16 = "UNS16"
    UNS32 = "UNS32"
    BITARRAY_16 = "BITARRAY_16"
    BITARRAY_32 = "BITARRAY_32"


class ScalingType(StrEnum):
    """P-AXIS-00401, P-AXIS-00724: how a value is scaled on its way to the drive."""

    UNSCALED = "UNSCALED"
    LINEAR = "LINEAR"
    TORQUE_DRIVE_SIDE = "TORQUE_DRIVE_SIDE"


class MissingReleases(StrEnum):
    """P-AXIS-00763: reaction to missing drive releases at the fixed stop."""

    ERROR = "ERROR"
    WARNING = "WARNING"
    NONE = "NONE"
