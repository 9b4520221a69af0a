"""Process data objects (CiA 301): parameters, remapping, transmission types, packing plans."""

import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache
from operator import call
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.base.time import NS_PER_MS, NS_PER_US, Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import STRUCT_CODES, DataType, Value, integer_range, size_of
from hli_bench.protocols.canopen.dictionary import ObjectValues, ReadHook, RecordHook, WriteHook
from hli_bench.protocols.canopen.eds import Entry, ObjectDictionary
from hli_bench.wire.can import CanFrame

RPDO_COMMUNICATION: Final = range(0x1400, 0x1600)
TPDO_COMMUNICATION: Final = range(0x1800, 0x1A00)
MAPPING_OFFSET: Final = 0x200
MAX_ENTRIES: Final = 8
MAX_BYTES: Final = 8

INVALID: Final = 1 << 31
"""COB-ID bit: the PDO does not exist."""
NO_RTR: Final = 1 << 30
"""COB-ID bit of a TPDO: remote frames are not answered."""
_EXTENDED: Final = 1 << 29
_COB_ID_MASK: Final = 0x7FF

SYNCHRONOUS: Final = range(241)
ON_EVENT: Final = (254, 255)
_INHIBIT_NS: Final = 100 * NS_PER_US


class _Parameter(IntEnum):
    """Sub-indices of the communication parameter."""

    COB_ID = 1
    TYPE = 2
    INHIBIT = 3
    EVENT_TIMER = 5


_RESTRICTED: Final = (
    range(0x081),
    range(0x101, 0x181),
    range(0x581, 0x600),
    range(0x601, 0x680),
    range(0x6E0, 0x800),
)
"""Identifiers that no PDO may take (NMT, SYNC, SDO, error control and reserved ones)."""

Signature = tuple[int, int, tuple[int, ...]]
"""COB-ID with its bits, transmission type, mapping entries."""


@dataclass(frozen=True, slots=True)
class PdoPlan:
    """How a mapping packs into bytes, computed once per mapping; `entries` are the real objects in order."""

    mapping: tuple[int, ...]
    entries: tuple[Entry, ...]
    codec: struct.Struct


@lru_cache(maxsize=1024)
def make_plan(description: ObjectDictionary, mapping: tuple[int, ...], *, sending: bool) -> PdoPlan:
    """Return the plan of mapping entries (index<<16 | subindex<<8 | bits). Raises SdoAbort.

    Mapping is byte-granular: objects of one bit cannot be mapped (decided here).
    """
    codes = ["<"]
    entries = []
    for word in mapping:
        entry = mapped_entry(description, word, sending=sending)
        if entry is None:
            codes.append(f"{(word & 0xFF) // 8}x")
        else:
            codes.append(STRUCT_CODES[entry.data_type])
            entries.append(entry)
    codec = struct.Struct("".join(codes))
    if codec.size > MAX_BYTES:
        raise SdoAbort(AbortCode.PDO_LENGTH)
    return PdoPlan(mapping, tuple(entries), codec)


def mapped_entry(description: ObjectDictionary, word: int, *, sending: bool) -> Entry | None:
    """Return the object of a mapping entry, None for a dummy of an RPDO. Raises SdoAbort."""
    index, subindex, bits = word >> 16, word >> 8 & 0xFF, word & 0xFF
    if index < 0x20 and not sending:
        _check_dummy(index, subindex, bits)
        return None
    if (index, subindex) not in description:
        known = description.has_object(index)
        raise SdoAbort(AbortCode.NO_SUBINDEX if known else AbortCode.NO_OBJECT)
    entry = description[index, subindex]
    size = size_of(entry.data_type)
    allowed = entry.access.readable if sending else entry.access.writable
    whole_bytes = size is not None and entry.data_type is not DataType.BOOLEAN and bits == 8 * size
    if not (entry.pdo_mappable and allowed and whole_bytes):
        raise SdoAbort(AbortCode.NOT_MAPPABLE)
    return entry


def _check_dummy(index: int, subindex: int, bits: int) -> None:
    """Check a dummy entry: index is an integer type's code and takes its place in the RPDO."""
    known = {int(kind) for kind in DataType if kind is not DataType.BOOLEAN and integer_range(kind)}
    if index not in known or subindex or bits != 8 * (size_of(DataType(index)) or 0):
        raise SdoAbort(AbortCode.NOT_MAPPABLE)


_Parameters = tuple[int, int, PdoPlan]
"""COB-ID with its bits, transmission type, plan."""


def _mapping_words(values: ObjectValues, mapping: int, count: int) -> tuple[int, ...]:
    return tuple(values.number(mapping, subindex) for subindex in range(1, count + 1))


