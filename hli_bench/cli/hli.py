"""`hli-bench hli ls/get/set/watch`: HLI and terminal elements of a bench that is up."""

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hli_bench.base.errors import InputError
from hli_bench.cli import tables
from hli_bench.cli.console import say, tell
from hli_bench.cli.options import Commands, add_connect

if TYPE_CHECKING:
    from hli_bench.shells.zenoh_client import HliClient

PATH = (
    "ax/3/lr_mc_control/probing_signal, with /command_w for one member; gpAx[3]^.lr_mc_control.probing_signal "
    "and the old names do as well; io/probe/ch2/input for a terminal"
)


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser(
        "hli", help="look at and set HLI and terminal elements of a bench that is up"
    )
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    ls = actions.add_parser("ls", help="list elements with type, unit and access")
    ls.add_argument("path", metavar="PART", nargs="?", default="", help="only paths that contain this")
    ls.set_defaults(execute=list_elements)
    get = actions.add_parser("get", help="print a value, or all members of a unit or terminal")
    get.add_argument("path", metavar="PATH", help=PATH)
    get.set_defaults(execute=get_value)
    put = actions.add_parser("set", help="write a value; returns when it has taken effect")
    put.add_argument("path", metavar="PATH", help=PATH)
    put.add_argument("value", metavar="VALUE", help="TRUE, FALSE or a number in the unit that `hli ls` shows")
    put.set_defaults(execute=set_value)
    watch = actions.add_parser("watch", help="print a value now and whenever it changes, until Ctrl-C")
    watch.add_argument("path", metavar="PATH", help=PATH)
    watch.set_defaults(execute=watch_value)
    for action in (ls, get, put, watch):
        add_connect(action)


def list_elements(arguments: argparse.Namespace) -> int:
    """Print the elements."""
    with _client(arguments) as client:
        rows = client.ls(arguments.path)
    for line in tables.lines([("PATH", "TYPE", "UNIT", "ACCESS"), *rows]):
        say(line)
    return 0


def get_value(arguments: argparse.Namespace) -> int:
    """Print a value, a line a member."""
    with _client(arguments) as client:
        value = client.get(arguments.path)
    if isinstance(value, Mapping):
        for line in tables.lines((name, tables.value(item)) for name, item in value.items()):
            say(line)
    else:
        say(tables.value(value))
    return 0


def set_value(arguments: argparse.Namespace) -> int:
    """Write a value."""
    with _client(arguments) as client:
        try:
            note = client.set(arguments.path, arguments.value)
        except InputError as error:
            raise InputError(f"{arguments.path}: {error.message}") from error
    if note:
        tell(f"note: {arguments.path} {note}")
    return 0


def watch_value(arguments: argparse.Namespace) -> int:
    """Print a line a change until the bench ends or Ctrl-C."""
    try:
        with _client(arguments) as client:
            for value in client.watch(arguments.path):
                say(_line(value), at_once=True)
    except KeyboardInterrupt:
        return 0
    return 0


def _line(value: Any) -> str:
    if isinstance(value, Mapping):
        return " ".join(f"{name}={tables.value(item)}" for name, item in value.items())
    return tables.value(value)


def _client(arguments: argparse.Namespace) -> "HliClient":
    from hli_bench.shells.zenoh_client import HliClient

    return HliClient(arguments.connect, arguments.machine)
