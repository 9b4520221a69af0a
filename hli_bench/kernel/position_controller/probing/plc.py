"""PLC: the PLC hands over the probe's level, the kernel finds the edge and takes the actual value of its cycle.

Source: measurement manual 7.1 and 8.2.3.
"""

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.core import Core
from hli_bench.kernel.sequence import Level, Until
from hli_bench.kernel.watches import Condition
from hli_bench.manual.axis.words import Edge

UNIT = "lr_mc_control/probing_signal"
UNITS = (UNIT,)
POSITION = "lr_mc_control/probing_position"


def _level(core: Core, axis: AxisIndex) -> bool | None:
    """Return the level that the PLC hands over, None while the unit is not enabled."""
    unit = core.unit(axis, UNIT)
    return bool(unit.effective) if unit.redirected else None


def blocked(core: Core, axis: AxisIndex, edge: Edge) -> bool:
    """The probe is operated when the level after the edge is already there."""
    return _level(core, axis) == (edge is Edge.POS)


def first_look(core: Core, axis: AxisIndex, edge: Edge) -> Until:
    """The first level that the PLC hands over in this run is the one behind the edge; the edge itself came before."""
    seen = _level(core, axis) is not None

    def found_operated() -> bool:
        nonlocal seen
        level = None if seen else _level(core, axis)
        seen = seen or level is not None
        return level == (edge is Edge.POS)

    return Level(found_operated)


def free(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> bool:
    """It shows nothing of an earlier run."""
    return True


def arm(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Condition | None:
    """Nothing to prepare: the unit is read all the time."""
    return None


def event(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Until:
    """The edge of P-AXIS-00518 in the unit, against the level that the PLC handed over last."""
    before = _level(core, axis)

    def edge_came() -> bool:
        nonlocal before
        level = _level(core, axis)
        if level is None:
            return False
        came = before is not None and level != before and level == (edge is Edge.POS)
        before = level
        return came

    return Level(edge_came)


def latched(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> tuple[float, Ns] | None:
    """What the PLC has measured itself, or the actual value in the cycle that saw the edge (HLI, probing position)."""
    unit = core.unit(axis, POSITION)
    position = unit.effective if unit.redirected else core.row(axis)["actual"]
    return float(position), core.dc_now


def disarm(core: Core, axis: AxisIndex) -> None:
    """Nothing to switch off."""
