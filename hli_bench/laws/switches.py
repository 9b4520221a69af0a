"""Spatial switches, contact bounce, and the wires that bring an edge to terminals and drives, in order of time."""

import math

import numpy as np

from hli_bench.laws.channels import channel_edge
from hli_bench.laws.compiled import law
from hli_bench.laws.rows import NOISE, Row, Rows
from hli_bench.laws.servo import count
from hli_bench.laws.touch_probe import probe_edge


@law
def crossing(before: float, after: float, threshold: float, begin_ns: int, step_ns: int) -> int:
    """Return the instant (ns, within (begin, begin + step]) at which the straight way reaches `threshold`."""
    part = (threshold - before) / (after - before) if after != before else 1.0
    at = begin_ns + int(math.floor(part * step_ns + 0.5))
    return min(max(at, begin_ns + 1), begin_ns + step_ns)


@law
def switch_change(row: Row, before: float, after: float, begin_ns: int, step_ns: int) -> int:
    """Return the instant at which a spatial switch changes in this sub-step, or -1; flips its state."""
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
def signal_level(row: Row) -> int:
    """Return the level that wires carry: forced (a fault) or operated."""
    if row["forced"] >= 0:
        return int(row["forced"])
    return 1 if row["operated"] >= row["needed"] else 0


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
    level = signal_level(signal[number])
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
            channel_edge(channel[c], level, at_ns, dc_epoch_ns)
    part = (at_ns - begin_ns) / step_ns
    for axis in range(servo.shape[0]):
        row = servo[axis]
        for i in range(2):
            if row["probe_signal"][i] == number:
                before = row["angles"][sub]
                angle = before + part * (row["angles"][sub + 1] - before)
                probe_edge(row, i, level, count(row, angle), dc_epoch_ns + at_ns, 0)
        for i in range(8):
            if row["input_signal"][i] == number:
                if level:
                    row["digital_inputs"] |= np.uint32(1) << np.uint32(i)
                else:
                    row["digital_inputs"] &= ~(np.uint32(1) << np.uint32(i))


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
        at = switch_change(switch[s], angles[sub], angles[sub + 1], begin_ns, step_ns)
        if at < 0:
            continue
        change = switch[s]["weight"] if switch[s]["state"] else -switch[s]["weight"]
        put_pending(pending, edges, at, switch[s]["signal"], change)
        bounce = switch[s]["bounce_ns"]
        # A bounce is left out before a change of the switch itself, for which each keeps a place, would be.
        if bounce > 0 and edges[1] + 2 + switch.shape[0] <= pending.shape[0]:
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
