"""What a report and tests want to see of a run, in memory of bounded size.

Axis curves get coarser as the run gets longer: each sample keeps least and greatest values of its cycles, so that
short events stay visible. Around each measured value a window stays at full resolution.
"""

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.time import NS_PER_MS, NS_PER_US, Ns
from hli_bench.base.units import TENTH_UM_PER_MM
from hli_bench.kernel.cycle import Kernel
from hli_bench.kernel.records import Emitted, MeasuredValue
from hli_bench.laws.rows import LOG_CYCLES, Rows
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.frames import CycleBuffer
from hli_bench.terminals.settings import TerminalSettings
from hli_bench.terminals.terminal import type_of
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge

SAMPLES: Final = 20_000
"""Samples of a curve; one more halves their number (decided here)."""
CONDENSE: Final = 128
"""Cycles that wait to become samples, at least: many together are quicker, a few hold no paced cycle (decided here)."""
EVENTS: Final = 20_000
"""Edges, writes and records that are kept, the newest of each (decided here)."""
WINDOWS: Final = 64
"""Windows that are kept, the newest (decided here)."""
LOOKS: Final = 2
"""How often the states of units are looked at after a write; the CNC answers in the next cycle."""
BEFORE_NS: Final = 50 * NS_PER_MS
AFTER_NS: Final = 20 * NS_PER_MS

_SAMPLE: Final = np.dtype(
    [
        ("command_low", "f8"),
        ("command_high", "f8"),
        ("actual_low", "f8"),
        ("actual_high", "f8"),
        ("lag_low", "f8"),
        ("lag_high", "f8"),
    ]
)


@dataclass(frozen=True, slots=True)
class InputTap:
    """A terminal input to be shown: it shows `signal` after `delay_ns`, refreshed every `period_ns`."""

    name: str
    signal: str
    delay_ns: int
    period_ns: int


def input_taps(terminals: Iterable[TerminalSettings]) -> tuple[InputTap, ...]:
    """Return the connected inputs of a machine's terminals."""
    return tuple(
        InputTap(
            f"{settings.model} {settings.name}/ch{number}",
            channel.signal,
            channel.delay_ns,
            settings.period_us * NS_PER_US,
        )
        for settings in terminals
        for number, channel in enumerate(type_of(settings).channels(settings), 1)
        if channel.signal
    )


@dataclass(frozen=True, slots=True)
class AxisInfo:
    """One axis: `kind` is T (linear, mm), R or S (degrees)."""

    name: str
    number: int
    kind: str

    @property
    def unit(self) -> str:
        """Unit of its positions."""
        return "mm" if self.kind == "T" else "°"


@dataclass(frozen=True, slots=True)
class Curve:
    """Samples of one axis in mm (degrees): `at_ns` is the first cycle of each; lows and highs span its cycles.

    It begins with the first telegram of the drive: before that nobody knows where the axis stands.
    """

    at_ns: NDArray[np.int64]
    command_low: NDArray[np.float64]
    command_high: NDArray[np.float64]
    actual_low: NDArray[np.float64]
    actual_high: NDArray[np.float64]
    lag_low: NDArray[np.float64]
    lag_high: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class HliChange:
    """An element of the HLI has a new value: written by a PLC in its cycle, or shown by the CNC in its own."""

    at_ns: Ns
    path: str
    value: int


@dataclass(slots=True)
class Window:
    """Full resolution around a measured value: `rows` are log rows from cycle `first` on; `emitted_ns` its cycle."""

    value: MeasuredValue
    emitted_ns: Ns
    first: int
    rows: Rows
    last: int


_Piece = tuple[NDArray[np.int64], Rows]
"""Consecutive samples: the first cycle of each, and their values."""


