"""The look-ahead: a straight way becomes a segment, and the path runs through its transitions as fast as it may."""

import math

from hli_bench.laws.compiled import law
from hli_bench.laws.rows import IDLE, PATH, RUN, SEGMENTS, Row, Rows

NOTHING = -1
"""Instead of the number of a segment: the block moves nothing."""
SHORTEST = 1e-6
"""A block that moves nothing by more than this (0.1 um) has no path."""
STRAIGHT = 1e-9
"""Components of direction that differ by no more than this are the same."""


@law
def path_length(leg: Rows, slot: int, tip: Rows) -> float:
    """Return the length that the F word counts: of the linear axes when any moves, else of all that move."""
    squares = 0.0
    for number in range(tip.shape[0]):
        if leg[slot, number]["moves"] and tip[number]["linear"]:
            way = leg[slot, number]["end"] - leg[slot, number]["start"]
            squares += way * way
    if squares == 0.0:
        for number in range(tip.shape[0]):
            if leg[slot, number]["moves"]:
                way = leg[slot, number]["end"] - leg[slot, number]["start"]
                squares += way * way
    return math.sqrt(squares)


@law
def take_dynamics(one: Row, leg: Rows, slot: int, dynamics: Rows) -> float:
    """Give a segment the rates that exceed no axis's own; return the greatest velocity they leave."""
    limit = math.inf
    split = math.inf
    for rank in range(2):
        one["acceleration"][rank] = math.inf
        one["deceleration"][rank] = math.inf
        one["hold"][rank] = math.inf
    for number in range(dynamics.shape[0]):
        if not leg[slot, number]["moves"]:
            continue
        part = abs(leg[slot, number]["direction"])
        may = dynamics[number]
        for rank in range(2):
            one["acceleration"][rank] = min(one["acceleration"][rank], may["up"][rank] / part)
            one["deceleration"][rank] = min(one["deceleration"][rank], may["down"][rank] / part)
            one["hold"][rank] = min(one["hold"][rank], may["hold"][rank] / part)
        split = min(split, may["up"][2] / part)
        limit = min(limit, may["limit"] / part)
    one["split"] = split
    return limit


@law
def join(
    path: Rows, segment: Rows, leg: Rows, last: Row, tip: Rows, dynamics: Rows, number: int, cycle_s: float
) -> None:
    """Let the path run from the segment before into `number` as fast as no axis jumps and all can brake."""
    one = segment[number % SEGMENTS]
    through = min(one["feed"], last["velocity"])
    for axis in range(dynamics.shape[0]):
        turn = abs(leg[number % SEGMENTS, axis]["direction"] - tip[axis]["direction"])
        if turn > STRAIGHT:
            jump = min(dynamics[axis]["up"][0], dynamics[axis]["down"][0]) * cycle_s
            through = min(through, jump / turn)
    one["v_start"] = through
    for at in range(number, path[0]["head"], -1):
        one = segment[at % SEGMENTS]
        previous = segment[(at - 1) % SEGMENTS]
        rate = min(one["deceleration"][0], one["deceleration"][1])
        reach = math.sqrt(one["v_end"] ** 2 + 2.0 * rate * one["length"])
        allowed = min(one["v_start"], reach)
        if at < number and allowed <= previous["v_end"]:
            return
        previous["v_end"] = allowed


@law
def put_segment(
    axis: Rows,
    path: Rows,
    segment: Rows,
    leg: Rows,
    plan: Rows,
    tip: Rows,
    target: Rows,
    cycle_s: float,
    kinds: Rows,
    kind: int,
    feed: float,
    rapid: int,
) -> int:
    """Put a straight way to `target` (n, 0.1 um; NaN: not programmed) behind the prepared path.

    `kinds` (k, n) is what the axes may do in each kind of way, `kind` the one it is, `feed` in 0.1 um/s. Returns the
    number of the segment or NOTHING.
    """
    dynamics = kinds[kind]
    here = plan[0]
    number = path[0]["tail"]
    slot = number % SEGMENTS
    one = segment[slot]
    moving = False
    for i in range(axis.shape[0]):
        way = leg[slot, i]
        way["start"] = tip[i]["end"]
        way["end"] = tip[i]["end"] if math.isnan(target[i]) else target[i]
        way["moves"] = abs(way["end"] - way["start"]) > SHORTEST
        moving = moving or way["moves"] != 0
    if not moving:
        return NOTHING
    one["length"] = path_length(leg, slot, tip)
    for i in range(axis.shape[0]):
        way = leg[slot, i]
        way["direction"] = (way["end"] - way["start"]) / one["length"] if way["moves"] else 0.0
    limit = take_dynamics(one, leg, slot, dynamics)
    one["feed"] = limit if rapid else min(feed, limit)
    one["rapid"] = rapid
    one["v_start"] = 0.0
    one["v_end"] = 0.0
    if here["joined"] and path[0]["state"] != IDLE:
        join(path, segment, leg, here, tip, dynamics, number, cycle_s)
    here["joined"] = 1
    here["velocity"] = one["feed"]
    for i in range(axis.shape[0]):
        tip[i]["direction"] = leg[slot, i]["direction"]
        tip[i]["end"] = leg[slot, i]["end"]
        if leg[slot, i]["moves"]:
            axis[i]["mode"] = PATH
    path[0]["tail"] = number + 1
    if path[0]["state"] == IDLE:
        path[0]["head"] = number
        path[0]["s"] = 0.0
        path[0]["v"] = 0.0
        path[0]["state"] = RUN
    return int(number)
