"""Homing strategies: one module each with `table(run)`, its phases as rows; a new strategy is a new module.

Shared here: what a strategy works with, how the cam is seen, and how a position becomes the reference.
"""

from collections.abc import Callable
from dataclasses import dataclass

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import tenth_um_from_um_per_s
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.core import Core
from hli_bench.kernel.path_preparation.dynamics import homing_rate
from hli_bench.kernel.records import Homed
from hli_bench.kernel.sequence import Level, Until
from hli_bench.kernel.setup import AxisSetup
from hli_bench.kernel.watches import digital_input
from hli_bench.laws.rows import JOG, PATH
from hli_bench.manual.axis.words import ReferenceCamSignal

HOME_SWITCH = 0x4
"""Bit of the drive's digital inputs (60FD) that carries the home switch."""


@dataclass(slots=True)
class Run:
    """Homing of one axis."""

    core: Core
    source: Source
    axis: AxisIndex
    begin: float = 0.0
    """Where the axis stood before, 0.1 um."""
    turned: float = 0.0
    """Where it set out last, 0.1 um, and `before` that."""
    before: float = 0.0
    method: str = ""
    shifts: Callable[[], None] = lambda: None
    """To be told that the axis system is shifted now."""

    @property
    def setup(self) -> AxisSetup:
        """The axis being homed."""
        return self.core.axis(self.axis)

    @property
    def direction(self) -> int:
        """P-AXIS-00158: +1 or -1."""
        return 1 if self.setup.params.kenngr.ref_richt else -1


def jog(run: Run, direction: int, velocity_um_per_s: int) -> None:
    """Move the axis by itself with the homing acceleration; 0 stops it."""
    row = run.core.row(run.axis)
    row["mode"] = JOG
    row["jog_velocity"] = direction * tenth_um_from_um_per_s(velocity_um_per_s)
    row["jog_acceleration"] = homing_rate(run.setup)


def cam(run: Run, *, operated: bool) -> Until:
    """The reference cam is operated or not, as P-AXIS-00321 says where it is seen and P-AXIS-00038 its level."""
    if run.setup.params.antr.reference_cam_signal is ReferenceCamSignal.STATUS_DIG_INPUTS:
        level = operated == run.setup.params.lr_hw[0].cam_level
        return digital_input(run.axis, HOME_SWITCH, HOME_SWITCH if level else 0)
    return Level(lambda: cam_operated(run) == operated)


def cam_operated(run: Run) -> bool:
    """Tell whether the cam is operated in this cycle."""
    params = run.setup.params
    if params.antr.reference_cam_signal is ReferenceCamSignal.STATUS_DIG_INPUTS:
        return bool(run.core.row(run.axis)["digital_inputs"] & HOME_SWITCH) == params.lr_hw[0].cam_level
    unit = run.core.unit(run.axis, "lr_mc_control/reference_cam")
    heard = unit.redirected and not params.lr_hw[0].cam_direct_access
    return heard and bool(unit.effective) == params.lr_hw[0].cam_level


def reference(run: Run, increments: int) -> None:
    """Let the encoder value `increments` be the reference position P-AXIS-00152; the axis system shifts at once."""
    run.shifts()
    row = run.core.row(run.axis)
    position = run.setup.params.getriebe[0].pos_refpkt
    before = int(row["reference"])
    row["reference"] = increments - round(position * run.setup.increments_per_unit)
    shift = (before - int(row["reference"])) / run.setup.increments_per_unit
    for name in ("command", "past", "actual"):
        row[name] += shift
    run.core.referenced[run.axis] = True


def finish(run: Run) -> None:
    """The axis stands: report it homed and give it back to the path."""
    core = run.core
    core.row(run.axis)["mode"] = PATH
    core.preparation.synchronise()
    core.show(run.axis, "lr_state/homing_done_r", True)
    position = run.setup.params.getriebe[0].pos_refpkt
    core.emitted.append(
        Homed(source=run.source, axis=run.axis, position_tenth_um=position, method=run.method)
    )


def abandon(run: Run) -> None:
    """Brake the axis when homing is broken off; the path takes it again when it stands."""
    row = run.core.row(run.axis)
    row["jog_velocity"] = 0.0
    row["probe_function"] = 0
