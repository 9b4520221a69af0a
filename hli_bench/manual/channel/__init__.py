"""Channel parameters as one tree of frozen dataclasses; the nesting is the list path."""

from dataclasses import dataclass, field

from hli_bench.manual.sheet import LENGTH, TENTH_PERCENT, DataType, Effect, Sheet, param


@dataclass(frozen=True, slots=True, kw_only=True)
class StartSlope:
    """`prog_start.slope.*`: dynamics at program start."""

    profile: int = param(
        0,
        Sheet(
            number="P-CHAN-00071",
            data_type=DataType.SGN16,
            choices=(0, 1, 2, 3),
            doc="Acceleration profile of path motions: 0 linear, 1 trapezoidal, 2 sine square, 3 HSC.",
            source="TF5200 oscillating axis, infosys page 222124555",
            effect=Effect.REFUSED,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgStart:
    """`prog_start.*`."""

    slope: StartSlope = field(default_factory=StartSlope)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelParams:
    """The channel list."""

    messtyp: int = param(
        1,
        Sheet(
            number="P-CHAN-00057",
            data_type=DataType.UNS16,
            low=1,
            high=7,
            doc="Measurement type at start-up.",
            source="measurement manual 8.2.1",
            effect=Effect.EMULATED,
        ),
    )
    max_vb_override: int = param(
        1000,
        Sheet(
            number="P-CHAN-00056",
            data_type=DataType.UNS16,
            high=2000,
            units=TENTH_PERCENT,
            doc="Largest channel override.",
            source="TF5200 channel parameters, infosys page 149072779",
            effect=Effect.EMULATED,
        ),
    )
    use_drive_curr_limit: bool = param(
        False,
        Sheet(
            number="P-CHAN-00097",
            data_type=DataType.BOOLEAN,
            doc="Deceleration at feedhold: 0 the current one, 1 the feedhold parameters of the axes.",
            source="measurement manual 8.2.1",
            effect=Effect.EMULATED,
        ),
    )
    meas_error_no_signal: bool = param(
        False,
        Sheet(
            number="P-CHAN-00176",
            data_type=DataType.BOOLEAN,
            doc="Type 1: a run without probing signal is an error.",
            source="measurement manual 8.2.1",
            effect=Effect.EMULATED,
        ),
    )
    meas_deceleration_mode: int = param(
        0,
        Sheet(
            number="P-CHAN-00214",
            data_type=DataType.UNS16,
            choices=(0, 1),
            doc="Deceleration after the event: 0 feedhold, 1 rapid traverse.",
            source="measurement manual 8.2.1",
            effect=Effect.EMULATED,
        ),
    )
    meas_fixed_stop_no_error: bool = param(
        False,
        Sheet(
            number="P-CHAN-00266",
            data_type=DataType.BOOLEAN,
            doc="Type 7: a run that found no stop is no error.",
            source="measurement manual 8.2.1",
            effect=Effect.EMULATED,
        ),
    )
    meas_use_std_dynamic: bool = param(
        False,
        Sheet(
            number="P-CHAN-00296",
            data_type=DataType.BOOLEAN,
            doc="Plan the run with G01 dynamics (1) instead of G00 (0).",
            source="measurement manual 8.2.1",
            effect=Effect.EMULATED,
        ),
    )
    meas_allow_actuated_probe: bool = param(
        False,
        Sheet(
            number="P-CHAN-00312",
            data_type=DataType.BOOLEAN,
            doc="A run that finds the probe operated: 0 is error 50052, 1 ends at once without error.",
            source="TF5200 channel parameters, P-CHAN-00312",
            effect=Effect.EMULATED,
        ),
    )
    meas_error_no_move_path: bool = param(
        True,
        Sheet(
            number="P-CHAN-00313",
            data_type=DataType.BOOLEAN,
            doc="A measuring run without motion: 1 is error 50067, 0 none.",
            source="TF5200 channel parameters, P-CHAN-00313",
            effect=Effect.EMULATED,
        ),
    )
    meas_pcs_value_no_probe_radius: bool = param(
        False,
        Sheet(
            number="P-CHAN-00311",
            data_type=DataType.BOOLEAN,
            doc="Leave the ball radius of the probe out of the PCS value.",
            source="TF5200 channel parameters, infosys page 149046539",
            effect=Effect.ACCEPTED,
        ),
    )
    channel_init_actpos_exclusive: bool = param(
        False,
        Sheet(
            number="P-CHAN-00455",
            data_type=DataType.BOOLEAN,
            doc="#CHANNEL INIT [ACTPOS] with named axes leaves the others alone.",
            source="TF5200 channel parameters, infosys page 1012527499",
            effect=Effect.ACCEPTED,
        ),
    )
    kasto_multi_block: bool = param(
        False,
        Sheet(
            number="P-CHAN-00029",
            data_type=DataType.BOOLEAN,
            doc="Edge banding over several blocks.",
            source="TF5200 channel parameters, infosys page 149013003",
            effect=Effect.REFUSED,
        ),
    )
    kasto_residual_path: int = param(
        0,
        Sheet(
            number="P-CHAN-00030",
            data_type=DataType.SGN32,
            low=0,
            units=LENGTH,
            doc="Path after the edge banding event.",
            source="TF5200 channel parameters, infosys page 149011467",
            effect=Effect.ACCEPTED,
        ),
    )
    kasto_prog_meas_trigger: bool = param(
        False,
        Sheet(
            number="P-CHAN-00257",
            data_type=DataType.BOOLEAN,
            doc="The program triggers the edge banding event.",
            source="TF5200 channel parameters, infosys page 149024651",
            effect=Effect.REFUSED,
        ),
    )
    prog_start: ProgStart = field(default_factory=ProgStart)
