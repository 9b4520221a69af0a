"""Terminal channels by themselves: for a process that hosts terminals and is told the edges."""

from hli_bench.laws.compiled import law
from hli_bench.laws.machine import channel_edge, channel_image
from hli_bench.laws.rows import Rows


@law
def advance_channels(channel: Rows, edge: Rows, edges: int, now_ns: int, dc_epoch_ns: int) -> None:
    """Take the edges of one cycle, in order, and refresh what the images show at `now_ns`."""
    for e in range(edges):
        for c in range(channel.shape[0]):
            if channel[c]["signal"] == edge[e]["signal"]:
                channel_edge(channel, c, edge[e]["level"], edge[e]["at_ns"], dc_epoch_ns)
    for c in range(channel.shape[0]):
        channel_image(channel, c, now_ns, dc_epoch_ns)
