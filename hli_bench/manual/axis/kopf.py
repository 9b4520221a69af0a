"""`kopf.*`: the head of an axis list."""

from dataclasses import dataclass

from hli_bench.manual.sheet import DataType, Effect, Sheet, axis_page, param


@dataclass(frozen=True, slots=True, kw_only=True)
class Kopf:
    """Identification of the axis."""

    achs_nr: int = param(
        1,
        Sheet(
            number="P-AXIS-00016",
            data_type=DataType.UNS16,
            low=1,
            doc="Logical axis number, unique in the system; the index of the axis on the HLI.",
            source=axis_page(117174539),
            effect=Effect.EMULATED,
        ),
    )
    mds_ident: int = param(
        1,
        Sheet(
            number="P-AXIS-00110",
            data_type=DataType.UNS16,
            high=1,
            doc="Whether the list may be loaded anew: 0 no, 1 yes.",
            source="TF5200 axis parameters 1.1",
            effect=Effect.ACCEPTED,
        ),
    )
    log_achs_name: str = param(
        "X_Achse",
        Sheet(
            number="P-AXIS-00297",
            data_type=DataType.STRING,
            max_length=16,
            doc="Default name of the axis; the name in the NC program comes from the machine folder.",
            source="TF5200 axis parameters; length as P-COMP-00002",
            effect=Effect.ACCEPTED,
        ),
    )
