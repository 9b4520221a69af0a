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
def move_axis(row: Row, sub_steps: int, time: float, cycle: float) -> None:
    """Move one axis by one cycle: servo and mechanics, sub-step after sub-step of `time` seconds.

    Servo: position P with velocity feed-forward, speed PI, torque clamp that holds the integrator. Mechanics:
    friction with stiction, fixed stop, inertia, semi-implicit Euler. The angles go into `angles`.
    An axis at rest whose last cycle changed nothing would come out the same again, and is left as it is.
    """
    whole = servo_span(row)
    limit = min(row["torque_limit_permille"], row["peak_permille"]) * 1e-3 * row["rated_torque"]
    if row["resting_limit"] == limit and whole == 0.0:
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
    side = row["stop_side"]
    stop_angle = row["stop_angle"]
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
        elif torque < -limit:
            torque = -limit
            flags = 0x0800
        else:
            integrator += integral_gain * error * time
        acting = torque
        if side != 0:
            depth = (angle - stop_angle) * side
            if depth > 0.0:
                push = row["stop_stiffness"] * depth + row["stop_damping"] * speed * side
                if push > 0.0:
                    acting -= push * side
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
    row["resting_limit"] = limit if rests else -1.0
    row["resting_flags"] = flags
    row["angle"] = angle
    row["speed"] = speed
    row["integrator"] = integrator
    row["torque"] = torque
    row["angle_low"] = lowest
    row["angle_high"] = highest
    row["status_flags"] |= flags


@law
def rest_axis(row: Row, sub_steps: int) -> None:
    """Let an axis without power stand (its brake holds)."""
    angle = row["angle"]
    row["resting_limit"] = -1.0
    row["demand_from"] = float(count(row, angle))
    row["integrator"] = 0.0
    row["speed"] = 0.0
    row["torque"] = 0.0
    row["angle_low"] = angle
    row["angle_high"] = angle
    for sub in range(sub_steps + 1):
        row["angles"][sub] = angle


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
    if row["enabled"]:
        row["status_flags"] |= 0x1000
