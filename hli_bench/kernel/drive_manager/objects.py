"""Acyclic drive objects: SDO orders to the nodes, one at a time for each node, in the order they were given."""

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Final

from hli_bench.base.ids import NodeId
from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.sdo import SdoClient
from hli_bench.wire.can import CanFrame

ATTEMPTS: Final = 3
"""Times that a transfer is begun that others on the bus break off (decided here)."""
BROKEN_OFF: Final = frozenset(
    {AbortCode.TIME_OUT, AbortCode.TOGGLE, AbortCode.BAD_COMMAND, AbortCode.LENGTH, AbortCode.SEQUENCE}
)
"""How a transfer ends whose server has begun another one for somebody else; all else is a refusal of the drive."""
Done = Callable[[SdoAbort | None], None]


@dataclass(frozen=True, slots=True)
class Order:
    """One download; `done` gets None, or why the drive refused it. `attempts` counts those that were made."""

    index: int
    subindex: int
    data: bytes
    done: Done
    attempts: int = 1


class ObjectChannel:
    """The service channel to all nodes."""

    __slots__ = ("_clients", "_orders", "_running", "probing_inputs")

    def __init__(self, nodes: Iterable[NodeId]) -> None:
        self._clients = {node: SdoClient(node) for node in nodes}
        self._orders: dict[NodeId, deque[Order]] = {node: deque() for node in self._clients}
        self._running: dict[NodeId, Order] = {}
        self.probing_inputs: dict[NodeId, int] = {}
        """Probing input whose latches the telegrams of a node carry since they were configured; 0: not known."""

    def waits(self, node: NodeId) -> bool:
        """Tell whether orders for a node are waiting or on their way."""
        return node in self._running or bool(self._orders[node])

    def write(self, node: NodeId, order: Order) -> None:
        """Queue a download."""
        self._orders[node].append(order)

    def begin(self, now: Ns) -> list[CanFrame]:
        """Start what waits where the channel of its node is free; abort what is overdue."""
        frames: list[CanFrame] = []
        if not self.busy:
            return frames
        for node, client in self._clients.items():
            frames += client.tick(now)
            self._finish(node)
            if not client.busy and self._orders[node]:
                order = self._orders[node].popleft()
                self._running[node] = order
                frames += client.begin_write(order.index, order.subindex, order.data, now)
        return frames

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Take a frame that may be an answer."""
        client = self._clients.get(NodeId(frame.cob_id - 0x580))
        if client is None:
            return []
        frames = client.on_frame(frame, now)
        self._finish(NodeId(client.node_id))
        return frames

    def next_due(self) -> Ns | None:
        """Return when an answer that is waited for becomes overdue."""
        dues = [due for client in self._clients.values() if (due := client.next_due()) is not None]
        return min(dues, default=None)

    @property
    def busy(self) -> bool:
        """Orders are waiting or on their way."""
        return bool(self._running) or any(self._orders.values())

    def clear(self) -> None:
        """Forget what waits (a CNC reset); what is on its way ends by itself, and nobody hears how."""
        for node, orders in self._orders.items():
            if orders:
                self.probing_inputs[node] = 0
            orders.clear()
        for node, order in self._running.items():
            self._running[node] = replace(order, done=_nobody)

    def _finish(self, node: NodeId) -> None:
        client = self._clients[node]
        if client.busy or node not in self._running:
            return
        order = self._running.pop(node)
        try:
            client.result()
        except SdoAbort as abort:
            if not client.collided or abort.code not in BROKEN_OFF:
                order.done(abort)
            elif order.attempts < ATTEMPTS:
                self._orders[node].appendleft(replace(order, attempts=order.attempts + 1))
            else:
                order.done(SdoAbort(abort.code, collided=True))
        else:
            order.done(None)


def _nobody(_: SdoAbort | None) -> None:
    """Hear the answer to an order that nobody waits for any more."""
