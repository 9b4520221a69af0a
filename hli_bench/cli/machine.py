"""`hli-bench machine check / schema / copy`: machine folders."""

import argparse
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from hli_bench.base.errors import EnvironmentLacks, InputError, NotEmulated
from hli_bench.cli.console import say
from hli_bench.cli.options import Commands, add_lenient, machine_name, settings_of

if TYPE_CHECKING:
    from hli_bench.bench.config import MachineConfig


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser("machine", help="check a machine folder; print what may stand in one")
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    check = actions.add_parser(
        "check",
        help="check a machine folder: machine.toml, lists, drives, PLC scripts",
        description="Checks a machine folder as `run` would take it. Drive models are imported and PLC scripts are "
        "loaded: what stands at their top level runs. Nothing is started.",
    )
    check.add_argument("machine", metavar="DIR", help="a folder, or the name of a machine of the package")
    check.add_argument("--set", metavar="KEY=VALUE", action="append", help="checked as `run` would take it")
    add_lenient(check)
    check.add_argument(
        "--modbus", action="store_true", help="not built yet: prints the Modbus map of the machine"
    )
    check.set_defaults(execute=check_machine)
    schema = actions.add_parser(
        "schema", help="print every key of machine.toml: key: what it takes [default]: meaning"
    )
    schema.set_defaults(execute=print_schema)
    copy = actions.add_parser(
        "copy", help="copy a machine of the package into a folder, to begin one of your own"
    )
    copy.add_argument("machine", metavar="NAME", help="a machine of the package, or a folder")
    copy.add_argument("folder", metavar="DIR", help="the new folder; it must not exist")
    copy.set_defaults(execute=copy_machine)


def copy_machine(arguments: argparse.Namespace) -> int:
    """Copy the folder. Raises InputError when there is no such machine, or the new folder exists."""
    from hli_bench.bench.folder import machine_folder

    source, target = machine_folder(machine_name(arguments.machine, "")), Path(arguments.folder)
    try:
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
    except FileExistsError as error:
        message = "is there already and is not written over; choose another folder, or remove it first"
        raise InputError(message, file=str(target)) from error
    except OSError as error:
        # copytree gathers the errors of all files as (from, to, reason).
        reason = error.args[0][0][2] if isinstance(error, shutil.Error) else error.strerror
        raise EnvironmentLacks(f"{target}: cannot be written: {reason}") from error
    say(f"{target}: copied from {source}; use it with --machine {target}")
    return 0


def print_schema(arguments: argparse.Namespace) -> int:
    """Print the schema."""
    from hli_bench.bench import schema

    say(schema.text().rstrip("\n"))
    return 0


def check_machine(arguments: argparse.Namespace) -> int:
    """Check the folder and all it names. Raises InputError, and NotEmulated for what is not built."""
    if arguments.modbus:
        raise NotEmulated("machine check --modbus is not built yet")
    from hli_bench.bench.folder import load

    config = load(machine_name(arguments.machine, ""), settings_of(arguments))
    check_named(config)
    for note in config.notes:
        say(f"{note.place()}: {note.severity}: {note.message}")
    say(
        f"{config.folder}: {len(config.axes)} axes ({', '.join(axis.name for axis in config.axes)}), "
        f"{len(config.terminals)} terminals, {len(config.plcs)} PLC tasks, accepted"
    )
    return 0


def check_named(config: "MachineConfig") -> None:
    """Check drive models with their EDS files, and PLC scripts. Raises InputError naming whose they are."""
    from hli_bench.bench import build
    from hli_bench.plant import build as plant
    from hli_bench.plc import load as load_script

    build.drives(config, plant.build(config.plant, config.channels()).rows.servo)
    for plc in config.plcs:
        load_script(plc.script)
