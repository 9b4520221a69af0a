"""Modulo calculation (P-AXIS-00015) is not built: an axis that moves and asks for it is refused.

A spindle may ask for it: it neither moves nor homes here, so nothing depends on it.
"""

from collections.abc import Iterator, Mapping

from hli_bench.manual.drive_types import AxisMode, AxisType
from hli_bench.manual.sheet import Value

MODE = "kenngr.achs_mode"
TYPE = "kenngr.achs_typ"


def unbuilt_modulo(values: Mapping[str, Value]) -> Iterator[tuple[str, str]]:
    """Yield the axis mode that the bench does not have: (path, text)."""
    mode = values.get(MODE)
    if isinstance(mode, AxisMode) and AxisMode.MODULO in mode and values.get(TYPE) != AxisType.SPINDEL:
        yield (
            MODE,
            (
                f"P-AXIS-00015: {MODE} = {mode:#x}: MODULO ({AxisMode.MODULO.value:#x}) is not emulated "
                "but for a spindle; with LINEAR (0x1) the positions of the axis go on beyond a turn"
            ),
        )
