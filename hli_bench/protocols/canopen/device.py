"""One CANopen slave: object dictionary, SDO, PDO, NMT, error control, EMCY, LSS, put together."""

from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import Value
from hli_bench.protocols.canopen.dictionary import ALL_OBJECTS, APPLICATION, COMMUNICATION, ObjectValues
from hli_bench.protocols.canopen.eds import ObjectDictionary
from hli_bench.protocols.canopen.emcy import (
    COMMUNICATION_LOST,
    RPDO_TOO_LONG,
    RPDO_TOO_SHORT,
    EmergencyProducer,
    ErrorRegister,
)
from hli_bench.protocols.canopen.lss import MASTER_COB_ID, LssSlave
from hli_bench.protocols.canopen.nmt import (
    ERROR_CONTROL_COB_ID,
    NMT_COB_ID,
    ErrorControl,
    HeartbeatConsumer,
    NmtCommand,
    NmtSlave,
    NmtState,
)
from hli_bench.protocols.canopen.pdo import PdoSet
from hli_bench.protocols.canopen.sdo import REQUEST_COB_ID
from hli_bench.protocols.canopen.sdo_servers import FREE, SdoServers
from hli_bench.protocols.canopen.sync import SyncConsumer
from hli_bench.wire.can import CanFrame

_TALKING: Final = (NmtState.PRE_OPERATIONAL, NmtState.OPERATIONAL)
"""States in which a node answers SDOs and sends EMCY."""
CONFIGURING: Final = frozenset(
    {NMT_COB_ID, MASTER_COB_ID, *range(REQUEST_COB_ID, REQUEST_COB_ID + 0x80), *FREE}
)
"""Identifiers whose frames may change what a node hears."""
_IDENTITY: Final = 0x1018
_SERIAL: Final = 4
"""Sub-index of the serial number, which stays when LSS gives the node another id."""
_STORE: Final = 0x1010
_RESTORE: Final = 0x1011
_SAVE: Final = int.from_bytes(b"save", "little")
_LOAD: Final = int.from_bytes(b"load", "little")
_AREAS: Final = {1: ALL_OBJECTS, 2: COMMUNICATION, 3: APPLICATION}
_SUPPORTED: Final = 1
"""What 0x1010 and 0x1011 read as: acts on command."""


class Application(Protocol):
    """What a device profile adds to the slave."""

    def on_reset(self) -> None:
        """Start from power-on values, which all application objects have again."""

    def on_nmt(self, state: NmtState) -> None:
        """Follow a change of the NMT state."""

    def on_sync(self, now: Ns) -> None:
        """Look at the machine at a SYNC, before RPDO data take effect and TPDOs are sampled."""

    def on_connection_lost(self) -> None:
        """React to guarding or a consumed heartbeat that stayed out."""


