"""Network management (CiA 301): slave states, boot-up, heartbeat, node guarding, and what a master sends."""

from dataclasses import dataclass
from enum import IntEnum
from functools import partial
from typing import Final

from hli_bench.base.time import NS_PER_MS, Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import Value
from hli_bench.protocols.canopen.dictionary import ObjectValues
from hli_bench.wire.can import CanFrame

NMT_COB_ID: Final = 0x000
ERROR_CONTROL_COB_ID: Final = 0x700

_GUARD_TIME: Final = 0x100C
_LIFE_FACTOR: Final = 0x100D
_CONSUMER: Final = 0x1016
_PRODUCER: Final = 0x1017


class NmtState(IntEnum):
    """States as the error control frames carry them."""

    INITIALISING = 0x00
    STOPPED = 0x04
    OPERATIONAL = 0x05
    PRE_OPERATIONAL = 0x7F


class NmtCommand(IntEnum):
    """What a master may tell its slaves."""

    START = 0x01
    STOP = 0x02
    ENTER_PRE_OPERATIONAL = 0x80
    RESET_NODE = 0x81
    RESET_COMMUNICATION = 0x82


_TARGET: Final = {
    NmtCommand.START: NmtState.OPERATIONAL,
    NmtCommand.STOP: NmtState.STOPPED,
    NmtCommand.ENTER_PRE_OPERATIONAL: NmtState.PRE_OPERATIONAL,
}


def nmt_frame(command: NmtCommand, node_id: int = 0) -> CanFrame:
    """Return a master's command to one node, or to all with node id 0."""
    return CanFrame(NMT_COB_ID, bytes((command, node_id)))


def guarding_request(node_id: int) -> CanFrame:
    """Return a master's node guarding request."""
    return CanFrame(ERROR_CONTROL_COB_ID + node_id, remote=True)


def node_state(frame: CanFrame) -> tuple[int, NmtState] | None:
    """Return node id and state of a boot-up, heartbeat or guarding answer, None for any other frame."""
    node_id = frame.cob_id - ERROR_CONTROL_COB_ID
    if not 1 <= node_id <= 127 or frame.remote or len(frame.data) != 1:
        return None
    try:
        return node_id, NmtState(frame.data[0] & 0x7F)
    except ValueError:
        return None


class NmtSlave:
    """State machine of one node; acting on resets is up to its owner."""

    __slots__ = ("node_id", "state")

    def __init__(self, node_id: int) -> None:
        self.node_id = node_id
        self.state = NmtState.INITIALISING

    def boot(self) -> CanFrame:
        """Enter PRE-OPERATIONAL and return the boot-up message."""
        self.state = NmtState.PRE_OPERATIONAL
        return CanFrame(ERROR_CONTROL_COB_ID + self.node_id, bytes((NmtState.INITIALISING,)))

    def on_frame(self, frame: CanFrame) -> NmtCommand | None:
        """Return the command that a frame gives this node; the state is then already the new one."""
        if frame.cob_id != NMT_COB_ID or frame.remote or len(frame.data) != 2:
            return None
        specifier, node_id = frame.data
        if node_id not in {0, self.node_id} or self.state is NmtState.INITIALISING:
            return None
        try:
            command = NmtCommand(specifier)
        except ValueError:
            return None
        self.state = _TARGET.get(command, NmtState.INITIALISING)
        return command


