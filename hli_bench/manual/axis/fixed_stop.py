"""`antr.fixed_stop.*`: move to fixed stop, and the presets of its drive objects by drive type."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from hli_bench.manual.axis.words import Communication, MissingReleases, ObjectDataType, ScalingType
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.sheet import (
    CYCLES,
    LENGTH,
    MICROSECONDS,
    TENTH_PERCENT,
    DataType,
    Effect,
    Sheet,
    array_of,
    axis_page,
    param,
)

NO_LIMIT: Final = 1.0e199
"""Switches P-AXIS-00725 and 00726 off."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Detect:
    """`antr.fixed_stop.detect.*`: common criteria of all functions that look for a stop."""

    pos_lag_limit: int = param(
        -1,
        Sheet(
            number="P-AXIS-00769",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            since="V2.11.2810.01",
            doc="Position lag that means a fixed stop; 0 off, negative: P-AXIS-00331.",
            source=axis_page(794978059),
            effect=Effect.EMULATED,
        ),
    )
    min_time: int = param(
        0,
        Sheet(
            number="P-AXIS-00770",
            data_type=DataType.UNS32,
            units=MICROSECONDS,
            axis_types="TR",
            since="V2.11.2810.01",
            low=1,
            unset=0,
            doc="Time the criteria must hold; 0: P-AXIS-00332.",
            source=axis_page(794987915),
            effect=Effect.EMULATED,
        ),
    )
    start_distance: int = param(
        -1,
        Sheet(
            number="P-AXIS-00771",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            since="V2.11.2810.01",
            doc="Path before detection is armed; negative: not set.",
            source=axis_page(795010571),
            effect=Effect.EMULATED,
        ),
    )
    start_distance_per_mille: int = param(
        -1,
        Sheet(
            number="P-AXIS-00772",
            data_type=DataType.SGN16,
            units=TENTH_PERCENT,
            axis_types="TR",
            since="V2.11.2810.01",
            doc="Share of the block before detection is armed; negative: not set; above 1000 a warning.",
            source=axis_page(795022347),
            effect=Effect.EMULATED,
        ),
    )
    max_delta_position_window: int = param(
        -1,
        Sheet(
            number="P-AXIS-00773",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            since="V2.11.2810.01",
            doc="Largest path in the time of P-AXIS-00770 at a stop; 0 or negative: off.",
            source=axis_page(795031947),
            effect=Effect.EMULATED,
        ),
    )
    detect_velocity_limit: int = param(
        1000,
        Sheet(
            number="P-AXIS-00817",
            data_type=DataType.UNS16,
            high=1000,
            units=TENTH_PERCENT,
            doc="Rest of the speed at which a stop counts as found; 1000 off.",
            source=axis_page(1088207755),
            effect=Effect.ACCEPTED,
        ),
    )
    detect_torque_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00818",
            data_type=DataType.UNS16,
            high=1000,
            units=TENTH_PERCENT,
            drive_types=(DriveType.SIMULATION, DriveType.SERCOS, DriveType.CANOPEN),
            doc="Share of the reduced torque at which a stop counts as found; 0 off.",
            source=axis_page(1088251531),
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveIdent:
    """`antr.fixed_stop.drive_ident[i].*`: a drive object that is changed at the stop."""

    id: str = param(
        "",
        Sheet(
            number="P-AXIS-00719",
            data_type=DataType.STRING,
            max_length=29,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Name of the drive object; TORQUE_LIMIT is reserved for the torque limit.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    commu: Communication = param(
        Communication.ACYCLIC,
        Sheet(
            number="P-AXIS-00720",
            data_type=DataType.STRING,
            choices=tuple(Communication),
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="How the object is reached: cyclic telegram, parameter channel, not at all.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    wr_ident: str = param(
        "",
        Sheet(
            number="P-AXIS-00721",
            data_type=DataType.STRING,
            max_length=29,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Drive object or telegram element to write.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    data_type: ObjectDataType = param(
        ObjectDataType.SGN16,
        Sheet(
            number="P-AXIS-00722",
            data_type=DataType.STRING,
            choices=tuple(ObjectDataType),
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Data type of the object.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    startup_value: float = param(
        0.0,
        Sheet(
            number="P-AXIS-00723",
            data_type=DataType.REAL64,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Value after start-up; needed for CYCLIC or with P-AXIS-00730 = 1.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    scaling_type: ScalingType = param(
        ScalingType.UNSCALED,
        Sheet(
            number="P-AXIS-00724",
            data_type=DataType.STRING,
            choices=tuple(ScalingType),
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Scaling on the way to the drive.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    max_limit: float = param(
        NO_LIMIT,
        Sheet(
            number="P-AXIS-00725",
            data_type=DataType.REAL64,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Largest output value; 1.0e+199 off.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    min_limit: float = param(
        NO_LIMIT,
        Sheet(
            number="P-AXIS-00726",
            data_type=DataType.REAL64,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Smallest output value; 1.0e+199 off.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    mask: str = param(
        "NOT_USED",
        Sheet(
            number="P-AXIS-00727",
            data_type=DataType.STRING,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Bit mask for BITARRAY objects.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    scaling_factor: float = param(
        1.0,
        Sheet(
            number="P-AXIS-00728",
            data_type=DataType.REAL64,
            nonzero=True,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Factor of LINEAR scaling.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    active_value: float = param(
        0.0,
        Sheet(
            number="P-AXIS-00729",
            data_type=DataType.REAL64,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc=(
                "Value while moving to and standing at the fixed stop. The printed range excludes 0, "
                "which the printed presets use."
            ),
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    use_startup_value: bool = param(
        False,
        Sheet(
            number="P-AXIS-00730",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Write P-AXIS-00723 at the end instead of the value read before.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    rd_ident: str = param(
        "",
        Sheet(
            number="P-AXIS-00731",
            data_type=DataType.STRING,
            max_length=29,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Object to read if it differs from P-AXIS-00721.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    default: bool = param(
        True,
        Sheet(
            number="P-AXIS-00746",
            data_type=DataType.BOOLEAN,
            replaced_by="P-AXIS-00821",
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Old: preset this object by drive type.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    default_ident: int = param(
        -1,
        Sheet(
            number="P-AXIS-00821",
            data_type=DataType.SGN08,
            since="V3.1.3080.11",
            replaces=("P-AXIS-00746",),
            axis_types="TR",
            drive_types=(
                DriveType.SIMULATION,
                DriveType.SERCOS,
                DriveType.CANOPEN,
                DriveType.TERMINAL,
            ),
            low=0,
            high=1,
            unset=-1,
            doc="Preset this object by drive type; -1: P-AXIS-00746 decides.",
            source="TF5200 axis parameters 8.9.21; -1 decided here",
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedStop:
    """`antr.fixed_stop.*`."""

    pos_lag_limit: int = param(
        20000,
        Sheet(
            number="P-AXIS-00712",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Position lag that means the fixed stop.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    window: int = param(
        0,
        Sheet(
            number="P-AXIS-00713",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Window around the stop position; 0 off.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    nbr_cycles: int = param(
        10,
        Sheet(
            number="P-AXIS-00714",
            data_type=DataType.UNS16,
            units=CYCLES,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            low=1,
            doc="Cycles the lag must stay above its limit.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    error_on_abort: bool = param(
        True,
        Sheet(
            number="P-AXIS-00715",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="A CNC reset during the approach is an error.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    error_not_detected: bool = param(
        True,
        Sheet(
            number="P-AXIS-00716",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="A stop that was not found is an error.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    warning_reset_while_detected: bool = param(
        True,
        Sheet(
            number="P-AXIS-00717",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Warn at a CNC reset while standing at the stop.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    max_torque: float = param(
        0.0,
        Sheet(
            number="P-AXIS-00718",
            data_type=DataType.REAL64,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc=(
                "Torque at the largest acceleration; 0.0 disables the reduction. The default is the "
                "largest torque limit (P-AXIS-00725) where one is given."
            ),
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    quick_stop_after_detection: bool = param(
        False,
        Sheet(
            number="P-AXIS-00762",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Stop at once when every axis of the approach found its stop.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    error_missing_drive_releases: MissingReleases = param(
        MissingReleases.ERROR,
        Sheet(
            number="P-AXIS-00763",
            data_type=DataType.STRING,
            choices=tuple(MissingReleases),
            axis_types="TR",
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Reaction to missing drive releases.",
            source="fixed stop manual 5.3.2",
            effect=Effect.ACCEPTED,
        ),
    )
    detect: Detect = field(default_factory=Detect)
    drive_ident: tuple[DriveIdent, ...] = field(default=(), metadata=array_of(DriveIdent, 4))


def _preset(monitoring: str, window: float, torque: str, torque_max: float) -> tuple[DriveIdent, ...]:
    """Return the two preset objects: position lag monitoring off, torque limited."""
    return (
        DriveIdent(
            id="MON_WINDOW",
            wr_ident=monitoring,
            data_type=ObjectDataType.UNS32,
            min_limit=0.0,
            startup_value=1048575.0,
            active_value=window,
        ),
        DriveIdent(
            id="TORQUE_LIMIT",
            wr_ident=torque,
            data_type=ObjectDataType.UNS16,
            scaling_type=ScalingType.LINEAR,
            scaling_factor=10.0,
            min_limit=0.0,
            max_limit=torque_max,
            startup_value=torque_max,
            active_value=1.0,
        ),
    )


PRESETS: Final[Mapping[DriveType, tuple[DriveIdent, ...]]] = {
    DriveType.SERCOS: _preset("S_0_0159", 0.0, "S_0_0092", 100.0),
    DriveType.CANOPEN: _preset("6065_00", 4294967295.0, "6072_00", 500.0),
}
"""Drive objects preset at start-up. Source: fixed stop manual 5.1.1 and 5.1.2."""
