"""The loop that steps the bench: quiet cycles in one call, the others one by one.

A cycle in which only the standard telegrams pass needs no frames: the compiled stride exchanges their numbers, and
one in which control words change passes numbers too. Every other cycle hands real frames to the drives and takes real
frames from them. All give the same bits.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, Protocol

from hli_bench.base.errors import BenchError
from hli_bench.base.time import Ns
from hli_bench.kernel.cycle import Kernel
from hli_bench.kernel.records import Emitted
from hli_bench.laws import stride as law
from hli_bench.laws.native import bind
from hli_bench.laws.rows import LOG_CYCLES, MachineRows, Rows
from hli_bench.protocols.canopen.sync import SYNC_COB_ID
from hli_bench.protocols.hli.access import Access, Refusal
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge


class Link(Protocol):
    """How the CNC reaches the machine: in this process by rows, or over a bus."""

    rows: MachineRows
    sub_steps: int

    def power_on(self) -> list[CanFrame]:
        """Boot all nodes."""

    def advance(self, cycle: int) -> None:
        """Move the machine to the SYNC of `cycle`."""

    def telegrams(self, cycle: int, inbox: Sequence[CanFrame]) -> list[CanFrame]:
        """Exchange the frames of a SYNC."""

    def exchange(self, cycle: int) -> None:
        """Exchange the numbers of a SYNC in which only control words changed."""

    def timers(self, cycle: int) -> list[CanFrame]:
        """Return what the drives send by time in a quiet cycle."""

    def quiet(self, cycle: int) -> int:
        """Return how many cycles may be strided over, or passed by `exchange`."""

    def images(self, cycle: int) -> Mapping[str, bytes]:
        """Return the process images by terminal."""

    def take_edges(self) -> list[Edge]:
        """Return the edges of all signals since the last call."""

    def take_foreign(self) -> list[CanFrame]:
        """Return what others sent on the bus since the last call."""


class PlcPort(Protocol):
    """An attached PLC task, in this process or another."""

    name: str
    period_cycles: int

    @property
    def figures(self) -> Mapping[str, object]:
        """How it keeps its period: runs, overruns, times; in lock-step nothing, as time waits for it."""

    def tick(self, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]) -> Commands | None:
        """Run once on the images of `cycle`; None when there is no answer (the PLC is gone)."""


class Listener(Protocol):
    """Whoever wants to hear what the kernel emits and which writes were refused."""

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        """The kernel emitted something."""

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        """Writes were refused."""


class Observer(Listener, Protocol):
    """Whoever records: is also told what happened, cycle by cycle or in blocks."""

    def cycles(self, first: int, count: int) -> None:
        """Cycles `first` .. `first + count - 1` stand in the kernel's log ring."""

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        """Frames of a cycle beside its telegrams."""

    def edges(self, edges: Sequence[Edge]) -> None:
        """Signals changed."""

    def commands(self, commands: Commands) -> None:
        """A PLC wrote."""

    def overran(self, cycle: int, plc: str) -> None:
        """A PLC that was due in a cycle has not kept its period."""


NO_TICK: Final = 1 << 62
FRAMES: Final = 0
"""No stretch: real frames pass in the next cycle."""
WORDS: Final = -1
"""No stretch: control words change in the next cycle, nothing else."""