def _parameters(values: ObjectValues, communication: int, *, sending: bool) -> _Parameters:
    """Return the parameters of a PDO as they stand in the dictionary. Raises InputError (broken EDS)."""
    mapping = communication + MAPPING_OFFSET
    try:
        cob_word, transmission, count = (
            values.number(communication, _Parameter.COB_ID),
            values.number(communication, _Parameter.TYPE),
            values.number(mapping, 0),
        )
    except SdoAbort as abort:
        message = f"0x{communication:04X} and 0x{mapping:04X} lack an object that a PDO needs"
        raise InputError(message) from abort
    try:
        words = _mapping_words(values, mapping, count)
        return cob_word, transmission, make_plan(values.description, words, sending=sending)
    except SdoAbort as abort:
        raise InputError(f"default mapping of 0x{mapping:04X}: {abort}") from abort


@lru_cache(maxsize=4096)
def _from_factory(
    description: ObjectDictionary, node_id: int, communication: int, *, sending: bool
) -> _Parameters:
    """Return the parameters that a node has by its EDS, worked out once a process."""
    return _parameters(ObjectValues(description, node_id), communication, sending=sending)


class _Pdo:
    """Parameters of one PDO and the rules by which they may change.

    `cob_word` is its COB-ID with all bits, `cob_id` the 11-bit identifier, `valid` whether the PDO exists.
    """

    __slots__ = (
        "_changed",
        "_communication",
        "_mapping",
        "_values",
        "cob_id",
        "cob_word",
        "plan",
        "sending",
        "transmission",
        "valid",
    )

    def __init__(
        self, values: ObjectValues, communication: int, changed: Callable[[], None], *, sending: bool
    ) -> None:
        self._values = values
        self._changed = changed
        self._communication = communication
        self._mapping = communication + MAPPING_OFFSET
        self.sending = sending
        self._take(_from_factory(values.description, values.node_id, communication, sending=sending))

    @property
    def hooks(self) -> dict[int, RecordHook]:
        """What follows writes to its parameters, by object."""
        return {self._communication: self._write_parameter, self._mapping: self._write_mapping}

    def start(self) -> None:
        """Begin anew, on entering OPERATIONAL."""
        raise NotImplementedError

    def bind(self) -> None:
        """Find out by which hooks the values of the mapping pass."""
        raise NotImplementedError

    def _identify(self, cob_word: int) -> None:
        self.cob_word = cob_word
        self.cob_id = cob_word & _COB_ID_MASK
        self.valid = not cob_word & INVALID

    @property
    def signature(self) -> Signature:
        """What decides the bytes and the moment of this PDO."""
        return self.cob_word, self.transmission, self.plan.mapping

    def reload(self) -> None:
        """Take over the values of the dictionary after a reset. Raises InputError (broken EDS)."""
        self._take(_parameters(self._values, self._communication, sending=self.sending))
        self._changed()

    def _take(self, parameters: _Parameters) -> None:
        cob_word, self.transmission, self.plan = parameters
        self._identify(cob_word)

    def _write_parameter(self, subindex: int, value: Value) -> None:
        match subindex:
            case _Parameter.COB_ID:
                self._write_cob_id(value)
            case _Parameter.TYPE:
                self._write_type(value)
            case _Parameter.INHIBIT:
                self._write_inhibit(value)
            case _:
                pass

    def _write_mapping(self, subindex: int, value: Value) -> None:
        if subindex == 0:
            self._write_count(value)
        elif subindex <= MAX_ENTRIES:
            self._write_entry(value)

    def _write_cob_id(self, value: Value) -> None:
        word = int(value)
        identifier = word & _COB_ID_MASK
        if word & _EXTENDED or word & 0x1FFFF800:
            raise SdoAbort(AbortCode.RANGE)
        if not word & INVALID:
            if any(identifier in restricted for restricted in _RESTRICTED):
                raise SdoAbort(AbortCode.RANGE)
            if self.valid and identifier != self.cob_id:
                raise SdoAbort(AbortCode.RANGE)
        self._identify(word)
        self._changed()

    def _write_type(self, value: Value) -> None:
        if int(value) not in SYNCHRONOUS and int(value) not in ON_EVENT:
            raise SdoAbort(AbortCode.RANGE)
        self.transmission = int(value)
        self._changed()

    def _write_inhibit(self, value: Value) -> None:
        """Refuse a change while the PDO exists."""
        if self.valid and int(value) != self._values.number(self._communication, _Parameter.INHIBIT):
            raise SdoAbort(AbortCode.UNSUPPORTED_ACCESS)

    def _write_count(self, value: Value) -> None:
        """Activate that many entries after a check; only while the PDO is invalid."""
        count = int(value)
        if self.valid:
            raise SdoAbort(AbortCode.UNSUPPORTED_ACCESS)
        if count > MAX_ENTRIES or (count and not self._values.has(self._mapping, count)):
            raise SdoAbort(AbortCode.PDO_LENGTH)
        words = _mapping_words(self._values, self._mapping, count)
        self.plan = make_plan(self._values.description, words, sending=self.sending)
        self.bind()
        self._changed()

    def _write_entry(self, value: Value) -> None:
        """Check an entry; it changes only while the PDO is invalid and the count is 0; 0 clears it."""
        if self.valid or self._values.number(self._mapping, 0):
            raise SdoAbort(AbortCode.UNSUPPORTED_ACCESS)
        if value:
            mapped_entry(self._values.description, int(value), sending=self.sending)


