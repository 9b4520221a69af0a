"""Start-up of a CANopen drive: boot, configure by SDO, NMT start, then through the CiA 402 states to operation.

The steps of one drive are a table; all drives go through it side by side. A step that takes too long, or that the
drive refuses, ends in `OUT`, where the drive stays with the reason until a CNC reset.
"""

import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import NS_PER_MS
from hli_bench.kernel.core import Core
from hli_bench.kernel.drive_manager.objects import ObjectChannel, Order
from hli_bench.kernel.drive_manager.probe_telegrams import FIRST_INPUT, SECOND_INPUT, writes
from hli_bench.kernel.drive_manager.supervision import HEARTBEAT_MS, Supervision
from hli_bench.kernel.sequence import END, Level, Phase, Table, Then, Until
from hli_bench.kernel.watches import cycle_reached, statusword
from hli_bench.laws.rows import FOLLOW, HOLD, PATH
from hli_bench.manual.axis.fallbacks import effective_input
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.cia402 import (
    CYCLIC_SYNCHRONOUS_POSITION,
    MODE_OF_OPERATION,
    PRODUCER_HEARTBEAT,
    STATES,
    Command,
    state_of,
)
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame

PHASE_MS: Final = 1500
"""Longest that a drive may take for one step: the longest stop along a ramp is over by then (decided here)."""
RELEASED_CYCLES: Final = 3
"""Cycles after which a drive has surely seen that a bit of the control word was cleared."""
CONFIGURE: Final = "configure"
BOOT: Final = "boot"
ASSESS: Final = "assess"
DISABLE: Final = "disable"
OUT: Final = "out"


@dataclass(slots=True)
class Drive:
    """One drive on its way. `heartbeat`: it sends one; `why`: what keeps it out."""

    core: Core
    channel: ObjectChannel
    supervision: Supervision
    axis: AxisIndex
    open_orders: int = 0
    heartbeat: bool = True
    why: str = ""

    def order(self, index: int, subindex: int, data: bytes, *, optional: bool = False) -> None:
        """Queue a configuration write; a drive may lack an `optional` object."""
        self.open_orders += 1
        node = self.core.axis(self.axis).node

        def done(refused: SdoAbort | None) -> None:
            self.open_orders -= 1
            if refused is None:
                return
            if optional and refused.code == AbortCode.NO_OBJECT:
                self.heartbeat = False
            elif not self.why:
                what = "does not answer about" if refused.code == AbortCode.TIME_OUT else "refuses"
                self.why = f"node {node} {what} {index:04X}:{subindex:02X} ({refused})"

        self.channel.write(node, Order(index, subindex, data, done))

    def command(self, word: int) -> None:
        """Put a control word into the command telegram."""
        self.core.row(self.axis)["controlword"] = word

    @property
    def node(self) -> int:
        """Node id."""
        return self.core.axis(self.axis).node


def _boot(drive: Drive) -> None:
    """Reset the node's communication: whatever others have set up there is as after power-on."""
    drive.supervision.booted.discard(drive.axis)
    drive.channel.probing_inputs[drive.core.axis(drive.axis).node] = FIRST_INPUT
    drive.core.row(drive.axis)["mode"] = FOLLOW
    drive.core.row(drive.axis)["statusword"] = 0
    drive.command(Command.DISABLE_VOLTAGE)
    drive.core.frames.append(nmt_frame(NmtCommand.RESET_COMMUNICATION, drive.node))


def _booted(drive: Drive) -> Until:
    return Level(lambda: drive.axis in drive.supervision.booted)


def _configure(drive: Drive) -> None:
    row = drive.core.row(drive.axis)
    row["mode"] = FOLLOW
    drive.heartbeat = True
    drive.order(*PRODUCER_HEARTBEAT, struct.pack("<H", HEARTBEAT_MS), optional=True)
    drive.order(*MODE_OF_OPERATION, struct.pack("<b", CYCLIC_SYNCHRONOUS_POSITION))
    axis = drive.core.axis(drive.axis)
    probing_input = SECOND_INPUT if effective_input(axis.params) == SECOND_INPUT else FIRST_INPUT
    carried = drive.channel.probing_inputs.get(axis.node, FIRST_INPUT)
    if {probing_input, carried} != {FIRST_INPUT}:
        for index, subindex, data in writes(axis.node, probing_input):
            drive.order(index, subindex, data)
    drive.channel.probing_inputs[axis.node] = probing_input


def _configured(drive: Drive) -> Until:
    return Level(lambda: drive.open_orders == 0 and not drive.why)


