"""Drives and plant as a process of their own: `python -m hli_bench.bench.drives_process`.

Arguments: descriptor of its pipe, machine, settings, CAN interface (empty: none), `realtime` or nothing.
Over the pipe it gets one order a cycle, and over the pipe go the telegrams: as numbers while they are all that passes,
else as frames. Over a CAN interface frames pass in every cycle, and SYNC is what lets the machine move on.
"""

import json
import sys
from collections import Counter
from collections.abc import Sequence

import numpy as np

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.bench import build, telegraph
from hli_bench.bench.folder import load
from hli_bench.bench.telegraph import Numbers, Order, Reply
from hli_bench.laws.native import bind
from hli_bench.laws.rows import AXIS, Rows
from hli_bench.laws.stride import exchange_in, exchange_out
from hli_bench.runtime.machine_side import SYNC, MachineSide
from hli_bench.shells.can_bus import CanBus
from hli_bench.shells.pipe import Pipe
from hli_bench.shells.processes import work
from hli_bench.shells.realtime import ask, settle
from hli_bench.wire.can import CanFrame


class Drives:
    """Serves the kernel's process."""

    def __init__(self, side: MachineSide, axis: Rows, pipe: Pipe, bus: CanBus | None) -> None:
        self._side = side
        self._pipe = pipe
        self._bus = bus
        self._numbers = Numbers(axis)
        self._exchange_in = bind(exchange_in, axis, side.rows.servo)
        self._exchange_out = bind(exchange_out, axis, side.rows.servo)
        self._moved = 0
        """The cycle to whose SYNC the machine has moved."""
        self._raised = False
        self._foreign: list[CanFrame] = []
        """What others have sent since the last answer."""

    def run(self) -> None:
        """Work until the kernel's process closes the pipe."""
        while True:
            try:
                message = self._pipe.receive()
            except EOFError:
                return
            kind, cycle, body = telegraph.read_order(message)
            if kind is Order.POWER_ON:
                self._answer(cycle, self._side.power_on())
                continue
            if kind is Order.CYCLE:
                inbox = telegraph.read_frames(body)
                if self._bus is not None:
                    inbox = self._from_bus(inbox)
                self._advance(cycle)
                self._answer(cycle, self._side.telegrams(cycle, inbox))
            elif self._exchange(kind, cycle, body):
                self._answer(cycle, numbers=self._numbers.actual())
            else:
                self._pipe.send(telegraph.reply(Reply(telegraph.FAULT)))
                continue
            if self._bus is None:
                # The targets for the next cycle are known since the last SYNC: move on while the kernel works.
                self._advance(cycle + 1)

    def _advance(self, cycle: int) -> None:
        """Move the machine to a SYNC, once."""
        if cycle == self._moved:
            return
        self._moved = cycle
        fault = self._side.rows.servo["fault"]
        before = fault.tobytes()
        self._side.advance(cycle)
        self._raised = fault.tobytes() != before

    def _exchange(self, kind: Order, cycle: int, body: bytes) -> bool:
        """Pass numbers at a SYNC; as within a stride a new fault needs frames, unless words change anyway."""
        self._advance(cycle)
        if self._raised and kind is Order.NUMBERS:
            return False
        self._numbers.take_command(body)
        if kind is Order.WORDS:
            self._side.exchange(cycle)
        else:
            self._exchange_in()
            self._exchange_out()
        return True

    def _from_bus(self, announced: Sequence[CanFrame]) -> list[CanFrame]:
        """Take frames until what the CNC has announced is there, and its SYNC. Raises EnvironmentLacks when it is not.

        What else is there came from others: it reaches the drives as well, but for a SYNC. Somebody's SYNC would end
        the cycle early, for this process and for every cycle that follows.
        """
        assert self._bus is not None
        waiting = Counter((*announced, SYNC))
        inbox: list[CanFrame] = []
        while waiting.total():
            frame = self._bus.receive()
            if frame is None:
                raise EnvironmentLacks("frames of the CNC were lost on the CAN bus, or its SYNC")
            self._sort(frame, waiting, inbox)
        while (frame := self._bus.receive_now()) is not None:
            self._sort(frame, waiting, inbox)
        return inbox

    def _sort(self, frame: CanFrame, waiting: Counter[CanFrame], inbox: list[CanFrame]) -> None:
        if waiting[frame]:
            waiting[frame] -= 1
        else:
            self._foreign.append(frame)
        if frame.cob_id != SYNC.cob_id:
            inbox.append(frame)

    def _answer(self, cycle: int, frames: Sequence[CanFrame] = (), *, numbers: bytes = b"") -> None:
        """Send numbers or frames (a CAN bus carries them itself), what is due by time, the edges of this cycle."""
        side = self._side
        state, due = telegraph.LOUD, b""
        if self._bus is None:
            due = telegraph.frames(side.timers(cycle))
            if side.quiet(cycle + 1) > 0:
                state = telegraph.QUIET
        else:
            for frame in frames:
                self._bus.send(frame)
        edges = telegraph.edges(side.take_edges(), side.signals)
        foreign, self._foreign = telegraph.frames(self._foreign), []
        packed = telegraph.frames(frames)
        self._pipe.send(telegraph.reply(Reply(state, numbers, packed, due, foreign, edges)))


def main(pipe: Pipe, arguments: Sequence[str]) -> None:
    """Build the machine side and serve."""
    machine, settings, can, realtime = arguments
    config = load(machine, json.loads(settings), with_plcs=False)
    # What the telegrams say, as numbers; the other fields are the kernel's and mean nothing here.
    axis = np.zeros(len(config.axes), AXIS)
    side = build.machine_side(config, axis)
    bus = CanBus(can) if can else None
    ask(realtime=bool(realtime))
    settle()
    try:
        Drives(side, axis, pipe, bus).run()
    finally:
        if bus is not None:
            bus.close()


if __name__ == "__main__":
    sys.exit(work(main, sys.argv[1:]))
