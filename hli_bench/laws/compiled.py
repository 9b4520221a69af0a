"""How a law is compiled: numba without fast-math, cached on disk, so that compiled and plain Python give the same bits."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Law = TypeVar("Law", bound=Callable[..., Any])


def law(function: Law) -> Law:
    """Compile `function`; `NUMBA_DISABLE_JIT=1` leaves it as plain Python."""
    compiled: Law = numba.njit(cache=True, fastmath=False, error_model="numpy")(function)
    return compiled
