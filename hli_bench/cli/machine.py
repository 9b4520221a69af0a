"""`hli-bench machine check / schema`: machine folders."""

import argparse
from typing import TYPE_CHECKING, Any

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.cli.drive import eds_of
from hli_bench.cli.options import Commands

if TYPE_CHECKING:
    from hli_bench.bench.config import MachineConfig


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser("machine", help="check a machine folder; print what may stand in one")
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    check = actions.add_parser(
        "check", help="check a machine folder: machine.toml, lists, drives, PLC scripts"
    )
    check.add_argument("machine", metavar="DIR", help="a folder, or the name of a machine of the package")
    check.add_argument("--set", metavar="KEY=VALUE", action="append", help="checked as `run` would take it")
    check.add_argument(
        "--modbus", action="store_true", help="prints the Modbus map of the machine (not built)"
    )
    check.set_defaults(execute=check_machine)
    schema = actions.add_parser(
        "schema", help="print every key of machine.toml: key: what it takes [default]: meaning"
    )
    schema.set_defaults(execute=print_schema)


def print_schema(arguments: argparse.Namespace) -> int:
    """Print the schema."""
    from hli_bench.bench import schema

    print(schema.text(), end="")
    return 0


def check_machine(arguments: argparse.Namespace) -> int:
    """Check the folder and all it names. Raises InputError, and NotEmulated for what is not built."""
    if arguments.modbus:
        raise NotEmulated("machine check --modbus")
    from hli_bench.bench.config import load
    from hli_bench.bench.sources import parse_set

    config = load(arguments.machine, parse_set(arguments.set or []))
    check_named(config)
    for note in config.notes:
        print(f"{note.file}:{note.line}: {note.severity}: {note.message}")
    print(
        f"{config.folder}: {len(config.axes)} axes ({', '.join(axis.name for axis in config.axes)}), "
        f"{len(config.terminals)} terminals, {len(config.plcs)} PLC tasks, accepted"
    )
    return 0


def check_named(config: "MachineConfig") -> None:
    """Check drive models with their EDS files, and PLC scripts. Raises InputError naming whose they are."""
    from hli_bench.plc import load as load_script
    from hli_bench.protocols.canopen.eds import load as load_eds

    seen: dict[str, Any] = {}
    for axis in config.axes:
        if axis.drive not in seen:
            try:
                seen[axis.drive] = load_eds(eds_of(axis.drive))
            except InputError as error:
                raise InputError(f"axis.{axis.name}.drive: {error}") from error
    for plc in config.plcs:
        load_script(plc.script)
