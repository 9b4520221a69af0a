"""Linear slope profile in closed form: accelerate, cruise, brake with constant rates, to the exact end of a segment.

Two rates act, below and above a `split` velocity (stage 1 and stage 2). The state after a step depends on
the present state only, so an override, a feedhold or a raised end velocity needs no re-planning.
"""

import math

from hli_bench.laws.compiled import law

TINY = 1e-7
"""Path below which a segment counts as done, 0.1 um."""


@law
def braking_path(v: float, v_end: float, low: float, high: float, split: float) -> float:
    """Return the path (0.1 um) needed to slow from `v` to `v_end` with the rates `low` / `high`."""
    if v <= v_end:
        return 0.0
    if v <= split or split <= 0.0:
        rate = low if split > 0.0 else high
        return (v * v - v_end * v_end) / (2.0 * rate)
    if v_end >= split:
        return (v * v - v_end * v_end) / (2.0 * high)
    return (v * v - split * split) / (2.0 * high) + (split * split - v_end * v_end) / (2.0 * low)


@law
def peak_velocity(
    v: float, rest: float, v_end: float, up: float, low: float, high: float, split: float
) -> float:
    """Return the velocity at which braking must begin when accelerating with `up` from `v` over `rest`."""
    if v < split:
        square = (2.0 * up * low * rest + low * v * v + up * v_end * v_end) / (up + low)
    else:
        down_to = v_end
        if v_end < split:
            rest -= (split * split - v_end * v_end) / (2.0 * low)
            down_to = split
        square = (2.0 * up * high * rest + high * v * v + up * down_to * down_to) / (up + high)
    return math.sqrt(square) if square > 0.0 else 0.0


@law
def advance(
    s: float,
    v: float,
    length: float,
    v_end: float,
    v_wanted: float,
    up_low: float,
    up_high: float,
    down_low: float,
    down_high: float,
    split: float,
    time: float,
) -> tuple[float, float, float]:
    """Return (path, velocity, time left) after `time` seconds; time is left only when the end was reached."""
    at_curve = False
    while time > 0.0:
        rest = length - s
        if rest <= TINY:
            return length, min(v, v_end), time
        brake = braking_path(v, v_end, down_low, down_high, split)
        if v > v_end and (at_curve or rest <= brake + TINY):
            # the rate that meets the end exactly; it differs from the nominal one by rounding only
            slow = (split * split - v_end * v_end) / (2.0 * down_low)
            above = v > split > v_end and rest > slow
            if above:
                rate = (v * v - split * split) / (2.0 * (rest - slow))
                lasts = 2.0 * (rest - slow) / (v + split)
            else:
                rate = (v * v - v_end * v_end) / (2.0 * rest)
                lasts = 2.0 * rest / (v + v_end)
            step = min(lasts, time)
            s += v * step - 0.5 * rate * step * step
            time -= step
            if step < lasts:
                v -= rate * step
            elif above:
                v = split
            else:
                return length, v_end, time
        elif v > v_wanted:
            above = v > split
            rate = down_high if above or split <= 0.0 else down_low
            floor = split if above and v_wanted < split else v_wanted
            lasts = (v - floor) / rate
            step = min(lasts, time)
            path = v * step - 0.5 * rate * step * step
            if path > rest:
                # the end comes first: leave it with the velocity reached there
                v_at = math.sqrt(max(v * v - 2.0 * rate * rest, 0.0))
                return length, v_at, time - (v - v_at) / rate
            s += path
            time -= step
            v = floor if step == lasts else v - rate * step
        elif v < v_wanted:
            below = v < split
            rate = up_low if below else up_high
            peak = peak_velocity(v, rest, v_end, rate, down_low, down_high, split)
            top = min(v_wanted, split) if below else v_wanted
            reachable = math.sqrt(v * v + 2.0 * rate * rest)
            top = max(min(top, peak, reachable), v)
            if top - v <= 1e-12 * (1.0 + v):
                if v <= 0.0:
                    return length, v_end, time
                if v > v_end:
                    at_curve = True
                else:
                    v_wanted = v  # rounding has left it a hair below: there is nothing to gain
                continue
            lasts = (top - v) / rate
            step = min(lasts, time)
            s += v * step + 0.5 * rate * step * step
            time -= step
            v = top if step == lasts else v + rate * step
            if step == lasts and top == reachable:
                return length, v, time
        else:
            if v <= 0.0:
                return s, 0.0, 0.0
            room = rest - brake
            lasts = room / v
            step = min(lasts, time)
            s += v * step
            time -= step
            if step == lasts and brake == 0.0:
                return length, v, time
    return min(s, length), v, 0.0


@law
def ramp(v: float, wanted: float, rate: float, time: float) -> tuple[float, float]:
    """Return (path, velocity) after `time` seconds of approaching `wanted` (signed) with `rate`."""
    lasts = abs(wanted - v) / rate if rate > 0.0 else 0.0
    if lasts <= time:
        path = 0.5 * (v + wanted) * lasts + wanted * (time - lasts)
        return path, wanted
    after = v + math.copysign(rate * time, wanted - v)
    return 0.5 * (v + after) * time, after
