"""`lr_param.*`: the position controller."""

from dataclasses import dataclass

from hli_bench.manual.sheet import DataType, Effect, Sheet, axis_page, param


@dataclass(frozen=True, slots=True, kw_only=True)
class LrParam:
    """`lr_param.*`."""

    suppress_pos_lag_error: bool = param(
        False,
        Sheet(
            number="P-AXIS-00176",
            data_type=DataType.BOOLEAN,
            doc="Compute the position lag limits but report nothing.",
            source="TF5200 axis parameters, infosys page 15266976907; group of the path decided here",
            effect=Effect.EMULATED,
        ),
    )
    check_pos_command_limit: bool = param(
        False,
        Sheet(
            number="P-AXIS-00520",
            data_type=DataType.BOOLEAN,
            axis_types="T",
            doc=("Watch command positions at the positive software limit switch in the position controller."),
            source=axis_page(130037899),
            effect=Effect.ACCEPTED,
        ),
    )
