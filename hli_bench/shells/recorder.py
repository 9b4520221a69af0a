"""Traces and CAN logs of a run: written by the thread that steps the kernel, or handed to a process that writes them.

In free pace the kernel waits for what is written. In real pace it must not: what happened is handed over some cycles
at a time, and those for which there is no room are left out and told. Decision 0016.
"""

import pickle
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Protocol

from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.kernel.records import Emitted
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import LOG_CYCLES, Rows
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.engine import Observer
from hli_bench.runtime.frames import CycleBuffer
from hli_bench.shells.candump import CandumpLog
from hli_bench.shells.pipe import Pipe, framed
from hli_bench.shells.processes import ANSWER_S, Worker
from hli_bench.shells.record_file import OnNote, uninterrupted
from hli_bench.shells.trace_file import BLOCK_CYCLES, TraceFile
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge

BATCH: Final = 50
"""Cycles that are handed over at a time: a part of a trace's block (decided here)."""
ROOM: Final = 320
"""Batches that wait for the process that writes: 16 s of cycles of 1 ms (decided here)."""
PIECE: Final = 1 << 15
"""Bytes that one cycle hands over at most (decided here)."""
PROCESS: Final = "hli_bench.shells.recorder_process"


class Recorder(Observer, Protocol):
    """An observer with an end."""

    def close(self) -> None:
        """Write what waits and close the file. Raises EnvironmentLacks when not all of it could be written."""


class Sink(Recorder, Protocol):
    """One that writes a file."""

    def gap(self, first: int, count: int) -> None:
        """Cycles were lost with all that happened in them."""

    def break_off(self) -> None:
        """Close the file of a run that has died."""


@dataclass(frozen=True, slots=True)
class What:
    """What is recorded: `kind` is one of KINDS, `machine` and `overrides` stand in a trace."""

    kind: str
    path: Path
    setup: KernelSetup
    machine: str
    overrides: Mapping[str, object] = field(default_factory=dict)


Call = tuple[str, tuple[Any, ...]]
"""A method of an observer and its arguments."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Cycles `first` ... as bytes of the log, behind what happened since the batch before; the last one is empty."""

    first: int
    rows: bytes
    calls: Sequence[Call]


def _trace(what: What, log: Rows, on_note: OnNote) -> Sink:
    return TraceFile(what.path, what.setup, log, what.machine, what.overrides, on_note)


def _can_log(what: What, log: Rows, on_note: OnNote) -> Sink:
    return CandumpLog(what.path, what.setup, log, on_note)


KINDS: Final[Mapping[str, Callable[[What, Rows, OnNote], Sink]]] = {"trace": _trace, "can_log": _can_log}


def record(what: What, log: Rows, *, paced: bool, on_note: OnNote = lambda _: None) -> Recorder:
    """Return an observer that writes a file; `log` is the kernel's ring, `on_note` gets a line for people.

    Raises InputError when the file cannot be written.
    """
    return Handover(what, log, on_note) if paced else KINDS[what.kind](what, log, on_note)


class Outbox:
    """Messages for a process that may be slow: at most `room` of them wait, nobody waits for them."""

    def __init__(self, pipe: Pipe, room: int) -> None:
        self._pipe = pipe
        self._room = room
        self._waiting: deque[memoryview] = deque()

    @property
    def full(self) -> bool:
        """There is no room for another message."""
        return len(self._waiting) >= self._room

    def put(self, message: bytes) -> None:
        """Take a message."""
        self._waiting.append(memoryview(framed(message)))

    def send(self) -> None:
        """Send a piece of what waits, if it goes. Raises as `Pipe.send_part` does."""
        if self._waiting:
            with uninterrupted():
                self._send_piece()

    def send_all(self) -> None:
        """Send all that waits. Raises as `Pipe.send_part` does."""
        while self._waiting:
            self.send()

    def _send_piece(self) -> None:
        message = self._waiting[0]
        rest = message[self._pipe.send_part(message[:PIECE]) :]
        if rest:
            self._waiting[0] = rest
        else:
            self._waiting.popleft()


