"""Machine side of a cycle: cyclic position servos, mechanics, contact, spatial switches, edges and their latches.

A cycle is walked in equal sub-steps, axis by axis: nothing that happens at a switch acts back on the motion in
the same cycle. Within a sub-step an axis moves with constant speed, so the instant at which it crosses a threshold
is exact. Only when an axis may have reached a threshold are the sub-steps gone through for edges, in the order of
their instants.
"""

import math

import numpy as np

from hli_bench.laws.compiled import law
from hli_bench.laws.rows import NOISE, Rows

STANDSTILL = 1e-6
"""Motor speed below which static friction may hold, rad/s."""
FOLLOWING_ERROR = 0x8611
NEVER = np.iinfo(np.int64).max


@law
def wrap32(value: int) -> int:
    """Return `value` as it shows in a signed 32-bit object."""
    return (int(value) + 0x80000000) % 0x100000000 - 0x80000000


@law
def count(servo: Rows, axis: int, angle: float) -> int:
    """Return the encoder count (unwrapped) of `axis` at a motor angle."""
    return int(math.floor(angle * servo[axis]["increments_per_rad"] + 0.5)) + servo[axis]["encoder_offset"]


@law
def move_axis(servo: Rows, axis: int, sub_steps: int, time: float, cycle: float) -> None:
    """Move one axis by one cycle: servo and mechanics, sub-step after sub-step of `time` seconds.

    Servo: position P with velocity feed-forward, speed PI, torque clamp that holds the integrator. Mechanics:
    friction with stiction, fixed stop, inertia, semi-implicit Euler. The angles go into `angles`.
    An axis at rest whose last cycle changed nothing would come out the same again, and is left as it is.
    """
    row = servo[axis]
    whole = servo_span(servo, axis)
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
    kv = row["kv"]
    gain = row["speed_gain"]
    integral_gain = row["speed_integral_gain"]
    inertia = row["inertia"]
    viscous = row["viscous"]
    coulomb = row["coulomb"]
    static = row["static"]
    side = row["stop_side"]
    stop_angle = row["stop_angle"]
    demand_from = row["demand_from"]
    feed_forward = whole / cycle
    lowest = angle
    highest = angle
    torque = 0.0
    flags = 0
    angles[0] = angle
    for sub in range(sub_steps):
        demand = demand_from + whole * (sub / sub_steps)
        position = float(int(math.floor(angle * per_rad + 0.5)))
        wanted = (kv * (demand - offset - position) + feed_forward) / per_rad
        error = wanted - speed
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
            after = speed + time / inertia * (acting - viscous * speed - friction)
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
def rest_axis(servo: Rows, axis: int, sub_steps: int) -> None:
    """Let an axis without power stand (its brake holds)."""
    row = servo[axis]
    angle = row["angle"]
    row["resting_limit"] = -1.0
    row["demand_from"] = float(count(servo, axis, angle))
    row["integrator"] = 0.0
    row["speed"] = 0.0
    row["torque"] = 0.0
    row["angle_low"] = angle
    row["angle_high"] = angle
    for sub in range(sub_steps + 1):
        row["angles"][sub] = angle


@law
def probe_edge(
    servo: Rows, axis: int, number: int, level: int, position: int, at_dc_ns: int, zero_pulse: int
) -> None:
    """Latch a touch probe input's edge (CiA 402, 60B8..60BD): input `number` 0 or 1, or the zero pulse.

    The time latch (60D1..60D4) holds the low 32 bits of the DC time.
    """
    row = servo[axis]
    shift = 8 * number
    function = row["probe_function"] >> shift
    if function & 0x01 == 0 or ((function & 0x04) != 0) != (zero_pulse != 0):
        return
    if function & (0x10 if level else 0x20) == 0:
        return
    stored = (0x02 if level else 0x04) << shift
    if row["probe_status"] & stored and function & 0x02 == 0:
        return
    slot = 2 * number + (0 if level else 1)
    row["latch"][slot] = wrap32(position)
    row["latch_time"][slot] = at_dc_ns % 0x100000000
    row["probe_status"] |= stored


