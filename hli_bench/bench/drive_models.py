"""Drive models: modules found by their path, each with `create` and, in `MODEL`, the name of its EDS."""

from pathlib import Path
from typing import Any

from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file, module


def drive_model(name: str) -> Any:
    """Return the drive model at a module path. Raises InputError when there is none."""
    loaded = module(name)
    if not callable(getattr(loaded, "create", None)):
        raise InputError(f"{name!r} is no drive model, it has no create()")
    return loaded


def eds_of(name: str) -> Path | None:
    """Return the EDS that a drive model names, None when it names none. Raises InputError for a file that is not."""
    eds = getattr(getattr(drive_model(name), "MODEL", None), "eds", None)
    return None if eds is None else data_file("eds", eds)