class Rpdo(_Pdo):
    """A PDO that this node receives."""

    __slots__ = ("_receivers", "received")

    def __init__(self, values: ObjectValues, communication: int, changed: Callable[[], None]) -> None:
        self._receivers: list[WriteHook] = []
        self.received: bytes | None = None
        """Data that wait for a SYNC."""
        super().__init__(values, communication, changed, sending=False)

    def bind(self) -> None:
        """Find out where the values of the mapping go."""
        self._receivers = [self._values.receiver(entry) for entry in self.plan.entries]

    def start(self) -> None:
        """Begin anew, on entering OPERATIONAL."""
        self.received = None
        self.bind()

    def receive(self, data: bytes) -> bool:
        """Take data, effective now or, for synchronous types, at the next SYNC. False: too short."""
        if len(data) < self.plan.codec.size:
            return False
        if self.transmission in SYNCHRONOUS:
            self.received = data
        else:
            self._apply(data)
        return True

    def on_sync(self) -> None:
        """Let `received` take effect, unless it is too short for a mapping made since."""
        data, self.received = self.received, None
        if data is not None and len(data) >= self.plan.codec.size:
            self._apply(data)

    def _apply(self, data: bytes) -> None:
        """Store all values; one that its object refuses is left out (decided here: a PDO has no abort)."""
        for receive, value in zip(self._receivers, self.plan.codec.unpack_from(data), strict=True):
            try:
                receive(value)
            except SdoAbort:
                continue


class Tpdo(_Pdo):
    """A PDO that this node sends."""

    __slots__ = ("_readers", "_sent", "_sent_at", "_syncs")

    def __init__(self, values: ObjectValues, communication: int, changed: Callable[[], None]) -> None:
        self._readers: list[ReadHook] = []
        self._sent_at: Ns | None = None
        self._sent: CanFrame | None = None
        self._syncs = 0
        super().__init__(values, communication, changed, sending=True)

    def bind(self) -> None:
        """Find out where the values of the mapping come from."""
        getters = self._values.getters
        self._readers = [getters[entry.index, entry.subindex] for entry in self.plan.entries]

    def start(self) -> None:
        """Begin anew, on entering OPERATIONAL."""
        self._sent_at = None
        self._sent = None
        self._syncs = 0
        self.bind()

    def pack(self) -> bytes:
        """Return the present values of all mapped objects as PDO data."""
        return self.plan.codec.pack(*map(call, self._readers))

    def on_sync(self, now: Ns) -> CanFrame | None:
        """Return the frame due at this SYNC: every n-th for types 1..240, after a change for type 0."""
        if self.transmission == 0:
            data = self.pack()
            return None if self._has_sent(data) else self._send(data, now)
        self._syncs += 1
        if self._syncs < self.transmission:
            return None
        self._syncs = 0
        return self._send(self.pack(), now)

    @property
    def at_sync(self) -> bool:
        """Whether a SYNC sends it."""
        return self.valid and self.transmission in SYNCHRONOUS

    @property
    def on_event(self) -> bool:
        """Whether an event or a timer sends it."""
        return self.valid and self.transmission in ON_EVENT

    def tick(self, now: Ns) -> CanFrame | None:
        """Return the frame due by event (a mapped value changed) or timer, after the inhibit time."""
        if not self.on_event or not self.plan.entries:
            return None
        data = self.pack()
        timer = self._timer_due()
        if self._has_sent(data) and (timer is None or now < timer):
            return None
        return None if now < self._inhibited_until() else self._send(data, now)

    def on_remote(self, now: Ns) -> CanFrame | None:
        """Return the answer to a remote frame, None where bit 30 of the COB-ID forbids it."""
        if not self.valid or self.cob_word & NO_RTR:
            return None
        return self._send(self.pack(), now)

    def next_due(self) -> Ns | None:
        """Return when the event timer or the end of the inhibit time makes `tick` send at the latest."""
        if not self.on_event or self._sent_at is None:
            return None
        timer = self._timer_due()
        if not self._has_sent(self.pack()):
            return self._inhibited_until()
        return None if timer is None else max(timer, self._inhibited_until())

    def _timer_due(self) -> Ns | None:
        timer_ms = self._optional(_Parameter.EVENT_TIMER)
        return None if not timer_ms or self._sent_at is None else Ns(self._sent_at + timer_ms * NS_PER_MS)

    def _inhibited_until(self) -> Ns:
        return (
            Ns(0)
            if self._sent_at is None
            else Ns(self._sent_at + self._optional(_Parameter.INHIBIT) * _INHIBIT_NS)
        )

    def _optional(self, subindex: int) -> int:
        has = self._values.has(self._communication, subindex)
        return self._values.number(self._communication, subindex) if has else 0

    def _has_sent(self, data: bytes) -> bool:
        return self._sent is not None and self._sent.data == data

    def _send(self, data: bytes, now: Ns) -> CanFrame:
        """Return the frame with these data; the one sent last while it says the same."""
        self._sent_at = now
        sent = self._sent
        if sent is None or sent.data != data or sent.cob_id != self.cob_id:
            sent = self._sent = CanFrame(self.cob_id, data)
        return sent


