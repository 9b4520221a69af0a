"""A run as an MCAP file, written while it runs: numbers of all axes in blocks, events between them.

Topics: `meta` (one message), `axes` (blocks of cycles as the log holds them), `can` (frames that are no
telegrams; the telegrams follow from `axes`), `edges`, `plc`, `refused`, `cnc`; `gaps` where cycles are missing.
Times are bench time in ns.
A block begins at a multiple of BLOCK_CYCLES and what happened in it stands behind it in order of time, so
equal runs give equal bytes however they were cut into strides. Decision 0011.
"""

import json
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from struct import Struct
from struct import error as StructError  # noqa: N812 an exception class in lower case
from types import TracebackType
from typing import Any, BinaryIO, Final, Self, cast

import numpy as np
from mcap.exceptions import EndOfFile, McapError
from mcap.records import Channel, DataEnd, Header, McapRecord, Message, Schema
from mcap.stream_reader import CRCValidationError, StreamReader
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer
from zstandard import ZstdError

from hli_bench.base.errors import InputError
from hli_bench.base.ids import NodeId
from hli_bench.base.time import Ns
from hli_bench.base.units import mm
from hli_bench.kernel.records import Emitted, Homed, MeasuredValue
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import LOG, LOG_CYCLES, Rows
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.frames import CycleBuffer
from hli_bench.shells.record_file import OnNote, RecordFile, uninterrupted
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge

FORMAT: Final = 1
BLOCK_CYCLES: Final = 250
CHUNK_BYTES: Final = 1 << 20
"""Uncompressed; what a crash can cost at most."""
WRITER: Final = "hli-bench"

TOPICS: Final = ("meta", "axes", "can", "edges", "plc", "refused", "cnc")
GAPS: Final = "gaps"
"""A topic only of files in which cycles are missing."""
OVERRUNS: Final = "overruns"
"""A topic only of files in which a PLC has not kept its period."""

_BLOCK: Final = Struct("<QII")
_CAN: Final = Struct("<HBB")
_REMOTE: Final = 1
_PACKED: Final = "packed"
_TEXT: Final = {"type": "string"}
_WHOLE: Final = {"type": "integer"}


def _object(**properties: object) -> dict[str, object]:
    return {"type": "object", "properties": properties, "required": list(properties)}


_SCHEMAS: Final[Mapping[str, object]] = {
    "meta": _object(
        format=_WHOLE,
        machine=_TEXT,
        cycle_ns=_WHOLE,
        dc_epoch_ns=_WHOLE,
        axes={"type": "array", "items": _object(name=_TEXT, number=_WHOLE, node=_WHOLE, kind=_TEXT)},
        overrides={"type": "object"},
    ),
    "axes": {
        "byte_order": "little",
        "header": ["first cycle: u8", "cycles: u4", "axes: u4"],
        "rows": "cycles x axes records without padding, lengths of f8 fields in 0.1 um, increments else",
        "record": [list(field) for field in LOG.newbyteorder("<").descr],
    },
    "can": {
        "byte_order": "little",
        "header": ["identifier: u2", "flags: u1, bit 0 remote frame", "length: u1"],
        "data": "length bytes",
    },
    "edges": _object(signal=_TEXT, level={"type": "boolean"}),
    "plc": _object(plc=_TEXT, cycle=_WHOLE, writes={"type": "array"}),
    "refused": _object(path=_TEXT, reason=_TEXT, writer=_TEXT),
    "cnc": _object(kind=_TEXT),
    OVERRUNS: _object(plc=_TEXT, cycle=_WHOLE),
    GAPS: _object(first=_WHOLE, count=_WHOLE),
}


@dataclass(frozen=True, slots=True)
class AxesBlock:
    """Cycles `first` ... of all axes: `rows` has shape (cycles, axes) and the fields of the log."""

    first: int
    rows: Rows


@dataclass(frozen=True, slots=True)
class TraceEvent:
    """Something at an instant: `value` is a CanFrame for topic `can`, the decoded object for the others."""

    topic: str
    at_ns: Ns
    value: Any


