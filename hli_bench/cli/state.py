"""`hli-bench state`: one look at a bench that is up."""

import argparse
import json

from hli_bench.cli import tables
from hli_bench.cli.console import say
from hli_bench.cli.options import Commands, add_connect


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "state",
        help="one look at a bench that is up",
        description="Prints mode of the CNC, axes, drives with their 402 state and faults, terminals, PLCs and "
        "late cycles of a bench that is up.",
    )
    parser.add_argument("--json", action="store_true", help="as JSON")
    add_connect(parser)
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> int:
    """Print the state."""
    from hli_bench.shells.zenoh_client import HliClient

    with HliClient(arguments.connect, arguments.machine) as client:
        state = client.state()
    if arguments.json:
        say(json.dumps(state, indent=2))
    else:
        for axis in state["axes"]:
            axis["statusword"] = f"0x{axis['statusword']:04X}"
        for line in tables.tree(state):
            say(line)
    return 0
