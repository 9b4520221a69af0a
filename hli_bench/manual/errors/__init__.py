"""Messages of the control as sheets, one module per stage, which owns its range of numbers.

Only the stage itself imports its module; everybody else meets sheets in emitted records, or by number.
"""

from collections.abc import Iterator
from functools import cache
from types import MappingProxyType, ModuleType
from typing import Final

from hli_bench.manual.errors import (
    axis_manager,
    decoder,
    hli,
    independent_axes,
    path_interpolator,
    path_preparation,
    position_controller,
)
from hli_bench.manual.errors.record import ErrorSheet, ReactionClass, Severity

__all__ = ["RANGES", "ErrorSheet", "ReactionClass", "Severity", "by_number", "sheets"]

RANGES: Final = MappingProxyType(
    {
        decoder: range(20_000, 30_000),
        hli: range(40_000, 50_000),
        path_interpolator: range(50_000, 60_000),
        independent_axes: range(60_000, 70_000),
        position_controller: range(70_000, 80_000),
        axis_manager: range(110_000, 120_000),
        path_preparation: range(120_000, 130_000),
    }
)
"""Numbers that each module may use."""


def sheets(module: ModuleType) -> Iterator[tuple[str, ErrorSheet]]:
    """Yield the constants of one stage: (name, sheet)."""
    for name, value in vars(module).items():
        if isinstance(value, ErrorSheet):
            yield name, value


@cache
def by_number() -> MappingProxyType[int, ErrorSheet]:
    """Return every sheet by its number."""
    return MappingProxyType({sheet.number: sheet for module in RANGES for _, sheet in sheets(module)})
