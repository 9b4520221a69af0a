"""Drive models: modules found by their path, each with `create` and, in `MODEL`, the name of its EDS."""

import traceback
from pathlib import Path
from typing import Any, Final

from hli_bench.base.errors import STOPS, BenchError, InputError, told
from hli_bench.base.loading import SUPPLIED, data_file, is_module, module

FOLDER: Final = "drives."
"""How machine folders name the drives of the project, after their folder in its source tree."""


def supplied_name(name: str) -> str:
    """Return the module that a path under `drives` means: the project's own where it has one, else the user's.

    The project's are installed as `hli_bench_drives`, because a user's project may have a folder drives/ of its own.
    """
    own = f"{SUPPLIED}.{name.removeprefix(FOLDER)}"
    return own if name.startswith(FOLDER) and is_module(own) else name


def drive_model(name: str) -> Any:
    """Return the drive model at a module path. Raises InputError when there is none, or it cannot be loaded."""
    try:
        loaded = module(supplied_name(name))
    except BenchError:
        raise
    except SyntaxError as error:
        raise InputError(f"syntax: {error.msg}", error.filename or name, error.lineno or 0) from error
    except STOPS:
        raise
    except BaseException as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        raise InputError(told(error), last.filename, last.lineno or 0) from error
    if not callable(getattr(loaded, "create", None)):
        raise InputError(f"{name!r} is no drive model, it has no create()")
    return loaded


def eds_of(model: Any) -> Path | None:
    """Return the EDS that a drive model names, None when it names none. Raises InputError for a file that is not."""
    eds = getattr(getattr(model, "MODEL", None), "eds", None)
    return None if eds is None else data_file("eds", eds)
