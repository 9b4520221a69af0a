"""Kernel side of a cycle: `sense` takes actual values, keeps history and asks the conditions; `act` interpolates."""

import math

from hli_bench.laws.compiled import law
from hli_bench.laws.integers import wrap32
from hli_bench.laws.profile import TINY, advance, braking_path, ramp
from hli_bench.laws.rows import (
    BRAKE,
    FEEDHOLD,
    FOLLOW,
    HISTORY_CYCLES,
    IDLE,
    JOG,
    PATH,
    SEGMENTS,
    W_CYCLE,
    W_DIGITAL_INPUT,
    W_FIXED_STOP,
    W_FREE,
    W_JOG_STOPPED,
    W_LAG_OVER,
    W_LAG_WITHIN,
    W_MOVED,
    W_NONE,
    W_OUTSIDE,
    W_PATH_DONE,
    W_PATH_STANDS,
    W_PROBE_STATUS,
    W_SEGMENT,
    W_STANDSTILL_LAG_OVER,
    W_STATUSWORD,
    W_STATUSWORD_LEFT,
    Row,
    Rows,
)


@law
def take_feedback(row: Row, history: Rows, number: int, cycle: int) -> None:
    """Take the received actual position of one axis: unwrap it, convert it, keep it in the history."""
    row["feedback"] += wrap32(row["received"] - row["feedback"])
    history[cycle % HISTORY_CYCLES, number] = row["feedback"]
    row["actual"] = (row["feedback"] - row["reference"]) / row["increments_per_unit"]
    if row["mode"] == FOLLOW:
        row["command"] = row["actual"]
        row["past"] = row["actual"]
    row["lag"] = row["past"] - row["actual"]


@law
def moved_within(one: Row, history: Rows, number: int, cycles: int, cycle: int) -> float:
    """Return how far (0.1 um) the actual position moved over the last `cycles` cycles."""
    back = min(cycles, HISTORY_CYCLES - 1)
    if cycle < back:
        return math.inf
    now = history[cycle % HISTORY_CYCLES, number]
    then = history[(cycle - back) % HISTORY_CYCLES, number]
    return abs((now - then) / one["increments_per_unit"])


@law
def holds(one: Row, path: Row, row: Row, cycle: int) -> bool:
    """Return whether condition `row`, about axis `one`, holds in this cycle."""
    kind = row["kind"]
    # first what is always watched
    if kind == W_LAG_OVER:
        return abs(one["lag"]) > row["limit"]
    if kind == W_STANDSTILL_LAG_OVER:
        return one["velocity"] == 0.0 and abs(one["lag"]) > row["limit"]
    if kind == W_STATUSWORD_LEFT:
        return (one["statusword"] & row["mask"]) != row["value"]
    if kind == W_STATUSWORD:
        return (one["statusword"] & row["mask"]) == row["value"]
    if kind == W_OUTSIDE:
        return one["actual"] > row["limit"] or one["actual"] < row["window"]
    if kind == W_CYCLE:
        return cycle >= row["limit"]
    if kind == W_PATH_DONE:
        return path["state"] == IDLE
    if kind == W_PATH_STANDS:
        return path["v"] <= 0.0 or path["state"] == IDLE
    if kind == W_SEGMENT:
        return path["head"] >= row["limit"] or path["state"] == IDLE
    if kind == W_JOG_STOPPED:
        return one["velocity"] == 0.0 and one["jog_velocity"] == 0.0
    if kind == W_LAG_WITHIN:
        return abs(one["lag"]) <= row["limit"]
    if kind == W_PROBE_STATUS:
        return (one["probe_status"] & row["mask"]) == row["value"]
    if kind == W_DIGITAL_INPUT:
        return (one["digital_inputs"] & row["mask"]) == row["value"]
    if kind == W_MOVED:
        # window: where the way begins
        return abs(one["actual"] - row["window"]) >= row["limit"]
    if kind == W_FIXED_STOP:
        # limit: position lag, 0 = not asked
        return (row["limit"] <= 0.0 or abs(one["lag"]) > row["limit"]) and path["s"] >= row["value"]
    return False


@law
def lasted(one: Row, row: Row, history: Rows, cycle: int) -> bool:
    """Return whether condition `row`, about axis `one`, has held long enough.

    A fixed stop asks how far the axis moved meanwhile.
    """
    if row["count"] < row["cycles"]:
        return False
    if row["kind"] != W_FIXED_STOP or row["window"] < 0.0:
        return True
    return moved_within(one, history, row["axis"], row["cycles"], cycle) <= row["window"]


@law
def ask_watches(axis: Rows, path: Rows, watch: Rows, history: Rows, cycle: int) -> int:
    """Ask every condition once; return how many have now held for their number of cycles."""
    fired = 0
    for w in range(watch.shape[0]):
        row = watch[w]
        if row["kind"] == W_NONE:
            break
        if row["kind"] == W_FREE:
            continue
        if not holds(axis[row["axis"]], path[0], row, cycle):
            row["count"] = 0
            continue
        row["count"] += 1
        if row["fired"] == 0 and lasted(axis[row["axis"]], row, history, cycle):
            row["fired"] = 1
            fired += 1
    return fired


@law
def sense(axis: Rows, path: Rows, watch: Rows, history: Rows, cycle: int) -> int:
    """First half of a kernel cycle: actual values, history, conditions; return how many of these are now met."""
    for number in range(axis.shape[0]):
        take_feedback(axis[number], history, number, cycle)
    return ask_watches(axis, path, watch, history, cycle)


