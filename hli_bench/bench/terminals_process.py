"""Terminals as a process of their own: `python -m hli_bench.bench.terminals_process FD MACHINE SETTINGS`.

It is told the edges of a cycle and answers with the process images, and whether they stay so while no edge comes.
"""

import json
import sys
from collections.abc import Sequence

from hli_bench.base.time import Ns
from hli_bench.bench import build, telegraph
from hli_bench.bench.folder import load
from hli_bench.laws.channels import NEVER, advance_channels
from hli_bench.laws.native import bind
from hli_bench.laws.rows import MachineRows
from hli_bench.plant import build as plant
from hli_bench.shells.pipe import Pipe
from hli_bench.shells.processes import work


def main(pipe: Pipe, arguments: Sequence[str]) -> None:
    """Build the terminals and serve until the pipe closes."""
    machine, settings = arguments
    config = load(machine, json.loads(settings), with_plcs=False)
    built = plant.build(config.plant, config.channels())
    rows: MachineRows = built.rows
    terminals = build.terminals(config, rows.channel)
    names = built.signals.names
    advance = bind(advance_channels, rows.channel, rows.edge, config.dc_epoch_ns)
    slow = any(terminal.period_ns > config.cycle_ns for terminal in terminals)
    state = b""
    while True:
        try:
            _, cycle, body = telegraph.read_order(pipe.receive())
        except EOFError:
            return
        edges = telegraph.read_edges(body, names)
        for number, edge in enumerate(edges):
            rows.edge[number]["signal"] = names.index(edge.signal)
            rows.edge[number]["at_ns"] = edge.at_ns
            rows.edge[number]["level"] = edge.level
        now = Ns(cycle * config.cycle_ns)
        advance(len(edges), now)
        before, state = state, rows.channel.tobytes()
        waiting = slow or bool((rows.channel["level_due_ns"] != NEVER).any())
        says = telegraph.SETTLED if state == before and not waiting else telegraph.CHANGING
        pipe.send(telegraph.parts(says, *(terminal.step(now).data for terminal in terminals)))


if __name__ == "__main__":
    sys.exit(work(main, sys.argv[1:]))
