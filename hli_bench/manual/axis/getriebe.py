"""`getriebe[i].*`: speeds, accelerations and positions of a gear step."""

from dataclasses import dataclass, field

from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.sheet import (
    ACCELERATION,
    JERK,
    LENGTH,
    MICROSECONDS,
    TENTH_PERCENT,
    VELOCITY,
    DataType,
    Effect,
    Sheet,
    Units,
    axis_page,
    param,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Dynamik:
    """`getriebe[i].dynamik.*`: limits of the axis."""

    a_emergency: int = param(
        0,
        Sheet(
            number="P-AXIS-00003",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            units=ACCELERATION,
            high="2*P-AXIS-00008",
            doc="Deceleration of an emergency stop, at most twice P-AXIS-00008; 0: P-AXIS-00008.",
            source="TF5200 gantry operation, infosys page 285764875",
            effect=Effect.EMULATED,
        ),
    )
    a_max: int = param(
        1000,
        Sheet(
            number="P-AXIS-00008",
            data_type=DataType.UNS32,
            low=1,
            high=100_000_000,
            units=ACCELERATION,
            doc="Largest acceleration of the axis.",
            source=axis_page(117642251),
            effect=Effect.EMULATED,
        ),
    )
    tr_min: int = param(
        10000,
        Sheet(
            number="P-AXIS-00201",
            data_type=DataType.UNS32,
            units=MICROSECONDS,
            doc="Shortest ramp time.",
            source=axis_page(117645323),
            effect=Effect.ACCEPTED,
        ),
    )
    vb_max: int = param(
        200000,
        Sheet(
            number="P-AXIS-00212",
            data_type=DataType.UNS32,
            low=1,
            high=2_000_000_000,
            units=VELOCITY,
            doc="Largest speed of the axis.",
            source=axis_page(117640715),
            effect=Effect.EMULATED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class SlopeProfil:
    """`getriebe[i].slope_profil.*`: the jerk-limited (non-linear) slope."""

    a_beschl: int = param(
        1000,
        Sheet(
            number="P-AXIS-00001",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            axis_types="TR",
            doc="Acceleration at feed (G01).",
            source=axis_page(117614731),
            effect=Effect.ACCEPTED,
        ),
    )
    a_brems: int = param(
        1000,
        Sheet(
            number="P-AXIS-00002",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Deceleration at feed (G01).",
            source=axis_page(117616267),
            effect=Effect.ACCEPTED,
        ),
    )
    a_grenz: int = param(
        1000,
        Sheet(
            number="P-AXIS-00004",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Acceleration and deceleration in rapid traverse (G00).",
            source=axis_page(117623947),
            effect=Effect.ACCEPTED,
        ),
    )
    a_feedh: int = param(
        0,
        Sheet(
            number="P-AXIS-00053",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            axis_types="TR",
            doc="Deceleration at feedhold and after a probe event; 0: P-AXIS-00004.",
            source=axis_page(117627019),
            effect=Effect.ACCEPTED,
        ),
    )
    tr_feedh: int = param(
        0,
        Sheet(
            number="P-AXIS-00081",
            data_type=DataType.UNS32,
            low="P-AXIS-00201",
            unset=0,
            units=MICROSECONDS,
            axis_types="TR",
            doc="Ramp time at feedhold; 0: P-AXIS-00200.",
            source=axis_page(117628555),
            effect=Effect.ACCEPTED,
        ),
    )
    tr_beschl_ab: int = param(
        50000,
        Sheet(
            number="P-AXIS-00195",
            data_type=DataType.UNS32,
            low="P-AXIS-00201",
            units=MICROSECONDS,
            doc="Ramp time to reduce the acceleration.",
            source=axis_page(117619339),
            effect=Effect.ACCEPTED,
        ),
    )
    tr_beschl_zu: int = param(
        50000,
        Sheet(
            number="P-AXIS-00196",
            data_type=DataType.UNS32,
            low="P-AXIS-00201",
            units=MICROSECONDS,
            doc="Ramp time to build up the acceleration.",
            source=axis_page(117617803),
            effect=Effect.ACCEPTED,
        ),
    )
    tr_brems_ab: int = param(
        50000,
        Sheet(
            number="P-AXIS-00197",
            data_type=DataType.UNS32,
            low="P-AXIS-00201",
            units=MICROSECONDS,
            doc="Ramp time to reduce the deceleration.",
            source=axis_page(117622411),
            effect=Effect.ACCEPTED,
        ),
    )
    tr_brems_zu: int = param(
        50000,
        Sheet(
            number="P-AXIS-00198",
            data_type=DataType.UNS32,
            low="P-AXIS-00201",
            units=MICROSECONDS,
            doc="Ramp time to build up the deceleration.",
            source=axis_page(117620875),
            effect=Effect.ACCEPTED,
        ),
    )
    tr_grenz: int = param(
        10000,
        Sheet(
            number="P-AXIS-00200",
            data_type=DataType.UNS32,
            low="P-AXIS-00201",
            units=MICROSECONDS,
            doc="Ramp time in rapid traverse.",
            source=axis_page(117625483),
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class LslopeProfil:
    """`getriebe[i].lslope_profil.*`: the linear slope with two acceleration steps."""

    a_grenz_stufe_1: int = param(
        1000,
        Sheet(
            number="P-AXIS-00005",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Rapid traverse acceleration below the changeover speed.",
            source=axis_page(117602315),
            effect=Effect.EMULATED,
        ),
    )
    a_grenz_stufe_2: int = param(
        1000,
        Sheet(
            number="P-AXIS-00006",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Rapid traverse acceleration above the changeover speed.",
            source="TF5200 dynamics, infosys page 248714123",
            effect=Effect.EMULATED,
        ),
    )
    a_stufe_1: int = param(
        1000,
        Sheet(
            number="P-AXIS-00011",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Feed acceleration below the changeover speed.",
            source=axis_page(117594635),
            effect=Effect.EMULATED,
        ),
    )
    a_stufe_2: int = param(
        1000,
        Sheet(
            number="P-AXIS-00012",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Feed acceleration above the changeover speed.",
            source="TF5200 dynamics, infosys page 222127627",
            effect=Effect.EMULATED,
        ),
    )
    a_feedh: int = param(
        0,
        Sheet(
            number="P-AXIS-00024",
            data_type=DataType.UNS32,
            low=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            axis_types="TR",
            doc=(
                "Deceleration at feedhold and after a probe event; 0: the smaller of P-AXIS-00005 and 00006."
            ),
            source=axis_page(117609995),
            effect=Effect.EMULATED,
        ),
    )
    vb_grenz_stufe_1_2: int = param(
        100000,
        Sheet(
            number="P-AXIS-00211",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00212",
            units=VELOCITY,
            doc="Changeover speed in rapid traverse.",
            source=axis_page(117608459),
            effect=Effect.EMULATED,
        ),
    )
    vb_stufe_1_2: int = param(
        100000,
        Sheet(
            number="P-AXIS-00221",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00212",
            units=VELOCITY,
            doc="Changeover speed at feed.",
            source="TF5200 dynamics, infosys page 222127627; default not read, as P-AXIS-00211",
            effect=Effect.EMULATED,
        ),
    )
    d_grenz_stufe_1: int = param(
        0,
        Sheet(
            number="P-AXIS-00280",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Rapid traverse deceleration below the changeover speed; 0: P-AXIS-00005.",
            source=axis_page(117605387),
            effect=Effect.EMULATED,
        ),
    )
    d_grenz_stufe_2: int = param(
        0,
        Sheet(
            number="P-AXIS-00281",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Rapid traverse deceleration above the changeover speed; 0: P-AXIS-00006.",
            source="TF5200 axis parameters; by analogy to P-AXIS-00280",
            effect=Effect.EMULATED,
        ),
    )
    d_stufe_1: int = param(
        0,
        Sheet(
            number="P-AXIS-00282",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Feed deceleration below the changeover speed; 0: P-AXIS-00011.",
            source=axis_page(117597707),
            effect=Effect.EMULATED,
        ),
    )
    d_stufe_2: int = param(
        0,
        Sheet(
            number="P-AXIS-00283",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            doc="Feed deceleration above the changeover speed; 0: P-AXIS-00012.",
            source="TF5200 axis parameters; by analogy to P-AXIS-00282",
            effect=Effect.EMULATED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class GearHoming:
    """`getriebe[i].homing.*`: motion of homing to a fixed stop."""

    torq_move_velocity: int = param(
        0,
        Sheet(
            number="P-AXIS-00333",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00212",
            units=VELOCITY,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Speed of the search for the stop.",
            source=axis_page(117282187),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_move_acceleration: int = param(
        0,
        Sheet(
            number="P-AXIS-00334",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Acceleration of the search for the stop.",
            source=axis_page(117283723),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_move_jerk: int = param(
        0,
        Sheet(
            number="P-AXIS-00335",
            data_type=DataType.UNS32,
            low=1,
            unset=0,
            units=JERK,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Jerk of the search for the stop, below P-AXIS-00008 / P-AXIS-00196.",
            source=axis_page(117285259),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_move_torque_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00342",
            data_type=DataType.UNS16,
            high=1000,
            units=TENTH_PERCENT,
            other_drives="KUKA",
            doc="Torque limit of the search for the stop.",
            source=axis_page(1172867951133182731),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_detect_torque_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00343",
            data_type=DataType.UNS16,
            high=1000,
            units=TENTH_PERCENT,
            replaced_by="P-AXIS-00820",
            other_drives="KUKA",
            doc="Old: share of P-AXIS-00342 at which the stop counts as found.",
            source=axis_page(1172883311133183499),
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Getriebe:
    """`getriebe[i].*`."""

    nummer: int = param(
        1,
        Sheet(
            number="P-AXIS-00135",
            data_type=DataType.UNS16,
            low=1,
            doc="Number of the gear step.",
            source=axis_page(117585419),
            effect=Effect.ACCEPTED,
        ),
    )
    kv: int = param(
        1000,
        Sheet(
            number="P-AXIS-00099",
            data_type=DataType.UNS32,
            low=1,
            units=Units("0.01/s", "0.01/s", "0.01/s"),
            doc="Position loop gain; acts only where the CNC closes the position loop.",
            source=axis_page(117703691),
            effect=Effect.ACCEPTED,
        ),
    )
    moduloo: int = param(
        3_600_000,
        Sheet(
            number="P-AXIS-00126",
            data_type=DataType.SGN32,
            low="P-AXIS-00127",
            units=LENGTH,
            axis_types="RS",
            doc="Upper modulo limit.",
            source=axis_page(117197963),
            effect=Effect.EMULATED,
        ),
    )
    modulou: int = param(
        0,
        Sheet(
            number="P-AXIS-00127",
            data_type=DataType.SGN32,
            high="P-AXIS-00126",
            units=LENGTH,
            axis_types="RS",
            doc="Lower modulo limit.",
            source=axis_page(117199499),
            effect=Effect.EMULATED,
        ),
    )
    pos_refpkt: int = param(
        0,
        Sheet(
            number="P-AXIS-00152",
            data_type=DataType.SGN32,
            low="P-AXIS-00177",
            high="P-AXIS-00178",
            units=LENGTH,
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            doc="Position of the reference point.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    slep_abw: int = param(
        512,
        Sheet(
            number="P-AXIS-00166",
            data_type=DataType.UNS32,
            high=1024,
            doc="Remaining deviation of the non-linear position lag monitoring.",
            source=axis_page(117749515),
            effect=Effect.ACCEPTED,
        ),
    )
    slep_dyn: int = param(
        1000,
        Sheet(
            number="P-AXIS-00167",
            data_type=DataType.SGN16,
            low=0,
            high=1024,
            doc=(
                "Factor of the dynamic position lag monitoring (types 1 and 2); 1024 switches monitoring off."
            ),
            source=axis_page(117746827),
            effect=Effect.ACCEPTED,
        ),
    )
    slep_max: int = param(
        100000,
        Sheet(
            number="P-AXIS-00168",
            data_type=DataType.SGN32,
            low=1,
            units=LENGTH,
            doc="Largest position lag; type 4: the limit of a moving axis.",
            source=axis_page(117745291),
            effect=Effect.EMULATED,
        ),
    )
    slep_min: int = param(
        20000,
        Sheet(
            number="P-AXIS-00169",
            data_type=DataType.SGN32,
            low=1,
            units=LENGTH,
            doc="Smallest position lag limit; type 4: the limit at standstill.",
            source=axis_page(117743755),
            effect=Effect.EMULATED,
        ),
    )
    slep_ueberw_typ: int = param(
        0,
        Sheet(
            number="P-AXIS-00172",
            data_type=DataType.UNS32,
            not_emulated=(1, 2, 3),
            doc="Position lag monitoring: 1 standard, 2 linear, 4 independent of the speed, else off.",
            source=axis_page(117742219),
            effect=Effect.EMULATED,
        ),
    )
    vb_eilgang: int = param(
        166666,
        Sheet(
            number="P-AXIS-00209",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00212",
            units=VELOCITY,
            doc="Rapid traverse speed (G00).",
            source=axis_page(117631627),
            effect=Effect.EMULATED,
        ),
    )
    vb_reflow: int = param(
        16666,
        Sheet(
            number="P-AXIS-00218",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00219",
            units=VELOCITY,
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Slow homing speed.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    vb_refmax: int = param(
        83333,
        Sheet(
            number="P-AXIS-00219",
            data_type=DataType.UNS32,
            low="P-AXIS-00218",
            high="P-AXIS-00212",
            units=VELOCITY,
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Fast homing speed.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    wegaufn: int = param(
        1,
        Sheet(
            number="P-AXIS-00233",
            data_type=DataType.UNS32,
            low=1,
            units=LENGTH,
            doc="Resolution of the measuring system, path (denominator).",
            source=axis_page(117770763),
            effect=Effect.EMULATED,
        ),
    )
    wegaufz: int = param(
        1,
        Sheet(
            number="P-AXIS-00234",
            data_type=DataType.UNS32,
            low=1,
            units=Units("increments", "increments", "increments"),
            doc="Resolution of the measuring system, increments (numerator).",
            source=axis_page(125765771),
            effect=Effect.EMULATED,
        ),
    )
    window: int = param(
        500,
        Sheet(
            number="P-AXIS-00236",
            data_type=DataType.SGN32,
            low=0,
            units=LENGTH,
            doc="Position window for exact stop: in position while the lag is not larger.",
            source=axis_page(117705227),
            effect=Effect.ACCEPTED,
        ),
    )
    slope_type: int = param(
        0,
        Sheet(
            number="P-AXIS-00270",
            data_type=DataType.UNS16,
            choices=(0, 1, 2),
            doc="Profile of homing: 0 linear, 1 trapezoidal, 2 sine square; homing always runs with the linear one.",
            source="TF5200 dynamics, infosys page 248658571; homing manual 2; type and range decided here",
            effect=Effect.ACCEPTED,
        ),
    )
    vb_not_referenced: int = param(
        0,
        Sheet(
            number="P-AXIS-00268",
            data_type=DataType.UNS32,
            high="P-AXIS-00212",
            units=VELOCITY,
            doc="Largest speed of spindles and single axes before homing.",
            source=axis_page(117250187),
            effect=Effect.ACCEPTED,
        ),
    )
    a_ref: int = param(
        0,
        Sheet(
            number="P-AXIS-00285",
            data_type=DataType.UNS32,
            low=0,
            high="P-AXIS-00008",
            units=ACCELERATION,
            axis_types="TR",
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Homing acceleration; 0: the smaller of P-AXIS-00005 and 00006.",
            source=axis_page(117262475),
            effect=Effect.EMULATED,
        ),
    )
    tr_ref: int = param(
        0,
        Sheet(
            number="P-AXIS-00286",
            data_type=DataType.UNS32,
            units=MICROSECONDS,
            axis_types="TR",
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Homing ramp time; 0 or too small: P-AXIS-00201.",
            source=axis_page(117264011),
            effect=Effect.ACCEPTED,
        ),
    )
    pos_lag_mon_error_delay_time: int = param(
        0,
        Sheet(
            number="P-AXIS-00488",
            data_type=DataType.UNS32,
            high=250000,
            units=MICROSECONDS,
            doc="Time by which type 4 of the position lag monitoring delays its error.",
            source=axis_page(117758859),
            effect=Effect.EMULATED,
        ),
    )
    position_settling_time: int = param(
        -1,
        Sheet(
            number="P-AXIS-00532",
            data_type=DataType.SGN32,
            units=MICROSECONDS,
            doc="Longest time until the axis is in the exact stop window; 0 off, negative: P-AXIS-00151.",
            source=axis_page(117752587),
            effect=Effect.ACCEPTED,
        ),
    )
    dynamik: Dynamik = field(default_factory=Dynamik)
    slope_profil: SlopeProfil = field(default_factory=SlopeProfil)
    lslope_profil: LslopeProfil = field(default_factory=LslopeProfil)
    homing: GearHoming = field(default_factory=GearHoming)
