"""How often Python looks for garbage in a process that is ours: what is loaded stays, a bench goes as a whole."""

import gc
from typing import Final

THRESHOLDS: Final = (50_000, 20, 100)


def seldom() -> None:
    """Look seldom: with Python's own thresholds a tenth of the time of a start goes into looking."""
    gc.set_threshold(*THRESHOLDS)


def of_one_run() -> None:
    """Look at what a run has left, while it is still in the cache: looking later costs five times as much."""
    gc.collect(0)
