"""Function blocks with their meaning of IEC 61131-3: `self.edge(CLK=io.probe.ch2.input)`, then `self.edge.Q`.

Calling an instance runs it once and returns its output Q. Timers take the time of the task's cycle; PT and ET
are in milliseconds. As in the standard, R_TRIG sees an edge on its first call with CLK = TRUE and F_TRIG on
its first call with CLK = FALSE.
"""
# ruff: noqa: N801, N803, FBT001 - names and inputs of the blocks are those of the standard

from collections.abc import Callable
from contextvars import ContextVar
from functools import wraps
from typing import Any, Final, ParamSpec, TypeVar

from hli_bench.base.time import NS_PER_MS, Ns

TASK_TIME: Final[ContextVar[Ns]] = ContextVar("TASK_TIME")
"""DC time of the task cycle that is running."""


TC2_STANDARD: Final = {"SET1": "S1", "RESET": "R", "SET": "S", "RESET1": "R1"}
"""Inputs of SR, RS and CTU as the PLC library Tc2_Standard names them, by which ported code calls them."""
P = ParamSpec("P")
R = TypeVar("R")


def both_names(call: Callable[P, R]) -> Callable[..., R]:
    """Let a block be called with the names of its inputs in IEC 61131-3 or in Tc2_Standard."""

    @wraps(call)
    def translated(*args: Any, **inputs: Any) -> R:
        return call(*args, **{TC2_STANDARD.get(name, name): value for name, value in inputs.items()})

    return translated


class R_TRIG:
    """Rising edge: Q is TRUE for the one call in which CLK became TRUE."""

    __slots__ = ("Q", "_last")

    def __init__(self) -> None:
        self.Q = False
        self._last = False

    def __call__(self, CLK: bool) -> bool:
        """Run the block once; return its output."""
        self.Q = bool(CLK) and not self._last
        self._last = bool(CLK)
        return self.Q


class F_TRIG:
    """Falling edge: Q is TRUE for the one call in which CLK became FALSE."""

    __slots__ = ("Q", "_last")

    def __init__(self) -> None:
        self.Q = False
        self._last = True

    def __call__(self, CLK: bool) -> bool:
        """Run the block once; return its output."""
        self.Q = not CLK and self._last
        self._last = bool(CLK)
        return self.Q


class _Timer:
    """What the three timers share: outputs Q and ET, and the start of the running time."""

    __slots__ = ("ET", "Q", "_start")

    def __init__(self) -> None:
        self.Q = False
        self.ET = 0.0
        self._start: Ns | None = None

    def _elapsed(self, PT: float) -> bool:
        now = TASK_TIME.get()
        if self._start is None:
            self._start = now
        elapsed_ns = now - self._start
        self.ET = min(elapsed_ns / NS_PER_MS, PT)
        return elapsed_ns >= PT * NS_PER_MS

    def _stop(self) -> None:
        self._start = None
        self.ET = 0.0


class TON(_Timer):
    """On delay: Q becomes TRUE when IN has been TRUE for PT, FALSE with IN."""

    __slots__ = ()

    def __call__(self, IN: bool, PT: float) -> bool:
        """Run the block once; return its output."""
        if IN:
            self.Q = self._elapsed(PT)
        else:
            self.Q = False
            self._stop()
        return self.Q


class TOF(_Timer):
    """Off delay: Q is TRUE with IN and stays so until IN has been FALSE for PT."""

    __slots__ = ()

    def __call__(self, IN: bool, PT: float) -> bool:
        """Run the block once; return its output."""
        if IN:
            self.Q = True
            self._stop()
        elif self.Q:
            self.Q = not self._elapsed(PT)
        return self.Q


class TP(_Timer):
    """Pulse: a rising edge of IN sets Q for PT, whatever IN does meanwhile; ET holds PT until IN is FALSE."""

    __slots__ = ("_last",)

    def __init__(self) -> None:
        super().__init__()
        self._last = False

    def __call__(self, IN: bool, PT: float) -> bool:
        """Run the block once; return its output."""
        if self.Q:
            self.Q = not self._elapsed(PT)
        elif IN and not self._last:
            self._stop()
            self.Q = not self._elapsed(PT)
        if not self.Q and not IN:
            self._stop()
        self._last = bool(IN)
        return self.Q


class SR:
    """Bistable, set dominant."""

    __slots__ = ("Q1",)

    def __init__(self) -> None:
        self.Q1 = False

    @both_names
    def __call__(self, S1: bool, R: bool) -> bool:
        """Run the block once; return its output."""
        self.Q1 = bool(S1) or (not R and self.Q1)
        return self.Q1


class RS:
    """Bistable, reset dominant."""

    __slots__ = ("Q1",)

    def __init__(self) -> None:
        self.Q1 = False

    @both_names
    def __call__(self, S: bool, R1: bool) -> bool:
        """Run the block once; return its output."""
        self.Q1 = not R1 and (bool(S) or self.Q1)
        return self.Q1


class CTU:
    """Up counter: CV counts rising edges of CU, R sets it to 0, Q tells CV >= PV."""

    __slots__ = ("CV", "Q", "_edge")

    def __init__(self) -> None:
        self.Q = False
        self.CV = 0
        self._edge = R_TRIG()

    @both_names
    def __call__(self, CU: bool, R: bool, PV: int) -> bool:
        """Run the block once; return its output."""
        rising = self._edge(CU)
        if R:
            self.CV = 0
        elif rising:
            self.CV += 1
        self.Q = self.CV >= PV
        return self.Q