class Device:
    """A slave node. Frames and time go in, frames come out; `values` is its object dictionary.

    `on_frame` handles SYNC too; `on_sync` is for a caller that knows that there is one.
    """

    __slots__ = (
        "_application",
        "_consumer",
        "_error_control",
        "_heard",
        "_heard_in",
        "_lss",
        "_pdos",
        "_sdo",
        "_sync",
        "emcy",
        "nmt",
        "values",
    )

    def __init__(self, description: ObjectDictionary, node_id: int) -> None:
        self.values = ObjectValues(description, node_id)
        self.nmt = NmtSlave(node_id)
        self.emcy = EmergencyProducer(self.values)
        self._error_control = ErrorControl(self.values, self.nmt)
        self._consumer = HeartbeatConsumer(self.values)
        self._sync = SyncConsumer(self.values)
        self._pdos = PdoSet(self.values)
        self._sdo = SdoServers(self.values, node_id)
        self._lss = LssSlave(node_id, self._identity())
        self._application: Application | None = None
        self._heard: frozenset[int] = frozenset()
        self._heard_in: tuple[object, ...] = ()
        """What `_heard` was worked out from."""
        self._hook_storage(_STORE, _SAVE, self.values.store)
        self._hook_storage(_RESTORE, _LOAD, self.values.restore_factory)

    @property
    def node_id(self) -> int:
        """The active node id."""
        return self.nmt.node_id

    @property
    def sync_cob_id(self) -> int:
        """The identifier of the SYNC that it acts on (0x1005)."""
        return self._sync.cob_id

    @property
    def pdos(self) -> PdoSet:
        """The PDOs with their present parameters."""
        return self._pdos

    def attach(self, application: Application) -> None:
        """Let a device profile follow resets, NMT states, SYNC and lost connections."""
        self._application = application

    def power_on(self) -> list[CanFrame]:
        """Boot: PRE-OPERATIONAL and the boot-up message."""
        return [self.nmt.boot()]

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Take one frame of the bus and return the answers to it."""
        cob_id = frame.cob_id
        if cob_id == self._sync.cob_id and not frame.remote:
            return self.on_sync(now)
        if cob_id == NMT_COB_ID:
            return self._on_nmt(frame)
        if cob_id == MASTER_COB_ID:
            return self._lss.on_frame(frame, self.node_id)
        if cob_id in self._sdo.requests:
            return self._sdo.on_frame(frame, now) if self.nmt.state in _TALKING else []
        if cob_id > ERROR_CONTROL_COB_ID:
            self._consumer.on_frame(frame, now)
            return self._error_control.on_frame(frame, now)
        return self._on_pdo(frame, now)

    def on_sync(self, now: Ns) -> list[CanFrame]:
        """Let received RPDO data take effect, then sample and return the synchronous TPDOs."""
        if self._application is not None:
            self._application.on_sync(now)
        if self.nmt.state is not NmtState.OPERATIONAL:
            return []
        return self._pdos.on_sync(now)

    def tick(self, now: Ns) -> list[CanFrame]:
        """Return what is due by time or event: EMCY, event-driven TPDOs, heartbeat, SDO time-out."""
        self._consumer.tick(now)
        frames = self._error_control.tick(now)
        self._check_connection()
        if self.nmt.state in _TALKING:
            frames += self._sdo.tick(now) + self.emcy.tick(now)
        if self.nmt.state is NmtState.OPERATIONAL:
            due = [tpdo.tick(now) for tpdo in self._pdos.on_event]
            frames += [frame for frame in due if frame is not None]
        return sorted(frames, key=lambda frame: frame.cob_id) if len(frames) > 1 else frames

    def hears(self) -> frozenset[int]:
        """Return the identifiers that `on_frame` may act on; a configuration by SDO, NMT or LSS changes them."""
        state = (
            self._pdos.changes,
            self.node_id,
            self._sync.cob_id,
            self._consumer.nodes,
            self._sdo.requests,
        )
        if state != self._heard_in:
            self._heard_in = state
            own = {NMT_COB_ID, MASTER_COB_ID, self._sync.cob_id} | self._sdo.requests
            states = {ERROR_CONTROL_COB_ID + node for node in (self.node_id, *self._consumer.nodes)}
            pdos = {pdo.cob_id for pdo in (*self._pdos.rpdos, *self._pdos.tpdos) if pdo.valid}
            self._heard = frozenset(own | states | pdos)
        return self._heard

    def next_due(self, now: Ns) -> Ns | None:
        """Return when `tick` has something to do at the latest; a mapped value may change earlier."""
        dues: list[Ns | None] = [self._error_control.next_due(now), self._consumer.next_due()]
        if self.nmt.state in _TALKING:
            dues += [self._sdo.next_due(), self.emcy.next_due()]
        if self.nmt.state is NmtState.OPERATIONAL:
            dues += [tpdo.next_due() for tpdo in self._pdos.on_event]
        known = [due for due in dues if due is not None]
        return max(now, min(known)) if known else None

    def _on_nmt(self, frame: CanFrame) -> list[CanFrame]:
        """Act on an NMT command."""
        match self.nmt.on_frame(frame):
            case None:
                return []
            case NmtCommand.RESET_NODE:
                return self._reset(ALL_OBJECTS, self._lss.stored_node_id)
            case NmtCommand.RESET_COMMUNICATION:
                return self._reset(COMMUNICATION, self._lss.pending_node_id)
            case NmtCommand.START:
                self._pdos.start()
            case NmtCommand.STOP | NmtCommand.ENTER_PRE_OPERATIONAL:
                pass
        self._tell_nmt()
        return []

    def _reset(self, indices: range, node_id: int) -> list[CanFrame]:
        """Load power-on values, take over a node id that LSS set, boot again."""
        self._tell_nmt()
        if node_id != self.node_id:
            self.values.move(node_id)
            self.nmt.node_id = node_id
            indices = ALL_OBJECTS
        self._lss.pending_node_id = node_id
        self._lss.configuring = False
        self.values.reset(indices)
        if self.values.has(_IDENTITY, _SERIAL):
            self.values.put(_IDENTITY, _SERIAL, self._lss.identity[3])
        self.emcy.reset(keep_errors=indices is not ALL_OBJECTS)
        self._error_control.reset()
        self._consumer.reload()
        self._sync.reload()
        self._sdo.reload(node_id)
        self._pdos.reload()
        if indices is ALL_OBJECTS and self._application is not None:
            self._application.on_reset()
        boot_up = self.nmt.boot()
        self._tell_nmt()
        return [boot_up]

    def _tell_nmt(self) -> None:
        if self._application is not None:
            self._application.on_nmt(self.nmt.state)

    def _on_pdo(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Take an RPDO or answer a remote frame for a TPDO."""
        if self.nmt.state is not NmtState.OPERATIONAL:
            return []
        if frame.remote:
            asked = [tpdo.on_remote(now) for tpdo in self._pdos.tpdos if tpdo.cob_id == frame.cob_id]
            return [answer for answer in asked if answer is not None]
        for rpdo in self._pdos.receivers(frame.cob_id):
            accepted = rpdo.receive(frame.data)
            exact = len(frame.data) == rpdo.plan.codec.size
            if not exact or self.emcy.active:
                self._check_length(accepted=accepted, exact=exact)
        return []

    def _check_length(self, *, accepted: bool, exact: bool) -> None:
        """Report RPDOs of the wrong length; a right one ends the error."""
        if accepted:
            self.emcy.recover(RPDO_TOO_SHORT)
        else:
            self.emcy.occur(RPDO_TOO_SHORT, ErrorRegister.COMMUNICATION)
        if exact:
            self.emcy.recover(RPDO_TOO_LONG)
        elif accepted:
            self.emcy.occur(RPDO_TOO_LONG, ErrorRegister.COMMUNICATION)

    def _check_connection(self) -> None:
        """Report a master or node that fell silent, once, and its return."""
        if not self._error_control.lost and not self._consumer.lost:
            self.emcy.recover(COMMUNICATION_LOST)
        elif (
            self.emcy.occur(COMMUNICATION_LOST, ErrorRegister.COMMUNICATION) and self._application is not None
        ):
            self._application.on_connection_lost()

    def _identity(self) -> tuple[int, int, int, int]:
        vendor, product, revision, serial = (
            self.values.number(_IDENTITY, sub) if self.values.has(_IDENTITY, sub) else 0
            for sub in range(1, 5)
        )
        return vendor, product, revision, serial

    def _hook_storage(self, index: int, signature: int, act: Callable[[range], None]) -> None:
        """Connect 0x1010 or 0x1011: the right signature acts, another is refused, reading gives 1."""
        for sub, area in _AREAS.items():
            if self.values.has(index, sub):
                self.values.on_read(index, sub, lambda: _SUPPORTED)
                self.values.on_write(index, sub, partial(_command, signature, act, area))


def _command(signature: int, act: Callable[[range], None], area: range, value: Value) -> None:
    if value != signature:
        raise SdoAbort(AbortCode.CANNOT_STORE)
    act(area)
