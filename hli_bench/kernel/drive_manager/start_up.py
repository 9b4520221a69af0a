"""Start-up of a CANopen drive: configure by SDO, NMT start, then through the CiA 402 states to operation.

The steps of one drive are a table; all drives go through it side by side.
"""

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from hli_bench.base.errors import BenchError
from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.core import Core
from hli_bench.kernel.drive_manager.objects import ObjectChannel, Order
from hli_bench.kernel.drive_manager.probe_telegrams import FIRST_INPUT, SECOND_INPUT, writes
from hli_bench.kernel.sequence import END, Level, Phase, Table, Then, Until
from hli_bench.kernel.watches import statusword
from hli_bench.laws.rows import FOLLOW, HOLD, PATH
from hli_bench.manual.axis.fallbacks import effective_input
from hli_bench.protocols.canopen.aborts import SdoAbort
from hli_bench.protocols.canopen.cia402 import (
    CYCLIC_SYNCHRONOUS_POSITION,
    MODE_OF_OPERATION,
    PRODUCER_HEARTBEAT,
    STATES,
    Command,
)
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame

HEARTBEAT_MS: Final = 1000
"""Producer heartbeat that the CNC asks of its drives (decided here)."""


@dataclass(slots=True)
class Drive:
    """One drive on its way."""

    core: Core
    channel: ObjectChannel
    axis: AxisIndex
    open_orders: int = 0

    def order(self, index: int, subindex: int, data: bytes) -> None:
        """Queue a configuration write."""
        self.open_orders += 1
        node = self.core.axis(self.axis).node

        def done(refused: SdoAbort | None) -> None:
            self.open_orders -= 1
            if refused is not None:
                name = self.core.axis(self.axis).name
                raise BenchError(f"drive of axis {name} refuses {index:04X}:{subindex:02X}: {refused}")

        self.channel.write(node, Order(index, subindex, data, done))


def _configure(drive: Drive) -> None:
    row = drive.core.row(drive.axis)
    row["mode"] = FOLLOW
    drive.order(*PRODUCER_HEARTBEAT, struct.pack("<H", HEARTBEAT_MS))
    drive.order(*MODE_OF_OPERATION, struct.pack("<b", CYCLIC_SYNCHRONOUS_POSITION))
    axis = drive.core.axis(drive.axis)
    probing_input = SECOND_INPUT if effective_input(axis.params) == SECOND_INPUT else FIRST_INPUT
    carried = drive.channel.probing_inputs.get(axis.node, FIRST_INPUT)
    if {probing_input, carried} != {FIRST_INPUT}:
        for index, subindex, data in writes(axis.node, probing_input):
            drive.order(index, subindex, data)
    drive.channel.probing_inputs[axis.node] = probing_input


def _configured(drive: Drive) -> Until:
    return Level(lambda: drive.open_orders == 0)


def _start_node(drive: Drive) -> None:
    drive.core.frames.append(nmt_frame(NmtCommand.START, drive.core.axis(drive.axis).node))


def _controlword(word: int) -> Callable[[Drive], None]:
    def send(drive: Drive) -> None:
        drive.core.row(drive.axis)["controlword"] = word

    return send


def _state(name: str) -> Callable[[Drive], Until]:
    mask, value = STATES[name]

    def reached(drive: Drive) -> Until:
        return statusword(drive.axis, mask, value)

    return reached


def _follow(drive: Drive) -> None:
    """Take the drive out of operation, so that its set point can take up the actual position."""
    drive.core.row(drive.axis)["mode"] = FOLLOW
    drive.core.row(drive.axis)["controlword"] = Command.SHUT_DOWN


def _in_operation(drive: Drive) -> None:
    # A path that still brakes goes on without this axis: it stands where it was taken back into operation.
    drive.core.row(drive.axis)["mode"] = PATH if drive.core.path.idle else HOLD
    drive.core.show(drive.axis, "lr_state/ready_for_power_on_r", True)
    drive.core.show(drive.axis, "lr_state/ready_for_control_loop_on_r", True)


TABLE: Final[Table[Drive]] = {
    "configure": Phase(_configure, (Then(_configured, "start"),)),
    "start": Phase(_start_node, (Then(_state("switch on disabled"), "shut down"),)),
    "reset": Phase(_controlword(Command.RESET_FAULT), (Then(_state("switch on disabled"), "shut down"),)),
    "disable": Phase(
        _follow, (Then(_state("ready to switch on"), "switch on"), Then(_state("fault"), "reset"))
    ),
    "shut down": Phase(_controlword(Command.SHUT_DOWN), (Then(_state("ready to switch on"), "switch on"),)),
    "switch on": Phase(_controlword(Command.SWITCH_ON), (Then(_state("switched on"), "enable"),)),
    "enable": Phase(
        _controlword(Command.ENABLE_OPERATION), (Then(_state("operation enabled"), END, _in_operation),)
    ),
}
"""From power-on (`configure`), a fault (`reset`) or operation itself (`disable`) to operation enabled."""
