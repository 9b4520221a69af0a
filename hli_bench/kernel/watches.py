"""Conditions as data: rows that the compiled `sense` asks once a cycle, handed out and taken back here."""

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Final

from hli_bench.base.errors import BenchError
from hli_bench.laws import rows as law

ROOM: Final = 64
"""Conditions that can be watched at the same time, beside those of the axes (decided here)."""
ROOM_OF_AXIS: Final = 8
"""Conditions of one axis: monitoring, start-up, homing, measuring (decided here)."""


def room(axes: int) -> int:
    """Return how many conditions can be watched on a machine with `axes` axes."""
    return ROOM + ROOM_OF_AXIS * axes


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """One condition: it is met when it has held in `cycles` cycles in a row. See the W_ kinds of `laws.rows`."""

    kind: int
    axis: int = 0
    limit: float = 0.0
    window: float = -1.0
    mask: int = 0
    value: int = 0
    cycles: int = 1


def path_done() -> Condition:
    """The path has come to its end or has been braked to standstill."""
    return Condition(kind=law.W_PATH_DONE)


def path_stands() -> Condition:
    """The path stands: held, or at its end."""
    return Condition(kind=law.W_PATH_STANDS)


def segment_reached(number: int) -> Condition:
    """The interpolator has begun segment `number`."""
    return Condition(kind=law.W_SEGMENT, limit=float(number))


def jog_stopped(axis: int) -> Condition:
    """An axis moving by itself stands (its set point does)."""
    return Condition(kind=law.W_JOG_STOPPED, axis=axis)


def lag_over(axis: int, limit_tenth_um: float, cycles: int = 1) -> Condition:
    """The position lag is larger than the limit."""
    return Condition(kind=law.W_LAG_OVER, axis=axis, limit=limit_tenth_um, cycles=cycles)


def standstill_lag_over(axis: int, limit_tenth_um: float, cycles: int = 1) -> Condition:
    """The position lag is larger than the limit while the set point stands."""
    return Condition(kind=law.W_STANDSTILL_LAG_OVER, axis=axis, limit=limit_tenth_um, cycles=cycles)


def outside(axis: int, low_tenth_um: float, high_tenth_um: float) -> Condition:
    """The actual position is outside of a range."""
    return Condition(kind=law.W_OUTSIDE, axis=axis, limit=high_tenth_um, window=low_tenth_um)


def lag_within(axis: int, limit_tenth_um: float, cycles: int = 1) -> Condition:
    """The position lag is not larger than the limit."""
    return Condition(kind=law.W_LAG_WITHIN, axis=axis, limit=limit_tenth_um, cycles=cycles)


def fixed_stop(axis: int, lag: float, window: float, cycles: int, from_path: int) -> Condition:
    """Lag over `lag` (0: not asked) and moved at most `window` in `cycles` (< 0: not asked), behind `from_path`."""
    return Condition(
        kind=law.W_FIXED_STOP, axis=axis, limit=lag, window=window, value=from_path, cycles=max(cycles, 1)
    )


def moved(axis: int, way_tenth_um: float, from_tenth_um: float) -> Condition:
    """The axis is at least `way_tenth_um` away from a position."""
    return Condition(kind=law.W_MOVED, axis=axis, limit=way_tenth_um, window=from_tenth_um)


def probe_status(axis: int, mask: int, value: int) -> Condition:
    """Bits of the drive's touch probe status."""
    return Condition(kind=law.W_PROBE_STATUS, axis=axis, mask=mask, value=value)


def statusword(axis: int, mask: int, value: int) -> Condition:
    """Bits of the drive's statusword."""
    return Condition(kind=law.W_STATUSWORD, axis=axis, mask=mask, value=value)


def statusword_left(axis: int, mask: int, value: int) -> Condition:
    """Bits of the drive's statusword are no longer what they were."""
    return Condition(kind=law.W_STATUSWORD_LEFT, axis=axis, mask=mask, value=value)


def digital_input(axis: int, mask: int, value: int) -> Condition:
    """Bits of the drive's digital inputs."""
    return Condition(kind=law.W_DIGITAL_INPUT, axis=axis, mask=mask, value=value)


def cycle_reached(cycle: int) -> Condition:
    """Time is up."""
    return Condition(kind=law.W_CYCLE, limit=float(cycle))


class Watches:
    """Hands out watch rows, the lowest first; a handle is the number of its row. Rows behind the last cost nothing."""

    __slots__ = ("_fired", "_gaps", "_kind", "_row", "_used")

    def __init__(self, watch: law.Rows) -> None:
        self._row = watch
        self._kind, self._fired = watch["kind"], watch["fired"]
        self._gaps: list[int] = []
        """Rows that were given back, as a heap; those from `_used` on do not count."""
        self._used = 0

    def watch(self, condition: Condition) -> int:
        """Put a condition under watch and return its handle. Raises BenchError when no row is left."""
        handle = self._free()
        one = condition
        given = one.kind, one.axis, one.limit, one.window, one.mask, one.value, one.cycles
        self._row[handle] = (*given, 0, 0)  # count and fired begin anew
        return handle

    def met(self, handle: int) -> bool:
        """Tell whether the condition has been met since it was put under watch."""
        return bool(self._fired[handle])

    def any_met(self, handles: Sequence[int]) -> bool:
        """Tell whether one of several conditions has been met."""
        return any(map(self._fired.item, handles))

    def forget(self, handle: int) -> None:
        """Take a condition back; one that has been taken back already stays so."""
        if self._kind[handle] in (law.W_FREE, law.W_NONE):
            return
        self._fired[handle] = 0
        self._kind[handle] = law.W_FREE
        heappush(self._gaps, handle)
        while self._used and self._kind[self._used - 1] == law.W_FREE:
            self._used -= 1
            self._kind[self._used] = law.W_NONE

    def _free(self) -> int:
        """Return the lowest row that is not in use."""
        while self._gaps:
            handle = heappop(self._gaps)
            if handle < self._used:
                return handle
        if self._used == len(self._row):
            raise BenchError(f"more than {len(self._row)} conditions to be watched at the same time")
        self._used += 1
        return self._used - 1
