"""Plant, drives and terminals as one node group: what stands on the other end of the bus."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter, is_
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.time import Ns
from hli_bench.laws.machine import advance_machine
from hli_bench.laws.native import bind
from hli_bench.laws.rows import MachineRows, Rows
from hli_bench.laws.stride import exchange_in
from hli_bench.protocols.canopen.device import CONFIGURING
from hli_bench.wire.can import CanFrame
from hli_bench.wire.images import ProcessImage
from hli_bench.wire.signals import Edge

SYNC: Final = CanFrame(0x80)
NOT_KNOWN: Final = -1
FAR: Final = 1 << 40
"""More cycles than any run has."""
_BY_COB_ID: Final = attrgetter("cob_id")


@dataclass(frozen=True, slots=True)
class Forced:
    """From `at_ns` on a signal is held at `level`, whatever its switches do; None lets it go."""

    at_ns: Ns
    signal: str
    level: int | None


class DriveNode(Protocol):
    """What the bench asks of a drive model."""

    @property
    def node_id(self) -> int:
        """CANopen node id."""

    def power_on(self) -> list[CanFrame]:
        """Boot."""

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Take one frame, SYNC included."""

    def hears(self) -> frozenset[int]:
        """Return the identifiers of the frames that it may act on."""

    def tick(self, now: Ns) -> list[CanFrame]:
        """Return what is due by time or event."""

    def next_due(self, now: Ns) -> Ns | None:
        """Return when `tick` has something to do at the latest."""

    def cyclic_signature(self) -> bool:
        """Tell whether numbers may pass between rows without frames."""

    @property
    def statusword(self) -> int:
        """Object 0x6041."""

    def exchange(self, controlword: int, target: int, probe_function: int, now: Ns) -> int:
        """Act at a SYNC as on the standard RPDOs with these numbers, without frames; return the statusword."""


class TerminalNode(Protocol):
    """What the bench asks of a terminal."""

    @property
    def period_ns(self) -> int:
        """Time between refreshes of its image."""

    @property
    def due_ns(self) -> Ns:
        """Instant of the next refresh."""

    def step(self, now_ns: Ns) -> ProcessImage:
        """Return the process image at an instant."""