class ErrorControl:
    """Heartbeat producer (0x1017), else node guarding with life guarding (0x100C, 0x100D)."""

    __slots__ = ("_heartbeat_at", "_life_until", "_period_ms", "_slave", "_toggle", "_values", "lost")

    def __init__(self, values: ObjectValues, slave: NmtSlave) -> None:
        self._values = values
        self._slave = slave
        self._toggle = 0
        self._heartbeat_at: Ns | None = None
        self._life_until: Ns | None = None
        self._period_ms = self._number(_PRODUCER)
        self.lost = False
        """The master's guarding stayed out for the life time."""
        if values.has(_PRODUCER):
            values.on_write(_PRODUCER, 0, self._write_producer)
        for index in (_GUARD_TIME, _LIFE_FACTOR):
            if values.has(index):
                values.on_write(index, 0, self._write_guarding)

    def reset(self) -> None:
        """Start anew after a reset: toggle bit 0, heartbeat due at once."""
        self._toggle = 0
        self._heartbeat_at = None
        self._life_until = None
        self._period_ms = self._number(_PRODUCER)
        self.lost = False

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Answer a guarding request."""
        ours = frame.remote and frame.cob_id == ERROR_CONTROL_COB_ID + self._slave.node_id
        if not ours or self._period_ms:
            return []
        answer = self._error_control(self._toggle | self._slave.state)
        self._toggle ^= 0x80
        self.lost = False
        life = self._number(_GUARD_TIME) * self._number(_LIFE_FACTOR)
        self._life_until = Ns(now + life * NS_PER_MS) if life else None
        return [answer]

    def tick(self, now: Ns) -> list[CanFrame]:
        """Return the heartbeat when it is due; note a master that fell silent."""
        if self._life_until is not None and now >= self._life_until:
            self._life_until = None
            self.lost = True
        period = self._period_ms
        if not period or self._slave.state is NmtState.INITIALISING:
            self._heartbeat_at = None
            return []
        if self._heartbeat_at is not None and now < self._heartbeat_at:
            return []
        basis = now if self._heartbeat_at is None else self._heartbeat_at
        self._heartbeat_at = Ns(max(basis + period * NS_PER_MS, now + 1))
        return [self._error_control(self._slave.state)]

    def next_due(self, now: Ns) -> Ns | None:
        """Return when `tick` has something to do at the latest."""
        heartbeat = (self._heartbeat_at or now) if self._period_ms else None
        return min((due for due in (heartbeat, self._life_until) if due is not None), default=None)

    def _error_control(self, state: int) -> CanFrame:
        return CanFrame(ERROR_CONTROL_COB_ID + self._slave.node_id, bytes((state,)))

    def _write_producer(self, value: Value) -> None:
        """Start a new period with a heartbeat at once."""
        self._period_ms = int(value)
        self._heartbeat_at = None
        if self._period_ms:
            # A node has one or the other: who asks for heartbeats does not guard it any more.
            self._life_until = None
            self.lost = False

    def _write_guarding(self, value: Value) -> None:
        """End life guarding when one of its factors becomes 0; else the next request counts with the new time."""
        if not value:
            self._life_until = None
            self.lost = False

    def _number(self, index: int) -> int:
        return self._values.number(index) if self._values.has(index) else 0


@dataclass(slots=True)
class _Watched:
    """A node whose heartbeat is consumed; `due` is None until its first heartbeat."""

    period: Ns
    due: Ns | None = None
    lost: bool = False


class HeartbeatConsumer:
    """Watches other nodes' heartbeats (0x1016, node id << 16 | ms), each from its first heartbeat on."""

    __slots__ = ("_subs", "_values", "_watched")

    def __init__(self, values: ObjectValues) -> None:
        self._values = values
        self._subs = values.description.subindices(_CONSUMER)
        self._watched: dict[int, _Watched] = {}
        for sub in self._subs:
            values.on_write(_CONSUMER, sub, partial(self._write, sub))
        self.reload()

    @property
    def lost(self) -> tuple[int, ...]:
        """Node ids whose heartbeat is overdue."""
        if not self._watched:
            return ()
        return tuple(node for node, watched in self._watched.items() if watched.lost)

    @property
    def nodes(self) -> tuple[int, ...]:
        """Node ids of the watched nodes."""
        return tuple(self._watched)

    def reload(self) -> None:
        """Take over the dictionary's values after a reset."""
        self._watched = {}
        for sub in self._subs:
            self._watch(self._values.number(_CONSUMER, sub))

    def on_frame(self, frame: CanFrame, now: Ns) -> None:
        """Take a heartbeat of a watched node."""
        if not self._watched:
            return
        heard = node_state(frame)
        watched = None if heard is None else self._watched.get(heard[0])
        if watched is not None:
            watched.due = Ns(now + watched.period)
            watched.lost = False

    def tick(self, now: Ns) -> None:
        """Note heartbeats that are overdue."""
        for watched in self._watched.values():
            if watched.due is not None and now >= watched.due:
                watched.lost = True
                watched.due = None

    def next_due(self) -> Ns | None:
        """Return when the next heartbeat becomes overdue."""
        return min(
            (watched.due for watched in self._watched.values() if watched.due is not None), default=None
        )

    def _write(self, sub: int, value: Value) -> None:
        """Refuse a second watch of one node, as the standard asks."""
        word = int(value)
        node_id, period = word >> 16 & 0x7F, word & 0xFFFF
        others = [self._values.number(_CONSUMER, other) for other in self._subs if other != sub]
        if word >> 23:
            raise SdoAbort(AbortCode.RANGE)
        if node_id and period and any(other >> 16 & 0x7F == node_id and other & 0xFFFF for other in others):
            raise SdoAbort(AbortCode.PARAMETER_INCOMPATIBLE)
        self._watched.pop(self._values.number(_CONSUMER, sub) >> 16 & 0x7F, None)
        self._watch(word)

    def _watch(self, word: int) -> None:
        node_id, period = word >> 16 & 0x7F, word & 0xFFFF
        if node_id and period:
            self._watched[node_id] = _Watched(Ns(period * NS_PER_MS))
