"""`hli-bench doctor`: what this computer offers, and what to do about what it lacks."""

import argparse

from hli_bench.cli import tables
from hli_bench.cli.console import say
from hli_bench.cli.options import Commands


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "doctor",
        help="what this computer offers a bench",
        description="Looks at what a bench may use: interpreter, cores, SocketCAN, real-time priority, ports, "
        "compiler cache. Changes nothing; what is lacking is no failure.",
    )
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> int:
    """Print the findings and, for those that lack something, the advice."""
    from hli_bench.shells.environment import findings

    found = findings()
    rows = [("ok" if one.ok else "lacks", one.name, one.detail) for one in found]
    for one, line in zip(found, tables.lines(rows), strict=True):
        say(line)
        if not one.ok:
            say(f"       {one.advice}")
    return 0