class MachineSide:
    """Steps everything that is not the CNC.

    `axis` holds the numbers of the telegrams as the CNC has them, `pending` coming changes of signals (bounce).
    """

    def __init__(
        self,
        rows: MachineRows,
        axis: Rows,
        pending: NDArray[np.int64],
        drives: Sequence[DriveNode],
        terminals: Sequence[TerminalNode],
        signals: Sequence[str],
        cycle_ns: int,
        sub_steps: int,
        dc_epoch_ns: int,
        forced: Sequence[Forced] = (),
    ) -> None:
        self.rows = rows
        self._axis = axis
        self.pending = pending
        self.drives = drives
        self.terminals = terminals
        self.cycle_ns = cycle_ns
        self.sub_steps = sub_steps
        self.dc_epoch_ns = dc_epoch_ns
        self.signals = signals
        self._due = NOT_KNOWN
        """Next cycle in which a drive sends by time or a fault begins; what is quiet ends with it."""
        self._ticked = NOT_KNOWN
        self._words = b""
        """Control words of the last exchange: as long as they and the status words stay, nothing new becomes due."""
        self._slow_terminals = [one for one in terminals if one.period_ns > cycle_ns]
        self._channels = b""
        """The channels' rows as of the last images: without a change there the images stay."""
        self._images: Mapping[str, bytes] = {}
        self._heard: list[frozenset[int]] = []
        self._hearing: dict[int, list[DriveNode]] = {}
        """Drives by the identifiers that they may act on: a frame is offered to nobody else."""
        self._listen()
        self._forced = sorted(forced, key=lambda one: one.at_ns)
        self._exchange_in = bind(exchange_in, axis, rows.servo)
        self._advance = bind(
            advance_machine,
            rows.servo,
            rows.switch,
            rows.signal,
            rows.channel,
            rows.edge,
            rows.edges,
            pending,
            cycle_ns,
            sub_steps,
            dc_epoch_ns,
        )

    def power_on(self) -> list[CanFrame]:
        """Boot all nodes: their boot-up messages."""
        return [frame for drive in self.drives for frame in drive.power_on()]

    def advance(self, cycle: int) -> None:
        """Move the machine to the SYNC of `cycle`."""
        begin = Ns((cycle - 1) * self.cycle_ns)
        self._force(begin)
        self._advance(begin)

    def telegrams(self, cycle: int, inbox: Iterable[CanFrame]) -> list[CanFrame]:
        """Hand the drives what the bus carried since the last SYNC, then this SYNC; return what they send."""
        now = Ns(cycle * self.cycle_ns)
        frames: list[CanFrame] = []
        for frame in (*inbox, SYNC):
            for drive in self._hearing.get(frame.cob_id, ()):
                frames += drive.on_frame(frame, now)
            if frame.cob_id in CONFIGURING:
                self._listen()
        for drive in self.drives:
            frames += drive.tick(now)
        self._due, self._ticked, self._words = NOT_KNOWN, cycle, b""
        frames.sort(key=_BY_COB_ID)
        return frames

    def _listen(self) -> None:
        """Find out anew who hears which identifier."""
        heard = [drive.hears() for drive in self.drives]
        if all(map(is_, heard, self._heard)) and self._hearing:
            return
        self._heard = heard
        self._hearing = {}
        for drive, identifiers in zip(self.drives, heard, strict=True):
            for cob_id in sorted(identifiers):
                self._hearing.setdefault(cob_id, []).append(drive)

    def exchange(self, cycle: int) -> None:
        """Pass the standard telegrams of a SYNC in which only control words changed, by numbers."""
        now = Ns(cycle * self.cycle_ns)
        axis = self._axis
        words = axis["controlword"].tobytes()
        self._exchange_in()
        same = words == self._words
        self._words = words
        for drive, row in zip(self.drives, axis, strict=True):
            status = drive.exchange(
                int(row["controlword"]), int(row["target"]), int(row["probe_function"]), now
            )
            same = same and status == row["statusword"]
            row["statusword"] = status
        if not same:
            self._due = NOT_KNOWN

    def timers(self, cycle: int) -> list[CanFrame]:
        """Return what the drives send by time in a cycle without frames (heartbeats).

        Faults that are due begin, terminals whose period is longer than a cycle refresh their image.
        """
        if cycle < self._due:
            return []
        for terminal in self._slow_terminals:
            terminal.step(Ns(cycle * self.cycle_ns))
        if cycle == self._ticked:
            return []
        self._due, self._ticked = NOT_KNOWN, cycle
        now = Ns(cycle * self.cycle_ns)
        self._force(now)
        return sorted((frame for drive in self.drives for frame in drive.tick(now)), key=_BY_COB_ID)

    def quiet(self, cycle: int) -> int:
        """Return for how many cycles from `cycle` on only telegrams pass; `timers` has to be asked in the last."""
        if cycle > self._due:
            if not all(drive.cyclic_signature() for drive in self.drives):
                return 0
            now = Ns((cycle - 1) * self.cycle_ns)
            dues = [at for drive in self.drives if (at := drive.next_due(now)) is not None]
            dues += [fault.at_ns for fault in self._forced[:1]]
            dues += [terminal.due_ns for terminal in self._slow_terminals]
            self._due = max(cycle, min((-(-at // self.cycle_ns) for at in dues), default=cycle + FAR))
        return self._due - cycle + 1

    def _force(self, now: Ns) -> None:
        """Hold the signals whose faults have begun at their level."""
        while self._forced and self._forced[0].at_ns <= now:
            fault = self._forced.pop(0)
            level = -1 if fault.level is None else fault.level
            self.rows.signal[self.signals.index(fault.signal)]["forced"] = level

    def images(self, cycle: int) -> Mapping[str, bytes]:
        """Return the process images at the SYNC of `cycle` by terminal."""
        state = self.rows.channel.tobytes()
        if state != self._channels or self._slow_terminals:
            self._channels = state
            now = Ns(cycle * self.cycle_ns)
            images = [terminal.step(now) for terminal in self.terminals]
            self._images = {image.terminal: image.data for image in images}
        return self._images

    def take_foreign(self) -> list[CanFrame]:
        """Return nothing: in this process nobody else is on the bus."""
        return []

    def take_edges(self) -> list[Edge]:
        """Return the edges of all signals since the last call, in order."""
        count = int(self.rows.edges[0])
        if not count:
            return []
        self.rows.edges[0] = 0
        taken: Any = self.rows.edge[:count]
        return [
            Edge(self.signals[int(row["signal"])], Ns(int(row["at_ns"])), bool(row["level"])) for row in taken
        ]
