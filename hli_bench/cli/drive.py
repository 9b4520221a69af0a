"""`hli-bench drive show / check`: object dictionaries of drive models and EDS files."""

import argparse
import pkgutil
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.base.loading import module
from hli_bench.bench.drive_models import drive_model, eds_of
from hli_bench.cli import tables
from hli_bench.cli.console import say, tell
from hli_bench.cli.options import Commands
from hli_bench.protocols.canopen.cia402_objects import CONTROLWORD, CYCLIC, STATUSWORD, features_off, lacking
from hli_bench.protocols.canopen.datatypes import size_of
from hli_bench.protocols.canopen.eds import Entry, ObjectDictionary, load
from hli_bench.protocols.canopen.notation import written_in_hex

MODELS: Final = "hli_bench_drives.models"
CIA402: Final = 402
DEVICE_TYPE: Final = (0x1000, 0)
HEADS: Final = ("OBJECT", "NAME", "TYPE", "ACCESS", "PDO", "DEFAULT", "RANGE")


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser("drive", help="object dictionaries of drive models; check EDS files")
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    show = actions.add_parser("show", help="print the object dictionary of a drive model")
    show.add_argument(
        "model", metavar="MODEL", help="servo402, or a module path such as drives.models.servo402"
    )
    show.set_defaults(execute=show_model)
    check = actions.add_parser(
        "check",
        help="check an EDS file",
        description="Reads an EDS or DCF. What is wrong with it is said, all of it; an error is only what the bench "
        "cannot work with. Of a CiA 402 drive it says which features are off for want of their objects.",
    )
    check.add_argument("files", metavar="FILE.eds", nargs="+")
    check.set_defaults(execute=check_files)


def show_model(arguments: argparse.Namespace) -> int:
    """Print the object dictionary. Raises InputError for an unknown model."""
    name = arguments.model if "." in arguments.model else f"{MODELS}.{arguments.model}"
    try:
        path = eds_of(drive_model(name))
    except InputError as error:
        raise InputError(f"{error}; supplied models: {', '.join(supplied_models())}") from error
    if path is None:
        raise InputError(f"{name} does not say what its EDS is: MODEL.eds expected")
    for line in tables.lines([HEADS, *map(row, load(path))]):
        say(line)
    return 0


def supplied_models() -> list[str]:
    """Return the names of the drive models that come with the bench."""
    return [found.name for found in pkgutil.iter_modules(module(MODELS).__path__)]


def row(entry: Entry) -> Sequence[str]:
    """Return an object as a row of the table."""
    return (
        f"{entry.index:04X}:{entry.subindex:02X}",
        entry.name,
        entry.data_type.name,
        str(entry.access),
        "yes" if entry.pdo_mappable else "",
        _default(entry),
        "" if entry.low is None and entry.high is None else f"{_bound(entry.low)}..{_bound(entry.high)}",
    )


def _default(entry: Entry) -> str:
    if isinstance(entry.default, int):
        if entry.default_plus_node_id:
            return f"0x{entry.default:X} + node id"
        if written_in_hex(entry):
            return f"0x{entry.default:0{2 * (size_of(entry.data_type) or 1)}X}"
    return "" if entry.default is None else str(entry.default)


def _bound(limit: int | None) -> str:
    return "" if limit is None else str(limit)


def check_files(arguments: argparse.Namespace) -> int:
    """Check the files; 2 when one of them is not accepted."""
    return max([check_file(Path(file)) for file in arguments.files])


def check_file(path: Path) -> int:
    """Print what a file holds and what is wrong with it."""
    try:
        described = load(path)
        for remark in described.remarks:
            tell(remark)
        if is_402(described) and (missing := lacking(described.entries)):
            raise InputError(f"a CiA 402 drive needs the objects {', '.join(missing)}", file=str(path))
    except InputError as error:
        tell(error)
        return error.exit_status
    drive = is_402(described)
    kind = "CiA 402 drive" if drive else "CANopen device"
    say(f"{path}: {kind}, {len(described.names)} objects, {len(described.entries)} entries, accepted")
    if drive:
        if missing := lacking(described.entries, CYCLIC):
            say(f"  cannot be moved by the bench's CNC, for want of {', '.join(missing)}")
        for off in features_off(described.entries):
            say(f"  off, for want of objects: {off}")
    return 0


def is_402(described: ObjectDictionary) -> bool:
    """Tell whether it is a drive: by its device type (0x1000, low word), where that is open by its status word."""
    number = described[DEVICE_TYPE].default if DEVICE_TYPE in described else None
    if not isinstance(number, int) or not number:
        return CONTROLWORD in described and STATUSWORD in described
    return number & 0xFFFF == CIA402
