"""`hli-bench plc`: a PLC script attached to a bench that is up."""

import argparse
from functools import partial

from hli_bench.cli.console import say
from hli_bench.cli.options import Commands, add_connect, supplied_file


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "plc",
        help="attach a PLC script to a bench that is up",
        description="Attaches a PLC script to a bench that is up and runs it until the bench ends or Ctrl-C.",
    )
    parser.add_argument("script", metavar="SCRIPT", help="a file, or the name of a supplied script")
    parser.add_argument("--name", default="", help="name of the PLC (default: that of the file)")
    add_connect(parser)
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the script until the bench ends."""
    script = supplied_file("plc_scripts", arguments.script, ".py")
    from hli_bench.shells.plc_process import attach

    try:
        attach(
            script,
            arguments.connect,
            arguments.machine,
            arguments.name,
            on_line=partial(say, at_once=True),
        )
    except KeyboardInterrupt:
        return 0
    return 0
