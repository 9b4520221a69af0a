"""How axes come to stand at an error, as a table by the reaction class of its sheet.

Source: TF5200 diagnosis 1.2; LAG (70020 stops on P-AXIS-00003); decision 0020.
"""

from collections.abc import Mapping
from enum import IntEnum
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.core import Core
from hli_bench.kernel.path_preparation.dynamics import controlled_rate, emergency_rate
from hli_bench.laws.rows import JOG, PATH
from hli_bench.manual.errors import ReactionClass


class Stop(IntEnum):
    """How an axis is stopped, the harder the greater."""

    NONE = 0
    RUN_OUT = 1
    """What is prepared is executed to its end."""
    FEEDHOLD = 2
    """With the path, or by itself when it homes, on the ramp of the motion."""
    CONTROLLED = 3
    """By itself, the loop closed, with its deceleration at feedhold."""
    EMERGENCY = 4
    """By itself, with P-AXIS-00003: the path is left."""


TABLE: Final[Mapping[ReactionClass, tuple[Stop, Stop]]] = {
    ReactionClass.NONE: (Stop.NONE, Stop.NONE),
    ReactionClass.ABORT_PROGRAM: (Stop.RUN_OUT, Stop.RUN_OUT),
    ReactionClass.ABORT_JOB: (Stop.RUN_OUT, Stop.RUN_OUT),
    ReactionClass.FEEDHOLD_GROUP: (Stop.FEEDHOLD, Stop.FEEDHOLD),
    ReactionClass.STOP_AXIS: (Stop.EMERGENCY, Stop.FEEDHOLD),
    ReactionClass.STOP_ALL: (Stop.EMERGENCY, Stop.EMERGENCY),
    ReactionClass.CONTROLLED_STOP: (Stop.CONTROLLED, Stop.FEEDHOLD),
    ReactionClass.OPEN_LOOP_STOP: (Stop.EMERGENCY, Stop.FEEDHOLD),
}
"""How the axis that the error names stops, and how the others of the channel do."""


def react(core: Core, at_least: Stop = Stop.NONE) -> None:
    """Stop the axes as the errors reported since the last call ask; none is stopped softer than before."""
    others = at_least
    alone: dict[AxisIndex, Stop] = {}
    for reaction, axis in core.faults:
        named, rest = TABLE[reaction]
        others = max(others, rest)
        if axis is not None:
            alone[axis] = max(alone.get(axis, Stop.NONE), named)
    core.faults.clear()
    for index, how in alone.items():
        if how >= Stop.CONTROLLED:
            _stop_alone(core, index, how)
    if others is Stop.EMERGENCY:
        for one in core.setup.axes:
            _stop_alone(core, one.index, others)
        core.path.drop()
    elif others >= Stop.FEEDHOLD:
        core.rows.axis["jog_velocity"] = 0.0
        core.path.stop()
    core.stopping = max(core.stopping, others)


def _stop_alone(core: Core, index: AxisIndex, how: Stop) -> None:
    """Take an axis from the path and let it brake by itself; one that brakes already does not do so slower."""
    row, axis = core.row(index), core.axis(index)
    rate = emergency_rate(axis) if how is Stop.EMERGENCY else controlled_rate(axis)
    if row["mode"] == JOG:
        row["jog_acceleration"] = max(rate, float(row["jog_acceleration"]))
    elif row["mode"] == PATH and not core.path.idle:
        row["mode"] = JOG
        row["jog_acceleration"] = rate
    row["jog_velocity"] = 0.0
