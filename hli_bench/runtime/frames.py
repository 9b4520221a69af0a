"""All frames of a cycle, made from the logged numbers: what passed in a stride is encoded when somebody looks.

Order within a cycle: SYNC, the drives' TPDOs by identifier, what else the drives sent, the CNC's RPDOs by
identifier, what else the CNC sent. All of them carry the instant of the cycle (bus time is not emulated).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.ids import NodeId
from hli_bench.laws.rows import LOG_CYCLES, Rows
from hli_bench.protocols.canopen.nmt import NMT_COB_ID, NmtCommand, NmtState, node_state
from hli_bench.protocols.canopen.sync import sync_frame
from hli_bench.protocols.canopen.telegram import RPDOS, TPDOS, Number, Telegram
from hli_bench.wire.can import CanFrame

_SDO_REQUESTS: Final = range(0x601, 0x680)
_LSS_MASTER: Final = 0x7E5


@dataclass(frozen=True, slots=True)
class AxisTelegram:
    """One PDO that every cycle brings: `axis` is the column of the log that it is made from."""

    cob_id: int
    node: NodeId
    axis: int
    numbers: Sequence[Number]

    def payload(self, rows: Rows) -> NDArray[np.uint8]:
        """Return its data bytes, shape (cycles, length), from log rows of shape (cycles, axes)."""
        packed = np.empty(len(rows), [(f"f{at}", f"<{one.code}") for at, one in enumerate(self.numbers)])
        column = rows[:, self.axis]
        for at, one in enumerate(self.numbers):
            field = column[one.name]
            packed[f"f{at}"] = field if one.element is None else field[:, one.element]
        return packed.view(np.uint8).reshape(len(rows), packed.dtype.itemsize)


def actual_telegrams(nodes: Sequence[NodeId]) -> tuple[AxisTelegram, ...]:
    """Return the TPDOs of all drives in bus order; `nodes` in row order."""
    return _in_bus_order(TPDOS, nodes)


def command_telegrams(nodes: Sequence[NodeId]) -> tuple[AxisTelegram, ...]:
    """Return the RPDOs of all drives in bus order; `nodes` in row order."""
    return _in_bus_order(RPDOS, nodes)


def _in_bus_order(telegrams: Iterable[Telegram], nodes: Sequence[NodeId]) -> tuple[AxisTelegram, ...]:
    of_axes = (
        AxisTelegram(one.base + node, node, axis, one.numbers)
        for one in telegrams
        for axis, node in enumerate(nodes)
    )
    return tuple(sorted(of_axes, key=lambda telegram: telegram.cob_id))


def from_cnc(frame: CanFrame) -> bool:
    """Tell whether a frame that is no telegram is the CNC's: NMT, SDO request, LSS, guarding request."""
    return (
        frame.cob_id == NMT_COB_ID
        or frame.cob_id in _SDO_REQUESTS
        or frame.cob_id == _LSS_MASTER
        or frame.remote
    )


def cycle_frames(
    nodes: Sequence[NodeId], row: Rows, others: Iterable[CanFrame] = (), silent: frozenset[int] = frozenset()
) -> list[CanFrame]:
    """Return all frames of a cycle in order; `row` is its log, shape (axes,), `silent` nodes sent no TPDO."""
    rows = row[np.newaxis]
    beside = list(others)
    return [
        sync_frame(),
        *(_frame(telegram, rows) for telegram in actual_telegrams(nodes) if telegram.node not in silent),
        *(frame for frame in beside if not from_cnc(frame)),
        *(_frame(telegram, rows) for telegram in command_telegrams(nodes)),
        *(frame for frame in beside if from_cnc(frame)),
    ]


def _frame(telegram: AxisTelegram, rows: Rows) -> CanFrame:
    return CanFrame(telegram.cob_id, telegram.payload(rows).tobytes())


class SilentNodes:
    """Which drives send no telegrams, as any listener of the bus can tell: from NMT, boot-up, heartbeat.

    A node counts as OPERATIONAL until it says otherwise, for listeners that come later.
    """

    __slots__ = ("_nodes", "_ordered", "now")

    def __init__(self, nodes: Iterable[NodeId]) -> None:
        self._nodes = tuple(nodes)
        self._ordered: dict[int, bool] = {}
        self.now: frozenset[int] = frozenset()

    def begin_cycle(self) -> None:
        """Let the orders of the cycle before act: a drive takes them in front of the SYNC."""
        for node, silent in self._ordered.items():
            self._set(node, silent=silent)
        self._ordered.clear()

    def take(self, frames: Iterable[CanFrame]) -> None:
        """Take the frames of a cycle beside its telegrams."""
        for frame in frames:
            if frame.cob_id == NMT_COB_ID and len(frame.data) == 2:
                silent = frame.data[0] != NmtCommand.START
                nodes = (frame.data[1],) if frame.data[1] else self._nodes
                self._ordered.update((node, silent) for node in nodes)
            elif (shown := node_state(frame)) is not None:
                self._set(shown[0], silent=shown[1] is not NmtState.OPERATIONAL)

    def _set(self, node: int, *, silent: bool) -> None:
        self.now = self.now | {node} if silent else self.now - {node}


