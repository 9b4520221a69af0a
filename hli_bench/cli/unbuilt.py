"""Commands that are declared and not built: they end with NotEmulated."""

import argparse

from hli_bench.base.errors import NotEmulated
from hli_bench.cli.options import Commands, add_connect


def add(commands: Commands) -> None:
    """Declare the commands."""
    inject = _command(commands, "inject", "put a fault into a bench that is up")
    inject.add_argument("fault", metavar="FAULT", nargs="?", help="kind of fault")
    inject.add_argument("--at", metavar="WHEN", help="when it begins")
    inject.add_argument("--for", metavar="TIME", dest="duration", help="how long it lasts")
    inject.add_argument("--list", action="store_true", help="lists the kinds of faults")
    add_connect(inject)
    clear = _command(commands, "clear", "take faults out of a bench that is up")
    clear.add_argument("fault", metavar="FAULT", nargs="?", help="kind of fault (default all)")
    add_connect(clear)
    _command(commands, "scope", "the web scope")


def _command(commands: Commands, name: str, text: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name, help=f"not built yet: {text}", description=f"Not built yet: {text}."
    )
    parser.set_defaults(execute=refuse, refused=name)
    return parser


def refuse(arguments: argparse.Namespace) -> int:
    """Say that the command is not built."""
    raise NotEmulated(f"hli-bench {arguments.refused} is not built yet")
