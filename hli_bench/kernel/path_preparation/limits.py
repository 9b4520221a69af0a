"""What forbids a motion before it begins: a missing reference, a target beyond a software limit switch.

Source: software limit switches (TF5200) 1.22; P-AXIS-00177, 00178, 00014, 00015, 00277.
"""

from collections.abc import Mapping

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import TENTH_UM_PER_MM
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.core import Core
from hli_bench.manual.errors import path_interpolator as interpolator_errors
from hli_bench.manual.errors import path_preparation as errors


def limited(core: Core, index: AxisIndex) -> bool:
    """Tell whether the software limits of an axis hold: where it stands must be known, and it must be no spindle.

    They hold for linear and rotary axes (none with modulo calculation is built) with a reference or an absolute system.
    """
    axis = core.axis(index)
    kenngr = axis.params.kenngr
    if axis.kind == "S":
        return False
    return kenngr.swe_neg < kenngr.swe_pos and (core.referenced[index] or kenngr.abs_pos_gueltig)


def forbidden(core: Core, source: Source, target: Mapping[AxisIndex, float]) -> bool:
    """Report the first thing that forbids a motion to `target` (mm, degrees); tell whether anything does."""
    for index, position in target.items():
        axis = core.axis(index)
        kenngr = axis.params.kenngr
        if kenngr.prog_move_requires_homing and not core.referenced[index]:
            core.report(interpolator_errors.MOTION_NEEDS_HOMING, source, axis.number, axis=index)
            return True
        if not limited(core, index):
            continue
        end, start = round(position * TENTH_UM_PER_MM), round(float(core.rows.tip[index]["end"]))
        for beyond, limit, sheet in (
            (end > kenngr.swe_pos, kenngr.swe_pos, errors.POSITIVE_SOFTWARE_LIMIT),
            (end < kenngr.swe_neg, kenngr.swe_neg, errors.NEGATIVE_SOFTWARE_LIMIT),
        ):
            if beyond:
                core.report(sheet, source, axis.number, end, limit, start, end, axis=index)
                return True
    return False
