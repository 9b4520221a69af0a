"""`hli-bench serve`: a bench that stays up."""

import argparse
from functools import partial

from hli_bench.base.endpoints import DEFAULT_ENDPOINT
from hli_bench.cli.console import say, tell
from hli_bench.cli.options import Commands, add_bench, bench_options


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "serve",
        help="start a bench and leave it up until Ctrl-C",
        description="Starts a bench and leaves it up until Ctrl-C: the HLI listens on Zenoh, PLCs attach, "
        "`run --connect` runs programs on it.",
    )
    add_bench(parser, pace="real", zenoh=DEFAULT_ENDPOINT)
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C, which is the regular end."""
    options = bench_options(arguments)
    from hli_bench.bench.serve import serve

    try:
        serve(
            options.machine,
            options.settings,
            plc=options.plc,
            pace=options.pace,
            can=options.can,
            zenoh=options.zenoh,
            on_line=partial(say, at_once=True),
            realtime=options.realtime,
            on_note=tell,
        )
    except KeyboardInterrupt:
        return 0
    return 0
