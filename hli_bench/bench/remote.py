"""The machine in processes of its own: drives with the plant, and terminals; the kernel is in this one."""

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Final, Self

import numpy as np

from hli_bench.base.errors import EnvironmentLacks, InputError, NotEmulated
from hli_bench.bench import telegraph
from hli_bench.bench.config import MachineConfig
from hli_bench.bench.telegraph import Numbers, Order, Reply
from hli_bench.kernel.cycle import Kernel
from hli_bench.laws.rows import MachineRows, Rows
from hli_bench.plant.build import signal_names
from hli_bench.runtime.engine import FRAMES, WORDS, Engine
from hli_bench.runtime.machine_side import SYNC
from hli_bench.shells.can_bus import CanBus
from hli_bench.shells.processes import Worker
from hli_bench.terminals.terminal import type_of
from hli_bench.wire.can import CanFrame
from hli_bench.wire.images import TerminalLayout
from hli_bench.wire.signals import Edge

REALTIME: Final = "realtime"
UNASKED: Final = 100
"""Cycles for which terminals that stay as they are are not asked; then they are, to see that their process lives."""
_DRIVES: Final = "hli_bench.bench.drives_process"
_TERMINALS: Final = "hli_bench.bench.terminals_process"


def can_interface(can: str) -> str:
    """Return the interface of `socketcan:vcan0`, "" for `inproc`. Raises InputError, NotEmulated for others."""
    kind, _, place = can.partition(":")
    if can == "inproc":
        return ""
    if kind == "socketcan" and place:
        return place
    if kind == "socketcand":
        raise NotEmulated("--can socketcand: the bench does not serve the socketcand protocol yet")
    raise InputError(f"--can {can}: inproc, socketcan:INTERFACE or socketcand:HOST:PORT expected")


class RemoteEngine(Engine):
    """Steps a machine in other processes: cycle by cycle, by numbers while no frames are needed."""

    def __init__(self, kernel: Kernel, machine: "RemoteMachine") -> None:
        super().__init__(kernel, machine, machine.pending)
        self._machine = machine

    def _stretch(self, first: int, limit: int) -> int:
        """Return that numbers or frames pass in the next cycle; no cycle is strided over."""
        if self._machine.ahead is not None:
            return WORDS
        return FRAMES if self.frames_wait or not self._machine.quiet(first) else WORDS

    def _exchange(self, cycle: int) -> None:
        """Pass numbers; frames after all when a drive has raised a fault."""
        if self._new_words and self._machine.ahead is None:
            super()._exchange(cycle)
        elif not self._machine.numbers(Order.NUMBERS, cycle):
            self._telegrams(cycle)

    def _complete(self, first: int, count: int) -> None:
        """Complete a cycle; when no more than targets pass in the next one, they are sent at once."""
        super()._complete(first, count)
        if not self.frames_wait and not self._new_words and self._machine.quiet(self.cycle + 1):
            self._machine.send_ahead(self.cycle + 1)