@law
def path_held(axis: Rows, path: Row, leg: Rows, slot: int) -> bool:
    """Tell whether the path must stand: feedhold of the channel, a short cut, or an axis it moves is not released."""
    if path["hold"]:
        return True
    for number in range(axis.shape[0]):
        if leg[slot, number]["moves"] and axis[number]["released"] == 0:
            return True
    return False


@law
def velocity_before_hold(axis: Rows, path: Row, segment: Rows, leg: Rows) -> float:
    """Return how fast the segment under way may be left so that the path stands where a held axis would begin to move.

    An axis that is not released stays where it is, so the way before its own ends at rest. From that border back each
    segment between allows v^2 = v_end^2 + 2 a length, as in the look-ahead; infinite when no prepared way is held.
    """
    held = path["head"] + 1
    while held < path["tail"] and not path_held(axis, path, leg, held % SEGMENTS):
        held += 1
    if held >= path["tail"]:
        return math.inf
    square = 0.0
    for at in range(held - 1, path["head"], -1):
        one = segment[at % SEGMENTS]
        square += 2.0 * min(one["deceleration"][0], one["deceleration"][1]) * one["length"]
    return math.sqrt(square)


@law
def walk_path(axis: Rows, row: Row, segment: Rows, leg: Rows, time: float) -> None:
    """Advance along the prepared segments by `time` seconds."""
    any_held = False
    for number in range(axis.shape[0]):
        any_held = any_held or axis[number]["released"] == 0
    while time > 0.0 and row["state"] != IDLE:
        one = segment[row["head"] % SEGMENTS]
        split = one["split"]
        v_end = one["v_end"]
        wanted = one["feed"]
        if row["override"] < 1.0 or one["rapid"] == 0:
            wanted *= row["override"]
        low = one["deceleration"][0]
        high = one["deceleration"][1]
        if row["state"] == BRAKE:
            wanted = 0.0
            low = row["brake"][0]
            high = row["brake"][1]
            split = row["brake_split"]
        elif path_held(axis, row, leg, row["head"] % SEGMENTS):
            wanted = 0.0
            low = one["hold"][0]
            high = one["hold"][1]
        elif any_held:
            v_end = min(v_end, velocity_before_hold(axis, row, segment, leg))
            if braking_path(row["v"], v_end, low, high, split) > one["length"] - row["s"] + TINY:
                # The hold came too late to stand at the border: braking begins at once and goes on into that way.
                v_end = one["v_end"]
                wanted = 0.0
                low = one["hold"][0]
                high = one["hold"][1]
        s, v, time = advance(
            row["s"],
            row["v"],
            one["length"],
            v_end,
            wanted,
            one["acceleration"][0],
            one["acceleration"][1],
            low,
            high,
            split,
            time,
        )
        row["s"] = s
        row["v"] = v
        if row["state"] == BRAKE and v <= 0.0:
            row["state"] = IDLE
            return
        if s < one["length"]:
            return
        if row["head"] + 1 >= row["tail"]:
            row["v"] = 0.0
            row["state"] = IDLE
            return
        row["head"] += 1
        row["s"] = 0.0
        row["v"] = v


@law
def act(axis: Rows, path: Rows, segment: Rows, leg: Rows, cycle_ns: int) -> None:
    """Interpolate one cycle: new set points and the targets of the command telegrams."""
    time = cycle_ns * 1e-9
    running = path[0]["state"] != IDLE
    if running:
        walk_path(axis, path[0], segment, leg, time)
    slot = path[0]["head"] % SEGMENTS
    for number in range(axis.shape[0]):
        row = axis[number]
        row["past"] = row["command"]
        before = row["command"]
        mode = row["mode"]
        if mode == PATH and running and leg[slot, number]["moves"]:
            way = leg[slot, number]
            if path[0]["s"] >= segment[slot]["length"]:
                row["command"] = way["end"]
            else:
                row["command"] = way["start"] + way["direction"] * path[0]["s"]
            row["velocity"] = (row["command"] - before) / time
        elif mode == JOG:
            wanted = 0.0
            if row["released"] and path[0]["hold"] & FEEDHOLD == 0:
                wanted = row["jog_velocity"] * min(path[0]["override"], 1.0)
            way, v = ramp(row["velocity"], wanted, row["jog_acceleration"], time)
            row["command"] = before + way
            row["velocity"] = v
        else:
            row["velocity"] = 0.0
        position = row["command"] * row["increments_per_unit"] + row["reference"]
        row["target"] = wrap32(int(math.floor(position + 0.5)))


@law
def write_log(axis: Rows, log: Rows, slot: int) -> None:
    """Keep what this cycle's telegrams carried (frames and traces are made from it when somebody looks)."""
    for number in range(axis.shape[0]):
        row = axis[number]
        out = log[slot, number]
        out["command"] = row["command"]
        out["actual"] = row["actual"]
        out["lag"] = row["lag"]
        out["target"] = row["target"]
        out["controlword"] = row["controlword"]
        out["statusword"] = row["statusword"]
        out["probe_function"] = row["probe_function"]
        out["probe_status"] = row["probe_status"]
        out["digital_inputs"] = row["digital_inputs"]
        out["torque_permille"] = row["torque_permille"]
        out["following_error"] = row["following_error"]
        out["position"] = wrap32(row["feedback"])
        for i in range(2):
            out["latch"][i] = row["latch"][i]