class Engine:
    """Owns the cycle count. `cycle` is the last completed cycle."""

    def __init__(self, kernel: Kernel, link: Link, pending: Rows) -> None:
        self.kernel = kernel
        self.link = link
        self.cycle = 0
        self.access = Access(kernel.image)
        self.plcs: list[PlcPort] = []
        self.observers: list[Observer] = []
        self.listeners: list[Listener] = []
        self.lost: list[PlcPort] = []
        self.foreign_syncs = 0
        """SYNC frames that were not the CNC's: the drives do not act on them."""
        self._orders: list[CanFrame] = []
        self._foreign: list[CanFrame] = []
        self._decide = True
        self._cycle_ns = kernel.setup.cycle_ns
        self._tick = NO_TICK
        self._loud = 0
        """First cycle of which it is not known that only telegrams pass."""
        self._words: bytes = b""
        self._new_words = True
        machine, rows = link.rows, kernel.rows
        self._law = bind(
            law.stride,
            rows.axis,
            rows.path,
            rows.segment,
            rows.leg,
            rows.watch,
            rows.history,
            rows.log,
            machine.servo,
            machine.switch,
            machine.signal,
            machine.channel,
            machine.edge,
            machine.edges,
            pending,
            *kernel.shown,
            self._cycle_ns,
            link.sub_steps,
            kernel.setup.dc_epoch_ns,
        )

    @property
    def frames_wait(self) -> bool:
        """Frames beside the telegrams are to pass with the next SYNC."""
        return bool(self._orders or self._foreign)

    @property
    def dc_ns(self) -> Ns:
        """DC time of the last completed cycle."""
        return Ns(self.kernel.setup.dc_epoch_ns + self.cycle * self._cycle_ns)

    def power_on(self) -> None:
        """Boot the drives and begin the start-up of the kernel."""
        frames = self.link.power_on()
        self.kernel.drives.take(frames)
        self._tell_frames(0, frames)
        self.kernel.drives.begin_start_up()

    def step(self, limit: int) -> None:
        """Run a stretch: to the next decision, PLC tick or `limit`, whichever comes first."""
        first = self.cycle + 1
        room = self._stretch(first, limit)
        if room > 0:
            done, where = self._stride(first, room, law.MACHINE)
        else:
            self.link.advance(first)
            done, where = 0, law.SENSE
        cycle = first + done
        if where == law.SENSE:
            if room == WORDS:
                self._exchange(cycle)
            else:
                self._telegrams(cycle)
            _, where = self._stride(cycle, 1, law.SENSE)
            if where == law.MACHINE:
                done += 1
        if where == law.ACT:
            done += 1
            self._timers(cycle)
            try:
                self._think(cycle)
            finally:
                # what the machine has lived through is finished, whatever was wrong with the program
                self._stride(cycle, 1, law.ACT)
                self._complete(first, done)
        else:
            self._complete(first, done)

    def wake(self) -> None:
        """Let the kernel decide in the next cycle: something has been put from outside."""
        self._decide = True

    def put(self, frames: Iterable[CanFrame]) -> None:
        """Let frames of somebody else pass on the bus with the next SYNC."""
        given = list(frames)
        self._note_foreign(self.cycle, given)
        self._foreign += [frame for frame in given if frame.cob_id != SYNC_COB_ID]

    def apply(self, commands: Commands) -> list[Refusal]:
        """Let writes from outside count from the next cycle on; return those that were refused."""
        refusals = self.access.apply(commands)
        if commands.plc or not refusals:
            for observer in self.observers:
                observer.commands(commands)
        self._decide = True
        return self.refuse(refusals)

    def overran(self, plc: str, cycle: int) -> None:
        """Tell the observers that a PLC has not kept its period."""
        for observer in self.observers:
            observer.overran(cycle, plc)

    def refuse(self, refusals: list[Refusal]) -> list[Refusal]:
        """Tell all who listen of writes that were refused; return them."""
        if refusals:
            for listener in (*self.observers, *self.listeners):
                listener.refused(self.cycle, refusals)
        return refusals

    def attach(self, plc: PlcPort) -> None:
        """Let a PLC take part from the next cycle on that its period divides."""
        self.plcs.append(plc)
        self._tick = self._next_tick()

    def _stretch(self, first: int, limit: int) -> int:
        """Return how many cycles from `first` on may be strided over; WORDS or FRAMES when not even one may."""
        if self.frames_wait:
            return FRAMES
        if self._new_words:
            return WORDS if self.link.quiet(first) > 0 else FRAMES
        if first >= self._loud:
            self._loud = first + self.link.quiet(first)
            if first >= self._loud:
                return FRAMES
        last = min(self._tick, limit)
        if last >= self._loud:
            last = self._loud - 1
        if last == first:
            return 1
        return min(last - self.cycle, LOG_CYCLES)

    def _next_tick(self) -> int:
        """Return the next cycle in which a PLC task is due."""
        return min(
            ((self.cycle // plc.period_cycles + 1) * plc.period_cycles for plc in self.plcs), default=NO_TICK
        )

    def _word_bytes(self) -> bytes:
        """Control and latch control words as sent: a cycle in which they change is not quiet."""
        axis = self.kernel.rows.axis
        words: bytes = axis["controlword"].tobytes() + axis["probe_function"].tobytes()
        return words

    def _exchange(self, cycle: int) -> None:
        """Pass the telegrams of a cycle in which a control word changes, by numbers."""
        self._words, self._new_words, self._loud = self._word_bytes(), False, 0
        self.link.exchange(cycle)

    def _timers(self, cycle: int) -> None:
        """Take what the drives send by time in a quiet cycle."""
        frames = self.link.timers(cycle)
        if frames:
            self._loud = 0
            self._tell_frames(cycle, frames)
            self.kernel.begin_cycle(cycle)
            if self.kernel.drives.take(frames):
                self._decide = True

    def _telegrams(self, cycle: int) -> None:
        """Pass real frames at the SYNC of a cycle."""
        self._words, self._new_words, self._loud = self._word_bytes(), False, 0
        orders, self._orders = self._orders, []
        foreign, self._foreign = self._foreign, []
        self.kernel.begin_cycle(cycle)
        frames = self.link.telegrams(cycle, [*foreign, *self.kernel.drives.cyclic_frames(), *orders])
        self._note_foreign(cycle - 1, self.link.take_foreign())
        ids = self.kernel.drives.telegram_ids
        self._tell_frames(cycle, [frame for frame in frames if frame.cob_id not in ids])
        if self.kernel.drives.take_telegrams(frames):
            self._decide = True

    def _stride(self, cycle: int, cycles: int, phase: int) -> tuple[int, int]:
        stop, self._decide = (self._decide, False) if phase != law.ACT else (False, self._decide)
        done, where = divmod(self._law(cycle, cycles, phase, stop, bool(self.observers)), law.PLACES)
        if stop and where == law.SENSE:
            self._decide = True
        return done, where

    def _think(self, cycle: int) -> None:
        """Let the kernel decide between sense and act."""
        self.kernel.begin_cycle(cycle)
        try:
            self.kernel.decide()
        finally:
            self._hand_out(cycle)

    def hand_out(self) -> None:
        """Tell at once what the kernel would tell in its next cycle: another program may begin with that."""
        self._hand_out(self.cycle)

    def _hand_out(self, cycle: int) -> None:
        """Take what the kernel has to say: frames to be sent, records."""
        self._new_words = self._word_bytes() != self._words
        orders = self.kernel.take_orders()
        self._orders += orders
        self._tell_frames(cycle, orders)
        emitted = self.kernel.take_emitted()
        if emitted:
            for listener in (*self.observers, *self.listeners):
                listener.emitted(cycle, emitted)

    def _complete(self, first: int, count: int) -> None:
        """Cycles are done: tell the observers, run the PLC tasks that are due."""
        self.cycle = first + count - 1
        self._timers(self.cycle)
        edges = self.link.take_edges()
        for observer in self.observers:
            observer.cycles(first, count)
            if edges:
                observer.edges(edges)
        if self.cycle >= self._tick:
            self._run_plcs()

    def _run_plcs(self) -> None:
        """Run the tasks that are due: all of them see the same images."""
        cycle = self.cycle
        due = [plc for plc in self.plcs if cycle % plc.period_cycles == 0]
        self._tick = self._next_tick() if len(self.plcs) > 1 or not due else cycle + due[0].period_cycles
        io = self.link.images(cycle)
        dc_ns = self.dc_ns
        image = self.kernel.image.data
        answers: list[tuple[PlcPort, Commands | None]] = []
        try:
            for plc in due:
                answers.append((plc, self._run_plc(plc, cycle, dc_ns, image, io)))  # noqa: PERF401 - kept when one fails
        finally:
            # Those who have answered never say it again, whatever became of one after them.
            for plc, commands in answers:
                if commands is None:
                    self.lose(plc.name)
                elif commands.writes:
                    self.apply(commands)

    def _run_plc(
        self, plc: PlcPort, cycle: int, dc_ns: Ns, image: bytearray, io: Mapping[str, bytes]
    ) -> Commands | None:
        """Run one task; one whose script fails takes part no more."""
        try:
            return plc.tick(cycle, dc_ns, image, io)
        except BenchError:
            self.lose(plc.name)
            raise

    def lose(self, name: str) -> None:
        """A PLC has gone: its units fall back, the CNC reacts as to a PLC stop."""
        lost = [plc for plc in self.plcs if plc.name == name]
        if not lost:
            return
        self.plcs = [plc for plc in self.plcs if plc.name != name]
        self._tick = self._next_tick()
        self.lost += lost
        self.access.leave(name)
        self.kernel.plc_lost(name)
        self._decide = True

    def _note_foreign(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        """Record what others sent behind the SYNC of a cycle."""
        if frames:
            self.foreign_syncs += sum(frame.cob_id == SYNC_COB_ID for frame in frames)
            self._tell_frames(cycle, frames)

    def _tell_frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        if frames:
            for observer in self.observers:
                observer.frames(cycle, frames)
