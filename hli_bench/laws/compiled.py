"""How a law is compiled: numba, cached on disk, without fast-math, so that plain Python gives the same bits."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Law = TypeVar("Law", bound=Callable[..., Any])


def law(function: Law) -> Law:
    """Compile `function`; `NUMBA_DISABLE_JIT=1` leaves it as plain Python."""
    compiled: Any = numba.njit(cache=True, fastmath=False, error_model="numpy")
    return cast("Law", compiled(function))