@dataclass(slots=True)
class _Samples:
    """Curves of all axes, a sample every `interval` cycles: a power of two that grows with the run.

    When it grows the samples so far are `stale`; they are made coarser a piece at a time, as cycles come, because a
    paced bench has no time for all of them at once.
    """

    axes: int
    limit: int
    interval: int = 1
    first: int = 0
    old: list[_Piece] = field(default_factory=list)
    stale: deque[_Piece] = field(default_factory=deque)
    new: list[_Piece] = field(default_factory=list)

    def add(self, first: int, rows: Rows) -> None:
        """Take cycles."""
        samples: Any = np.empty(rows.shape, _SAMPLE)
        for name in ("command", "actual", "lag"):
            samples[f"{name}_low"] = samples[f"{name}_high"] = rows[name]
        unknown = rows["statusword"] == 0
        if unknown.any():
            for name in _SAMPLE.names or ():
                samples[name][unknown] = np.nan
        self.first = self.first or first
        while (first + len(rows) - 1) // self.interval - self.first // self.interval >= self.limit:
            self.interval *= 2
            self.stale = deque((*self.old, *self.stale, *self.new))
            self.old, self.new = [], []
        self._join(self.new, (np.arange(first, first + len(rows), dtype=np.int64), samples))
        if self.stale:
            self._join(self.old, self.stale.popleft())

    def take(self) -> _Piece:
        """Return cycle numbers and samples."""
        nothing = (np.empty(0, np.int64), np.empty((0, self.axes), _SAMPLE))
        return self._merged([nothing, *self.old, *self.stale, *self.new])

    def _join(self, pieces: list[_Piece], piece: _Piece) -> None:
        """Put a piece behind others, together with the last one when that is small."""
        small = pieces and len(pieces[-1][0]) < CONDENSE
        pieces.append(self._merged([pieces.pop(), piece] if small else [piece]))

    def _merged(self, pieces: Sequence[_Piece]) -> _Piece:
        """Return pieces as one with a sample every `interval` cycles."""
        cycles, samples = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
        if self.interval == 1:
            return cycles, samples
        starts = np.flatnonzero(np.diff(cycles // self.interval, prepend=-1))
        merged: Any = np.empty((len(starts), self.axes), _SAMPLE)
        for name in _SAMPLE.names or ():
            extreme = np.fmin if name.endswith("_low") else np.fmax
            merged[name] = extreme.reduceat(samples[name], starts)
        return cycles[starts], merged


class Recording:
    """Observer for reports and tests. Times are bench time; `inputs` and `plcs` (period in ns) are shown along."""

    def __init__(
        self,
        kernel: Kernel,
        inputs: Sequence[InputTap] = (),
        plcs: Mapping[str, int] | None = None,
        samples: int = SAMPLES,
    ) -> None:
        setup = kernel.setup
        self.cycle_ns = setup.cycle_ns
        self.dc_epoch_ns = setup.dc_epoch_ns
        self.axes = tuple(AxisInfo(axis.name, axis.number, axis.kind) for axis in setup.axes)
        self.inputs = tuple(inputs)
        self.plcs = dict(plcs or {})
        self.edges_seen: deque[Edge] = deque(maxlen=EVENTS)
        self.hli: deque[HliChange] = deque(maxlen=EVENTS)
        self.records: deque[tuple[Ns, Emitted]] = deque(maxlen=EVENTS)
        self.refusals: deque[tuple[Ns, Refusal]] = deque(maxlen=EVENTS)
        self.windows: deque[Window] = deque(maxlen=WINDOWS)
        self.first = 0
        self.last = 0
        self._image = kernel.image
        self._log = kernel.rows.log
        self._buffer = CycleBuffer(self._log)
        self._samples = _Samples(len(self.axes), samples)
        self._open: list[Window] = []
        self._looks = 0
        self._states: dict[str, int] = {}
        self._shown: dict[str, int] = {}

    def cycles(self, first: int, count: int) -> None:
        """Take cycles of the log ring, and what the CNC answered on the HLI in them."""
        self.first = self.first or first
        self.last = first + count - 1
        self._buffer.add(first, count)
        if self._buffer.count >= CONDENSE:
            self._condense()
        for window in self._open:
            rows = self._cycles(window.first + len(window.rows), min(self.last, window.last))
            window.rows = np.concatenate((window.rows, rows))
        if self._open:
            self._open = [window for window in self._open if window.last > self.last]
        if self._looks:
            self._look()

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        """Frames are not kept."""

    def edges(self, edges: Sequence[Edge]) -> None:
        """Take edges of signals."""
        self.edges_seen.extend(edges)

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        """Take what the kernel emitted; a measured value opens a window."""
        at_ns = Ns(cycle * self.cycle_ns)
        for record in records:
            self.records.append((at_ns, record))
            if isinstance(record, MeasuredValue):
                self._open_window(cycle, record)

    def commands(self, commands: Commands) -> None:
        """Take what a PLC wrote; the CNC's answer is looked for after the next cycles."""
        self._looks = LOOKS
        at_ns = Ns(commands.cycle * self.cycle_ns)
        for write in commands.writes:
            self.hli.append(HliChange(at_ns, write.path, int(write.value)))
            group = write.path.rpartition("/")[0]
            if group not in self._states and group in self._image.layout.groups:
                elements = self._image.layout.groups[group].elements
                state = next((element for element in elements if element.member == "state_r"), None)
                if state is not None:
                    self._states[group] = state.id
                    self._shown[group] = int(self._image.get(state.id))

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        """Take writes that were refused."""
        self.refusals.extend((Ns(cycle * self.cycle_ns), refusal) for refusal in refusals)

    def overran(self, cycle: int, plc: str) -> None:
        """The result counts them."""

    def curve(self, axis: str) -> Curve:
        """Return the samples of an axis. Raises KeyError for an axis that the machine has not."""
        self._condense()
        index = {info.name: number for number, info in enumerate(self.axes)}[axis]
        numbers, values = self._samples.take()
        known = ~np.isnan(values["actual_low"][:, index])
        mm = {name: values[name][known, index] / TENTH_UM_PER_MM for name in _SAMPLE.names or ()}
        return Curve(at_ns=numbers[known] * self.cycle_ns, **mm)

    def level(self, signal: str, at_ns: int) -> bool:
        """Return the level of a signal at an instant; in front of its first edge, the other level than after."""
        level: bool | None = None
        for edge in self.edges_seen:
            if edge.signal != signal:
                continue
            if edge.at_ns > at_ns:
                return not edge.level if level is None else level
            level = edge.level
        return bool(level)

    def _condense(self) -> None:
        first = self._buffer.first
        rows = self._buffer.take(self._buffer.count)
        if len(rows):
            self._samples.add(first, rows)

    def _look(self) -> None:
        """Note the state of every unit that a PLC has written to, when it changed."""
        self._looks -= 1
        for group, element in self._states.items():
            value = int(self._image.get(element))
            if value != self._shown[group]:
                self._shown[group] = value
                self.hli.append(HliChange(Ns(self.last * self.cycle_ns), f"{group}/state_r", value))

    def _open_window(self, cycle: int, value: MeasuredValue) -> None:
        """Open a window: the cycles before `cycle` stand in the ring, it and the next ones are still to come."""
        latched = (value.dc_ns - self.dc_epoch_ns) // self.cycle_ns
        wanted = min(latched, cycle) - BEFORE_NS // self.cycle_ns
        first = max(wanted, cycle - LOG_CYCLES + 1, self.first or cycle)
        rows = self._cycles(first, cycle - 1)
        last = cycle + AFTER_NS // self.cycle_ns
        window = Window(value, Ns(cycle * self.cycle_ns), first, rows, last)
        self.windows.append(window)
        self._open.append(window)

    def _cycles(self, first: int, last: int) -> Rows:
        """Return a copy of cycles that stand in the ring."""
        taken: Rows = self._log[np.arange(first, last + 1) % LOG_CYCLES]
        return taken
