"""What the decoder reports by number: records of sheets, and the exception that carries them out."""

from hli_bench.kernel.blocks import Source
from hli_bench.kernel.records import CncError
from hli_bench.manual.errors.record import ErrorSheet


def cnc_error(sheet: ErrorSheet, source: Source, *values: float | str, axis: str = "") -> CncError:
    """Return the record of a message with its values in the order of the sheet."""
    named = sheet.named(values)
    return CncError(
        number=sheet.number,
        severity=str(sheet.severity),
        text=sheet.message_of(named),
        source=source,
        axis=axis,
        values=named,
    )


class CncStop(Exception):  # noqa: N818 - it is how a block ends, not a usage error
    """Ends the program with an error of the CNC; caught by `Decoder.blocks`, never seen outside."""

    def __init__(self, sheet: ErrorSheet, source: Source, *values: float | str, axis: str = "") -> None:
        super().__init__(str(sheet))
        self.error = cnc_error(sheet, source, *values, axis=axis)
