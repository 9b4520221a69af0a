"""What writes the trace or the CAN log of a bench in real pace: `python -m hli_bench.shells.recorder_process`.

Argument: descriptor of its pipe. Over the pipe come what is to be recorded, then batches of cycles; it answers the
first and the last message: empty, or what has gone wrong.
"""

import pickle
import signal
import sys
from collections.abc import Sequence

import numpy as np

from hli_bench.base.errors import BenchError
from hli_bench.base.plain import plain
from hli_bench.laws.rows import LOG, LOG_CYCLES
from hli_bench.shells.pipe import Pipe
from hli_bench.shells.processes import work
from hli_bench.shells.record_file import INTERRUPTS
from hli_bench.shells.recorder import KINDS, Batch, Sink, What


class Replay:
    """Tells a sink what happened in another process, from a log ring of its own."""

    def __init__(self, what: What) -> None:
        """Raises InputError when the file cannot be written."""
        ring = np.zeros((LOG_CYCLES, len(what.setup.axes)), LOG)
        self._ring = ring.view(np.uint8).reshape(LOG_CYCLES, -1)
        self._next: int | None = None
        self.sink: Sink = KINDS[what.kind](what, ring, _note)

    def take(self, batch: Batch) -> bool:
        """Let the sink take a batch, and know which cycles are missing in front of it; tell whether more will come."""
        if self._next is not None and batch.first > self._next:
            self.sink.gap(self._next, batch.first - self._next)
        rows = np.frombuffer(batch.rows, np.uint8).reshape(-1, self._ring.shape[1])
        for name, arguments in batch.calls:
            getattr(self.sink, name)(*arguments)
        self._next = batch.first + len(rows)
        if len(rows):
            self._ring[np.arange(batch.first, self._next) % LOG_CYCLES] = rows
            self.sink.cycles(batch.first, len(rows))
        return len(rows) > 0


def main(pipe: Pipe, arguments: Sequence[str]) -> None:
    """Write until the last batch; a bench that has died leaves a file that was not ended."""
    for number in INTERRUPTS:
        signal.signal(number, signal.SIG_IGN)
    try:
        replay = Replay(pickle.loads(pipe.receive()))
    except BenchError as error:
        pipe.send(str(error).encode())
        return
    pipe.send(b"")
    try:
        while replay.take(pickle.loads(pipe.receive())):
            pass
    except EOFError:
        replay.sink.break_off()
        return
    pipe.send(_closed(replay.sink).encode())


def _closed(sink: Sink) -> str:
    try:
        sink.close()
    except BenchError as error:
        return str(error)
    return ""


def _note(note: str) -> None:
    sys.stderr.write(f"{plain(note)}\n")
    sys.stderr.flush()


if __name__ == "__main__":
    sys.exit(work(main, sys.argv[1:]))
