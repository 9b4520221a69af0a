"""Options that several commands share, and what their texts mean."""

import argparse
import difflib
import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hli_bench.base import endpoints
from hli_bench.base.endpoints import DEFAULT_ENDPOINT
from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.base.loading import data_file, supplied
from hli_bench.base.paths import is_file, is_folder

Commands = Any
"""The subparsers action of argparse, whose class is private."""

DEFAULT_MACHINE: Final = "demo"
NO_PLC: Final = "none"
BUS: Final = re.compile(r"inproc|socketcan:\S+|socketcand:\S+:\d+")


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchOptions:
    """What a command line says about the bench to build; `zenoh` None: not on Zenoh, `plc` None: the machine's."""

    machine: str
    settings: dict[str, object]
    plc: list[str] | None
    pace: str
    realtime: bool
    can: str
    zenoh: str | None


def add_bench(parser: argparse.ArgumentParser, *, pace: str, zenoh: str | None) -> None:
    """Declare the options that say which bench to build, with a command's default pace and endpoint."""
    bench = parser.add_argument_group("the bench")
    bench.add_argument(
        "--machine",
        metavar="NAME|DIR",
        help=f"a machine of the package, or a folder (default {DEFAULT_MACHINE})",
    )
    bench.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        help="overrides a key of the machine folder, e.g. plant.probe.Z.face_mm=100; repeatable",
    )
    add_lenient(bench)
    bench.add_argument(
        "--plc",
        metavar="SCRIPT",
        action="append",
        help="replaces the machine's PLC scripts; repeatable; none: no PLC",
    )
    bench.add_argument(
        "--pace",
        choices=("free", "real"),
        help=f"as fast as possible and repeatable, or by the clock (default {pace})",
    )
    bench.add_argument(
        "--realtime",
        action="store_true",
        default=None,
        help="with --pace real: asks for SCHED_FIFO and locked memory, and says what it got",
    )
    bench.add_argument(
        "--can",
        metavar="BUS",
        type=bus,
        help="inproc, or socketcan:INTERFACE (default inproc); socketcand:HOST:PORT is not built yet",
    )
    bench.add_argument(
        "--zenoh",
        metavar="ENDPOINT",
        type=endpoint,
        help=f"where the HLI listens, e.g. {DEFAULT_ENDPOINT} (default {zenoh or 'off'})",
    )
    bench.add_argument("--modbus", metavar="HOST:PORT", help="not built yet: Modbus TCP")
    parser.set_defaults(default_pace=pace, default_zenoh=zenoh)


def add_lenient(parser: argparse._ActionsContainer) -> None:
    """Declare the option for lists of real machines."""
    parser.add_argument(
        "--lenient",
        action="store_true",
        default=None,
        help="list files: pass over parameters that the bench does not know and brackets that never close, "
        "and say in one remark which",
    )


def add_connect(parser: argparse.ArgumentParser) -> None:
    """Declare the options that say which bench, of those that are up, is meant."""
    parser.add_argument(
        "--connect",
        metavar="ENDPOINT",
        type=endpoint,
        default=DEFAULT_ENDPOINT,
        help="where the bench listens (default %(default)s)",
    )
    parser.add_argument(
        "--machine", metavar="NAME", default="", help="its machine, if several benches are there"
    )


def bus(text: str) -> str:
    """Return the text of `--can` if it has one of the three forms."""
    if not BUS.fullmatch(text):
        raise argparse.ArgumentTypeError(
            f"{text!r}: expected inproc, socketcan:INTERFACE or socketcand:HOST:PORT"
        )
    return text


def endpoint(text: str) -> str:
    """Return the text of `--zenoh` or `--connect` if it has the form of an endpoint."""
    try:
        return endpoints.endpoint(text)
    except InputError as error:
        raise argparse.ArgumentTypeError(error.message) from error


def bench_options(arguments: argparse.Namespace) -> BenchOptions:
    """Return what the options say. Raises InputError, and NotEmulated for what is not built."""
    if arguments.modbus is not None:
        raise NotEmulated("--modbus: Modbus TCP is not built yet")
    can = arguments.can or "inproc"
    if can.startswith("socketcand:"):
        raise NotEmulated(f"--can {can}: the socketcand protocol is not built yet")
    pace = arguments.pace or arguments.default_pace
    if arguments.realtime and pace != "real":
        raise InputError(f"only with --pace real, the pace is {pace}", file="--realtime")
    return BenchOptions(
        machine=machine_name(arguments.machine or DEFAULT_MACHINE),
        settings=settings_of(arguments),
        plc=None if arguments.plc is None else plc_scripts(arguments.plc),
        pace=pace,
        realtime=bool(arguments.realtime),
        can=can,
        zenoh=arguments.zenoh or arguments.default_zenoh,
    )


def settings_of(arguments: argparse.Namespace) -> dict[str, object]:
    """Return the overrides that `--set` and `--lenient` give. Raises InputError."""
    from hli_bench.bench.sources import parse_set

    settings = parse_set(arguments.set or [])
    return settings | {"lenient": True} if arguments.lenient else settings


def machine_name(text: str, place: str = "--machine") -> str:
    """Return `text` if it is a folder or a machine of the package. Raises InputError that names `place`."""
    if not is_folder(Path(text)):
        try:
            data_file("machines", text)
        except InputError as error:
            message = f"{text!r} is neither a machine of the package nor a folder with machine.toml"
            raise InputError(message, file=place) from error
    return text


def plc_scripts(texts: list[str]) -> list[str]:
    """Return the files of `--plc`, none for `none`. Raises InputError."""
    if texts == [NO_PLC]:
        return []
    if NO_PLC in texts:
        raise InputError(f"{NO_PLC} stands for itself, not beside a script", file="--plc")
    return [str(supplied_file("plc_scripts", text, ".py")) for text in texts]


def supplied_file(folder: str, text: str, suffix: str) -> Path:
    """Return a file by its path or, if there is none, by its name among those supplied in `folder`.

    The suffix may be left out. Raises InputError with the names that come near.
    """
    names = (text,) if text.endswith(suffix) else (text, text + suffix)
    for path in map(Path, names):
        if is_file(path):
            return path
        if len(path.parts) == 1:
            with suppress(InputError):
                return data_file(folder, path.name)
    if is_folder(Path(text)):
        raise InputError("is a folder, expected a file", file=text)
    near = difflib.get_close_matches(names[-1], supplied(folder), n=3, cutoff=0.6)
    hint = f" (did you mean {' or '.join(near)}?)" if near else ""
    raise InputError(f"no such file, nor one of {folder}/{hint}", file=text)
