"""Drives and plant as a process of their own: `python -m hli_bench.bench.drives_process FD MACHINE SETTINGS CAN`.

Over the pipe it gets one order a cycle; frames come and go over the pipe too, or over a CAN interface, where
SYNC is what lets the machine move on.
"""

import json
import sys
from collections.abc import Sequence

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.bench import build, telegraph
from hli_bench.bench.config import load
from hli_bench.bench.telegraph import Order
from hli_bench.runtime.machine_side import SYNC, MachineSide
from hli_bench.shells.can_bus import CanBus
from hli_bench.shells.processes import Pipe, work
from hli_bench.wire.can import CanFrame


class Drives:
    """Serves the kernel's process."""

    def __init__(self, side: MachineSide, pipe: Pipe, bus: CanBus | None) -> None:
        self._side = side
        self._pipe = pipe
        self._bus = bus

    def run(self) -> None:
        """Work until the kernel's process closes the pipe."""
        while True:
            try:
                message = self._pipe.receive()
            except EOFError:
                return
            kind, cycle, body = telegraph.read_order(message)
            if kind is Order.POWER_ON:
                self._answer(self._side.power_on())
                continue
            inbox = telegraph.read_frames(body) if self._bus is None else self._from_bus()
            self._side.advance(cycle)
            self._answer(self._side.telegrams(cycle, inbox))

    def _from_bus(self) -> list[CanFrame]:
        """Take frames until the SYNC that belongs to this cycle. Raises EnvironmentLacks when it does not come."""
        assert self._bus is not None
        inbox: list[CanFrame] = []
        while (frame := self._bus.receive()) is not None:
            if frame.cob_id == SYNC.cob_id:
                return inbox
            inbox.append(frame)
        raise EnvironmentLacks("the SYNC of the CNC was lost on the CAN bus")

    def _answer(self, frames: Sequence[CanFrame]) -> None:
        """Send the frames (a CAN bus carries them itself) and the edges of this cycle."""
        if self._bus is not None:
            for frame in frames:
                self._bus.send(frame)
        edges = telegraph.edges(self._side.take_edges(), self._side.signals)
        self._pipe.send(telegraph.parts(telegraph.frames(frames), edges))


def main(pipe: Pipe, arguments: Sequence[str]) -> None:
    """Build the machine side and serve."""
    machine, settings, can = arguments
    side = build.machine_side(load(machine, json.loads(settings)))
    bus = CanBus(can) if can else None
    try:
        Drives(side, pipe, bus).run()
    finally:
        if bus is not None:
            bus.close()


if __name__ == "__main__":
    sys.exit(work(main, sys.argv[1:]))
