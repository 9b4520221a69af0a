"""What is watched all the time: position lag (type 4 of P-AXIS-00172) and faults of the drives."""

import struct

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.core import Core
from hli_bench.kernel.watches import lag_over, standstill_lag_over, statusword
from hli_bench.manual.errors import position_controller as errors
from hli_bench.protocols.canopen.cia402 import STATES
from hli_bench.wire.can import CanFrame

LAG_TYPE = 4
STANDSTILL_CYCLES = 100
"""An axis may need this long to come to rest behind its set point (decided here)."""


class Monitoring:
    """Holds the permanent conditions of every axis."""

    __slots__ = ("_core", "_emergency", "_fault", "_handles", "_lag", "_tripped")

    def __init__(self, core: Core) -> None:
        self._core = core
        self._fault: dict[AxisIndex, int] = {}
        self._lag: dict[AxisIndex, tuple[int, int]] = {}
        self._emergency: dict[AxisIndex, int] = {}
        self._tripped: set[AxisIndex] = set()
        self._handles: list[int] = []
        """Of all conditions."""

    def switch_on(self, axis: AxisIndex) -> None:
        """Begin to watch an axis whose drive is in operation."""
        self.switch_off(axis)
        self._fault[axis] = self._core.watches.watch(statusword(axis, *STATES["fault"]))
        self.lag(axis, on=True)

    def switch_off(self, axis: AxisIndex) -> None:
        """Stop watching an axis."""
        self.lag(axis, on=False)
        if axis in self._fault:
            self._core.watches.forget(self._fault.pop(axis))
        self._gather()

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

    def _gather(self) -> None:
        self._handles = [*self._fault.values(), *(handle for pair in self._lag.values() for handle in pair)]

    def rearm(self) -> None:
        """Watch the position lag again where it has tripped: no program runs without."""
        for axis in self._tripped:
            self.lag(axis, on=True)

    def take_tripped(self) -> list[AxisIndex]:
        """Return the axes that have left their lag limits since the last call."""
        tripped = sorted(self._tripped)
        self._tripped.clear()
        return tripped

    def emergency(self, frame: CanFrame) -> None:
        """Keep the code of an EMCY frame for the report of the fault."""
        for axis in self._core.setup.axes:
            if frame.cob_id == 0x80 + axis.node and len(frame.data) >= 2:
                self._emergency[axis.index] = int(struct.unpack_from("<H", frame.data)[0])

    def check(self, source: Source) -> list[AxisIndex]:
        """Report what was found since the last call; return the axes with a drive fault."""
        core = self._core
        if not core.watches.any_met(self._handles):
            return []
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
        faulted = [axis for axis, handle in self._fault.items() if core.watches.met(handle)]
        for axis in faulted:
            self.switch_off(axis)
            code = self._emergency.get(axis, 0)
            core.report(errors.CANOPEN_DRIVE_ERROR, source, core.axis(axis).number, f"{code:#06x}", axis=axis)
        return faulted
