"""The running path: hold, override, brake. Its numbers are walked by the compiled `act`."""

import numpy as np

from hli_bench.kernel.path_preparation.dynamics import Ramp
from hli_bench.laws.rows import BRAKE, FEEDHOLD, IDLE, RUN, SEGMENTS, SHORT_CUT, KernelRows


class Path:
    """The path of the channel, as the other stages command it."""

    __slots__ = ("_rows",)

    def __init__(self, rows: KernelRows) -> None:
        self._rows = rows

    @property
    def idle(self) -> bool:
        """Nothing moves and nothing is prepared."""
        return bool(self._rows.path[0]["state"] == IDLE)

    @property
    def segment(self) -> int:
        """Number of the running (or last) segment."""
        return int(self._rows.path[0]["head"])

    @property
    def done(self) -> float:
        """Path done in the running segment, 0.1 um."""
        return float(self._rows.path[0]["s"])

    def brake(self, ramp: Ramp) -> None:
        """Brake to standstill with `ramp` and drop the distance to go."""
        path = self._rows.path[0]
        if path["state"] == IDLE:
            return
        path["brake"] = (ramp.low, ramp.high)
        path["brake_split"] = ramp.split
        path["state"] = BRAKE

    def hold(self, *, on: bool) -> None:
        """Feedhold of the channel: the path and what moves by itself stand."""
        self._hold(FEEDHOLD, on=on)

    def hold_for_short_cut(self, *, on: bool) -> bool:
        """Let the path stand because its rest is to be dropped; tell whether there is one under way."""
        self._hold(SHORT_CUT, on=on)
        return bool(self._rows.path[0]["state"] == RUN)

    @property
    def stands(self) -> bool:
        """The path stands, held or at its end."""
        return self.idle or bool(self._rows.path[0]["v"] <= 0.0)

    @property
    def tail(self) -> int:
        """Number of the segment that will be put next."""
        return int(self._rows.path[0]["tail"])

    def drop(self) -> None:
        """Drop all that is prepared; the path must stand, or its axes go on by themselves."""
        path = self._rows.path[0]
        path["state"], path["s"], path["v"] = IDLE, 0.0, 0.0

    def _hold(self, reason: int, *, on: bool) -> None:
        path = self._rows.path[0]
        path["hold"] = path["hold"] | reason if on else path["hold"] & ~np.uint8(reason)

    def override(self, factor: float) -> None:
        """Set the feed override, 1.0 = as programmed."""
        self._rows.path[0]["override"] = factor

    def stop(self) -> None:
        """Brake as at feedhold and drop the distance to go."""
        hold = self._rows.segment[self.segment % SEGMENTS]["hold"]
        self.brake(
            Ramp(float(hold[0]), float(hold[1]), float(self._rows.segment[self.segment % SEGMENTS]["split"]))
        )