def _refused(drive: Drive) -> Until:
    return Level(lambda: bool(drive.why))


def _start_node(drive: Drive) -> None:
    drive.core.frames.append(nmt_frame(NmtCommand.START, drive.node))


def _heard(drive: Drive) -> None:
    """Telegrams come again."""
    drive.supervision.silent.pop(drive.axis, None)


def _controlword(word: int) -> Callable[[Drive], None]:
    return lambda drive: drive.command(word)


def _state(name: str) -> Callable[[Drive], Until]:
    mask, value = STATES[name]
    return lambda drive: statusword(drive.axis, mask, value)


def _after(milliseconds: int) -> Callable[[Drive], Until]:
    def late(drive: Drive) -> Until:
        cycles = milliseconds * NS_PER_MS // drive.core.setup.cycle_ns
        return cycle_reached(drive.core.cycle + cycles)

    return late


def _seen(drive: Drive) -> Until:
    return cycle_reached(drive.core.cycle + RELEASED_CYCLES)


def _follow(drive: Drive) -> None:
    """Take the drive out of operation, so that its set point can take up the actual position."""
    drive.core.row(drive.axis)["mode"] = FOLLOW
    drive.command(Command.SHUT_DOWN)


def _in_operation(drive: Drive) -> None:
    # A path that still brakes goes on without this axis: it stands where it was taken back into operation.
    drive.core.row(drive.axis)["mode"] = PATH if drive.core.path.idle else HOLD


def _give_up(why: str, drive: Drive) -> None:
    """Keep the reason, with the state that the drive shows."""
    status = int(drive.core.row(drive.axis)["statusword"])
    code = drive.supervision.error_code(drive.axis)
    error = f", error {code:#06x}" if code else ""
    drive.why = drive.why or f"node {drive.node}: {why.format(state=state_of(status) + error)}"


def _out(drive: Drive) -> None:
    """Stay out: programs need not wait for this drive."""
    drive.core.row(drive.axis)["mode"] = FOLLOW
    drive.command(Command.DISABLE_VOLTAGE)
    drive.core.starting.discard(drive.axis)
    drive.core.show(drive.axis, "head/error_r", True)


def _phase(motion: Callable[[Drive], None], *ways: Then[Drive], late: str) -> Phase[Drive]:
    """Return a phase that ends in OUT when none of its ways is gone in time."""
    return Phase(motion, (*ways, Then(_after(PHASE_MS), OUT, partial(_give_up, late))))


_STAYS: Final = "it stays in {state}"
_POWER_OFF: Final = (
    Then(_state("switch on disabled"), "shut down", _heard),
    Then(_state("fault"), "clear", _heard),
)
"""Where every other state leads while the control word asks for no voltage, or for a quick stop."""
TABLE: Final[Table[Drive]] = {
    BOOT: _phase(_boot, Then(_booted, CONFIGURE), late="no boot-up message after NMT reset communication"),
    CONFIGURE: _phase(
        _configure,
        Then(_refused, OUT),
        Then(_configured, "start"),
        late="no answer to its configuration by SDO",
    ),
    "start": _phase(_start_node, *_POWER_OFF, late="no telegrams after NMT start, or it stays in {state}"),
    ASSESS: Phase(_controlword(Command.QUICK_STOP), (*_POWER_OFF, Then(_after(PHASE_MS), "off"))),
    "off": _phase(_controlword(Command.DISABLE_VOLTAGE), *_POWER_OFF, late=_STAYS),
    "clear": Phase(_controlword(Command.DISABLE_VOLTAGE), (Then(_seen, "reset"),)),
    "reset": _phase(
        _controlword(Command.RESET_FAULT), Then(_state("switch on disabled"), "shut down"), late=_STAYS
    ),
    DISABLE: _phase(
        _follow,
        Then(_state("ready to switch on"), "switch on"),
        Then(_state("switch on disabled"), "shut down"),
        Then(_state("fault"), "clear"),
        late=_STAYS,
    ),
    "shut down": _phase(
        _controlword(Command.SHUT_DOWN), Then(_state("ready to switch on"), "switch on"), late=_STAYS
    ),
    "switch on": _phase(_controlword(Command.SWITCH_ON), Then(_state("switched on"), "enable"), late=_STAYS),
    "enable": _phase(
        _controlword(Command.ENABLE_OPERATION),
        Then(_state("operation enabled"), END, _in_operation),
        late=_STAYS,
    ),
    OUT: Phase(_out, ()),
}
"""From power-on (CONFIGURE), a node that was lost (BOOT), any state (ASSESS) or operation (DISABLE) to operation."""
