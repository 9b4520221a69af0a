"""The machine in processes of its own: drives with the plant, and terminals; the kernel is in this one."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, Self

import numpy as np

from hli_bench.base.errors import EnvironmentLacks, InputError, NotEmulated
from hli_bench.bench import telegraph
from hli_bench.bench.config import MachineConfig
from hli_bench.bench.telegraph import Order
from hli_bench.laws.rows import MachineRows, Rows
from hli_bench.plant.build import signal_names
from hli_bench.runtime.machine_side import SYNC
from hli_bench.shells.can_bus import CanBus
from hli_bench.shells.processes import Worker
from hli_bench.terminals.terminal import type_of
from hli_bench.wire.can import CanFrame
from hli_bench.wire.images import TerminalLayout
from hli_bench.wire.signals import Edge

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


class RemoteMachine:
    """How the kernel's process reaches the others. Every cycle passes frames; there are no quiet ones."""

    def __init__(
        self, config: MachineConfig, machine: str | Path, settings: Mapping[str, object], can: str
    ) -> None:
        interface = can_interface(can)
        self._bus = CanBus(interface) if interface else None
        given = [str(machine), json.dumps(dict(settings))]
        self._drives = Worker(_DRIVES, [*given, interface])
        self._terminals = Worker(_TERMINALS, given)
        self._signals = signal_names([axis.name for axis in config.axes])
        self._edges: list[Edge] = []
        self._images: dict[str, bytes] = {}
        self.terminal_layouts: Sequence[TerminalLayout] = [
            type_of(settings).layout(settings) for settings in config.terminals
        ]
        self.rows = MachineRows.allocate(len(config.axes), 0, len(self._signals), 0)
        self.pending = np.full((1, 3), -1, np.int64)
        self.sub_steps = config.sub_steps

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._drives.close()
        self._terminals.close()
        if self._bus is not None:
            self._bus.close()

    def power_on(self) -> list[CanFrame]:
        """Boot all nodes."""
        frames = self._answer(self._drives.ask(telegraph.order(Order.POWER_ON, 0)))
        self._take_images(0)
        return frames

    def advance(self, cycle: int) -> None:
        """Nothing: the machine moves on when it gets its SYNC."""

    def telegrams(self, cycle: int, inbox: Sequence[CanFrame]) -> list[CanFrame]:
        """Send the frames and SYNC, return what the drives sent at it."""
        body = b""
        if self._bus is None:
            body = telegraph.frames(inbox)
        else:
            # What stands there before the drives were asked came from others, who must not fill the queue.
            self._bus.clear()
            for frame in (*inbox, SYNC):
                self._bus.send(frame)
        frames = self._answer(self._drives.ask(telegraph.order(Order.CYCLE, cycle, body)))
        self._take_images(cycle)
        return frames

    def exchange(self, cycle: int, axis: Rows) -> None:
        """Never asked: no cycle is quiet."""

    def timers(self, cycle: int) -> list[CanFrame]:
        """Return nothing: what is due by time comes with the telegrams."""
        return []

    def quiet(self, cycle: int) -> int:
        """No cycle passes without frames."""
        return 0

    def images(self, cycle: int) -> Mapping[str, bytes]:
        """Return the process images by terminal."""
        return self._images

    def image_horizon(self, cycle: int) -> int:
        """The images are taken in every cycle."""
        return 1

    def take_edges(self) -> list[Edge]:
        """Return the edges of all signals since the last call."""
        edges, self._edges = self._edges, []
        return edges

    def _answer(self, message: bytes) -> list[CanFrame]:
        """Take the drives' answer; over a bus the frames themselves come from there."""
        packed, edges = telegraph.read_parts(message)
        self._new_edges = edges
        self._edges += telegraph.read_edges(edges, self._signals)
        announced = telegraph.read_frames(packed)
        return announced if self._bus is None else self._from_bus(announced)

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

    def _take_images(self, cycle: int) -> None:
        answer = self._terminals.ask(telegraph.order(Order.CYCLE, cycle, self._new_edges))
        images = telegraph.read_parts(answer)
        self._images = {
            layout.name: image for layout, image in zip(self.terminal_layouts, images, strict=True)
        }
