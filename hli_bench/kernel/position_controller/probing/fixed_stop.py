"""FIXED_STOP: the event is the mechanical stop, seen by position lag and by how little the axis still moves.

Source: measurement manual 7.2, P-AXIS-00774..00778.
"""

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.core import Core
from hli_bench.kernel.sequence import Level, Until
from hli_bench.kernel.watches import Condition, fixed_stop
from hli_bench.laws.rows import SEGMENTS
from hli_bench.manual.axis.fallbacks import (
    fixed_stop_max_delta,
    fixed_stop_min_time_us,
    fixed_stop_pos_lag_limit,
    fixed_stop_start_distance,
    has_criterion,
)
from hli_bench.manual.axis.words import Edge


def blocked(core: Core, axis: AxisIndex, edge: Edge) -> bool:
    """A stop cannot be operated beforehand."""
    return False


def first_look(core: Core, axis: AxisIndex, edge: Edge) -> Until:
    """Never met."""
    return Level(lambda: False)


def free(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> bool:
    """It shows nothing of an earlier run."""
    return True


def arm(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Condition | None:
    """Nothing to prepare."""
    return None


def event(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Until:
    """All criteria in use have held for the minimum time, behind the path at which detection is armed."""
    params = core.axis(axis).params
    if not has_criterion(params):
        return Level(lambda: False)
    cycle_us = core.setup.cycle_ns // 1000
    cycles = -(-fixed_stop_min_time_us(params, cycle_us) // cycle_us)
    return fixed_stop(
        axis,
        lag=float(fixed_stop_pos_lag_limit(params)),
        window=float(fixed_stop_max_delta(params)),
        cycles=cycles,
        from_path=int(_armed_from(core)),
    )


def latched(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> tuple[float, Ns] | None:
    """The actual position in the cycle of the detection."""
    return float(core.row(axis)["actual"]), core.dc_now


def disarm(core: Core, axis: AxisIndex) -> None:
    """Nothing to switch off."""


def _armed_from(core: Core) -> float:
    """Return the path in the block (0.1 um) behind which a stop counts: the smallest of all axes it moves."""
    slot = core.path.segment % SEGMENTS
    length = float(core.rows.segment[slot]["length"])
    moved = [axis for axis in core.setup.axes if core.rows.leg[slot, axis.index]["moves"]]
    return min(fixed_stop_start_distance(axis.params, length) for axis in moved)
