"""What is watched all the time: position lag (type 4 of P-AXIS-00172). Drives: see drive_manager/supervision.py."""

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.core import Core
from hli_bench.kernel.path_preparation.limits import limited
from hli_bench.kernel.watches import lag_over, outside, standstill_lag_over
from hli_bench.laws.rows import FOLLOW
from hli_bench.manual.errors import position_controller as errors

LAG_TYPE = 4
STANDSTILL_CYCLES = 100
"""An axis may need this long to come to rest behind its set point (decided here)."""


class Monitoring:
    """Holds the permanent conditions of every axis."""

    __slots__ = ("_core", "_handles", "_lag", "_limits", "_tripped")

    def __init__(self, core: Core) -> None:
        self._core = core
        self._lag: dict[AxisIndex, tuple[int, int]] = {}
        self._limits: dict[AxisIndex, int] = {}
        self._tripped: set[AxisIndex] = set()
        self._handles: list[int] = []
        """Of all conditions."""

    def switch_on(self, axis: AxisIndex) -> None:
        """Begin to watch an axis whose drive is in operation."""
        self.lag(axis, on=True)
        self.limits(axis, on=True)

    def switch_off(self, axis: AxisIndex) -> None:
        """Stop watching an axis."""
        self.lag(axis, on=False)
        self.limits(axis, on=False)

    def lag(self, axis: AxisIndex, *, on: bool) -> None:
        """Switch the position lag monitoring of an axis; off during a run to a fixed stop."""
        for handle in self._lag.pop(axis, ()):
            self._core.watches.forget(handle)
        params = self._core.axis(axis).params
        gear = params.getriebe[0]
        if on and gear.slep_ueberw_typ == LAG_TYPE and not params.lr_param.suppress_pos_lag_error:
            delay = 1 + gear.pos_lag_mon_error_delay_time * 1000 // self._core.setup.cycle_ns
            standing = standstill_lag_over(axis, gear.slep_min, max(delay, STANDSTILL_CYCLES))
            watch = self._core.watches.watch
            self._lag[axis] = watch(lag_over(axis, gear.slep_max, delay)), watch(standing)
        self._gather()

    def limits(self, axis: AxisIndex, *, on: bool) -> None:
        """Watch actual positions against the software limits and P-AXIS-00179, where they hold.

        An axis that stands beyond them may move back, and no further away.
        """
        if axis in self._limits:
            self._core.watches.forget(self._limits.pop(axis))
        if on and limited(self._core, axis):
            kenngr, actual = self._core.axis(axis).params.kenngr, float(self._core.row(axis)["actual"])
            low, high = min(kenngr.swe_neg, actual), max(kenngr.swe_pos, actual)
            tolerance = kenngr.swe_toleranz
            self._limits[axis] = self._core.watches.watch(outside(axis, low - tolerance, high + tolerance))
        self._gather()

    def _gather(self) -> None:
        self._handles = [handle for pair in self._lag.values() for handle in pair]
        self._handles += self._limits.values()

    def rearm(self) -> None:
        """Watch the lag again where it has tripped, and the limits as they hold now: no program runs without."""
        for axis in self._tripped:
            self.lag(axis, on=True)
        for one in self._core.setup.axes:
            self.limits(one.index, on=self._core.row(one.index)["mode"] != FOLLOW)

    def take_tripped(self) -> list[AxisIndex]:
        """Return the axes that have left their lag limits since the last call."""
        tripped = sorted(self._tripped)
        self._tripped.clear()
        return tripped

    def check(self, source: Source) -> None:
        """Report what was found since the last call."""
        core = self._core
        if not core.watches.any_met(self._handles):
            return
        self._check_limits(source)
        for axis, (moving, standing) in list(self._lag.items()):
            row = core.row(axis)
            gear = core.axis(axis).params.getriebe[0]
            number, lag = core.axis(axis).number, round(abs(float(row["lag"])))
            if core.watches.met(moving):
                core.report(errors.POSITION_LAG, source, number, lag, gear.slep_max, axis=axis)
            elif core.watches.met(standing):
                core.report(errors.POSITION_LAG_AT_STANDSTILL, source, number, lag, gear.slep_min, axis=axis)
            else:
                continue
            self.lag(axis, on=False)
            self._tripped.add(axis)
            core.show(axis, "head/error_r", True)

    def _check_limits(self, source: Source) -> None:
        core = self._core
        for axis in [axis for axis, handle in self._limits.items() if core.watches.met(handle)]:
            kenngr, actual = core.axis(axis).params.kenngr, round(float(core.row(axis)["actual"]))
            beyond, limit = errors.POSITIVE_SOFTWARE_LIMIT, kenngr.swe_pos
            if actual < kenngr.swe_neg:
                beyond, limit = errors.NEGATIVE_SOFTWARE_LIMIT, kenngr.swe_neg
            core.report(beyond, source, core.axis(axis).number, actual, limit, axis=axis)
            self.limits(axis, on=False)
            core.show(axis, "head/error_r", True)
