"""`kenngr.*`: characteristics of the axis, measuring and homing among them."""

from dataclasses import dataclass, field

from hli_bench.manual.axis.words import Edge, HomingDirection, HomingType, ProbingSignal
from hli_bench.manual.drive_types import AxisMode, AxisType, DriveType
from hli_bench.manual.sheet import (
    CYCLES,
    LENGTH,
    MICROSECONDS,
    TENTH_PERCENT,
    VELOCITY,
    DataType,
    Effect,
    Sheet,
    array_of,
    axis_page,
    param,
)

EMULATED_MODES = (
    AxisMode.LINEAR | AxisMode.MODULO | AxisMode.KEINE_AUTO_RPF | AxisMode.ALLOW_RESOLUTION_CHANGE
)
"""Bits of P-AXIS-00015 that ask for nothing unbuilt: no spindle homes by itself here, no list changes while running."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedStopDetect:
    """`kenngr.measure.fixed_stop_detect.*`: when a measuring run has met its stop."""

    pos_lag_limit: int = param(
        -1,
        Sheet(
            number="P-AXIS-00774",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            drive_types=(
                DriveType.SERCOS,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            since="V2.11.2810.01",
            replaces=("P-AXIS-00331",),
            doc="Position lag that means a fixed stop; 0 off, negative: P-AXIS-00769, then 00331.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    min_time: int = param(
        0,
        Sheet(
            number="P-AXIS-00775",
            data_type=DataType.UNS32,
            units=MICROSECONDS,
            axis_types="TR",
            since="V2.11.2810.01",
            replaces=("P-AXIS-00332",),
            low=1,
            unset=0,
            doc="Time the criteria must hold; 0: P-AXIS-00770, then the cycles of 00332.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    start_distance: int = param(
        0,
        Sheet(
            number="P-AXIS-00776",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            since="V2.11.2810.01",
            doc="Path in the block before detection is armed; negative: P-AXIS-00771, else block start.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    start_distance_per_mille: int = param(
        -1,
        Sheet(
            number="P-AXIS-00777",
            data_type=DataType.SGN16,
            units=TENTH_PERCENT,
            axis_types="TR",
            doc=(
                "Share of the block before detection is armed; negative: P-AXIS-00772, else block "
                "start. A value above 1000 is kept with a warning and stops the run with 51026."
            ),
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    max_delta_position_window: int = param(
        -1,
        Sheet(
            number="P-AXIS-00778",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            doc="Largest path in the time of P-AXIS-00775 at a stop; negative: P-AXIS-00773, else off.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """`kenngr.measure.probe[i].*`: drive inputs behind the keywords PROBE0 and PROBE1."""

    input: int = param(
        0,
        Sheet(
            number="P-AXIS-00583",
            data_type=DataType.SGN16,
            axis_types="TR",
            since="V2.11.2808.00",
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.SERCOS,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            doc="Drive input meant by INPUT=PROBE0 / PROBE1; 0: P-AXIS-00517 / 00539.",
            source=axis_page(222331531),
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Measure:
    """`kenngr.measure.*`: source, input and edge of the probing signal."""

    signal: ProbingSignal = param(
        ProbingSignal.UNSET,
        Sheet(
            number="P-AXIS-00516",
            data_type=DataType.STRING,
            since="V2.11.2019.15",
            choices=tuple(ProbingSignal),
            replaces=(
                "P-AXIS-00115",
                "P-AXIS-00116",
                "P-AXIS-00117",
                "P-AXIS-00257",
                "P-AXIS-00269",
                "P-AXIS-00330",
            ),
            not_emulated=(
                ProbingSignal.PLC_EXT_LATCH_CONTROL,
                ProbingSignal.PLC_FIRST_EVENT,
                ProbingSignal.EXT_PROBE_WITH_DRIVE,
            ),
            doc="Source of the probing signal in a measuring run; empty: the older parameters decide.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    input: int = param(
        0,
        Sheet(
            number="P-AXIS-00517",
            data_type=DataType.UNS08,
            since="V2.11.2019.15",
            replaces=("P-AXIS-00430", "P-AXIS-00295"),
            doc=(
                "Probing input; 0: P-AXIS-00430. 1..2 for DRIVE (1 for drives with one input), 1..255"
                " for PLC_EXT_LATCH_CONTROL."
            ),
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    edge: Edge = param(
        Edge.UNSET,
        Sheet(
            number="P-AXIS-00518",
            data_type=DataType.STRING,
            choices=tuple(Edge),
            since="V2.11.2019.15",
            replaces=("P-AXIS-00113",),
            doc="Edge of the probing signal that latches; empty: P-AXIS-00113.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    input_edge_banding: int = param(
        0,
        Sheet(
            number="P-AXIS-00539",
            data_type=DataType.UNS08,
            drive_types=(DriveType.SERCOS, DriveType.PROFIDRIVE),
            doc="Probing input for edge banding; 0: the input of P-AXIS-00517.",
            source=axis_page(117333003),
            effect=Effect.ACCEPTED,
        ),
    )
    probe: tuple[Probe, ...] = field(default=(), metadata=array_of(Probe, 2))
    fixed_stop_detect: FixedStopDetect = field(default_factory=FixedStopDetect)


@dataclass(frozen=True, slots=True, kw_only=True)
class Homing:
    """`kenngr.homing.*`: kind of homing, and homing to a fixed stop."""

    homing_type: HomingType = param(
        HomingType.CNC_CONTROLLED,
        Sheet(
            number="P-AXIS-00299",
            data_type=DataType.STRING,
            choices=tuple(HomingType),
            words=(("DRIVE_CONROLLED", HomingType.DRIVE_CONTROLLED),),
            aliases=("kenngr.homing_type",),
            not_emulated=(HomingType.DRIVE_CONTROLLED, HomingType.TORQ, HomingType.NONE),
            doc="Who controls homing; not given, a SERCOS axis homes DRIVE_CONTROLLED.",
            source="homing manual 4.2 and 4.3",
            effect=Effect.EMULATED,
        ),
    )
    torq_min_distance: int = param(
        0,
        Sheet(
            number="P-AXIS-00344",
            data_type=DataType.SGN32,
            low=0,
            high="P-AXIS-00345",
            units=LENGTH,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Path that must be travelled before a stop counts.",
            source=axis_page(117289867),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_max_distance: int = param(
        0,
        Sheet(
            number="P-AXIS-00345",
            data_type=DataType.SGN32,
            low=0,
            units=LENGTH,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Longest path of the search for the stop.",
            source=axis_page(117291403),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_homing_dir: HomingDirection = param(
        HomingDirection.NEGATIVE,
        Sheet(
            number="P-AXIS-00346",
            data_type=DataType.STRING,
            choices=tuple(HomingDirection),
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Direction of the search for the stop.",
            source=axis_page(117292939),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_detect_velocity_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00347",
            data_type=DataType.UNS16,
            high=1000,
            units=TENTH_PERCENT,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Rest of the search speed at which the stop counts as found.",
            source=axis_page(117294475),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_retraction_distance: int = param(
        0,
        Sheet(
            number="P-AXIS-00348",
            data_type=DataType.SGN32,
            low=0,
            units=LENGTH,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Path back from the stop.",
            source=axis_page(117296011),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_homing_position: int = param(
        0,
        Sheet(
            number="P-AXIS-00349",
            data_type=DataType.SGN32,
            low=0,
            units=LENGTH,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Position of the stop.",
            source=axis_page(117297547),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_detect_time: int = param(
        0,
        Sheet(
            number="P-AXIS-00350",
            data_type=DataType.UNS32,
            units=MICROSECONDS,
            drive_types=(DriveType.SERCOS,),
            other_drives="KUKA",
            doc="Time the criteria must hold at the stop.",
            source=axis_page(117299083),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_detect_pos_lag_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00819",
            data_type=DataType.SGN32,
            low=0,
            units=LENGTH,
            drive_types=(DriveType.SIMULATION, DriveType.SERCOS, DriveType.CANOPEN),
            since="V3.1.3080.11",
            doc="Position lag at which the stop counts as found; 0: P-AXIS-00769, else unused.",
            source=axis_page(1088256907),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_detect_torque_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00820",
            data_type=DataType.UNS16,
            high=1000,
            units=TENTH_PERCENT,
            drive_types=(DriveType.SIMULATION, DriveType.SERCOS, DriveType.CANOPEN),
            since="V3.1.3080.11",
            replaces=("P-AXIS-00343",),
            doc=(
                "Share of the reduced torque at which the stop counts as found; 0: P-AXIS-00818, else unused."
            ),
            source=axis_page(1088262283),
            effect=Effect.ACCEPTED,
        ),
    )
    torq_distance_to_block: int = param(
        0,
        Sheet(
            number="P-AXIS-00822",
            data_type=DataType.UNS32,
            units=LENGTH,
            drive_types=(DriveType.SIMULATION,),
            doc="Simulation: path after which the drive behaves as blocked; 0 off.",
            source="TF5200 axis parameters, infosys page 1088273035; group of the path decided here",
            effect=Effect.ACCEPTED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Kenngr:
    """`kenngr.*`."""

    abs_pos_gueltig: bool = param(
        False,
        Sheet(
            number="P-AXIS-00014",
            data_type=DataType.BOOLEAN,
            drive_types=(DriveType.SIMULATION, DriveType.SERCOS, DriveType.CANOPEN),
            doc="The axis has an absolute position measuring system: no homing needed.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    achs_mode: AxisMode = param(
        AxisMode.LINEAR,
        Sheet(
            number="P-AXIS-00015",
            data_type=DataType.UNS32,
            low=0x1,
            high=0x1FFFFFFF,
            not_emulated=tuple(one for one in AxisMode if one not in EMULATED_MODES),
            doc="Axis mode bits; exactly one of LINEAR (0x1) and MODULO (0x4).",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    achs_typ: AxisType = param(
        AxisType.TRANSLATOR,
        Sheet(
            number="P-AXIS-00018",
            data_type=DataType.STRING,
            choices=tuple(AxisType),
            words=(
                ("ACHSTYP_TRANSLATOR", AxisType.TRANSLATOR),
                ("ACHSTYP_ROTATOR", AxisType.ROTATOR),
                ("ACHSTYP_SPINDEL", AxisType.SPINDEL),
            ),
            doc="Axis type: translator 1, rotator 2, spindle 4.",
            source="TF5200 coordinate systems, infosys page 306382475",
            effect=Effect.EMULATED,
        ),
    )
    antr_typ: DriveType = param(
        DriveType.SIMULATION,
        Sheet(
            number="P-AXIS-00020",
            data_type=DataType.UNS16,
            choices=tuple(DriveType),
            aliases=("antr_typ",),
            words=(
                ("ANTR_TYP_KONV", 1),
                ("ANTR_TYP_SERCOS", 2),
                ("ANTR_TYP_PROFIDRIVE", 3),
                ("ANTR_TYP_SIMU", 4),
                ("ANTR_TYP_LIGHTBUS", 5),
                ("ANTR_TYP_TERM", 6),
                ("ANTR_TYP_ETHERNET", 7),
                ("ANTR_TYP_CANOPEN", 8),
                ("ANTR_TYP_VIRTUELL", 16),
                ("ANTR_TYP_CAN", 32),
            ),
            not_emulated=tuple(one for one in DriveType if one is not DriveType.CANOPEN),
            doc="Drive type; read at start-up only.",
            source=axis_page(117185419),
            effect=Effect.EMULATED,
        ),
    )
    vorz_richtung: bool = param(
        False,
        Sheet(
            number="P-AXIS-00224",
            data_type=DataType.BOOLEAN,
            axis_types="RS",
            doc="The spindle may turn in one direction only, that of P-AXIS-00031.",
            source="homing manual 3.6.1 (example), TF5200 axis parameters 3.1.2.1",
            effect=Effect.ACCEPTED,
        ),
    )
    beweg_richt: bool = param(
        False,
        Sheet(
            number="P-AXIS-00031",
            data_type=DataType.BOOLEAN,
            axis_types="RS",
            doc="Direction in which a spindle with P-AXIS-00224 = 1 turns: 0 negative, 1 positive.",
            source="homing manual 3.6.1 (example), TF5200 axis parameters 3.1.2.2",
            effect=Effect.ACCEPTED,
        ),
    )
    echtzeit_bit_nr: int = param(
        0,
        Sheet(
            number="P-AXIS-00060",
            data_type=DataType.UNS08,
            high=2,
            axis_types="TR",
            drive_types=(DriveType.SERCOS,),
            doc="SERCOS real-time bits for measuring; 1 or 2 recommended, 0 needs P-AXIS-00106.",
            source="measurement manual 8.2.2",
            effect=Effect.ACCEPTED,
        ),
    )
    fast_from_cam: bool = param(
        True,
        Sheet(
            number="P-AXIS-00064",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            doc="Leave the cam with vb_refmax (1) or vb_reflow (0).",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    gantry_ax_nr: int = param(
        0,
        Sheet(
            number="P-AXIS-00070",
            data_type=DataType.UNS16,
            low=1,
            unset=0,
            axis_types="TR",
            doc="Logical axis number of the gantry master, in the list of the slave.",
            source="TF5200 gantry operation, infosys page 285764875",
            effect=Effect.REFUSED,
        ),
    )
    gantry_max_diff_reset_locked: int = param(
        0,
        Sheet(
            number="P-AXIS-00071",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            low="P-AXIS-00072",
            unset=0,
            doc="Gantry difference from which no reset is possible.",
            source="TF5200 gantry operation, infosys page 285747979; type and default decided here",
            effect=Effect.REFUSED,
        ),
    )
    gantry_max_diff_resetable: int = param(
        0,
        Sheet(
            number="P-AXIS-00072",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            low=1,
            unset=0,
            doc="Gantry difference that is an error which a reset clears.",
            source="TF5200 gantry operation, infosys page 285747979; type and default decided here",
            effect=Effect.REFUSED,
        ),
    )
    gantry_offset: int = param(
        0,
        Sheet(
            number="P-AXIS-00073",
            data_type=DataType.SGN32,
            units=LENGTH,
            axis_types="TR",
            doc="Static offset of the gantry slave to its master.",
            source="TF5200 gantry operation, infosys page 285747979; type and default decided here",
            effect=Effect.REFUSED,
        ),
    )
    gantry_slave_no_homing: bool = param(
        False,
        Sheet(
            number="P-AXIS-00074",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            doc="A gantry slave is not homed itself; it takes its reference position with the master.",
            source="homing manual 4.2",
            effect=Effect.REFUSED,
        ),
    )
    gantry_vb_korr: int = param(
        0,
        Sheet(
            number="P-AXIS-00075",
            data_type=DataType.UNS32,
            high="P-AXIS-00212",
            units=VELOCITY,
            axis_types="TR",
            low=1,
            unset=0,
            doc="Speed at which the gantry difference is removed.",
            source=axis_page(117393931),
            effect=Effect.REFUSED,
        ),
    )
    homing_without_zero_pulse: bool = param(
        False,
        Sheet(
            number="P-AXIS-00084",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            doc="Home on the cam only (1) or on the zero pulse after the cam (0).",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    hub_messtaster: int = param(
        50000,
        Sheet(
            number="P-AXIS-00086",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            doc="Stroke of the probe; types 2 and 4 limit the feed so that the axis brakes within it.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    kasto_achse: bool = param(
        False,
        Sheet(
            number="P-AXIS-00098",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            doc="The axis takes part in edge banding.",
            source=axis_page(117385227),
            effect=Effect.REFUSED,
        ),
    )
    max_vb_override: int = param(
        1000,
        Sheet(
            number="P-AXIS-00109",
            data_type=DataType.UNS16,
            low=1,
            high=2000,
            units=TENTH_PERCENT,
            doc="Largest axis override of independent axes and spindles.",
            source=axis_page(117486091),
            effect=Effect.ACCEPTED,
        ),
    )
    mess_neg_flanke: bool = param(
        False,
        Sheet(
            number="P-AXIS-00113",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            replaced_by="P-AXIS-00518",
            doc="Old: latch at the negative edge.",
            source="measurement manual 8.2.4 (old parameters)",
            effect=Effect.EMULATED,
        ),
    )
    mess_offset: int = param(
        0,
        Sheet(
            number="P-AXIS-00114",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            replaced_by="P-AXIS-00467",
            doc="Old: travel past the target while no probe event came, type 2 only.",
            source=axis_page(117323787),
            effect=Effect.EMULATED,
        ),
    )
    mess_signal_achs_steuer: bool = param(
        False,
        Sheet(
            number="P-AXIS-00115",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            replaced_by="P-AXIS-00516",
            doc="Old: a bit of the axis control mask is the probing signal.",
            source="measurement manual 8.2.4 (old parameters)",
            effect=Effect.EMULATED,
        ),
    )
    mess_signal_sercos: bool = param(
        False,
        Sheet(
            number="P-AXIS-00116",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            drive_types=(DriveType.SERCOS,),
            replaced_by="P-AXIS-00516",
            doc="Old: a SERCOS drive measures.",
            source="measurement manual 8.2.4 (old parameters)",
            effect=Effect.EMULATED,
        ),
    )
    mess_signal_taster: bool = param(
        False,
        Sheet(
            number="P-AXIS-00117",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            replaced_by="P-AXIS-00516",
            doc="Old: the probe is wired to a hardware interface of the kernel.",
            source="measurement manual 8.2.4 (old parameters)",
            effect=Effect.EMULATED,
        ),
    )
    messachse: bool = param(
        False,
        Sheet(
            number="P-AXIS-00118",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            doc="The axis may take part in measuring runs.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    ref_ohne_nocken: bool = param(
        False,
        Sheet(
            number="P-AXIS-00156",
            data_type=DataType.BOOLEAN,
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Home without a cam; then P-AXIS-00157 must be 1 too.",
            source="homing manual 4.2",
            effect=Effect.REFUSED,
        ),
    )
    ref_ohne_rev: bool = param(
        False,
        Sheet(
            number="P-AXIS-00157",
            data_type=DataType.BOOLEAN,
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Home in one phase, without reversal.",
            source="homing manual 4.2",
            effect=Effect.REFUSED,
        ),
    )
    ref_richt: bool = param(
        False,
        Sheet(
            number="P-AXIS-00158",
            data_type=DataType.BOOLEAN,
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Direction of homing from beside the cam: 0 negative, 1 positive.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    swe_neg: int = param(
        -100_000_000,
        Sheet(
            number="P-AXIS-00177",
            data_type=DataType.SGN32,
            high="P-AXIS-00178",
            units=LENGTH,
            axis_types="TR",
            doc="Negative software limit switch.",
            source=axis_page(117313035),
            effect=Effect.EMULATED,
        ),
    )
    swe_pos: int = param(
        100_000_000,
        Sheet(
            number="P-AXIS-00178",
            data_type=DataType.SGN32,
            low="P-AXIS-00177",
            units=LENGTH,
            axis_types="TR",
            doc="Positive software limit switch.",
            source=axis_page(117311499),
            effect=Effect.EMULATED,
        ),
    )
    swe_toleranz: int = param(
        1000,
        Sheet(
            number="P-AXIS-00179",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="How far actual positions may lie beyond the software limit switches.",
            source=axis_page(117309963),
            effect=Effect.EMULATED,
        ),
    )
    vb_messen: int = param(
        16666,
        Sheet(
            number="P-AXIS-00215",
            data_type=DataType.UNS32,
            low=1,
            high="P-AXIS-00212",
            units=VELOCITY,
            axis_types="TR",
            doc="Measuring feed of type 2.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    probing_signal_via_plc: bool = param(
        False,
        Sheet(
            number="P-AXIS-00257",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            replaced_by="P-AXIS-00516",
            doc="Old: the probing signal comes over the HLI control unit.",
            source="measurement manual 8.2.4 (old parameters)",
            effect=Effect.EMULATED,
        ),
    )
    meas_signal_drive: bool = param(
        False,
        Sheet(
            number="P-AXIS-00269",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            replaced_by="P-AXIS-00516",
            doc="Old: the drive supplies the probing signal.",
            source=axis_page(117382155),
            effect=Effect.EMULATED,
        ),
    )
    prog_move_requires_homing: bool = param(
        False,
        Sheet(
            number="P-AXIS-00277",
            data_type=DataType.BOOLEAN,
            doc="A programmed motion before homing is an error.",
            source=axis_page(117251723),
            effect=Effect.EMULATED,
        ),
    )
    homing_overflow_evaluation: bool = param(
        False,
        Sheet(
            number="P-AXIS-00294",
            data_type=DataType.BOOLEAN,
            drive_types=(DriveType.LIGHTBUS,),
            doc="Home at the overflow of the encoder; needs P-AXIS-00084 = 0.",
            source="homing manual 4.2",
            effect=Effect.REFUSED,
        ),
    )
    meas_signal_fixed_stop: bool = param(
        False,
        Sheet(
            number="P-AXIS-00330",
            data_type=DataType.BOOLEAN,
            axis_types="TR",
            replaced_by="P-AXIS-00516",
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.SERCOS,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            doc="Old: the fixed stop is the probing signal; needs P-AXIS-00331 or 00332.",
            source="measurement manual 8.2.4 (old parameters)",
            effect=Effect.EMULATED,
        ),
    )
    fixed_stop_pos_lag_limit: int = param(
        0,
        Sheet(
            number="P-AXIS-00331",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.SERCOS,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            replaced_by="P-AXIS-00774",
            doc="Old: position lag that means a fixed stop.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    fixed_stop_nbr_cycles: int = param(
        0,
        Sheet(
            number="P-AXIS-00332",
            data_type=DataType.UNS16,
            units=CYCLES,
            axis_types="TR",
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.SERCOS,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            replaced_by="P-AXIS-00775",
            low=1,
            unset=0,
            doc=(
                "Old: cycles the position lag must stay above its limit; counting restarts when it "
                "falls below."
            ),
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    homing_max_movement_dist: int = param(
        0,
        Sheet(
            number="P-AXIS-00412",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="RS",
            doc="Longest path of a homing run of a rotary axis or spindle; 0 off.",
            source=(
                "homing manual 4.2 (the key printed there belongs to another parameter); key from the"
                " overview 4.1"
            ),
            effect=Effect.EMULATED,
        ),
    )
    probing_offset: int = param(
        0,
        Sheet(
            number="P-AXIS-00467",
            data_type=DataType.UNS32,
            units=LENGTH,
            axis_types="TR",
            since="V2.11.2010.09",
            replaces=("P-AXIS-00114",),
            doc="Travel past the target while no probe event came; all types but 3.",
            source="measurement manual 8.2.2",
            effect=Effect.EMULATED,
        ),
    )
    indp_override_mode: int = param(
        0,
        Sheet(
            number="P-AXIS-00491",
            data_type=DataType.UNS16,
            choices=(0, 1, 2),
            axis_types="TR",
            doc="Override of independent axes: 0 channel, 1 the smaller of channel and axis, 2 axis.",
            source=axis_page(117487627),
            effect=Effect.ACCEPTED,
        ),
    )
    shift_offset_zero_pulse_activation: int = param(
        0,
        Sheet(
            number="P-AXIS-00494",
            data_type=DataType.UNS32,
            units=LENGTH,
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.SERCOS,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
                DriveType.CANOPEN,
            ),
            doc="Path after the cam before the zero pulse search is armed.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    indp_feedhold_mode: int = param(
        0,
        Sheet(
            number="P-AXIS-00540",
            data_type=DataType.UNS16,
            choices=(0, 1),
            axis_types="TR",
            doc="Feedhold of independent axes: 0 channel and axis, 1 axis.",
            source=axis_page(117490699),
            effect=Effect.ACCEPTED,
        ),
    )
    homing: Homing = field(default_factory=Homing)
    measure: Measure = field(default_factory=Measure)
