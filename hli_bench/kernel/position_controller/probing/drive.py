"""DRIVE: the drive latches the position itself (CANopen: touch probe objects in the cyclic telegrams).

Source: measurement manual 6.4; bits as in CiA 402.
"""

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.core import Core
from hli_bench.kernel.position_controller.latches import unwrapped
from hli_bench.kernel.sequence import Level, Until
from hli_bench.kernel.watches import Condition, probe_status
from hli_bench.manual.axis.words import Edge, TriggerSource

ENABLE = 0x01
DRIVE_DEFINED = 0x08
SAMPLE = {Edge.POS: 0x10, Edge.NEG: 0x20}
STORED = {Edge.POS: 0x02, Edge.NEG: 0x04}
SLOT = {Edge.POS: 0, Edge.NEG: 1}


def _shift(probing_input: int) -> int:
    return 8 * (probing_input - 1)


def blocked(core: Core, axis: AxisIndex, edge: Edge) -> bool:
    """Not to be seen: the level of the probe is not part of the telegram."""
    return False


def first_look(core: Core, axis: AxisIndex, edge: Edge) -> Until:
    """Never met."""
    return Level(lambda: False)


def free(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> bool:
    """Not in the cycle that cleared the word: a drive that never sees it cleared keeps the value it shows."""
    shown = core.row(axis)["probe_status"] & STORED[edge] << _shift(probing_input)
    return not shown or core.disarmed.get(axis) != core.cycle


def arm(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Condition | None:
    """Set the latch control word; ready when the drive shows it enabled."""
    function = ENABLE | SAMPLE[edge]
    if core.axis(axis).params.antr.canopen.probing_trigger_source is TriggerSource.DRIVE_DEFINED:
        function |= DRIVE_DEFINED
    core.row(axis)["probe_function"] = function << _shift(probing_input)
    mask = (ENABLE | STORED[edge]) << _shift(probing_input)
    return probe_status(axis, mask, ENABLE << _shift(probing_input))


def event(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Until:
    """The drive shows a stored value."""
    stored = STORED[edge] << _shift(probing_input)
    return probe_status(axis, stored, stored)


def latched(core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> tuple[float, Ns] | None:
    """The latched position; the telegram carries no time, so it is that of the cycle that brought the value."""
    row = core.row(axis)
    increments = unwrapped(row, int(row["latch"][SLOT[edge]]))
    return float((increments - row["reference"]) / row["increments_per_unit"]), core.dc_now


def disarm(core: Core, axis: AxisIndex) -> None:
    """Clear the latch control word."""
    core.disarmed[axis] = core.cycle
    core.row(axis)["probe_function"] = 0
