"""PLC_TIMESTAMP: the PLC hands over level and DC time of the edge; the position is calculated back to that instant.

Source: measurement manual 7.4 and 8.2.3.
"""

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.core import Core
from hli_bench.kernel.position_controller import history
from hli_bench.kernel.position_controller.probing import plc
from hli_bench.kernel.position_controller.probing.plc import arm, blocked, disarm, event, first_look, free
from hli_bench.manual.axis.words import Edge

__all__ = ["arm", "blocked", "disarm", "event", "first_look", "free", "latched"]

UNIT = "lr_mc_control/timestamp"
UNITS = (plc.UNIT, UNIT)


def latched(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> tuple[float, Ns] | None:
    """The position at the time in the timestamp unit; None when it is not enabled or outside the history."""
    unit = core.unit(axis, UNIT)
    if not unit.redirected:
        return None
    stamp = Ns(int(unit.effective))
    position = history.position(core, axis, stamp)
    return None if position is None else (position, stamp)
