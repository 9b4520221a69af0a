"""The cyclic telegrams of a drive as the CNC sends and takes them."""

from collections.abc import Sequence
from struct import Struct
from typing import Any, Final

from hli_bench.base.ids import NodeId
from hli_bench.laws.rows import Rows
from hli_bench.protocols.canopen.pdo import INVALID, MAPPING_OFFSET, NO_RTR, TPDO_COMMUNICATION
from hli_bench.protocols.canopen.telegram import RPDOS, TPDOS, Telegram, changed, frames
from hli_bench.wire.can import CanFrame

_LONG: Final = Struct("<I")
_HERE: Final = {"position": "received"}
"""Numbers that have another name in the CNC's rows: what came is not yet the actual position."""


def command_frames(node: NodeId, row: Any) -> list[CanFrame]:
    """Return the command telegrams of one axis from its row."""
    return frames(RPDOS, node, row)


def second_input_telegrams(node: NodeId) -> list[tuple[int, int, bytes]]:
    """Return the SDO writes that make the actual value telegrams carry the latches of the second probing input."""
    writes: list[tuple[int, int, bytes]] = []
    for place, telegram in changed(1):
        cob_id = telegram.base + node | NO_RTR
        communication = TPDO_COMMUNICATION[place]
        mapping = communication + MAPPING_OFFSET
        entries = telegram.mapping
        writes.append((communication, 1, _LONG.pack(cob_id | INVALID)))
        writes.append((mapping, 0, bytes((0,))))
        writes += [(mapping, number, _LONG.pack(entry)) for number, entry in enumerate(entries, 1)]
        writes.append((mapping, 0, bytes((len(entries),))))
        writes.append((communication, 1, _LONG.pack(cob_id)))
    return writes


class ActualTelegrams:
    """Takes TPDOs into the axis rows; a frame of another length than configured is left out."""

    __slots__ = ("_by_cob_id",)

    def __init__(self, nodes: Sequence[NodeId], axis: Rows) -> None:
        self._by_cob_id = {
            telegram.base + node: (axis[index], telegram, telegram.layout)
            for index, node in enumerate(nodes)
            for telegram in TPDOS
        }

    @property
    def cob_ids(self) -> frozenset[int]:
        """COB-IDs of all actual value telegrams: what a cycle waits for."""
        return frozenset(self._by_cob_id)

    def take(self, frame: CanFrame) -> bool:
        """Take a frame; tell whether it is an actual value telegram."""
        found = self._by_cob_id.get(frame.cob_id)
        if found is None:
            return False
        row, telegram, layout = found
        if len(frame.data) == layout.size:
            _store(row, telegram, layout.unpack(frame.data))
        return True


def _store(row: Rows, telegram: Telegram, values: Sequence[int]) -> None:
    for number, value in zip(telegram.numbers, values, strict=True):
        if number.element is None:
            row[_HERE.get(number.name, number.name)] = value
        else:
            row[number.name][number.element] = value
