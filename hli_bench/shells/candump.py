"""The bus as a candump log: one line a frame, `(1767225600.001000) can0 181#3706E8030000`, remote frames `701#R`.

`candump -L` writes this form; canplayer, python-can and Wireshark read it.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.time import NS_PER_S, NS_PER_US
from hli_bench.kernel.records import Emitted
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import LOG_CYCLES, Rows
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.frames import CycleBuffer
from hli_bench.shells.bus_file import BusFile
from hli_bench.shells.record_file import OnNote, RecordFile, uninterrupted
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge

INTERFACE: Final = "can0"
_SECOND_DIGITS: Final = 10 ** np.arange(9, -1, -1)
_MICROSECOND_DIGITS: Final = 10 ** np.arange(5, -1, -1)
_HEX: Final = np.frombuffer(b"".join(b"%02X" % value for value in range(256)), np.uint16)


def line(frame: CanFrame, unix_ns: int, interface: str) -> bytes:
    """Return one frame as a line of the log."""
    seconds, rest = divmod(unix_ns, NS_PER_S)
    data = "R" if frame.remote else frame.data.hex().upper()
    return b"(%010d.%06d) %s %03X#%s\n" % (
        seconds,
        rest // NS_PER_US,
        interface.encode(),
        frame.cob_id,
        data.encode(),
    )


class Candump:
    """Form of a candump log."""

    head: Final = b""
    tail: Final = 1

    def __init__(self, interface: str = INTERFACE) -> None:
        self._interface = interface

    def frame(self, frame: CanFrame, unix_ns: int) -> bytes:
        """Return one frame as a line."""
        return line(frame, unix_ns, self._interface)

    def stamps(self, unix_ns: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Return the times in brackets."""
        text = np.empty((len(unix_ns), len("(1767225600.001000)")), np.uint8)
        text[:] = np.frombuffer(b"(0000000000.000000)", np.uint8)
        seconds, rest = np.divmod(unix_ns, NS_PER_S)
        text[:, 1:11] += (seconds[:, np.newaxis] // _SECOND_DIGITS % 10).astype(np.uint8)
        text[:, 12:18] += (rest[:, np.newaxis] // NS_PER_US // _MICROSECOND_DIGITS % 10).astype(np.uint8)
        return text

    def data(self, payload: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return two hexadecimal digits a byte."""
        return _HEX[payload].view(np.uint8)


class CandumpLog:
    """Observer that writes every frame of the bus to a file."""

    def __init__(self, path: Path, setup: KernelSetup, log: Rows, on_note: OnNote = lambda _: None) -> None:
        """`log` is the kernel's ring. Raises InputError when the file cannot be written."""
        nodes = [axis.node for axis in setup.axes]
        self._buffer = CycleBuffer(log)
        self._others: dict[int, list[CanFrame]] = {}
        self._file = RecordFile(path, on_note)
        self._bus = BusFile(self._file, Candump(), nodes, setup.cycle_ns, setup.dc_epoch_ns)

    def cycles(self, first: int, count: int) -> None:
        """Take cycles of the log ring; written when enough of them wait."""
        self._buffer.add(first, count)
        if self._buffer.count >= LOG_CYCLES:
            self._write()

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        """Take frames beside the telegrams."""
        self._others.setdefault(cycle, []).extend(frames)

    def edges(self, edges: Sequence[Edge]) -> None:
        """Edges do not pass on the bus."""

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        """What the kernel emits does not pass on the bus."""

    def commands(self, commands: Commands) -> None:
        """The HLI is not on the bus."""

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        """The HLI is not on the bus."""

    def overran(self, cycle: int, plc: str) -> None:
        """PLCs are not on the bus."""

    def gap(self, first: int, count: int) -> None:
        """Cycles were lost: their lines are missing, the stamps show it."""
        self._write()

    def close(self) -> None:
        """Write what waits and close the file. May be called again.

        Raises EnvironmentLacks when not all of it could be written.
        """
        if not self._file.closed:
            self._write()
            self._file.close()

    break_off = close
    """A log has no end of its own."""

    def _write(self) -> None:
        """Write all waiting cycles with what passed beside them."""
        with uninterrupted():
            first = self._buffer.first
            rows = self._buffer.take(self._buffer.count)
            end = first + len(rows)
            due = {cycle: frames for cycle, frames in self._others.items() if cycle < end or not len(rows)}
            for cycle in due:
                del self._others[cycle]
            self._bus.write(first, rows, due)
            self._file.flush()