@law
def probe_arm(servo: Rows, axis: int) -> None:
    """Take over a changed touch probe function: the status of an input clears when its enable bit rises or falls."""
    row = servo[axis]
    new = row["probe_function"]
    old = row["probe_function_seen"]
    if new == old:
        return
    for number in range(2):
        bit = 0x01 << (8 * number)
        if (new ^ old) & bit:
            row["probe_status"] &= 0xFFFF ^ (0xFF << (8 * number))
            if new & bit:
                row["probe_status"] |= bit
    row["probe_function_seen"] = new


@law
def channel_settle(channel: Rows, number: int, now_ns: int, dc_epoch_ns: int) -> None:
    """Let an edge whose input delay is over by `now_ns` through: level and time latch."""
    row = channel[number]
    due = row["level_due_ns"]
    if due > now_ns:
        return
    level = row["level_next"]
    row["level"] = level
    row["level_due_ns"] = NEVER
    bit = 1 if level else 2
    if row["single_event"] and row["taken"] & bit:
        return
    row["taken"] |= bit
    if level:
        row["latch_pos"] = dc_epoch_ns + due + row["skew_ns"]
    else:
        row["latch_neg"] = dc_epoch_ns + due + row["skew_ns"]


@law
def channel_edge(channel: Rows, number: int, level: int, at_ns: int, dc_epoch_ns: int) -> None:
    """Take an edge into a terminal channel; a pulse shorter than the input delay does not get through."""
    channel_settle(channel, number, at_ns, dc_epoch_ns)
    row = channel[number]
    if level == row["level"]:
        row["level_due_ns"] = NEVER
    else:
        row["level_next"] = level
        row["level_due_ns"] = at_ns + row["delay_ns"]


@law
def channel_image(channel: Rows, number: int, now_ns: int, dc_epoch_ns: int) -> None:
    """Refresh what the process image shows at `now_ns`; reading frees the latches of single-event mode."""
    channel_settle(channel, number, now_ns, dc_epoch_ns)
    row = channel[number]
    row["input"] = row["level"]
    row["status"] = 0
    if row["single_event"]:
        row["status"] = 1 if row["level"] else (row["taken"] & 2)
        row["taken"] = 0


@law
def signal_level(signal: Rows, number: int) -> int:
    """Return the level that wires carry: forced (a fault) or operated."""
    row = signal[number]
    if row["forced"] >= 0:
        return int(row["forced"])
    return 1 if row["operated"] > 0 else 0


@law
def distribute(
    servo: Rows,
    signal: Rows,
    channel: Rows,
    edge: Rows,
    edges: Rows,
    number: int,
    at_ns: int,
    sub: int,
    begin_ns: int,
    step_ns: int,
    dc_epoch_ns: int,
) -> None:
    """Set a signal's level after a change and hand the edge, if it is one, to everything wired to it."""
    level = signal_level(signal, number)
    if level == signal[number]["level"]:
        return
    signal[number]["level"] = level
    if edges[0] < edge.shape[0]:
        edge[edges[0]]["at_ns"] = at_ns
        edge[edges[0]]["signal"] = number
        edge[edges[0]]["level"] = level
        edges[0] += 1
    for c in range(channel.shape[0]):
        if channel[c]["signal"] == number:
            channel_edge(channel, c, level, at_ns, dc_epoch_ns)
    part = (at_ns - begin_ns) / step_ns
    for axis in range(servo.shape[0]):
        row = servo[axis]
        for i in range(2):
            if row["probe_signal"][i] == number:
                before = row["angles"][sub]
                angle = before + part * (row["angles"][sub + 1] - before)
                probe_edge(servo, axis, i, level, count(servo, axis, angle), dc_epoch_ns + at_ns, 0)
        for i in range(8):
            if row["input_signal"][i] == number:
                if level:
                    row["digital_inputs"] |= np.uint32(1) << np.uint32(i)
                else:
                    row["digital_inputs"] &= ~(np.uint32(1) << np.uint32(i))


