"""The cyclic telegrams of a CANopen drive as the CNC sends and takes them (default map of the drive models).

RPDO1 controlword, target position; RPDO2 latch control word. TPDO1 statusword, actual position; TPDO2 latch
status word, latch position of the first edge; TPDO3 torque, following error; TPDO4 digital inputs, latch
position of the second edge. Source: measurement manual 6.4 for what measuring needs.
"""

from collections.abc import Callable, Mapping, Sequence
from struct import Struct
from typing import Any, Final

from hli_bench.base.ids import NodeId
from hli_bench.laws.rows import Rows
from hli_bench.protocols.canopen.cia402 import DIGITAL_INPUTS, LATCHES_2, PROBE_STATUS
from hli_bench.protocols.canopen.pdo import INVALID, MAPPING_OFFSET, NO_RTR, TPDO_COMMUNICATION
from hli_bench.wire.can import CanFrame

_WORD_AND_LONG: Final = Struct("<Hi")
_WORD: Final = Struct("<H")
_LONG: Final = Struct("<I")
_TORQUE_AND_ERROR: Final = Struct("<hi")
_INPUTS_AND_LATCH: Final = Struct("<Ii")


def command_frames(node: NodeId, row: Any) -> list[CanFrame]:
    """Return the command telegrams of one axis, from its row or a row of the log."""
    return [
        CanFrame(0x200 + node, _WORD_AND_LONG.pack(int(row["controlword"]), int(row["target"]))),
        CanFrame(0x300 + node, _WORD.pack(int(row["probe_function"]))),
    ]


def _position(row: Rows, data: bytes) -> None:
    row["statusword"], row["received"] = _WORD_AND_LONG.unpack(data)


def _latch(row: Rows, data: bytes) -> None:
    row["probe_status"], row["latch"][0] = _WORD_AND_LONG.unpack(data)


def _torque(row: Rows, data: bytes) -> None:
    row["torque_permille"], row["following_error"] = _TORQUE_AND_ERROR.unpack(data)


def _inputs(row: Rows, data: bytes) -> None:
    row["digital_inputs"], row["latch"][1] = _INPUTS_AND_LATCH.unpack(data)


_TAKE: Final[Mapping[int, tuple[int, Callable[[Rows, bytes], None]]]] = {
    0x180: (_WORD_AND_LONG.size, _position),
    0x280: (_WORD_AND_LONG.size, _latch),
    0x380: (_TORQUE_AND_ERROR.size, _torque),
    0x480: (_INPUTS_AND_LATCH.size, _inputs),
}


def second_input_telegrams(node: NodeId) -> list[tuple[int, int, bytes]]:
    """Return the SDO writes that make TPDO2 and TPDO4 carry the latches of the second probing input."""
    writes: list[tuple[int, int, bytes]] = []
    for pdo, entries in ((1, (PROBE_STATUS, LATCHES_2[0])), (3, (DIGITAL_INPUTS, LATCHES_2[1]))):
        cob_id = 0x180 + 0x100 * pdo + node | NO_RTR
        communication = TPDO_COMMUNICATION[pdo]
        mapping = communication + MAPPING_OFFSET
        writes.append((communication, 1, _LONG.pack(cob_id | INVALID)))
        writes.append((mapping, 0, bytes((0,))))
        writes += [(mapping, place, _LONG.pack(entry)) for place, entry in enumerate(entries, 1)]
        writes.append((mapping, 0, bytes((len(entries),))))
        writes.append((communication, 1, _LONG.pack(cob_id)))
    return writes


class ActualTelegrams:
    """Takes TPDOs into the axis rows; a frame of another length than configured is left out."""

    __slots__ = ("_by_cob_id",)

    def __init__(self, nodes: Sequence[NodeId], axis: Rows) -> None:
        self._by_cob_id = {
            cob_id + node: (axis[index], size, take)
            for index, node in enumerate(nodes)
            for cob_id, (size, take) in _TAKE.items()
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
        row, size, take = found
        if len(frame.data) == size:
            take(row, frame.data)
        return True
