"""`antr.*`: the drive and what the CNC may do with it."""

from dataclasses import dataclass, field

from hli_bench.manual.axis.fixed_stop import NO_LIMIT, FixedStop
from hli_bench.manual.axis.words import (
    Communication,
    ObjectDataType,
    ReferenceCamSignal,
    ScalingType,
    TriggerSource,
)
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.sheet import LENGTH, DataType, Effect, Sheet, Units, array_of, axis_page, param


@dataclass(frozen=True, slots=True, kw_only=True)
class Function:
    """`antr.function[i].*`: a drive object that #DRIVE writes."""

    id: str = param(
        "",
        Sheet(
            number="P-AXIS-00396",
            data_type=DataType.STRING,
            max_length=29,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Name of the drive function in the #DRIVE command (KEY=).",
            source="TF5200 drive command, infosys page 225973131",
            effect=Effect.EMULATED,
        ),
    )
    commu: Communication = param(
        Communication.CYCLIC,
        Sheet(
            number="P-AXIS-00397",
            data_type=DataType.STRING,
            choices=tuple(Communication),
            not_emulated=(Communication.CYCLIC,),
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="How the function is reached.",
            source="drive command, infosys page 15318549771; default decided here",
            effect=Effect.EMULATED,
        ),
    )
    wr_ident: tuple[str, ...] = param(
        ("", ""),
        Sheet(
            number="P-AXIS-00398",
            data_type=DataType.STRING,
            max_length=29,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Drive object (6072_00, S-0-0092) or telegram element; at most two.",
            source=axis_page(118089227),
            effect=Effect.EMULATED,
        ),
    )
    data_type: ObjectDataType = param(
        ObjectDataType.SGN16,
        Sheet(
            number="P-AXIS-00399",
            data_type=DataType.STRING,
            choices=tuple(ObjectDataType),
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            not_emulated=(ObjectDataType.BITARRAY_16, ObjectDataType.BITARRAY_32),
            doc="Data type of the object.",
            source="TF5200 drive command, infosys page 225973131; default as P-AXIS-00722",
            effect=Effect.EMULATED,
        ),
    )
    startup_value: float = param(
        0.0,
        Sheet(
            number="P-AXIS-00400",
            data_type=DataType.REAL64,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Value after start-up of a cyclic element.",
            source=axis_page(118092299),
            effect=Effect.ACCEPTED,
        ),
    )
    scaling_type: ScalingType = param(
        ScalingType.UNSCALED,
        Sheet(
            number="P-AXIS-00401",
            data_type=DataType.STRING,
            choices=tuple(ScalingType),
            not_emulated=(ScalingType.TORQUE_DRIVE_SIDE,),
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Scaling on the way to the drive.",
            source=axis_page(118093835),
            effect=Effect.EMULATED,
        ),
    )
    scaling_factor: float = param(
        1.0,
        Sheet(
            number="",
            data_type=DataType.REAL64,
            nonzero=True,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Factor of LINEAR scaling.",
            source="measurement manual 7.2.2 (example, no number printed)",
            effect=Effect.EMULATED,
        ),
    )
    min_limit: float = param(
        NO_LIMIT,
        Sheet(
            number="P-AXIS-00408",
            data_type=DataType.REAL64,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Smallest output value; 1.0e+199 off.",
            source=axis_page(118096523),
            effect=Effect.EMULATED,
        ),
    )
    max_limit: float = param(
        NO_LIMIT,
        Sheet(
            number="P-AXIS-00409",
            data_type=DataType.REAL64,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Largest output value; 1.0e+199 off.",
            source="TF5200 drive command, infosys page 225973131",
            effect=Effect.EMULATED,
        ),
    )
    mask: str = param(
        "NOT_USED",
        Sheet(
            number="P-AXIS-00429",
            data_type=DataType.STRING,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Bit mask for writing single bits.",
            source="TF5200 drive command, infosys page 225973131; default as P-AXIS-00727",
            effect=Effect.REFUSED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class At:
    """`antr.sercos.at[i].*`: an element of the drive telegram."""

    ident_len: int = param(
        4,
        Sheet(
            number="P-AXIS-00087",
            data_type=DataType.UNS08,
            units=Units("bytes", "bytes", "bytes"),
            drive_types=(DriveType.SERCOS,),
            doc="Length of a telegram element.",
            source=axis_page(117989899),
            effect=Effect.ACCEPTED,
        ),
    )
    ident_nr: int = param(
        0,
        Sheet(
            number="P-AXIS-00089",
            data_type=DataType.UNS16,
            drive_types=(DriveType.SERCOS,),
            doc="SERCOS ident of a telegram element.",
            source=axis_page(117988363),
            effect=Effect.ACCEPTED,
        ),
    )
    nc_ref: str = param(
        "",
        Sheet(
            number="",
            data_type=DataType.STRING,
            drive_types=(DriveType.SERCOS,),
            doc="Name of a telegram element in the CNC.",
            source="homing manual 2.5 (example, no number printed)",
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Sercos:
    """`antr.sercos.*`."""

    drive_supports_cnc_homing: bool = param(
        False,
        Sheet(
            number="P-AXIS-00386",
            data_type=DataType.BOOLEAN,
            drive_types=(DriveType.SERCOS,),
            doc="CNC-controlled homing with the zero pulse latch of S-0-146.",
            source="homing manual 4.2",
            effect=Effect.REFUSED,
        ),
    )
    cnc_homing_rt_bit_layout: int = param(
        0,
        Sheet(
            number="P-AXIS-00387",
            data_type=DataType.UNS16,
            low=1,
            high=16,
            unset=0,
            drive_types=(DriveType.SERCOS,),
            doc="Where the control and status bits of that homing are transferred.",
            source="homing manual 4.2",
            effect=Effect.ACCEPTED,
        ),
    )
    at: tuple[At, ...] = field(default=(), metadata=array_of(At, 8))


@dataclass(frozen=True, slots=True, kw_only=True)
class Canopen:
    """`antr.canopen.*`."""

    probing_input_number: int = param(
        0,
        Sheet(
            number="P-AXIS-00295",
            data_type=DataType.UNS16,
            low=1,
            high=2,
            unset=0,
            drive_types=(DriveType.CANOPEN,),
            replaced_by="P-AXIS-00430",
            doc="Old: probing input of a CANopen drive.",
            source=axis_page(118062347),
            effect=Effect.EMULATED,
        ),
    )
    cyclic_position_op_mode: int = param(
        8,
        Sheet(
            number="P-AXIS-00463",
            data_type=DataType.SGN16,
            drive_types=(DriveType.CANOPEN,),
            doc="Mode of operation written for cyclic position commands.",
            source=axis_page(118065419),
            effect=Effect.REFUSED,
        ),
    )
    cyclic_velocity_op_mode: int = param(
        9,
        Sheet(
            number="P-AXIS-00464",
            data_type=DataType.SGN16,
            drive_types=(DriveType.CANOPEN,),
            doc="Mode of operation written for cyclic velocity commands.",
            source=axis_page(118066955),
            effect=Effect.ACCEPTED,
        ),
    )
    probing_trigger_source: TriggerSource = param(
        TriggerSource.DEFAULT,
        Sheet(
            number="P-AXIS-00702",
            data_type=DataType.STRING,
            choices=tuple(TriggerSource),
            axis_types="TR",
            drive_types=(DriveType.CANOPEN,),
            doc="Who chooses the trigger: the CNC in the touch probe function, or the drive in 60D0.",
            source=axis_page(308119307),
            effect=Effect.EMULATED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceCheck:
    """`antr.reference_check.*`: reference monitoring. Examples spell it `antr.homing_check`."""

    bit_nr: int = param(
        -1,
        Sheet(
            number="P-AXIS-00425",
            data_type=DataType.SGN16,
            low=-1,
            high=31,
            aliases=("antr.homing_check.bit_nr",),
            drive_types=(DriveType.SERCOS,),
            doc="Bit of the signal 'drive is referenced'; -1 no reference monitoring.",
            source="homing manual 4.2",
            effect=Effect.ACCEPTED,
        ),
    )
    element_name: str = param(
        "",
        Sheet(
            number="P-AXIS-00426",
            data_type=DataType.STRING,
            aliases=("antr.homing_check.element_name",),
            drive_types=(DriveType.SERCOS,),
            doc="Telegram element with that bit; empty: no reference monitoring.",
            source="homing manual 4.2",
            effect=Effect.REFUSED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Simu:
    """`antr.simu.*`: the simulated drive. An example spells it `antr_simu`."""

    rpf_weg_bis_nip: int = param(
        10,
        Sheet(
            number="P-AXIS-00161",
            data_type=DataType.SGN32,
            units=LENGTH,
            drive_types=(DriveType.SIMULATION,),
            aliases=("antr_simu.rpf_weg_bis_nip",),
            doc="Path to the zero pulse when homing is simulated.",
            source="homing manual 4.2",
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Antr:
    """`antr.*`."""

    reference_cam_signal: ReferenceCamSignal = param(
        ReferenceCamSignal.PLC,
        Sheet(
            number="P-AXIS-00321",
            data_type=DataType.STRING,
            choices=tuple(ReferenceCamSignal),
            not_emulated=(
                ReferenceCamSignal.RT_STATUS_BIT_1,
                ReferenceCamSignal.RT_STATUS_BIT_2,
            ),
            drive_types=(DriveType.SERCOS, DriveType.LIGHTBUS, DriveType.CANOPEN),
            doc="Where the reference cam signal comes from.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    torque_scale_num: int = param(
        1,
        Sheet(
            number="P-AXIS-00325",
            data_type=DataType.UNS32,
            low=1,
            drive_types=(DriveType.SERCOS, DriveType.LIGHTBUS, DriveType.CANOPEN),
            doc="Torque scaling, numerator.",
            source=axis_page(117520523),
            effect=Effect.ACCEPTED,
        ),
    )
    torque_scale_denom: int = param(
        1,
        Sheet(
            number="P-AXIS-00326",
            data_type=DataType.UNS32,
            low=1,
            drive_types=(DriveType.SERCOS, DriveType.LIGHTBUS, DriveType.CANOPEN),
            doc="Torque scaling, denominator.",
            source=axis_page(117522059),
            effect=Effect.ACCEPTED,
        ),
    )
    encoder_overflow_offset: int = param(
        0,
        Sheet(
            number="P-AXIS-00354",
            data_type=DataType.SGN32,
            units=LENGTH,
            drive_types=(DriveType.SERCOS, DriveType.LIGHTBUS, DriveType.CANOPEN),
            doc="Shift of the encoder overflow.",
            source="homing manual 4.2",
            effect=Effect.ACCEPTED,
        ),
    )
    encoder_bit_range: int = param(
        0,
        Sheet(
            number="P-AXIS-00355",
            data_type=DataType.UNS08,
            low=1,
            high=31,
            unset=0,
            drive_types=(DriveType.SERCOS, DriveType.LIGHTBUS, DriveType.CANOPEN),
            doc="Bits of the position that make the encoder overflow.",
            source="homing manual 4.2",
            effect=Effect.ACCEPTED,
        ),
    )
    cnc_homing_encoder: int = param(
        0,
        Sheet(
            number="P-AXIS-00388",
            data_type=DataType.SGN16,
            choices=(0, 1, 2, 3),
            drive_types=(DriveType.SERCOS,),
            doc="Encoder of CNC-controlled homing: 0 not set, 1 automatic, 2 motor, 3 external.",
            source="homing manual 4.2",
            effect=Effect.ACCEPTED,
        ),
    )
    acc_reference_value: float = param(
        1.0,
        Sheet(
            number="P-AXIS-00392",
            data_type=DataType.REAL64,
            low=0,
            units=Units("N", "Nm", "Nm"),
            drive_types=(DriveType.SERCOS, DriveType.CANOPEN),
            doc="Stall torque of the motor: what a torque of 1 in the motor format stands for.",
            source="TF5200 axis parameters 8.1.12; group of the path as there",
            effect=Effect.ACCEPTED,
        ),
    )
    probing_input_nbr: int = param(
        0,
        Sheet(
            number="P-AXIS-00430",
            data_type=DataType.UNS08,
            choices=(0, 1, 2),
            since="V2.10.1505.26",
            replaces=("P-AXIS-00295",),
            replaced_by="P-AXIS-00517",
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE, DriveType.CANOPEN),
            doc="Old: probing input of the drive; 0: input 1.",
            source=axis_page(117935115),
            effect=Effect.EMULATED,
        ),
    )
    simu: Simu = field(default_factory=Simu)
    reference_check: ReferenceCheck = field(default_factory=ReferenceCheck)
    sercos: Sercos = field(default_factory=Sercos)
    canopen: Canopen = field(default_factory=Canopen)
    function: tuple[Function, ...] = field(default=(), metadata=array_of(Function, 20))
    """At most 20: decided here, the manuals call the number application-specific."""
    fixed_stop: FixedStop = field(default_factory=FixedStop)
