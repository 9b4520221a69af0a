"""Which probing input the actual value telegrams of a drive carry the latches of (measurement manual 6.4)."""

import struct
from collections.abc import Callable
from typing import Final

from hli_bench.kernel.drive_manager.objects import ObjectChannel, Order
from hli_bench.kernel.setup import AxisSetup
from hli_bench.protocols.canopen.aborts import SdoAbort
from hli_bench.protocols.canopen.pdo import INVALID, MAPPING_OFFSET, NO_RTR, TPDO_COMMUNICATION
from hli_bench.protocols.canopen.telegram import changed, tpdos

FIRST_INPUT: Final = 1
SECOND_INPUT: Final = 2
DRIVE_INPUTS: Final = (FIRST_INPUT, SECOND_INPUT)
UNKNOWN: Final = 0
"""Stands for an input while it is not known what a drive has taken."""
_LONG: Final = struct.Struct("<I")


def writes(node: int, probing_input: int) -> list[tuple[int, int, bytes]]:
    """Return the SDO writes after which the telegrams of a node carry the latches of a probing input."""
    found: list[tuple[int, int, bytes]] = []
    for place, _ in changed(SECOND_INPUT - 1):
        telegram = tpdos(probing_input - 1)[place]
        cob_id = telegram.base + node | NO_RTR
        communication = TPDO_COMMUNICATION[place]
        mapping = communication + MAPPING_OFFSET
        entries = telegram.mapping
        found.append((communication, 1, _LONG.pack(cob_id | INVALID)))
        found.append((mapping, 0, bytes((0,))))
        found += [(mapping, number, _LONG.pack(entry)) for number, entry in enumerate(entries, 1)]
        found.append((mapping, 0, bytes((len(entries),))))
        found.append((communication, 1, _LONG.pack(cob_id)))
    return found


class ProbeTelegrams:
    """Changes the telegrams of drives in operation when the program chooses another probing input."""

    __slots__ = ("_objects", "_refused")

    def __init__(self, objects: ObjectChannel) -> None:
        self._objects = objects
        self._refused: list[AxisSetup] = []

    def carry(self, axis: AxisSetup, probing_input: int) -> bool:
        """Tell whether the telegrams carry the latches of an input; order it where they do not yet."""
        objects, node = self._objects, axis.node
        if objects.probing_inputs.get(node, FIRST_INPUT) != probing_input:
            objects.probing_inputs[node] = probing_input
            for index, subindex, data in writes(node, probing_input):
                objects.write(node, Order(index, subindex, data, self._answer(axis)))
        return not objects.waits(node)

    def take_refused(self) -> list[AxisSetup]:
        """Return the axes whose drives have refused another telegram since the last call."""
        refused, self._refused = self._refused, []
        return refused

    def _answer(self, axis: AxisSetup) -> Callable[[SdoAbort | None], None]:
        def done(refused: SdoAbort | None) -> None:
            if refused is not None:
                self._objects.probing_inputs[axis.node] = UNKNOWN
                self._refused.append(axis)

        return done
