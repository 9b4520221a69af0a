"""What a PLC keeps from happening, in words for people: motion that it holds, commands of it that do not count."""

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.core import Core
from hli_bench.kernel.position_controller.probing import source
from hli_bench.laws.rows import FEEDHOLD, JOG, SEGMENTS
from hli_bench.protocols.hli.control_unit import ControlUnit

_CHANNEL = "ch/1/bahn_mc_control"
_WITHOUT_EFFECT = ("ipo_mc_control/override", "ipo_mc_control/override_valid")
_WHY = "it acts on independent axes and spindles only; path and homing take ch/1/bahn_mc_control/override_feedrate"


def holding(core: Core) -> list[str]:
    """Return the elements that make motion stand which has been commanded, none when nothing does."""
    path, axes = core.rows.path[0], core.rows.axis
    moves = [bool(row["mode"] == JOG and row["jog_velocity"]) for row in axes]
    found = []
    if not core.path.idle:
        leg = core.rows.leg[core.path.segment % SEGMENTS]
        moves = [one or bool(of_path) for one, of_path in zip(moves, leg["moves"], strict=True)]
    if any(moves):
        if path["hold"] & FEEDHOLD:
            found.append(f"{_CHANNEL}/feedhold is TRUE")
        if not path["override"]:
            found.append(f"{_CHANNEL}/override_feedrate is 0")
    for axis in core.setup.axes:
        if not moves[axis.index] or axes[axis.index]["released"]:
            continue
        released = core.unit(axis.index, "lr_mc_control/release_feedhold").effective
        what = "ipo_mc_control/feedhold is TRUE" if released else "lr_mc_control/release_feedhold is FALSE"
        found.append(f"ax/{axis.number}/{what}")
    return found


def unheard(core: Core) -> list[str]:
    """Return the control units with `enable_w` TRUE whose commands count for nothing, and why."""
    enabled = ((unit.path, _unheard(core, unit)) for unit in core.units.enabled())
    return [f"{path}: {why}" for path, why in enabled if why]


def unserved(core: Core, axis: AxisIndex, signal: str) -> list[str]:
    """Return the control units by which a PLC tells of the probing signal and that it does not serve, and why."""
    units = (core.unit(axis, name) for name in getattr(source(signal), "UNITS", ()))
    return [f"{unit.path}: {unit.unheard}" for unit in units if unit.unheard]


def in_vain(core: Core, member: str) -> str:
    """Return why a command, or the enabling of one, counts for nothing; "" when it counts or `member` is neither."""
    element = core.image.layout.element(member)
    if element.member not in ("enable_w", "command_w") or element.group not in core.units:
        return ""
    unit = core.units[element.group]
    return "" if element.member == "enable_w" and not unit.enabled else _unheard(core, unit)


def _unheard(core: Core, unit: ControlUnit) -> str:
    """Return why the command of a unit counts for nothing, "" when it does."""
    area, number, name = unit.path.split("/", 2)
    if area == "ax" and name == "lr_mc_control/reference_cam":
        axis = next(axis for axis in core.setup.axes if axis.number == int(number))
        direct = axis.params.lr_hw[0].cam_direct_access
        return unit.unheard or ("P-AXIS-00036 is 1" if direct else "")
    return unit.unheard or (_WHY if name in _WITHOUT_EFFECT and area == "ax" else "")
