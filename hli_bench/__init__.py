"""hli-bench: an emulated CNC, its drives and terminals, and an open CNC-PLC interface."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hli_bench.bench.bench import Bench

__all__ = ["Bench"]


def __getattr__(name: str) -> Any:
    """Load the bench (and the compiler with it) only when it is asked for."""
    if name != "Bench":
        raise AttributeError(f"module 'hli_bench' has no attribute {name!r}")
    from hli_bench.bench.bench import Bench

    return Bench
