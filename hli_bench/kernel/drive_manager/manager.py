"""All drives of the machine: telegrams and service channel, start-up, supervision, and the way back after an error."""

from collections.abc import Iterable

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.core import Core
from hli_bench.kernel.drive_manager import start_up
from hli_bench.kernel.drive_manager.objects import ObjectChannel
from hli_bench.kernel.drive_manager.probe_telegrams import SECOND_INPUT
from hli_bench.kernel.drive_manager.supervision import Supervision
from hli_bench.kernel.drive_manager.telegram import ActualTelegrams, CommandTelegrams
from hli_bench.kernel.monitoring import Monitoring
from hli_bench.kernel.sequence import END, Sequence
from hli_bench.kernel.watches import cycle_reached
from hli_bench.laws.rows import FOLLOW
from hli_bench.protocols.canopen.cia402 import STATES, Command, state_of
from hli_bench.protocols.canopen.telegram import TPDOS, changed
from hli_bench.wire.can import CanFrame


class DriveManager:
    """Brings drives into operation, hears when one drops out, brings it back at a CNC reset."""

    __slots__ = (
        "_actual",
        "_commands",
        "_core",
        "_monitoring",
        "_overdue",
        "_starting",
        "_supervision",
        "objects",
    )

    def __init__(self, core: Core, monitoring: Monitoring) -> None:
        nodes = [axis.node for axis in core.setup.axes]
        self._core = core
        self._monitoring = monitoring
        self._actual = ActualTelegrams(core.setup.axes, core.rows.axis)
        self._commands = CommandTelegrams(nodes, core.rows.axis)
        self._supervision = Supervision(core)
        self._starting: dict[AxisIndex, Sequence[start_up.Drive]] = {}
        self.objects = ObjectChannel(nodes)
        self._overdue: int | None = None
        """Wakes up when a drive does not answer about an object."""

    @property
    def ready(self) -> bool:
        """All drives are in operation."""
        return bool(self._starting) and all(sequence.ended for sequence in self._starting.values())

    @property
    def settled(self) -> bool:
        """No drive is on its way: each is in operation, or stays out."""
        return bool(self._starting) and all(
            sequence.ended or sequence.phase == start_up.OUT for sequence in self._starting.values()
        )

    def out(self) -> list[str]:
        """Return the names of the axes whose drives are not in operation, with what is known of the reason."""
        core = self._core
        under_way = [(core.axis(axis), one) for axis, one in self._starting.items() if not one.ended]
        reasons = [(axis.name, one.context.why or f"on its way: {one.phase}") for axis, one in under_way]
        dropped = [
            (axis.name, "waits for a CNC reset")
            for axis in core.setup.axes
            if self._starting[axis.index].ended and core.row(axis.index)["mode"] == FOLLOW
        ]
        return [f"{name} ({why})" for name, why in reasons + dropped]

    @property
    def telegram_ids(self) -> frozenset[int]:
        """COB-IDs of the telegrams that every cycle brings."""
        return self._actual.cob_ids

    def shown(self, axis: AxisIndex) -> str:
        """Return the state of a drive for people, also when no telegram tells it."""
        if axis in self._supervision.silent:
            return f"no telegrams: {self._supervision.silent[axis]}"
        return state_of(int(self._core.row(axis)["statusword"]))

    def cyclic_frames(self) -> list[CanFrame]:
        """Return the command telegrams of this cycle, in identifier order."""
        return self._commands.frames()

    def begin_start_up(self) -> None:
        """Begin to bring all drives into operation."""
        for axis in self._core.setup.axes:
            self._begin(axis.index, start_up.CONFIGURE)

    def take_telegrams(self, frames: Iterable[CanFrame]) -> bool:
        """Take what the bus brought at a SYNC, where every drive's telegrams belong; as `take`."""
        others = self._actual.take(frames)
        decide = self.take(others)
        return (bool(self._actual.missing) and self._supervision.missing(self._silent())) or decide

    def _silent(self) -> list[AxisIndex]:
        """Return the axes of which a telegram did not come, but for those that the CNC is configuring anew."""
        missing, found = self._actual.missing, []
        for axis in self._core.setup.axes:
            telegrams = {telegram.base + axis.node for telegram in TPDOS}
            if self.objects.waits(axis.node):
                telegrams -= {telegram.base + axis.node for _, telegram in changed(SECOND_INPUT - 1)}
            if telegrams & missing:
                found.append(axis.index)
        return found

    def take(self, frames: Iterable[CanFrame]) -> bool:
        """Take frames that are no telegrams; tell whether any of them needs a decision."""
        some = False
        for frame in frames:
            some = True
            self._core.frames += self.objects.on_frame(frame, self._core.now)
            self._supervision.on_frame(frame)
        return some

    def step(self, source: Source) -> None:
        """Go on with the drives on their way, report those that have dropped out."""
        under_way = [(axis, one) for axis, one in self._starting.items() if not one.ended]
        for axis, sequence in under_way:
            sequence.step()
            if sequence.ended:
                self._core.starting.discard(axis)
                self._supervision.begin(axis, heartbeat=sequence.context.heartbeat)
                self._monitoring.switch_on(axis)
        for axis in self._supervision.check(source):
            self._drop(axis)

    def serve_objects(self) -> None:
        """Go on with the acyclic objects."""
        core = self._core
        core.frames += self.objects.begin(core.now)
        if self._overdue is not None:
            core.watches.forget(self._overdue)
            self._overdue = None
        due = self.objects.next_due()
        if due is not None:
            self._overdue = core.watches.watch(cycle_reached(-(-due // core.setup.cycle_ns)))

    def reset(self) -> None:
        """Begin to bring back what has dropped out. A drive on its way goes on, one being configured begins anew."""
        self.objects.clear()
        tripped = self._monitoring.take_tripped()
        for axis in self._core.setup.axes:
            index = axis.index
            under_way = self._starting[index].phase if index in self._starting else END
            mask, fault = STATES["fault"]
            if under_way == start_up.CONFIGURE:
                self._begin(index, start_up.CONFIGURE)
            elif under_way == start_up.OUT or (under_way == END and index in self._supervision.silent):
                self._begin(index, start_up.BOOT)
            elif under_way != END and self._core.row(index)["statusword"] & mask != fault:
                continue
            elif self._core.row(index)["mode"] == FOLLOW:
                self._begin(index, start_up.ASSESS)
            elif index in tripped:
                self._monitoring.switch_off(index)
                self._supervision.end(index)
                self._begin(index, start_up.DISABLE)

    def _begin(self, axis: AxisIndex, phase: str) -> None:
        heartbeat = True
        if axis in self._starting:
            self._starting[axis].abort()
            heartbeat = self._starting[axis].context.heartbeat
        drive = start_up.Drive(self._core, self.objects, self._supervision, axis, heartbeat=heartbeat)
        self._core.starting.add(axis)
        self._starting[axis] = Sequence(start_up.TABLE, drive, phase, self._core.watches)

    def _drop(self, axis: AxisIndex) -> None:
        """A drive has dropped out: its set point follows, the others brake with the path.

        It is told to stop: one that still hears it does so along its ramp.
        """
        core = self._core
        self._monitoring.switch_off(axis)
        core.row(axis)["mode"] = FOLLOW
        core.row(axis)["controlword"] = Command.QUICK_STOP
        core.show(axis, "head/error_r", True)
