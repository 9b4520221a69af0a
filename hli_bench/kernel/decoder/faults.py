"""What the decoder reports by number, as the CNC does, and the exception that carries it out of a block."""

from collections.abc import Mapping
from dataclasses import dataclass

from hli_bench.kernel.blocks import Source
from hli_bench.kernel.records import CncError


@dataclass(frozen=True, slots=True)
class Fault:
    """Number of the message catalogue and its meaning in our words."""

    number: int
    text: str


NO_MEASURED_VALUE = Fault(20024, "no measured value has been taken for this axis before")
OFFSET_STILL_INCLUDED = Fault(20050, "a measurement offset is still included, deselect it with G102 first")
UNKNOWN_AXIS = Fault(20092, "unknown axis in a variable")
WRITE_DENIED = Fault(20100, "this variable cannot be written")
TWO_MEASURING_FUNCTIONS = Fault(20123, "two measuring functions in one block")
G100_NOT_ALLOWED = Fault(20138, "G100 is not allowed with the active measurement type")
UNKNOWN_VARIABLE = Fault(20196, "unknown variable")
WRONG_INDEX = Fault(20197, "index of a variable out of range")
OPEN_CONTROL_BLOCK = Fault(20375, "a control block is still open at the end of the program")
MESSAGE_VALUE_COUNT = Fault(20721, "the values of #MSG do not match the conversions of its text")
G_NOT_WITH_TYPE = Fault(20772, "this G function is not allowed with the active measurement type")
TYPE_OUT_OF_RANGE = Fault(20773, "measurement type out of range")
OFFSET_NOT_INCLUDED = Fault(20814, "G102 for an axis that has no measurement offset included")
KEYWORD_TWICE = Fault(21418, "keyword twice in #MEAS")
NOT_A_MEASUREMENT_AXIS = Fault(50637, "#MEAS for an axis that is not a measurement axis (P-AXIS-00118)")


class CncStop(Exception):  # noqa: N818 - it is how a block ends, not a usage error
    """Ends the program with an error of the CNC; caught by `Decoder.blocks`, never seen outside."""

    def __init__(
        self,
        fault: Fault,
        source: Source,
        *,
        axis: str = "",
        values: Mapping[str, float | int | str] | None = None,
    ) -> None:
        super().__init__(fault.text)
        self.error = CncError(
            number=fault.number,
            severity="error",
            text=fault.text,
            source=source,
            axis=axis,
            values=dict(values or {}),
        )
