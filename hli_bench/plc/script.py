"""A user's PLC script: what it is made of, how it is found in its file, how its errors are told."""

import traceback
from pathlib import Path
from typing import Any

from hli_bench.base import loading
from hli_bench.base.errors import STOPS, InputError, told


class Plc:
    """Base of a PLC program; a script may subclass it or bring any class with `period_us` and `cycle`.

    `hli` holds the HLI as in ST, `hli.ax[2].lr_mc_control.probing_signal.command_w`; every member may be
    read, those that end in `_w` or `_rw` also written. `io` holds the process images: `io.probe.ch2.input`.
    """

    period_us = 1000

    def start(self, hli: Any, io: Any) -> None:
        """Run once, before the first cycle and with its inputs."""

    def cycle(self, hli: Any, io: Any) -> None:
        """Run once every `period_us`."""
        raise NotImplementedError


def load(path: Path) -> Any:
    """Return an instance of the script's class: the only one with `cycle`, or the one named `Plc`.

    Raises InputError with file and line when the script cannot be loaded or has no such class.
    """
    try:
        module = loading.script(path)
    except InputError:
        raise
    except SyntaxError as error:
        place = (error.filename or str(path), error.lineno or 0, error.offset or 0)
        raise InputError(f"syntax: {error.msg}", *place) from error
    except STOPS:
        raise
    except BaseException as error:
        raise script_error(error, path) from error
    found = {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type)
        and value.__module__ == module.__name__
        and callable(getattr(value, "cycle", None))
    }
    chosen = found.get("Plc") or (next(iter(found.values())) if len(found) == 1 else None)
    if chosen is None:
        names = ", ".join(found) or "none"
        raise InputError(
            f"one class with cycle(self, hli, io) expected, or one named Plc; found: {names}", str(path)
        )
    try:
        return chosen()
    except STOPS:
        raise
    except BaseException as error:
        raise script_error(error, path) from error


def period_of(script: Any, path: Path) -> int:
    """Return the period that a script has, us. Raises InputError when it has none that could be one."""
    period_us = getattr(script, "period_us", None)
    if isinstance(period_us, bool) or not isinstance(period_us, int):
        given = "is missing" if period_us is None else f"= {period_us!r}"
        message = f"{type(script).__name__}.period_us {given}: expected a whole number of microseconds"
        raise InputError(message, str(path))
    return period_us


def script_error(error: BaseException, path: Path) -> InputError:
    """Return `error` as the error of the script at `path`, with the line of the script that it came from."""
    return InputError(told(error), str(path), line_of(error, path))


def line_of(error: BaseException, path: Path) -> int:
    """Return the innermost line of the script at `path` that an error came from, 0 when there is none."""
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.lineno or 0 for frame in frames if Path(frame.filename).resolve() == path.resolve()]
    return lines[-1] if lines else 0