class RemoteMachine:
    """How the kernel's process reaches the others: one round trip to the drives in every cycle.

    What is sent ahead is answered while the kernel waits for its next cycle, and counts in that cycle. The terminals
    are asked when there is an edge; their answer is taken when somebody looks at the images, at the latest before they
    are asked again.
    """

    def __init__(
        self,
        config: MachineConfig,
        machine: str | Path,
        settings: Mapping[str, object],
        can: str,
        axis: Rows,
        *,
        realtime: bool = False,
    ) -> None:
        """Start the processes; the numbers of telegrams come from and go into `axis`, the kernel's rows."""
        interface = can_interface(can)
        given = [str(machine), json.dumps(dict(settings))]
        with ExitStack() as stack:
            self._bus = CanBus(interface) if interface else None
            if self._bus is not None:
                stack.callback(self._bus.close)
            self._drives = Worker(_DRIVES, [*given, interface, REALTIME if realtime else ""])
            stack.callback(self._drives.close)
            self._terminals = Worker(_TERMINALS, given)
            stack.callback(self._terminals.close)
            # All there: from here on `__exit__` ends what the stack holds.
            self._closing = stack.pop_all()
        self.on_silence: Callable[[], None] = lambda: None
        """Called while a process does not answer."""
        for worker in (self._drives, self._terminals):
            worker.on_silence = self._silence
        self._signals = signal_names([axis.name for axis in config.axes])
        self._edges: list[Edge] = []
        self._images: dict[str, bytes] = {}
        self._asked: int | None = None
        """The cycle for which the terminals owe an answer."""
        self._ask_again = 0
        """Cycle from which on the terminals are to be asked also if there is no edge."""
        self.ahead: int | None = None
        """The cycle whose numbers have been sent ahead."""
        self._quiet = False
        self._numbers = Numbers(axis)
        self._due: list[CanFrame] = []
        self._foreign: list[CanFrame] = []
        self.terminal_layouts: Sequence[TerminalLayout] = [
            type_of(settings).layout(settings) for settings in config.terminals
        ]
        self.rows = MachineRows.allocate(len(config.axes), 0, len(self._signals), 0)
        self.pending = np.full((1, 3), -1, np.int64)
        self.sub_steps = config.sub_steps

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.close()

    def _silence(self) -> None:
        self.on_silence()

    @property
    def processes(self) -> dict[str, str]:
        """What a look at the processes shows: running, stopped, silent for some time, or ended."""
        return {"drives": self._drives.condition, "terminals": self._terminals.condition}

    def power_on(self) -> list[CanFrame]:
        """Boot all nodes."""
        answer = self._drives.ask(telegraph.order(Order.POWER_ON, 0))
        return self._frames(telegraph.read_reply(answer), 0)

    def advance(self, cycle: int) -> None:
        """Nothing: the machine moves on by itself, or when it gets its SYNC."""

    def telegrams(self, cycle: int, inbox: Sequence[CanFrame]) -> list[CanFrame]:
        """Send the frames and SYNC, return what the drives sent at it."""
        body = telegraph.frames(inbox)
        if self._bus is not None:
            # What stands there before the drives were asked came from others, who must not fill the queue.
            self._bus.clear()
            for frame in (*inbox, SYNC):
                self._bus.send(frame)
        answer = self._drives.ask(telegraph.order(Order.CYCLE, cycle, body))
        return self._frames(telegraph.read_reply(answer), cycle)

    def exchange(self, cycle: int) -> None:
        """Pass the telegrams of a SYNC in which only control words changed, by numbers."""
        self.numbers(Order.WORDS, cycle)

    def numbers(self, kind: Order, cycle: int) -> bool:
        """Pass the telegrams of a SYNC by numbers; False: a drive has a fault, frames have to pass."""
        if self.ahead is None:
            self._drives.tell(telegraph.order(kind, cycle, self._numbers.command()))
        self.ahead = None
        answer = self._drives.answer()
        reply = telegraph.read_reply(answer)
        if reply.state == telegraph.FAULT:
            return False
        self._numbers.take_actual(reply.numbers)
        self._take(reply, cycle)
        return True

    def send_ahead(self, cycle: int) -> None:
        """Send the targets for the next SYNC."""
        self.ahead = cycle
        self._drives.tell(telegraph.order(Order.NUMBERS, cycle, self._numbers.command()))

    def timers(self, cycle: int) -> list[CanFrame]:
        """Return what the drives sent by time in this cycle."""
        if not self._due:
            return self._due
        due, self._due = self._due, []
        return due

    def quiet(self, cycle: int) -> int:
        """Return 1 when the next cycle needs no frames."""
        return int(self._quiet)

    def images(self, cycle: int) -> Mapping[str, bytes]:
        """Return the process images by terminal."""
        if self._asked is not None and self._asked <= cycle:
            self._take_images()
        return self._images

    def take_foreign(self) -> list[CanFrame]:
        """Return what others have sent on the bus since the last call."""
        foreign, self._foreign = self._foreign, []
        return foreign

    def take_edges(self) -> list[Edge]:
        """Return the edges of all signals since the last call."""
        edges, self._edges = self._edges, []
        return edges

    def _frames(self, answer: Reply, cycle: int) -> list[CanFrame]:
        """Take the drives' answer; over a bus the frames themselves come from there."""
        self._take(answer, cycle)
        announced = telegraph.read_frames(answer.frames)
        return announced if self._bus is None else self._from_bus(announced)

    def _take(self, answer: Reply, cycle: int) -> None:
        """Take the rest of the drives' answer."""
        self._quiet = answer.state == telegraph.QUIET
        if answer.due:
            self._due += telegraph.read_frames(answer.due)
        if answer.foreign:
            self._foreign += telegraph.read_frames(answer.foreign)
        if answer.edges:
            self._edges += telegraph.read_edges(answer.edges, self._signals)
        self._tell_terminals(cycle, answer.edges)

    def _tell_terminals(self, cycle: int, edges: bytes) -> None:
        """Tell the terminals the edges of a cycle; they work while the kernel does something else."""
        self._take_images()
        if edges or cycle >= self._ask_again:
            self._asked = cycle
            self._terminals.tell(telegraph.order(Order.CYCLE, cycle, edges))

    def _from_bus(self, announced: Sequence[CanFrame]) -> list[CanFrame]:
        """Receive what the drives have announced; frames of other nodes on the bus are not for the CNC."""
        assert self._bus is not None
        open_frames = Counter(announced)
        found: list[CanFrame] = []
        while open_frames.total():
            frame = self._bus.receive()
            if frame is None:
                missing = ", ".join(f"{one.cob_id:03X}" for one in open_frames.elements())
                raise EnvironmentLacks(f"frames were lost on the CAN bus: {missing}")
            if open_frames[frame]:
                open_frames[frame] -= 1
                found.append(frame)
        return sorted(found, key=lambda frame: frame.cob_id)

    def _take_images(self) -> None:
        """Take the answer that the terminals owe."""
        if self._asked is None:
            return
        asked, self._asked = self._asked, None
        settled, *images = telegraph.read_parts(self._terminals.answer())
        self._ask_again = asked + UNASKED if settled == telegraph.SETTLED else 0
        self._images = {
            layout.name: image for layout, image in zip(self.terminal_layouts, images, strict=True)
        }