@dataclass(frozen=True, slots=True)
class TraceAxis:
    """An axis of the recorded machine, in the order of the rows."""

    name: str
    number: int
    node: NodeId
    kind: str


@dataclass(frozen=True, slots=True)
class TraceMeta:
    """What was recorded: machine, its cycle and axes, the overrides of its keys as text."""

    machine: str
    cycle_ns: int
    dc_epoch_ns: int
    axes: tuple[TraceAxis, ...]
    overrides: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Stretch:
    """A block with the events up to its end, in order of time."""

    block: AxesBlock
    events: tuple[TraceEvent, ...]


class TraceFile:
    """Observer that writes the trace of a run. Memory does not grow with the run."""

    def __init__(
        self,
        path: Path,
        setup: KernelSetup,
        log: Rows,
        machine: str,
        overrides: Mapping[str, object] | None = None,
        on_note: OnNote = lambda _: None,
    ) -> None:
        """`log` is the kernel's ring. Raises InputError when the file cannot be written."""
        self._cycle_ns = setup.cycle_ns
        self._axes = len(setup.axes)
        self._units = [axis.unit for axis in setup.axes]
        self._buffer = CycleBuffer(log, LOG_CYCLES + BLOCK_CYCLES)
        self._waiting: list[tuple[Ns, int, bytes]] = []
        self._file = RecordFile(path, on_note)
        self._writer = Writer(
            cast("BinaryIO", self._file), chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD
        )
        self._writer.start(profile="", library=WRITER)
        self._channels: dict[str, int] = {}
        for topic in TOPICS:
            self._register(topic)
        axes = [
            {"name": axis.name, "number": axis.number, "node": axis.node, "kind": axis.kind}
            for axis in setup.axes
        ]
        meta = {
            "format": FORMAT,
            "machine": machine,
            "cycle_ns": setup.cycle_ns,
            "dc_epoch_ns": setup.dc_epoch_ns,
            "axes": axes,
            "overrides": {key: str(value) for key, value in (overrides or {}).items()},
        }
        self._put(Ns(0), self._channels["meta"], _json(meta))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def cycles(self, first: int, count: int) -> None:
        """Write the blocks that are complete with their events, then take new cycles of the log ring."""
        if self._buffer.count >= self._to_block_end():
            with uninterrupted():
                self._write_blocks()
        self._buffer.add(first, count)

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        """Take frames beside the telegrams."""
        for frame in frames:
            head = _CAN.pack(frame.cob_id, _REMOTE if frame.remote else 0, len(frame.data))
            self._event(Ns(cycle * self._cycle_ns), "can", head + frame.data)

    def edges(self, edges: Sequence[Edge]) -> None:
        """Take edges of signals."""
        for edge in edges:
            self._event(edge.at_ns, "edges", _json({"signal": edge.signal, "level": edge.level}))

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        """Take what the kernel emitted."""
        for record in records:
            value = {"kind": type(record).__name__, **asdict(record), **self._in_units(record)}
            self._event(Ns(cycle * self._cycle_ns), "cnc", _json(value))

    def _in_units(self, record: Emitted) -> dict[str, Any]:
        """Return the position of a record in the unit of its axis; `tenth_um` is 0.0001 degree if that is rotary."""
        match record:
            case MeasuredValue(axis=axis, acs_tenth_um=position):
                return {"acs": mm(position), "unit": self._units[axis]}
            case Homed(axis=axis, position_tenth_um=position):
                return {"position": mm(position), "unit": self._units[axis]}
            case _:
                return {}

    def commands(self, commands: Commands) -> None:
        """Take what a PLC wrote."""
        writes = [[write.path, write.value] for write in commands.writes]
        value = {"plc": commands.plc, "cycle": commands.cycle, "writes": writes}
        self._event(Ns(commands.cycle * self._cycle_ns), "plc", _json(value))

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        """Take writes that were refused."""
        for refusal in refusals:
            self._event(Ns(cycle * self._cycle_ns), "refused", _json(asdict(refusal)))

    def overran(self, cycle: int, plc: str) -> None:
        """Take that a PLC has not kept its period."""
        if OVERRUNS not in self._channels:
            self._register(OVERRUNS)
        self._event(Ns(cycle * self._cycle_ns), OVERRUNS, _json({"plc": plc, "cycle": cycle}))

    def gap(self, first: int, count: int) -> None:
        """Note that cycles were lost with all that happened in them; the next ones begin a block."""
        with uninterrupted():
            self._write_rest()
            if GAPS not in self._channels:
                self._register(GAPS)
            self._event(Ns(first * self._cycle_ns), GAPS, _json({"first": first, "count": count}))
            self._write_events(None)

    def close(self) -> None:
        """Write what waits and the index, close the file. May be called again.

        Raises EnvironmentLacks when not all of it could be written.
        """
        self._end(self._writer.finish)

    def break_off(self) -> None:
        """Write what waits and close the file, but not as a recording that was ended."""
        self._end(self._writer.flush)

    def _end(self, ending: Callable[[], None]) -> None:
        if self._file.closed:
            return
        with uninterrupted():
            self._write_rest()
            ending()
            self._file.close()

    def _write_rest(self) -> None:
        self._write_blocks()
        if self._buffer.count:
            self._write_block(self._buffer.count)
        self._write_events(None)

    def _to_block_end(self) -> int:
        """Return how many cycles the block has that the buffer begins with."""
        return BLOCK_CYCLES - self._buffer.first % BLOCK_CYCLES

    def _write_blocks(self) -> None:
        """Write complete blocks. Their last events came after the cycles, so this waits for the next call."""
        while self._buffer.count >= (cycles := self._to_block_end()):
            self._write_block(cycles)

    def _write_block(self, cycles: int) -> None:
        first = self._buffer.first
        rows = np.ascontiguousarray(self._buffer.take(cycles), LOG.newbyteorder("<"))
        head = _BLOCK.pack(first, len(rows), self._axes)
        self._put(Ns(first * self._cycle_ns), self._channels["axes"], head + rows.tobytes())
        self._write_events(Ns((first + cycles - 1) * self._cycle_ns))
        self._file.flush()

    def _write_events(self, until: Ns | None) -> None:
        """Write waiting events up to an instant (all of them for None), in order of time and topic."""
        due = [event for event in self._waiting if until is None or event[0] <= until]
        self._waiting = [event for event in self._waiting if until is not None and event[0] > until]
        for at_ns, channel, data in sorted(due, key=lambda event: event[:2]):
            self._put(at_ns, channel, data)

    def _event(self, at_ns: Ns, topic: str, data: bytes) -> None:
        self._waiting.append((at_ns, self._channels[topic], data))

    def _put(self, at_ns: Ns, channel: int, data: bytes) -> None:
        self._writer.add_message(channel_id=channel, log_time=at_ns, publish_time=at_ns, data=data)

    def _register(self, topic: str) -> None:
        packed = topic in ("axes", "can")
        encoding = _PACKED if packed else "jsonschema"
        schema = self._writer.register_schema(f"{WRITER}/{topic}", encoding, _json(_SCHEMAS[topic]))
        self._channels[topic] = self._writer.register_channel(topic, _PACKED if packed else "json", schema)


