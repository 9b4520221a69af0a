"""What the CNC hears of the nodes of its drives, and what it concludes: one that dropped out is told at once.

A drive in operation is supervised four ways. Its telegrams must come with every SYNC; its node must show itself
OPERATIONAL (boot-up message, heartbeat, and a heartbeat within the consumer time); it must send no emergency message;
its status word must show "operation enabled". Only the last is asked in quiet cycles, by a row of the compiled laws:
a drive that does not send its telegrams makes no quiet cycles, and the others are frames.
"""

import struct
from collections.abc import Iterable
from typing import Final

from hli_bench.base.ids import AxisIndex, NodeId
from hli_bench.base.time import NS_PER_MS
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.core import Core
from hli_bench.kernel.watches import cycle_reached, statusword_left
from hli_bench.manual.errors import position_controller as errors
from hli_bench.protocols.canopen.cia402 import STATES, state_of
from hli_bench.protocols.canopen.nmt import NmtState, node_state
from hli_bench.wire.can import CanFrame

HEARTBEAT_MS: Final = 1000
"""Producer heartbeat that the CNC asks of its drives (decided here)."""
CONSUMER_MS: Final = 1500
"""A heartbeat that stays out longer is missed (decided here)."""
EMERGENCY_COB_ID: Final = 0x80
_FAULTS: Final = (STATES["fault"], STATES["fault reaction active"])


