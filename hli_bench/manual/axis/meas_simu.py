"""`meas_simu.*`: simulated probing events."""

from dataclasses import dataclass

from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.sheet import DataType, Effect, Sheet, axis_page, param


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasSimu:
    """`meas_simu.*`."""

    meas_simu_mode: int = param(
        1,
        Sheet(
            number="P-AXIS-00112",
            data_type=DataType.SGN32,
            low=0,
            high=6,
            axis_types="TRS",
            drive_types=(DriveType.SIMULATION,),
            doc=(
                "Simulated probing event: 0 none, 1 position, 2 cycles, 3 rest path, 4 and 5 target, 6 body."
            ),
            source=axis_page(118162699),
            effect=Effect.REFUSED,
        ),
    )
    parameter1: int = param(
        0,
        Sheet(
            number="P-AXIS-00145",
            data_type=DataType.SGN32,
            axis_types="TR",
            drive_types=(DriveType.SIMULATION,),
            doc="Value 1 of the simulated probing event; its unit depends on P-AXIS-00112.",
            source=axis_page(118165771),
            effect=Effect.ACCEPTED,
        ),
    )
    parameter2: int = param(
        0,
        Sheet(
            number="P-AXIS-00146",
            data_type=DataType.SGN32,
            axis_types="TR",
            drive_types=(DriveType.SIMULATION,),
            doc="Value 2 of the simulated probing event; its unit depends on P-AXIS-00112.",
            source=axis_page(326989707),
            effect=Effect.ACCEPTED,
        ),
    )
    parameter3: int = param(
        0,
        Sheet(
            number="P-AXIS-00147",
            data_type=DataType.SGN32,
            axis_types="TR",
            drive_types=(DriveType.SIMULATION,),
            doc="Value 3 of the simulated probing event; its unit depends on P-AXIS-00112.",
            source=axis_page(327020427),
            effect=Effect.ACCEPTED,
        ),
    )
    parameter4: int = param(
        0,
        Sheet(
            number="P-AXIS-00148",
            data_type=DataType.SGN32,
            axis_types="TR",
            drive_types=(DriveType.SIMULATION,),
            doc="Value 4 of the simulated probing event; its unit depends on P-AXIS-00112.",
            source=axis_page(327052043),
            effect=Effect.ACCEPTED,
        ),
    )
