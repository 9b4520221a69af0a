"""What the machine folder says about a terminal, and what a terminal says about its inputs."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from hli_bench.base.errors import InputError

CONTINUOUS: Final = "continuous"
SINGLE_EVENT: Final = "single_event"


@dataclass(frozen=True, slots=True)
class Channel:
    """One input: the signal it is wired to (empty: none), its input delay, its latch mode, its clock."""

    signal: str
    delay_ns: int = 0
    single_event: bool = False
    clock_skew_ns: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class TerminalSettings:
    """One terminal. `wiring`: signal by channel (`ch2`); `delay_ns` None: what the model has."""

    name: str
    model: str
    period_us: int
    wiring: Mapping[str, str] = field(default_factory=dict)
    mode: str = CONTINUOUS
    delay_ns: int | None = None
    clock_skew_ns: int = 0


def wired(settings: TerminalSettings, count: int, delay_ns: int) -> tuple[Channel, ...]:
    """Return the inputs `ch1`..`ch<count>` of a terminal. Raises InputError for a channel that it has not."""
    names = [f"ch{number}" for number in range(1, count + 1)]
    for channel in settings.wiring:
        if channel not in names:
            raise InputError(
                f"terminal.{settings.name}.wiring.{channel}: {settings.model} has ch1..ch{count} only"
            )
    delay = delay_ns if settings.delay_ns is None else settings.delay_ns
    single = settings.mode == SINGLE_EVENT
    skew = settings.clock_skew_ns
    return tuple(Channel(settings.wiring.get(name, ""), delay, single, skew) for name in names)
