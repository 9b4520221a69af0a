"""How a law is compiled: numba, cached on disk, without fast-math, so that plain Python gives the same bits."""

from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar, cast

import numba

Law = TypeVar("Law", bound=Callable[..., Any])
_OPTIONS: Final[Mapping[str, Any]] = {"fastmath": False, "error_model": "numpy"}


def law(function: Law) -> Law:
    """Compile `function`; `NUMBA_DISABLE_JIT=1` leaves it as plain Python.

    What is compiled is kept in NUMBA_CACHE_DIR, beside the laws or in the user's cache directory, whichever can
    be written first; where none can, every process compiles anew.
    """
    try:
        compiled: Any = numba.njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:
        compiled = numba.njit(**_OPTIONS)(function)
    return cast("Law", compiled)
