"""Where an axis was at an instant, from the positions stamped with the instants of their capture."""

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.core import Core
from hli_bench.laws.history import position_at
from hli_bench.laws.rows import HISTORY_CYCLES

AROUND = 3
"""Samples kept on each side of the instant; the interpolation uses the four nearest."""


def position(core: Core, axis: AxisIndex, dc_ns: Ns) -> float | None:
    """Return the ACS position (0.1 um) of `axis` at a DC time, None when the history does not reach there."""
    at_ns = dc_ns - core.setup.dc_epoch_ns
    cycle = at_ns // core.setup.cycle_ns
    first = max(cycle - AROUND, core.cycle - HISTORY_CYCLES + 1, 1)
    last = min(cycle + AROUND, core.cycle)
    if not first <= cycle or at_ns > core.now:
        return None
    counts = [int(core.rows.history[one % HISTORY_CYCLES, axis]) for one in range(first, last + 1)]
    base = counts[0]
    at = (at_ns - first * core.setup.cycle_ns) / core.setup.cycle_ns
    row = core.row(axis)
    increments = base + position_at([count - base for count in counts], at)
    return float((increments - row["reference"]) / row["increments_per_unit"])