class Handover:
    """Observer that hands what happened to a process; it never waits before `close`."""

    def __init__(self, what: What, log: Rows, on_note: OnNote, room: int = ROOM) -> None:
        self._path = what.path
        self._on_note = on_note
        self._buffer = CycleBuffer(log, LOG_CYCLES + BATCH)
        self._calls: list[Call] = []
        self._failure: EnvironmentLacks | None = None
        self._missing = 0
        self._dropping = False
        self._worker: Worker | None = Worker(PROCESS, ())
        try:
            refused = self._worker.ask(pickle.dumps(what)).decode()
        except BaseException:
            self._worker.close()
            raise
        if refused:
            self._worker.close()
            raise InputError(refused)
        self._worker.pipe.limit(0.0)
        self._outbox = Outbox(self._worker.pipe, room)

    def cycles(self, first: int, count: int) -> None:
        """Take cycles of the log ring; hand over a batch when it is complete."""
        self._buffer.add(first, count)
        while self._buffer.count >= (cycles := BATCH - self._buffer.first % BATCH):
            self._hand_over(cycles)
        if self._failure is None:
            self._send()

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        """Take frames beside the telegrams."""
        self._calls.append(("frames", (cycle, tuple(frames))))

    def edges(self, edges: Sequence[Edge]) -> None:
        """Take edges of signals."""
        self._calls.append(("edges", (tuple(edges),)))

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        """Take what the kernel emitted."""
        self._calls.append(("emitted", (cycle, tuple(records))))

    def commands(self, commands: Commands) -> None:
        """Take what a PLC wrote."""
        self._calls.append(("commands", (commands,)))

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        """Take writes that were refused."""
        self._calls.append(("refused", (cycle, tuple(refusals))))

    def overran(self, cycle: int, plc: str) -> None:
        """Take that a PLC has not kept its period."""
        self._calls.append(("overran", (cycle, plc)))

    def close(self) -> None:
        """Hand over what waits and let the process close the file. May be called again.

        Raises EnvironmentLacks when not all of it could be written.
        """
        worker, self._worker = self._worker, None
        if worker is None:
            return
        try:
            worker.pipe.limit(ANSWER_S)
            if self._failure is None:
                self._finish(worker)
        except (EnvironmentLacks, TimeoutError) as error:
            self._failure = self._failed(error)
        finally:
            worker.close()
        if self._missing:
            self._on_note(
                f"{self._path}: {self._missing} cycles are missing, they came faster than they were written"
            )
        if self._failure is not None:
            raise self._failure

    def _finish(self, worker: Worker) -> None:
        self._outbox.send_all()
        self._hand_over(self._buffer.count)
        self._put(0)
        self._outbox.send_all()
        failed = worker.answer().decode()
        if failed:
            self._failure = EnvironmentLacks(failed)

    def _hand_over(self, cycles: int) -> None:
        """Hand over cycles, or leave them out: where there is no room, and from there to the begin of a block."""
        inside = self._dropping and self._buffer.first % BLOCK_CYCLES
        self._dropping = bool(inside) or self._outbox.full or self._failure is not None
        if self._dropping:
            self._missing += len(self._buffer.take(cycles))
            self._calls.clear()
        elif cycles:
            self._put(cycles)

    def _send(self) -> None:
        try:
            self._outbox.send()
        except EnvironmentLacks as error:
            self._failure = self._failed(error)
            self._on_note(f"{self._failure}; the run goes on without it")

    def _put(self, cycles: int) -> None:
        batch = Batch(self._buffer.first, self._buffer.take(cycles).tobytes(), self._calls)
        self._outbox.put(pickle.dumps(batch))
        self._calls = []

    def _failed(self, error: Exception) -> EnvironmentLacks:
        return EnvironmentLacks(f"{self._path}: recording has failed: {error}")
