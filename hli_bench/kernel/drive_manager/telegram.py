"""The cyclic telegrams of a drive as the CNC sends and takes them."""

from collections.abc import Iterable, Sequence
from typing import Final

from hli_bench.base.ids import NodeId
from hli_bench.kernel.setup import AxisSetup
from hli_bench.laws.rows import Rows
from hli_bench.protocols.canopen.telegram import RPDOS, TPDOS, Telegram
from hli_bench.wire.can import CanFrame

_HERE: Final = {"position": "received"}
"""Numbers that have another name in the CNC's rows: what came is not yet the actual position."""


class CommandTelegrams:
    """Makes the command telegrams of all axes from their rows; one that says the same is the one made before."""

    __slots__ = ("_frames", "_makers")

    def __init__(self, nodes: Sequence[NodeId], axis: Rows) -> None:
        """`nodes` in the order of the rows."""
        makers = {
            telegram.base + node: (telegram.layout.pack, columns, index)
            for telegram in RPDOS
            for columns in [_columns(axis, telegram)]
            for index, node in enumerate(nodes)
        }
        self._frames = [CanFrame(cob_id) for cob_id in sorted(makers)]
        self._makers = [makers[frame.cob_id] for frame in self._frames]

    def frames(self) -> list[CanFrame]:
        """Return the telegrams with the present numbers, in identifier order."""
        frames = self._frames
        for place, (pack, columns, index) in enumerate(self._makers):
            data = pack(*[column[index] for column in columns])
            if data != frames[place].data:
                frames[place] = CanFrame(frames[place].cob_id, data)
        return frames.copy()


class ActualTelegrams:
    """Takes TPDOs into the axis rows; a frame of another length than configured is left out.

    `cob_ids` are those of all actual value telegrams: what a cycle waits for. `missing` are those that did not come
    when frames were taken last.
    """

    __slots__ = ("_takers", "cob_ids", "missing")

    def __init__(self, axes: Sequence[AxisSetup], axis: Rows) -> None:
        """`axes` in the order of the rows."""
        self._takers = {
            telegram.base + one.node: (telegram.layout.size, telegram.layout.unpack, columns, one.index)
            for telegram in TPDOS
            for columns in [_columns(axis, telegram)]
            for one in axes
            if telegram.base in one.telegrams
        }
        self.cob_ids = frozenset(self._takers)
        self.missing: frozenset[int] = frozenset()

    def take(self, frames: Iterable[CanFrame]) -> list[CanFrame]:
        """Take the actual value telegrams among the frames; return the others."""
        others = []
        came: list[int] = []
        for frame in frames:
            taker = self._takers.get(frame.cob_id)
            if taker is None:
                others.append(frame)
                continue
            size, unpack, columns, index = taker
            if len(frame.data) == size:
                came.append(frame.cob_id)
                for column, value in zip(columns, unpack(frame.data)):  # noqa: B905 (one each)
                    column[index] = value
        self.missing = frozenset() if len(came) == len(self.cob_ids) else self.cob_ids.difference(came)
        return others


def _columns(axis: Rows, telegram: Telegram) -> list[memoryview]:
    """Return the numbers of a telegram for all axes, as memory views: they read and store without numpy's detours."""
    fields = [(axis[_HERE.get(number.name, number.name)], number.element) for number in telegram.numbers]
    return [(field if element is None else field[:, element]).data for field, element in fields]
