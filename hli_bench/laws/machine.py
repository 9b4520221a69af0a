"""Machine side of a cycle: cyclic position servos, mechanics, contact, spatial switches, edges and their latches.

A cycle is walked in equal sub-steps, axis by axis: nothing that happens at a switch acts back on the motion in
the same cycle. Within a sub-step an axis moves with constant speed, so the instant at which it crosses a threshold
is exact. Only when an axis may have reached a threshold are the sub-steps gone through for edges, in the order of
their instants.
"""

import math

from hli_bench.laws.channels import channel_image
from hli_bench.laws.compiled import law
from hli_bench.laws.integers import wrap32
from hli_bench.laws.rows import Rows
from hli_bench.laws.servo import coast_axis, count, move_axis, servo_span, stop_span, supervise
from hli_bench.laws.switches import distribute, may_switch, signal_level, switches
from hli_bench.laws.touch_probe import probe_arm, zero_pulses


@law
def advance_machine(
    servo: Rows,
    switch: Rows,
    signal: Rows,
    channel: Rows,
    edge: Rows,
    edges: Rows,
    pending: Rows,
    cycle_ns: int,
    sub_steps: int,
    dc_epoch_ns: int,
    begin_ns: int,
) -> int:
    """Advance drives, mechanics and wiring over the cycle that begins at `begin_ns`; return how many faults came."""
    axes = servo.shape[0]
    step_ns = cycle_ns // sub_steps
    time = step_ns * 1e-9
    cycle = cycle_ns * 1e-9
    for axis in range(axes):
        row = servo[axis]
        probe_arm(row)
        row["status_flags"] = 0
        if row["enabled"]:
            row["span"] = servo_span(row) if row["stop_rate"] == 0.0 else stop_span(row, cycle)
            move_axis(row, sub_steps, time, cycle)
        else:
            row["span"] = 0.0
            coast_axis(row, sub_steps, time)
        if row["probe_function"] & 0x0404:
            for sub in range(sub_steps):
                zero_pulses(row, sub, begin_ns + sub * step_ns, step_ns, dc_epoch_ns)
    for number in range(signal.shape[0]):
        # a signal that was forced or let go since the last cycle changes at its begin
        if signal_level(signal[number]) != signal[number]["level"]:
            distribute(
                servo, signal, channel, edge, edges, number, begin_ns + 1, 0, begin_ns, step_ns, dc_epoch_ns
            )
    if edges[1] > 0 or may_switch(servo, switch):
        for sub in range(sub_steps):
            begin = begin_ns + sub * step_ns
            switches(servo, switch, signal, channel, edge, edges, pending, sub, begin, step_ns, dc_epoch_ns)
    now_ns = begin_ns + cycle_ns
    for c in range(channel.shape[0]):
        channel_image(channel[c], now_ns, dc_epoch_ns)
    faults = 0
    for axis in range(axes):
        row = servo[axis]
        row["demand_from"] += row["span"]
        position = count(row, row["angle"])
        row["position"] = wrap32(position)
        row["demand"] = wrap32(int(math.floor(row["demand_from"] + 0.5)))
        row["following_error"] = wrap32(int(math.floor(row["demand_from"] + 0.5)) - position)
        row["velocity"] = int(row["speed"] * row["increments_per_rad"])
        row["torque_permille"] = int(math.floor(row["torque"] / row["rated_torque"] * 1000.0 + 0.5))
        raised = row["fault"]
        supervise(row, cycle_ns)
        if row["fault"] != 0 and raised == 0:
            faults += 1
    return faults