@law
def crossing(before: float, after: float, threshold: float, begin_ns: int, step_ns: int) -> int:
    """Return the instant (ns, within (begin, begin + step]) at which the straight way reaches `threshold`."""
    part = (threshold - before) / (after - before) if after != before else 1.0
    at = begin_ns + int(math.floor(part * step_ns + 0.5))
    return min(max(at, begin_ns + 1), begin_ns + step_ns)


@law
def switch_change(switch: Rows, number: int, before: float, after: float, begin_ns: int, step_ns: int) -> int:
    """Return the instant at which a spatial switch changes in this sub-step, or -1; flips its state."""
    row = switch[number]
    shift = row["noise"][row["noise_index"]]
    if row["state"]:
        low = row["low"] - row["hysteresis"]
        high = row["high"] + row["hysteresis"]
        if low <= after <= high:
            return -1
        row["state"] = 0
        row["noise_index"] = (row["noise_index"] + 1) % NOISE
        return crossing(before, after, low if after < low else high, begin_ns, step_ns)
    low = row["low"] + shift
    high = row["high"] - shift
    if not low <= after <= high:
        return -1
    row["state"] = 1
    if low <= before <= high:
        return begin_ns + 1
    return crossing(before, after, low if before < low else high, begin_ns, step_ns)


