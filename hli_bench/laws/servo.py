"""One axis: cyclic position servo, motor, mechanics, fixed stop, and the supervision of its following error."""

import math

import numpy as np

from hli_bench.laws.compiled import law
from hli_bench.laws.integers import wrap32
from hli_bench.laws.rows import Row

STANDSTILL = 1e-6
"""Motor speed below which static friction may hold, rad/s."""
FOLLOWING_ERROR = 0x8611


@law
def count(row: Row, angle: float) -> int:
    """Return the encoder count (unwrapped) of an axis at a motor angle."""
    return int(math.floor(angle * row["increments_per_rad"] + 0.5)) + row["encoder_offset"]


@law
def servo_span(row: Row) -> float:
    """Return the way (increments) from the present demand to the newest target, the short way round 32 bits."""
    return float(wrap32(int(row["target"]) - int(math.floor(row["demand_from"] + 0.5)))) + (
        math.floor(row["demand_from"] + 0.5) - row["demand_from"]
    )


@law
def stop_span(row: Row, cycle: float) -> float:
    """Return the way (increments) of a set point that comes to a stop along its ramp, and slow it down."""
    speed = row["stop_speed"]
    rate = row["stop_rate"]
    if abs(speed) <= rate * cycle:
        row["stop_speed"] = 0.0
        return 0.5 * speed * abs(speed) / rate
    step = math.copysign(rate * cycle, speed)
    row["stop_speed"] = speed - step
    return (speed - 0.5 * step) * cycle


@law
def pushed(row: Row, angle: float, speed: float) -> float:
    """Return the torque with which a fixed stop pushes back."""
    side = row["stop_side"]
    if side != 0:
        depth = (angle - row["stop_angle"]) * side
        if depth > 0.0:
            push = row["stop_stiffness"] * depth + row["stop_damping"] * speed * side
            if push > 0.0:
                return -push * side
    return 0.0


@law
def move_axis(row: Row, sub_steps: int, time: float, cycle: float) -> None:
    """Move one axis by one cycle: servo and mechanics, sub-step after sub-step of `time` seconds.

    Servo: position P with velocity feed-forward, speed PI, torque clamp that holds the integrator. Mechanics:
    friction with stiction, fixed stop, inertia, semi-implicit Euler. The angles go into `angles`.
    An axis at rest whose last cycle changed nothing would come out the same again, and is left as it is.
    """
    whole = row["span"]
    both = min(row["torque_limit_permille"], row["peak_permille"])
    limit = min(both, row["positive_permille"]) * 1e-3 * row["rated_torque"]
    lower = -min(both, row["negative_permille"]) * 1e-3 * row["rated_torque"]
    if row["resting_limit"][0] == limit and row["resting_limit"][1] == -lower and whole == 0.0:
        row["status_flags"] |= row["resting_flags"]
        return
    angles = row["angles"]
    angle = row["angle"]
    speed = row["speed"]
    integrator = row["integrator"]
    per_rad = row["increments_per_rad"]
    offset = row["encoder_offset"]
    kv = row["kv"] / per_rad
    gain = row["speed_gain"]
    integral_gain = row["speed_integral_gain"]
    inertia = row["inertia"]
    viscous = row["viscous"]
    coulomb = row["coulomb"]
    static = row["static"]
    demand_from = row["demand_from"]
    feed_forward = whole / cycle / per_rad
    per_torque = time / inertia
    lowest = angle
    highest = angle
    torque = 0.0
    flags = 0
    angles[0] = angle
    for sub in range(sub_steps):
        demand = demand_from + whole * (sub / sub_steps)
        position = np.floor(angle * per_rad + 0.5)
        error = kv * (demand - offset - position) + feed_forward - speed
        torque = gain * error + integrator
        if torque > limit:
            torque = limit
            flags = 0x0800
        elif torque < lower:
            torque = lower
            flags = 0x0800
        else:
            integrator += integral_gain * error * time
        acting = torque + pushed(row, angle, speed)
        if abs(speed) < STANDSTILL and abs(acting) <= static:
            speed = 0.0
        else:
            friction = math.copysign(coulomb, acting if abs(speed) < STANDSTILL else speed)
            after = speed + per_torque * (acting - viscous * speed - friction)
            if speed * after < 0.0 and abs(acting) <= static:
                after = 0.0
            speed = after
            angle += after * time
        angles[sub + 1] = angle
        lowest = min(lowest, angle)
        highest = max(highest, angle)
    rests = (
        whole == 0.0
        and speed == 0.0
        and row["speed"] == 0.0
        and angle == row["angle"]
        and integrator == row["integrator"]
    )
    row["resting_limit"][0] = limit if rests else -1.0
    row["resting_limit"][1] = -lower if rests else -1.0
    row["resting_flags"] = flags
    row["angle"] = angle
    row["speed"] = speed
    row["integrator"] = integrator
    row["torque"] = torque
    row["angle_low"] = lowest
    row["angle_high"] = highest
    row["status_flags"] |= flags


@law
def coast_axis(row: Row, sub_steps: int, time: float) -> None:
    """Move an axis without power by one cycle: friction, its brake if it has one, a fixed stop. It may stand."""
    angle = row["angle"]
    speed = row["speed"]
    static = row["static"] + row["brake"]
    row["resting_limit"][0] = -1.0
    row["resting_limit"][1] = -1.0
    row["integrator"] = 0.0
    row["torque"] = 0.0
    row["angles"][0] = angle
    lowest = angle
    highest = angle
    stands = abs(speed) < STANDSTILL and abs(pushed(row, angle, speed)) <= static
    per_torque = time / row["inertia"] if not stands else 0.0
    for sub in range(sub_steps):
        acting = 0.0 if stands else pushed(row, angle, speed)
        if abs(speed) < STANDSTILL and abs(acting) <= static:
            speed = 0.0
        else:
            friction = math.copysign(
                row["coulomb"] + row["brake"], acting if abs(speed) < STANDSTILL else speed
            )
            after = speed + per_torque * (acting - row["viscous"] * speed - friction)
            if speed * after < 0.0 and abs(acting) <= static:
                after = 0.0
            speed = after
            angle += after * time
        row["angles"][sub + 1] = angle
        lowest = min(lowest, angle)
        highest = max(highest, angle)
    row["angle"] = angle
    row["speed"] = speed
    row["demand_from"] = float(count(row, angle))
    row["angle_low"] = lowest
    row["angle_high"] = highest


@law
def supervise(row: Row, cycle_ns: int) -> None:
    """Watch the following error (6065 for 6066 ms) and set the law's statusword bits."""
    window = row["following_window"]
    if row["enabled"] == 0 or window == 0xFFFFFFFF or window == 0 or abs(row["following_error"]) <= window:
        row["following_elapsed_ns"] = 0
    else:
        row["status_flags"] |= 0x2000
        row["following_elapsed_ns"] += cycle_ns
        if (
            row["following_elapsed_ns"] > np.int64(row["following_timeout_ms"]) * 1_000_000
            and row["fault"] == 0
        ):
            row["fault"] = FOLLOWING_ERROR
    if row["enabled"] and row["stop_rate"] == 0.0:
        row["status_flags"] |= 0x1000
