"""Channels of terminals: input delay, level, time latches; by themselves where a process hosts only terminals."""

import numpy as np

from hli_bench.laws.compiled import law
from hli_bench.laws.rows import Row, Rows

NEVER = np.iinfo(np.int64).max


@law
def channel_settle(row: Row, now_ns: int, dc_epoch_ns: int) -> None:
    """Let an edge whose input delay is over by `now_ns` through: level and time latch."""
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
def channel_edge(row: Row, level: int, at_ns: int, dc_epoch_ns: int) -> None:
    """Take an edge into a terminal channel; a pulse shorter than the input delay does not get through."""
    channel_settle(row, at_ns, dc_epoch_ns)
    if level == row["level"]:
        row["level_due_ns"] = NEVER
    else:
        row["level_next"] = level
        row["level_due_ns"] = at_ns + row["delay_ns"]


@law
def channel_image(row: Row, now_ns: int, dc_epoch_ns: int) -> None:
    """Refresh what the process image shows at `now_ns`; reading frees the latches of single-event mode."""
    channel_settle(row, now_ns, dc_epoch_ns)
    row["input"] = row["level"]
    row["status"] = 0
    if row["single_event"]:
        row["status"] = 1 if row["level"] else (row["taken"] & 2)
        row["taken"] = 0


@law
def advance_channels(channel: Rows, edge: Rows, dc_epoch_ns: int, count: int, now_ns: int) -> None:
    """Take the `count` edges of one cycle, in order, and refresh what the images show at `now_ns`."""
    for e in range(count):
        for c in range(channel.shape[0]):
            if channel[c]["signal"] == edge[e]["signal"]:
                channel_edge(channel[c], edge[e]["level"], edge[e]["at_ns"], dc_epoch_ns)
    for c in range(channel.shape[0]):
        channel_image(channel[c], now_ns, dc_epoch_ns)
