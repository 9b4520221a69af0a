"""G74: axes home in ascending rank, equal ranks together. Source: homing manual 2.2."""

from collections.abc import Iterator
from functools import partial
from itertools import groupby

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Home
from hli_bench.kernel.core import Core
from hli_bench.kernel.monitoring import Monitoring
from hli_bench.kernel.position_controller import homing
from hli_bench.kernel.position_controller.homing import default
from hli_bench.kernel.sequence import Sequence
from hli_bench.manual.axis.words import HomingType
from hli_bench.manual.errors import axis_manager as manager_errors
from hli_bench.manual.errors import path_interpolator as errors


class HomingOrder:
    """One G74 block on its way."""

    __slots__ = ("_block", "_core", "_groups", "_monitoring", "_running")

    def __init__(self, core: Core, monitoring: Monitoring, block: Home) -> None:
        self._core = core
        self._monitoring = monitoring
        self._block = block
        ranked = sorted(block.ranks.items(), key=lambda item: (item[1], item[0]))
        groups = [[axis for axis, _ in same] for _, same in groupby(ranked, key=lambda item: item[1])]
        self._groups: Iterator[list[AxisIndex]] = iter(groups)
        self._running: list[tuple[homing.Run, Sequence[homing.Run]]] = []

    def step(self) -> bool:
        """Go on; tell whether all axes are done (or an error has ended it)."""
        for _, sequence in self._running:
            sequence.step()
        while all(sequence.ended for _, sequence in self._running):
            for done, _ in self._running:
                self._monitoring.limits(done.axis, on=True)
            if self._core.failed:
                return True
            group = next(self._groups, None)
            if group is None:
                return True
            self._running = []
            for axis in group:
                # Kept one by one: those that are on their way can be stopped whatever becomes of the next.
                if (run := self._begin(axis)) is not None:
                    self._running.append(run)
        return False

    def abort(self) -> None:
        """Stop the axes that are on their way."""
        for run, sequence in self._running:
            if not sequence.ended:
                sequence.abort()
                homing.abandon(run)

    def _begin(self, axis: AxisIndex) -> tuple[homing.Run, Sequence[homing.Run]] | None:
        """Set the axis going; None when it is passed over (P-AXIS-00299).

        IGNORE_ABS_POS on an axis without an absolute system is a warning at each G74 (decided here); the axis is
        passed over all the same (homing manual 4.2).
        """
        setup = self._core.axis(axis)
        kenngr = setup.params.kenngr
        if kenngr.homing.homing_type is HomingType.IGNORE_ABS_POS:
            if not kenngr.abs_pos_gueltig:
                self._core.report(manager_errors.IGNORE_ABS_POS, self._block.source, setup.number, axis=axis)
            return None
        if kenngr.homing.homing_type is HomingType.DISABLED:
            self._core.report(errors.HOMING_DISABLED, self._block.source, setup.number, axis=axis)
            return None
        self._core.referenced[axis] = False
        self._core.show(axis, "lr_state/homing_done_r", False)
        run = homing.Run(self._core, self._block.source, axis, float(self._core.row(axis)["actual"]))
        run.shifts = partial(self._monitoring.limits, axis, on=False)
        # Without an absolute system nobody knows where the axis is until it has its reference.
        self._monitoring.limits(axis, on=True)
        sequence = Sequence(default.table(run), run, default.first(run), self._core.watches)
        return run, sequence