class Supervision:
    """Watches the drives that are in operation; `check` reports what dropped out since it was asked last."""

    __slots__ = (
        "_axes",
        "_core",
        "_cycles",
        "_due",
        "_emergency",
        "_left",
        "_lost",
        "_new",
        "_timer",
        "booted",
        "silent",
    )

    def __init__(self, core: Core) -> None:
        self._core = core
        self._axes = {NodeId(axis.node): axis.index for axis in core.setup.axes}
        self._cycles = CONSUMER_MS * NS_PER_MS // core.setup.cycle_ns
        self._left: dict[AxisIndex, int] = {}
        """Condition of every supervised drive: its status word shows something else than operation."""
        self._due: dict[AxisIndex, int] = {}
        """Cycle by which the next heartbeat must have come, of the drives that send one."""
        self._timer: int | None = None
        self._emergency: dict[AxisIndex, int] = {}
        """The newest error code of each drive."""
        self._new: dict[AxisIndex, int] = {}
        """Error code of the first emergency message of each drive since the last check."""
        self._lost: dict[AxisIndex, str] = {}
        """Nodes that have been found missing since the last check, and how."""
        self.silent: dict[AxisIndex, str] = {}
        """Drives of which no telegrams are known to come, and how that was found."""
        self.booted: set[AxisIndex] = set()
        """Drives whose boot-up message has come since somebody took them out of here."""

    def begin(self, axis: AxisIndex, *, heartbeat: bool) -> None:
        """Watch a drive that has come into operation; `heartbeat`: it sends one."""
        self.end(axis)
        self.silent.pop(axis, None)
        self._left[axis] = self._core.watches.watch(statusword_left(axis, *STATES["operation enabled"]))
        self._emergency.pop(axis, None)
        if heartbeat:
            self._due[axis] = self._core.cycle + self._cycles
            self._set_timer()

    def end(self, axis: AxisIndex) -> None:
        """Watch a drive no more."""
        if axis in self._left:
            self._core.watches.forget(self._left.pop(axis))
        self._due.pop(axis, None)
        self._lost.pop(axis, None)
        self._new.pop(axis, None)

    def error_code(self, axis: AxisIndex) -> int:
        """Return the error code that a drive has sent last, 0 when it has none."""
        return self._emergency.get(axis, 0)

    def on_frame(self, frame: CanFrame) -> None:
        """Take a frame that is no telegram."""
        shown = node_state(frame)
        if shown is not None:
            axis = self._axes.get(NodeId(shown[0]))
            if axis is not None:
                self._on_state(axis, shown[1])
            return
        axis = self._axes.get(NodeId(frame.cob_id - EMERGENCY_COB_ID))
        if axis is not None and len(frame.data) >= 2 and not frame.remote:
            self._emergency[axis] = code = int(struct.unpack_from("<H", frame.data)[0])
            if code and axis in self._left:
                self._new.setdefault(axis, code)

    def missing(self, axes: Iterable[AxisIndex]) -> bool:
        """Note drives whose telegrams did not come with this SYNC; tell whether one of them is supervised."""
        found = [axis for axis in axes if axis in self._left]
        for axis in found:
            self._lost.setdefault(axis, "its telegrams stay out")
        return bool(found)

    def check(self, source: Source) -> list[AxisIndex]:
        """Report what was found since the last call; return the axes whose drives have dropped out."""
        if self._timer is not None and self._core.watches.met(self._timer):
            self._miss_heartbeats()
        found = []
        if self._lost or self._new or self._core.watches.any_met([*self._left.values()]):
            for axis in [*self._left]:
                if self._has_dropped(axis, source):
                    self.end(axis)
                    found.append(axis)
        return found

    def _on_state(self, axis: AxisIndex, state: NmtState) -> None:
        """Take a boot-up message or a heartbeat."""
        if state is NmtState.INITIALISING:
            self.booted.add(axis)
            self._lose(axis, "it has booted again")
        elif state is not NmtState.OPERATIONAL:
            self._lose(axis, f"it is {state.name.lower().replace('_', '-')}")
        elif axis in self._due:
            self._due[axis] = self._core.cycle + self._cycles

    def _lose(self, axis: AxisIndex, how: str) -> None:
        """Keep how a supervised node was found missing."""
        if axis in self._left:
            self._lost[axis] = how

    def _miss_heartbeats(self) -> None:
        """Look whose heartbeat is overdue, and when to look again."""
        for axis, due in self._due.items():
            if due <= self._core.cycle:
                self._lose(axis, f"no heartbeat for {CONSUMER_MS} ms")
        self._set_timer()

    def _set_timer(self) -> None:
        """Wake up when the first heartbeat becomes overdue that does not come."""
        if self._timer is not None:
            self._core.watches.forget(self._timer)
        coming = [due for axis, due in self._due.items() if axis not in self._lost]
        self._timer = self._core.watches.watch(cycle_reached(min(coming))) if coming else None

    def _has_dropped(self, axis: AxisIndex, source: Source) -> bool:
        """Report what has happened to a drive, if anything; tell whether it is out of operation."""
        if axis in self._lost:
            self._report_lost(axis, source, self._lost[axis])
            return True
        left = self._core.watches.met(self._left[axis])
        if not left and axis not in self._new:
            return False
        code = self._new.pop(axis, self.error_code(axis))
        core, number = self._core, self._core.axis(axis).number
        status = int(core.row(axis)["statusword"])
        if not left or any(status & mask == value for mask, value in _FAULTS):
            told = self._common(axis), status, source.name, f"{code:#06x}"
            core.report(errors.CANOPEN_DRIVE_ERROR, source, number, *told, axis=axis)
            return left
        given = self._common(axis), f"{status:#06x}", source.name
        core.report(
            errors.DRIVE_NOT_READY, source, number, *given, axis=axis, cause=f"it shows {state_of(status)}"
        )
        return True

    def _report_lost(self, axis: AxisIndex, source: Source, how: str) -> None:
        """Report a node that is missing. An encoder that is not absolute may have lost count: the reference is gone."""
        core, setup = self._core, self._core.axis(axis)
        self.silent[axis] = how
        core.row(axis)["statusword"] = 0
        moves = core.row(axis)["velocity"] != 0.0
        sheet = errors.DRIVE_DATA_INVALID if moves else errors.DRIVE_DATA_INVALID_AT_STANDSTILL
        given = self._common(axis), 0, source.name
        core.report(sheet, source, setup.number, *given, axis=axis, cause=f"node {setup.node}: {how}")
        if core.referenced[axis] and not setup.params.kenngr.abs_pos_gueltig:
            core.referenced[axis] = False
            core.show(axis, "lr_state/homing_done_r", False)
            lost = self._common(axis), 1, 0, 1
            core.report(errors.REFERENCE_LOST_WITH_BUS, source, setup.number, *lost, axis=axis)

    def _common(self, axis: AxisIndex) -> int:
        """Return the drive type, which all these messages carry."""
        return int(self._core.axis(axis).params.kenngr.antr_typ)
