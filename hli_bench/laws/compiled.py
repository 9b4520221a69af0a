"""How a law is compiled: numba, cached on disk, without fast-math, so that plain Python gives the same bits."""

from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import numba
import numpy as np

Law = TypeVar("Law", bound=Callable[..., Any])
_TEXT: Final = sha256(
    b"".join(file.read_bytes() for file in sorted(Path(__file__).parent.glob("*.py")))
).hexdigest()
_STRAIGHT: Final[dict[tuple[Any, ...], Any]] = {}
"""Entries into the machine code by law and types: looking for the types of thirteen arrays takes milliseconds."""
_OPTIONS: Final[Mapping[str, Any]] = {"fastmath": False, "error_model": "numpy", "forceinline": True}


def law(function: Law) -> Law:
    """Compile `function`; `NUMBA_DISABLE_JIT=1` leaves it as plain Python.

    What is compiled is kept in NUMBA_CACHE_DIR, beside the laws or in the user's cache directory, whichever can
    be written first; where none can, every process compiles anew.
    """
    try:
        compiled: Any = numba.njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:
        compiled = numba.njit(**_OPTIONS)(function)
    else:
        _stamp(compiled)
    return cast("Law", compiled)


def straight(function: Law, *arguments: Any) -> Law:
    """Return a law for arguments of exactly the types of these, compiled by now.

    A call goes to the machine code without looking for the types of its arguments first, which costs more than a
    cycle of motion. Plain Python stays as it is.
    """
    if not hasattr(function, "overloads"):
        return function
    kinds = tuple(
        (argument.dtype, argument.ndim) if isinstance(argument, np.ndarray) else type(argument)
        for argument in arguments
    )
    if (function, kinds) not in _STRAIGHT:
        compiled: Any = function
        types = tuple(numba.typeof(argument) for argument in arguments)  # type: ignore[no-untyped-call]
        compiled.compile(types)
        _STRAIGHT[function, kinds] = compiled.overloads[types].entry_point
    return cast("Law", _STRAIGHT[function, kinds])


def _stamp(compiled: Any) -> None:
    """Let the cached code of a law count for as long as the text of all laws is the same.

    numba looks at the date of the one file only: code of a law that calls into a changed file would stay,
    and a fresh install of the same text would be compiled anew.
    """
    cache: Any = getattr(compiled, "_cache", None)
    if cache is not None and hasattr(cache, "_cache_file"):
        cache._source_stamp = cache._cache_file._source_stamp = _TEXT  # noqa: SLF001 numba has no public way
