"""Blocks that take their time while no path runs: measuring runs, drive objects, dwells."""

from collections.abc import Callable
from typing import Protocol

from hli_bench.base.time import NS_PER_S
from hli_bench.kernel.blocks import DriveWrite, Dwell
from hli_bench.kernel.core import Core
from hli_bench.kernel.drive_manager import functions
from hli_bench.kernel.drive_manager.objects import ObjectChannel
from hli_bench.kernel.monitoring import Monitoring
from hli_bench.kernel.position_controller import measurement
from hli_bench.kernel.sequence import Sequence
from hli_bench.kernel.watches import cycle_reached
from hli_bench.manual.errors import position_controller as errors
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort


class Activity(Protocol):
    """A block that takes its time."""

    def step(self) -> bool:
        """Go on; tell whether it is done."""

    def abort(self) -> None:
        """End it where it is."""


class Measuring:
    """A G100 block on its way; `done` gets the run when it has ended in any way."""

    def __init__(
        self,
        core: Core,
        monitoring: Monitoring,
        run: measurement.Run,
        done: Callable[[measurement.Run], None],
    ) -> None:
        self._monitoring = monitoring
        self._run = run
        self._done = done
        self._sequence = Sequence(measurement.table(run), run, measurement.arming(run), core.watches)
        if run.fixed_stop:
            self._lag_monitoring(on=False)

    def step(self) -> bool:
        """Go on with its phases."""
        self._sequence.step()
        if not self._sequence.ended:
            return False
        self._end()
        return True

    def cut(self) -> bool:
        """Brake and measure no more (delete distance to go); tell whether the run was on its way."""
        self._run.cut = self._sequence.phase == "running"
        return self._run.cut

    def abort(self) -> None:
        """Switch the sources off; what was latched counts."""
        self._sequence.abort()
        try:
            measurement.abort(self._run)
        finally:
            self._end()

    def _end(self) -> None:
        if self._run.fixed_stop:
            self._lag_monitoring(on=True)
        self._done(self._run)

    def _lag_monitoring(self, *, on: bool) -> None:
        for axis in self._run.block.axes:
            self._monitoring.lag(axis, on=on)


class DriveObject:
    """A #DRIVE WR block waiting for the drive's answer."""

    def __init__(self, core: Core, block: DriveWrite) -> None:
        self._core = core
        self._block = block
        self._done = False

    @classmethod
    def begin(cls, core: Core, objects: ObjectChannel, block: DriveWrite) -> "DriveObject | None":
        """Order the write; None when it was refused or is not waited for."""
        activity = cls(core, block)
        accepted = functions.write(core, objects, block, activity._answered)
        return activity if accepted and block.wait else None

    def step(self) -> bool:
        """Tell whether the drive has answered."""
        return self._done

    def abort(self) -> None:
        """The order itself goes on in the drive's channel."""

    def _answered(self, refused: SdoAbort | None) -> None:
        self._done = True
        if refused is None:
            return
        late = refused.code == AbortCode.TIME_OUT
        sheet = errors.DRIVE_COMMAND_TIMEOUT if late else errors.DRIVE_COMMAND_NOT_SUPPORTED
        axis = self._core.axis(self._block.axis)
        self._core.report(sheet, self._block.source, axis.number, axis=axis.index, cause=str(refused))


class Dwelling:
    """A G04 block."""

    def __init__(self, core: Core, block: Dwell) -> None:
        self._core = core
        self._until = core.cycle + round(block.seconds * NS_PER_S / core.setup.cycle_ns)
        self._handle = core.watches.watch(cycle_reached(self._until))

    def step(self) -> bool:
        """Tell whether the time is up."""
        if self._core.cycle < self._until:
            return False
        self._core.watches.forget(self._handle)
        return True

    def abort(self) -> None:
        """Wait no longer."""
        self._core.watches.forget(self._handle)
