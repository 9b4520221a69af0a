"""`lr_hw[i].*`: hardware of the position controller."""

from dataclasses import dataclass

from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.sheet import LENGTH, DataType, Effect, Sheet, axis_page, param


@dataclass(frozen=True, slots=True, kw_only=True)
class LrHw:
    """`lr_hw[i].*`."""

    nummer: int = param(
        1,
        Sheet(
            number="P-AXIS-00136",
            data_type=DataType.SGN16,
            choices=(1, 2),
            drive_types=(
                DriveType.SIMULATION,
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Number of the hardware parameter set.",
            source=axis_page(117845259),
            effect=Effect.ACCEPTED,
        ),
    )
    cam_direct_access: bool = param(
        True,
        Sheet(
            number="P-AXIS-00036",
            data_type=DataType.BOOLEAN,
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc=(
                "Access to the reference cam: 0 the PLC supplies it on the HLI; with 1 the HLI's does not count, and "
                "hardware of the CNC's own the bench has none."
            ),
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    cam_level: bool = param(
        True,
        Sheet(
            number="P-AXIS-00038",
            data_type=DataType.BOOLEAN,
            drive_types=(
                DriveType.CONVENTIONAL,
                DriveType.TERMINAL,
                DriveType.LIGHTBUS,
                DriveType.PROFIDRIVE,
            ),
            doc="Level of the reference cam unit while the cam is operated.",
            source="homing manual 4.2",
            effect=Effect.EMULATED,
        ),
    )
    mask_mess_1: int = param(
        0x80,
        Sheet(
            number="P-AXIS-00106",
            data_type=DataType.UNS16,
            choices=(0x40, 0x80),
            axis_types="TR",
            drive_types=(DriveType.SERCOS,),
            doc=("SERCOS status bit of the measurement: 0x40 bit 1, 0x80 bit 2; only with P-AXIS-00060 = 0."),
            source=axis_page(117337611),
            effect=Effect.ACCEPTED,
        ),
    )
    vz_istw: bool = param(
        False,
        Sheet(
            number="P-AXIS-00230",
            data_type=DataType.BOOLEAN,
            doc="Invert the sign of the actual value.",
            source=axis_page(117843723),
            effect=Effect.REFUSED,
        ),
    )
    vz_stellgr: bool = param(
        False,
        Sheet(
            number="P-AXIS-00231",
            data_type=DataType.BOOLEAN,
            doc="Invert the sign of the command value.",
            source=axis_page(117842187),
            effect=Effect.REFUSED,
        ),
    )
    zero_pulse_search_max_dist: int = param(
        0,
        Sheet(
            number="P-AXIS-00404",
            data_type=DataType.UNS32,
            units=LENGTH,
            doc="Longest path of the zero pulse search; 0 off.",
            source=axis_page(117271691),
            effect=Effect.EMULATED,
        ),
    )
    move_from_cam_max_dist: int = param(
        0,
        Sheet(
            number="P-AXIS-00531",
            data_type=DataType.SGN32,
            low=1,
            unset=0,
            units=LENGTH,
            doc="Longest path off the reference cam; 0 off.",
            source="TF5200 axis parameters 1.172",
            effect=Effect.EMULATED,
        ),
    )
