"""#DRIVE: a value for a key of `antr.function[]`, scaled and limited, to the drive object behind it.

Source: measurement manual 7.2.2; P-AXIS-00724..00728 for scaling and limits.
"""

import struct
from typing import Final

from hli_bench.kernel.blocks import DriveWrite
from hli_bench.kernel.core import Core
from hli_bench.kernel.drive_manager.objects import Done, ObjectChannel, Order
from hli_bench.manual.axis.antr import Function
from hli_bench.manual.axis.fixed_stop import NO_LIMIT
from hli_bench.manual.axis.words import Communication, ObjectDataType, ScalingType
from hli_bench.manual.errors import position_controller as errors

BEYOND: Final = 2.0**63
"""What is beyond every data type: a larger number says no more."""
_PACKING: Final = {
    ObjectDataType.SGN16: ("<h", -(1 << 15), (1 << 15) - 1),
    ObjectDataType.SGN32: ("<i", -(1 << 31), (1 << 31) - 1),
    ObjectDataType.UNS16: ("<H", 0, (1 << 16) - 1),
    ObjectDataType.UNS32: ("<I", 0, (1 << 32) - 1),
}


def write(core: Core, channel: ObjectChannel, block: DriveWrite, done: Done) -> bool:
    """Order the write of a #DRIVE block; False when it is refused (reported)."""
    axis = core.axis(block.axis)
    function = next((one for one in axis.params.antr.function if one.id == block.key), None)
    if function is None:
        core.report(errors.DRIVE_FUNCTION_UNKNOWN, block.source, axis.number, block.key, axis=block.axis)
        return False
    if function.commu is Communication.IGNORE:
        done(None)
        return True
    packing, low, high = _PACKING[function.data_type]
    raw = scaled(function, block.value)
    if not low <= raw <= high:
        sheet, bound = (errors.LIMIT_ABOVE_TYPE, high) if raw > high else (errors.LIMIT_BELOW_TYPE, low)
        factor = factor_of(function)
        values = (axis.number, function.id, raw / factor, factor, bound / factor)
        core.report(sheet, block.source, *values, axis=block.axis)
    index, subindex = ident(function)
    data = struct.pack(packing, min(max(raw, low), high))
    channel.write(axis.node, Order(index, subindex, data, done))
    return True


def scaled(function: Function, value: float) -> int:
    """Return the raw value: limited without a message (NO_LIMIT: not), times the factor with LINEAR scaling."""
    low = function.min_limit if function.min_limit < NO_LIMIT else value
    limited = min(max(value, low), function.max_limit)
    product = limited * factor_of(function)
    return round(min(max(product, -BEYOND), BEYOND))


def factor_of(function: Function) -> float:
    """Return what a value is multiplied with on its way to the drive."""
    return function.scaling_factor if function.scaling_type is ScalingType.LINEAR else 1.0


def ident(function: Function) -> tuple[int, int]:
    """Return index and sub-index of a CANopen ident such as `6065_00`."""
    index, _, subindex = function.wr_ident[0].partition("_")
    return int(index, 16), int(subindex or "0", 16)