@law
def switches(
    servo: Rows,
    switch: Rows,
    signal: Rows,
    channel: Rows,
    edge: Rows,
    edges: Rows,
    pending: Rows,
    sub: int,
    begin_ns: int,
    step_ns: int,
    dc_epoch_ns: int,
) -> None:
    """Find this sub-step's switch changes, add contact bounce, and distribute them in the order of their instants."""
    for s in range(switch.shape[0]):
        angles = servo[switch[s]["axis"]]["angles"]
        at = switch_change(switch, s, angles[sub], angles[sub + 1], begin_ns, step_ns)
        if at < 0:
            continue
        change = 1 if switch[s]["state"] else -1
        put_pending(pending, edges, at, switch[s]["signal"], change)
        bounce = switch[s]["bounce_ns"]
        if bounce > 0:
            put_pending(pending, edges, at + bounce // 2, switch[s]["signal"], -change)
            put_pending(pending, edges, at + bounce, switch[s]["signal"], change)
    end_ns = begin_ns + step_ns
    while edges[1] > 0:
        first = -1
        for p in range(pending.shape[0]):
            if (
                pending[p, 1] >= 0
                and pending[p, 0] <= end_ns
                and (first < 0 or pending[p, 0] < pending[first, 0])
            ):
                first = p
        if first < 0:
            return
        number = pending[first, 1]
        pending[first, 1] = -1
        edges[1] -= 1
        signal[number]["operated"] += pending[first, 2]
        at = pending[first, 0]
        distribute(servo, signal, channel, edge, edges, number, at, sub, begin_ns, step_ns, dc_epoch_ns)


@law
def may_switch(servo: Rows, switch: Rows) -> bool:
    """Tell whether an axis came where one of its switches could change."""
    for s in range(switch.shape[0]):
        row = switch[s]
        low = servo[row["axis"]]["angle_low"]
        high = servo[row["axis"]]["angle_high"]
        if row["state"]:
            if low < row["low"] - row["hysteresis"] or high > row["high"] + row["hysteresis"]:
                return True
        else:
            shift = row["noise"][row["noise_index"]]
            if low <= row["high"] - shift and high >= row["low"] + shift:
                return True
    return False


@law
def put_pending(pending: Rows, edges: Rows, at_ns: int, signal: int, change: int) -> None:
    """Note a coming change of a signal (`pending` rows: instant, signal or -1, change); `edges[1]` counts them."""
    for p in range(pending.shape[0]):
        if pending[p, 1] < 0:
            pending[p, 0] = at_ns
            pending[p, 1] = signal
            pending[p, 2] = change
            edges[1] += 1
            return


@law
def zero_pulses(servo: Rows, axis: int, sub: int, begin_ns: int, step_ns: int, dc_epoch_ns: int) -> None:
    """Latch the encoder's zero pulse when this sub-step passes it (an input is armed for it)."""
    row = servo[axis]
    turn = row["increments_per_turn"]
    before = count(servo, axis, row["angles"][sub]) - row["encoder_offset"] - row["zero_pulse"]
    after = count(servo, axis, row["angles"][sub + 1]) - row["encoder_offset"] - row["zero_pulse"]
    if before == after:
        return
    if after > before:
        pulse = (before // turn + 1) * turn
        if pulse > after:
            return
    else:
        pulse = -((-before) // turn + 1) * turn
        if pulse < after:
            return
    at = begin_ns + int(math.floor((pulse - before) / (after - before) * step_ns + 0.5))
    position = pulse + row["zero_pulse"] + row["encoder_offset"]
    for number in range(2):
        probe_edge(servo, axis, number, 1, position, dc_epoch_ns + at, 1)


@law
def supervise(servo: Rows, axis: int, cycle_ns: int) -> None:
    """Watch the following error (6065 for 6066 ms) and set the law's statusword bits."""
    row = servo[axis]
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


@law
def advance_machine(
    servo: Rows,
    switch: Rows,
    signal: Rows,
    channel: Rows,
    edge: Rows,
    edges: Rows,
    pending: Rows,
    begin_ns: int,
    cycle_ns: int,
    sub_steps: int,
    dc_epoch_ns: int,
) -> int:
    """Advance drives, mechanics and wiring over one cycle; return how many drives have raised a fault in it."""
    axes = servo.shape[0]
    step_ns = cycle_ns // sub_steps
    time = step_ns * 1e-9
    cycle = cycle_ns * 1e-9
    for axis in range(axes):
        row = servo[axis]
        probe_arm(servo, axis)
        row["status_flags"] = 0
        if row["enabled"]:
            move_axis(servo, axis, sub_steps, time, cycle)
        else:
            rest_axis(servo, axis, sub_steps)
        if row["probe_function"] & 0x0404:
            for sub in range(sub_steps):
                zero_pulses(servo, axis, sub, begin_ns + sub * step_ns, step_ns, dc_epoch_ns)
    for number in range(signal.shape[0]):
        # a signal that was forced or let go since the last cycle changes at its begin
        if signal_level(signal, number) != signal[number]["level"]:
            distribute(
                servo, signal, channel, edge, edges, number, begin_ns + 1, 0, begin_ns, step_ns, dc_epoch_ns
            )
    if edges[1] > 0 or may_switch(servo, switch):
        for sub in range(sub_steps):
            begin = begin_ns + sub * step_ns
            switches(servo, switch, signal, channel, edge, edges, pending, sub, begin, step_ns, dc_epoch_ns)
    now_ns = begin_ns + cycle_ns
    for c in range(channel.shape[0]):
        channel_image(channel, c, now_ns, dc_epoch_ns)
    faults = 0
    for axis in range(axes):
        row = servo[axis]
        row["demand_from"] += servo_span(servo, axis) if row["enabled"] else 0.0
        position = count(servo, axis, row["angle"])
        row["position"] = wrap32(position)
        row["demand"] = wrap32(int(math.floor(row["demand_from"] + 0.5)))
        row["following_error"] = wrap32(int(math.floor(row["demand_from"] + 0.5)) - position)
        row["velocity"] = int(row["speed"] * row["increments_per_rad"])
        row["torque_permille"] = int(math.floor(row["torque"] / row["rated_torque"] * 1000.0 + 0.5))
        raised = row["fault"]
        supervise(servo, axis, cycle_ns)
        if row["fault"] != 0 and raised == 0:
            faults += 1
    return faults


@law
def servo_span(servo: Rows, axis: int) -> float:
    """Return the way (increments) from the present demand to the newest target, the short way round 32 bits."""
    row = servo[axis]
    return float(wrap32(int(row["target"]) - int(math.floor(row["demand_from"] + 0.5)))) + (
        math.floor(row["demand_from"] + 0.5) - row["demand_from"]
    )