@dataclass(frozen=True, slots=True)
class Cyclic:
    """Cycles from `first` on in which only these telegrams passed, behind the SYNC if `sync`."""

    first: int
    rows: Rows
    telegrams: tuple[AxisTelegram, ...]
    sync: bool


@dataclass(frozen=True, slots=True)
class Beside:
    """Frames of a cycle that are no telegrams."""

    cycle: int
    frames: tuple[CanFrame, ...]


class BusOrder:
    """Puts logged cycles and the frames beside them into the order in which they passed on the bus."""

    __slots__ = ("_actual", "_command", "_silent")

    def __init__(self, nodes: Sequence[NodeId]) -> None:
        """`nodes` in row order."""
        self._actual = actual_telegrams(nodes)
        self._command = command_telegrams(nodes)
        self._silent = SilentNodes(nodes)

    def parts(
        self, first: int, rows: Rows, others: Mapping[int, Sequence[CanFrame]]
    ) -> Iterator[Cyclic | Beside]:
        """Yield what passed in cycles `first` ...; `others` by cycle, those before `first` come first.

        Take all parts before the next call: which drives are silent is known from what has passed.
        """
        begin = first
        for cycle in sorted(others):
            if cycle < first:
                yield Beside(cycle, tuple(others[cycle]))
                self._silent.take(others[cycle])
                continue
            yield from self._cyclic(begin, rows[begin - first : cycle - first])
            yield from self._mixed(cycle, rows[cycle - first :][:1], others[cycle])
            begin = cycle + 1
        yield from self._cyclic(begin, rows[begin - first :])

    def _cyclic(self, first: int, rows: Rows) -> Iterator[Cyclic]:
        if len(rows):
            self._silent.begin_cycle()
            yield Cyclic(first, rows, (*self._sending(), *self._command), sync=True)

    def _mixed(self, cycle: int, row: Rows, others: Sequence[CanFrame]) -> Iterator[Cyclic | Beside]:
        self._silent.begin_cycle()
        self._silent.take(others)
        yield Cyclic(cycle, row, self._sending(), sync=True)
        yield Beside(cycle, tuple(frame for frame in others if not from_cnc(frame)))
        yield Cyclic(cycle, row, self._command, sync=False)
        yield Beside(cycle, tuple(frame for frame in others if from_cnc(frame)))

    def _sending(self) -> tuple[AxisTelegram, ...]:
        silent = self._silent.now
        return tuple(telegram for telegram in self._actual if telegram.node not in silent)


class CycleBuffer:
    """Cycles copied from the kernel's log ring, in order, until they are taken. Never more than its room."""

    __slots__ = ("_bytes", "_ring", "_rows", "count", "first")

    def __init__(self, log: Rows, room: int = 2 * LOG_CYCLES) -> None:
        """`log` is the ring, shape (LOG_CYCLES, axes)."""
        self._ring = _as_bytes(log)
        self._rows: Any = np.zeros((room, log.shape[1]), log.dtype)
        self._bytes = _as_bytes(self._rows)
        self.first = 0
        self.count = 0

    def add(self, first: int, count: int) -> None:
        """Copy cycles that have just been done, at most LOG_CYCLES."""
        if not self.count:
            self.first = first
        slot = first % LOG_CYCLES
        head = min(count, LOG_CYCLES - slot)
        at = self.count
        self._bytes[at : at + head] = self._ring[slot : slot + head]
        self._bytes[at + head : at + count] = self._ring[: count - head]
        self.count += count

    def take(self, count: int) -> Rows:
        """Return the oldest cycles, shape (cycles, axes), and forget them."""
        count = min(count, self.count)
        taken: Rows = (
            self._bytes[:count].copy().view(self._rows.dtype)
        )  # field by field takes 10 times as long
        self._bytes[: self.count - count] = self._bytes[count : self.count].copy()
        self.first += count
        self.count -= count
        return taken


def _as_bytes(rows: Rows) -> NDArray[np.uint8]:
    return rows.view(np.uint8).reshape(len(rows), -1)
