"""The one place that loads by name: modules of a variant folder, user scripts, data files of the project."""

import importlib
import importlib.util
import json
import shlex
import sys
from functools import lru_cache
from pathlib import Path
from types import CodeType, ModuleType
from typing import Final

from hli_bench.base import paths
from hli_bench.base.errors import InputError

_PACKAGE = Path(__file__).resolve().parent.parent
_CHILD = (
    "import json, runpy, sys; sys.path[:] = json.loads(sys.argv.pop(1)); "
    "runpy.run_module(sys.argv.pop(1), run_name='__main__', alter_sys=True)"
)


@lru_cache(maxsize=256)
def data_file(folder: str, name: str) -> Path:
    """Return the path of `folder/name` (`eds`, `plc_scripts`, `programs`, `machines`), in a checkout or a wheel.

    Raises InputError when neither place has it.
    """
    places = [_PACKAGE.parent / folder / name, _PACKAGE / "_data" / folder / name, _PACKAGE / folder / name]
    for place in places:
        if paths.exists(place):
            return place
    raise InputError(f"no {name!r} in {folder}/")


def supplied(folder: str) -> list[str]:
    """Return the names of the files that come with the project in a folder (`programs`, `plc_scripts`)."""
    places = (_PACKAGE.parent / folder, _PACKAGE / "_data" / folder)
    return sorted(path.name for place in places if place.is_dir() for path in place.iterdir())


SUPPLIED: Final = "hli_bench_drives"
"""The package of the emulated drives, which the bench knows by name only."""


def is_module(name: str) -> bool:
    """Tell whether there is a module of that dotted path; the packages above it are imported for it."""
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def module(name: str) -> ModuleType:
    """Import a module by its dotted path. Raises InputError when there is none of that name."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name is not None and (name == error.name or name.startswith(error.name + ".")):
            raise InputError(f"no module {name!r} on the Python path") from error
        raise


def child_command(name: str, *arguments: str) -> list[str]:
    """Return the command that runs a module as a process of its own, which finds modules where this one does.

    `python -m` would look in the current directory before, where a user's `can.py` or `zenoh.py` may lie.
    """
    path = [place for place in sys.path if isinstance(place, str)]
    return [sys.executable, "-P", "-c", _CHILD, json.dumps(path), name, *arguments]


def installed(name: str) -> Path:
    """Return the file of an installed package without importing it."""
    spec = importlib.util.find_spec(name)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"{name} is not installed")
    return Path(spec.origin)


def version() -> str:
    """Return the version of hli-bench that is installed."""
    from importlib import metadata

    return metadata.version("hli-bench")


def how_to_install(package: str) -> str:
    """Return the command that installs a package for the Python that runs here, be it a checkout's or any other."""
    return f"{shlex.quote(sys.executable)} -m pip install {package}"


def script(path: Path) -> ModuleType:
    """Load a user's Python file as a module of its own. Raises InputError when it cannot be read.

    It may import what lies beside it; behind all other places, so that no name there hides a module of ours. The file
    itself is always read from its text: byte code that Python keeps beside it counts as fresh when the file is changed
    to one of the same size within a second, as scripts made by tests are.
    """
    if not paths.is_file(path):
        raise InputError("no such file", file=str(path))
    name = f"hli_bench_script_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None:
        raise InputError("not a Python file", file=str(path))
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[name] = loaded
    exec(_compiled(path.read_bytes(), path), vars(loaded))
    return loaded


@lru_cache(maxsize=32)
def _compiled(text: bytes, path: Path) -> CodeType:
    """Return the byte code of a script, compiled once a process for the same text."""
    code: CodeType = compile(text, path, "exec")
    return code