DAMAGED: Final = (
    McapError,
    ZstdError,
    CRCValidationError,
    ValueError,
    LookupError,
    OverflowError,
    MemoryError,
)
"""What reading raises for bytes that nobody has written: the library takes lengths and numbers as they stand."""


def _json(value: object) -> bytes:
    return json.dumps(value, sort_keys=True, separators=(",", ":")).encode()


def read(path: Path) -> Iterator[AxesBlock | TraceEvent]:
    """Read a trace in the order of the file; one that was cut off ends with its last complete chunk.

    Raises InputError for a file that is no trace or is damaged, OSError when it cannot be opened.
    """
    return TraceReader(path).entries()


class TraceReader:
    """A trace on disk, read from its beginning as often as wanted in constant memory.

    `torn` tells, once all has been read, that the file was cut off behind its last complete chunk.
    Raises InputError for a file that is no trace or is damaged, OSError when it cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.torn = False
        with closing(self.entries()) as entries:
            entry = next(entries, None)
        if not isinstance(entry, TraceEvent) or entry.topic != "meta":
            raise self._error("no trace: cut off in front of its first complete chunk")
        if entry.value["format"] > FORMAT:
            raise self._error(f"trace of format {entry.value['format']}, expected at most {FORMAT}")
        self.meta = _meta(entry.value)

    def stretches(self) -> Iterator[Stretch]:
        """Yield what was recorded block by block, `meta` excepted."""
        block = AxesBlock(0, np.zeros((0, len(self.meta.axes)), LOG.newbyteorder("<")))
        events: list[TraceEvent] = []
        for entry in self.entries():
            if isinstance(entry, TraceEvent):
                if entry.topic != "meta":
                    events.append(entry)
                continue
            if len(block.rows) or events:
                yield Stretch(block, tuple(events))
            block, events = entry, []
        if len(block.rows) or events:
            yield Stretch(block, tuple(events))

    def entries(self) -> Generator[AxesBlock | TraceEvent, None, None]:
        """Yield everything in the order of the file."""
        schemas: dict[int, Schema] = {}
        channels: dict[int, Channel] = {}
        self.torn = False
        with self.path.open("rb") as file:
            if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
                raise self._error("no trace: not an MCAP file")
            file.seek(0)
            for record in self._records(file):
                if isinstance(record, Header) and record.library != WRITER:
                    raise self._error(f"no trace: an MCAP file of {record.library!r}")
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Message):
                    try:
                        channel = channels[record.channel_id]
                        entry = _decoded(record, channel.topic, schemas[channel.schema_id])
                    except (*DAMAGED, StructError, TypeError) as error:
                        raise self._error(f"damaged in front of byte {file.tell()}: {error}") from error
                    yield entry

    def _records(self, file: BinaryIO) -> Iterator[McapRecord]:
        """Yield records up to the end of the data; note when the file ends in front of it."""
        try:
            for record in StreamReader(file, validate_crcs=True).records:
                if isinstance(record, DataEnd):
                    return
                yield record
        except (EndOfFile, StructError):
            self.torn = True
        except DAMAGED as error:
            raise self._error(f"damaged in front of byte {file.tell()}: {error}") from error

    def _error(self, message: str) -> InputError:
        return InputError(message, file=str(self.path))


def axes_text(meta: TraceMeta) -> str:
    """Return the axes as people read them."""
    return ", ".join(f"{axis.name} (axis {axis.number}, node {axis.node}, {axis.kind})" for axis in meta.axes)


def _meta(value: Mapping[str, Any]) -> TraceMeta:
    axes = tuple(TraceAxis(**axis) for axis in value["axes"])
    return TraceMeta(value["machine"], value["cycle_ns"], value["dc_epoch_ns"], axes, value["overrides"])


def _decoded(message: Message, topic: str, schema: Schema) -> AxesBlock | TraceEvent:
    at_ns = Ns(message.log_time)
    if topic == "axes":
        first, cycles, axes = _BLOCK.unpack_from(message.data)
        record = np.dtype([_field(entry) for entry in json.loads(schema.data)["record"]])
        rows = np.frombuffer(message.data, record, offset=_BLOCK.size).reshape(cycles, axes)
        return AxesBlock(first, rows)
    if topic == "can":
        cob_id, flags, length = _CAN.unpack_from(message.data)
        data = message.data[_CAN.size : _CAN.size + length]
        return TraceEvent(topic, at_ns, CanFrame(cob_id, data, remote=bool(flags & _REMOTE)))
    return TraceEvent(topic, at_ns, json.loads(message.data))


def _field(entry: Sequence[Any]) -> tuple[Any, ...]:
    """Return a field of the schema as numpy takes it: name, type and, for arrays, the shape."""
    return tuple(tuple(part) if isinstance(part, list) else part for part in entry)
