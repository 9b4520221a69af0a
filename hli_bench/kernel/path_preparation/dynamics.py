"""Which accelerations act in which block: G00, G01, feedhold, and the table of a measuring run."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from hli_bench.base.units import tenth_um_from_um_per_s, tenth_um_per_s2
from hli_bench.kernel.setup import AxisSetup
from hli_bench.laws.rows import DYNAMICS, Rows
from hli_bench.manual.axis.fallbacks import (
    TwoStepSlope,
    emergency_deceleration,
    feed_slope,
    feedhold_deceleration,
    homing_acceleration,
    rapid_slope,
)
from hli_bench.manual.axis.getriebe import Getriebe
from hli_bench.manual.channel import ChannelParams


@dataclass(frozen=True, slots=True)
class Ramp:
    """A rate below and above `split`: 0.1 um/s2 and 0.1 um/s. Of one axis, or of a path."""

    low: float
    high: float
    split: float

    def velocity_over(self, way: float) -> float:
        """Return the velocity that this ramp takes to standstill over `way` (0.1 um)."""
        below = self.split**2 / (2.0 * self.low)
        if way <= below:
            return math.sqrt(2.0 * self.low * way)
        return math.sqrt(self.split**2 + 2.0 * self.high * (way - below))


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Ramps that act in a block of one axis; `limit` is its greatest velocity, 0.1 um/s."""

    up: Ramp
    down: Ramp
    hold: Ramp
    limit: float


def rapid(axis: AxisSetup, channel: ChannelParams) -> Dynamics:
    """G00: P-AXIS-00005 / 00006, slowing down with 00280 / 00281 where they are set; P-AXIS-00209."""
    gear = axis.params.getriebe[0]
    return _dynamics(gear, channel, rapid_slope(gear), min(gear.vb_eilgang, gear.dynamik.vb_max))


def feed(axis: AxisSetup, channel: ChannelParams) -> Dynamics:
    """G01: P-AXIS-00011 / 00012, slowing down with 00282 / 00283 where they are set; P-AXIS-00212."""
    gear = axis.params.getriebe[0]
    return _dynamics(gear, channel, feed_slope(gear), gear.dynamik.vb_max)


def measuring(axis: AxisSetup, channel: ChannelParams) -> tuple[Dynamics, Ramp]:
    """Return (profile dynamics, deceleration after the event) of a measuring run.

    Measurement manual 2.1, table for linear slopes. Its third row prints the non-linear P-AXIS-00004 as
    deceleration; rapid traverse deceleration of the linear profile is taken (decided here, decision 0009).
    """
    limit = tenth_um_from_um_per_s(axis.params.getriebe[0].dynamik.vb_max)
    g00, g01 = rapid(axis, channel), feed(axis, channel)
    feedhold = _feedhold(axis.params.getriebe[0])
    if channel.meas_use_std_dynamic:
        return g01, feedhold
    profile = Dynamics(g00.up, g00.down, g00.hold, limit)
    if channel.meas_deceleration_mode == 0 and channel.use_drive_curr_limit:
        return profile, feedhold
    return profile, g00.down


def homing_rate(axis: AxisSetup) -> float:
    """Return the acceleration of homing motions (P-AXIS-00285, else the smaller of 00005 and 00006), 0.1 um/s2."""
    return tenth_um_per_s2(homing_acceleration(axis.params.getriebe[0]))


def emergency_rate(axis: AxisSetup) -> float:
    """Return the deceleration of an emergency stop (P-AXIS-00003, else 00008), 0.1 um/s2."""
    return tenth_um_per_s2(emergency_deceleration(axis.params.getriebe[0]))


def controlled_rate(axis: AxisSetup) -> float:
    """Return the deceleration of an axis that stops by itself with its loop closed, as at feedhold, 0.1 um/s2."""
    return tenth_um_per_s2(feedhold_deceleration(axis.params.getriebe[0]))


def rows(kinds: Iterable[Iterable[Dynamics]]) -> Rows:
    """Return what the axes may do in each kind of way as rows for the laws, shape (k, n)."""
    return np.array(
        [
            [
                (*((ramp.low, ramp.high, ramp.split) for ramp in (one.up, one.down, one.hold)), one.limit)
                for one in dynamics
            ]
            for dynamics in kinds
        ],
        DYNAMICS,
    )


def ramp_along(ramps: Sequence[Ramp], direction: Sequence[float]) -> Ramp:
    """Return the ramp that a path may use so that no axis exceeds its own."""
    parts = [abs(part) for part in direction]
    return Ramp(
        min(one.low / part for one, part in zip(ramps, parts, strict=True)),
        min(one.high / part for one, part in zip(ramps, parts, strict=True)),
        min(one.split / part for one, part in zip(ramps, parts, strict=True)),
    )


def _dynamics(gear: Getriebe, channel: ChannelParams, slope: TwoStepSlope, limit_um_per_s: int) -> Dynamics:
    split = tenth_um_from_um_per_s(slope.changeover)
    up = Ramp(tenth_um_per_s2(slope.acceleration_1), tenth_um_per_s2(slope.acceleration_2), split)
    down = Ramp(tenth_um_per_s2(slope.deceleration_1), tenth_um_per_s2(slope.deceleration_2), split)
    hold = _feedhold(gear) if channel.use_drive_curr_limit else down
    return Dynamics(up, down, hold, tenth_um_from_um_per_s(limit_um_per_s))


def _feedhold(gear: Getriebe) -> Ramp:
    rate = tenth_um_per_s2(feedhold_deceleration(gear))
    return Ramp(rate, rate, 0.0)
