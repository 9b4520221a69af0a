"""The bus as a candump log: one line a frame, `(1767225600.001000) can0 181#3706E8030000`, remote frames `701#R`.

Times are the DC times of the cycles as Unix time. `candump -L` writes this form; canplayer, python-can and
Wireshark read it.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.time import DC_EPOCH, NS_PER_S, NS_PER_US
from hli_bench.kernel.records import Emitted
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import LOG_CYCLES, Rows
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.frames import (
    CycleBuffer,
    SilentNodes,
    Telegram,
    actual_telegrams,
    command_telegrams,
    from_cnc,
)
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge

UNIX_OF_DC_NS: Final = int(DC_EPOCH.timestamp()) * NS_PER_S
_STAMP: Final = len("(1767225600.001000) ")
_SECOND_DIGITS: Final = 10 ** np.arange(9, -1, -1)
_MICROSECOND_DIGITS: Final = 10 ** np.arange(5, -1, -1)
_HEX: Final = np.frombuffer(b"".join(b"%02X" % value for value in range(256)), np.uint8).reshape(256, 2)


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


def telegram_lines(
    telegrams: Sequence[Telegram], rows: Rows, unix_ns: NDArray[np.int64], interface: str, *, sync: bool
) -> NDArray[np.uint8]:
    """Return the lines of many cycles as characters, shape (cycles, characters of a cycle)."""
    stamps = _stamps(unix_ns)
    parts: list[NDArray[np.uint8]] = []
    if sync:
        parts += [stamps, _constant(f"{interface} 080#\n", len(rows))]
    for telegram in telegrams:
        payload = telegram.payload(rows)
        parts += [
            stamps,
            _constant(f"{interface} {telegram.cob_id:03X}#", len(rows)),
            _HEX[payload].reshape(len(rows), -1),
            _constant("\n", len(rows)),
        ]
    return np.concatenate(parts, axis=1)


def _stamps(unix_ns: NDArray[np.int64]) -> NDArray[np.uint8]:
    text = np.empty((len(unix_ns), _STAMP), np.uint8)
    text[:] = np.frombuffer(b"(0000000000.000000) ", np.uint8)
    seconds, rest = np.divmod(unix_ns, NS_PER_S)
    text[:, 1:11] += (seconds[:, np.newaxis] // _SECOND_DIGITS % 10).astype(np.uint8)
    text[:, 12:18] += (rest[:, np.newaxis] // NS_PER_US // _MICROSECOND_DIGITS % 10).astype(np.uint8)
    return text


def _constant(text: str, count: int) -> NDArray[np.uint8]:
    characters = np.frombuffer(text.encode(), np.uint8)
    return np.broadcast_to(characters, (count, len(characters)))


class CandumpLog:
    """Observer that writes every frame of the bus to a file."""

    def __init__(self, path: Path, setup: KernelSetup, log: Rows, interface: str = "can0") -> None:
        """`log` is the kernel's ring. Raises OSError when the file cannot be written."""
        nodes = [axis.node for axis in setup.axes]
        self._interface = interface
        self._cycle_ns = setup.cycle_ns
        self._epoch_ns = setup.dc_epoch_ns + UNIX_OF_DC_NS
        self._actual = actual_telegrams(nodes)
        self._command = command_telegrams(nodes)
        self._silent = SilentNodes(nodes)
        self._buffer = CycleBuffer(log)
        self._others: dict[int, list[CanFrame]] = {}
        self._file = path.open("wb")

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

    def close(self) -> None:
        """Write what waits and close the file. May be called again."""
        if not self._file.closed:
            self._write()
            self._file.close()

    def _write(self) -> None:
        """Write all waiting cycles: in runs between cycles in which other frames pass."""
        first = self._buffer.first
        rows = self._buffer.take(self._buffer.count)
        end = first + len(rows)
        begin = first
        for cycle in sorted(cycle for cycle in self._others if cycle < end or not len(rows)):
            if cycle < first:
                self._file.writelines(self._lines(cycle, self._others[cycle]))
                self._silent.take(self._others.pop(cycle))
                continue
            self._run(rows[begin - first : cycle - first], begin)
            self._mixed(rows[cycle - first :][:1], cycle, self._others.pop(cycle))
            begin = cycle + 1
        self._run(rows[begin - first :], begin)

    def _run(self, rows: Rows, first: int) -> None:
        """Write cycles with nothing but telegrams."""
        if not len(rows):
            return
        self._silent.begin_cycle()
        times = self._times(first, len(rows))
        both = (*self._sending(), *self._command)
        self._file.write(telegram_lines(both, rows, times, self._interface, sync=True).tobytes())

    def _mixed(self, row: Rows, cycle: int, others: Sequence[CanFrame]) -> None:
        """Write one cycle in which other frames pass too."""
        self._silent.begin_cycle()
        self._silent.take(others)
        times = self._times(cycle, 1)
        self._file.write(telegram_lines(self._sending(), row, times, self._interface, sync=True).tobytes())
        self._file.writelines(self._lines(cycle, (frame for frame in others if not from_cnc(frame))))
        self._file.write(telegram_lines(self._command, row, times, self._interface, sync=False).tobytes())
        self._file.writelines(self._lines(cycle, (frame for frame in others if from_cnc(frame))))

    def _sending(self) -> tuple[Telegram, ...]:
        silent = self._silent.now
        return tuple(telegram for telegram in self._actual if telegram.node not in silent)

    def _times(self, first: int, count: int) -> NDArray[np.int64]:
        return self._epoch_ns + np.arange(first, first + count, dtype=np.int64) * self._cycle_ns

    def _lines(self, cycle: int, frames: Iterable[CanFrame]) -> list[bytes]:
        at = self._epoch_ns + cycle * self._cycle_ns
        return [line(frame, at, self._interface) for frame in frames]