class PdoSet:
    """All PDOs of a node, in the order of their numbers; `changes` grows with every change of a parameter.

    They begin as the EDS gives them, which a node's values do as well.
    """

    __slots__ = ("_at_sync", "_by_cob_id", "_on_event", "_values", "changes", "rpdos", "tpdos")

    def __init__(self, values: ObjectValues) -> None:
        self.changes = 0
        self._values = values
        self._by_cob_id: dict[int, list[Rpdo]] | None = None
        self._on_event: tuple[Tpdo, ...] | None = None
        self._at_sync: tuple[Tpdo, ...] | None = None
        received, sent = _communication(values.description)
        self.rpdos = tuple(Rpdo(values, index, self._changed) for index in received)
        self.tpdos = tuple(Tpdo(values, index, self._changed) for index in sent)
        hooks: dict[int, RecordHook] = {}
        for pdo in (*self.rpdos, *self.tpdos):
            hooks |= pdo.hooks
        values.on_write_records(hooks)

    @property
    def signature(self) -> tuple[Signature, ...]:
        """The signatures of all RPDOs, then of all TPDOs."""
        return tuple(pdo.signature for pdo in (*self.rpdos, *self.tpdos))

    def receivers(self, cob_id: int) -> list[Rpdo]:
        """Return the valid RPDOs of an identifier."""
        if self._by_cob_id is None:
            self._by_cob_id = {}
            for rpdo in self.rpdos:
                if rpdo.valid:
                    self._by_cob_id.setdefault(rpdo.cob_id, []).append(rpdo)
        return self._by_cob_id.get(cob_id, [])

    def on_sync(self, now: Ns) -> list[CanFrame]:
        """Let received RPDO data take effect, then sample and return the TPDOs that are due at a SYNC."""
        for rpdo in self.rpdos:
            if rpdo.received is not None:
                rpdo.on_sync()
        if self._at_sync is None:
            self._at_sync = tuple(tpdo for tpdo in self.tpdos if tpdo.at_sync)
        return [frame for tpdo in self._at_sync if (frame := tpdo.on_sync(now)) is not None]

    @property
    def on_event(self) -> tuple[Tpdo, ...]:
        """The valid TPDOs that an event or a timer sends."""
        if self._on_event is None:
            self._on_event = tuple(tpdo for tpdo in self.tpdos if tpdo.on_event)
        return self._on_event

    def reload(self) -> None:
        """Take over the dictionary's values after a reset."""
        for pdo in (*self.rpdos, *self.tpdos):
            pdo.reload()
        self.start()

    def start(self) -> None:
        """Begin anew, on entering OPERATIONAL."""
        for pdo in (*self.rpdos, *self.tpdos):
            pdo.start()
        self._values.hooked = self._bind

    def _bind(self) -> None:
        for pdo in (*self.rpdos, *self.tpdos):
            pdo.bind()

    def _changed(self) -> None:
        self.changes += 1
        self._by_cob_id = None
        self._on_event = None
        self._at_sync = None


@lru_cache(maxsize=64)
def _communication(description: ObjectDictionary) -> tuple[list[int], list[int]]:
    """Return the communication parameters of all RPDOs and of all TPDOs, in order."""
    indices = sorted(description.names)
    return [i for i in indices if i in RPDO_COMMUNICATION], [i for i in indices if i in TPDO_COMMUNICATION]
