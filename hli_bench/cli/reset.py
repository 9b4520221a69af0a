"""`hli-bench reset`: CNC reset of a bench that is up."""

import argparse

from hli_bench.cli.console import tell
from hli_bench.cli.options import Commands, add_connect


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "reset",
        help="CNC reset of a bench that is up",
        description="Aborts the running program, clears errors of the CNC and brings drives that dropped out back into "
        "operation; returns when that is done. Exit status 1: drives are still out.",
    )
    add_connect(parser)
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> int:
    """Reset the CNC."""
    from hli_bench.shells.zenoh_client import HliClient

    with HliClient(arguments.connect, arguments.machine) as client:
        note = client.reset()
    if note:
        tell(note)
    return 1 if note else 0
