"""Marks laws: plain functions on rows, which `native` has compiled, all of them together."""

from collections.abc import Callable
from typing import Any, Final, TypeVar

Law = TypeVar("Law", bound=Callable[..., Any])
LAWS: Final[list[Callable[..., Any]]] = []
"""Every law, in the order in which their modules were imported."""


def law(function: Law) -> Law:
    """Let compiled laws call `function`; called from Python it stays the plain function it is."""
    LAWS.append(function)
    return function
