"""A terminal of a bench: finds the module of its model, keeps its image between refreshes."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Protocol, cast

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.base.loading import module
from hli_bench.base.time import NS_PER_US, Ns
from hli_bench.laws.rows import Rows
from hli_bench.terminals.settings import SINGLE_EVENT, Channel, TerminalSettings
from hli_bench.wire.images import ProcessImage, TerminalLayout


class TerminalType(Protocol):
    """What a module of this folder offers."""

    MODELS: tuple[str, ...]
    layout: Callable[[TerminalSettings], TerminalLayout]
    channels: Callable[[TerminalSettings], tuple[Channel, ...]]
    image: Callable[[Rows], bytes]


@cache
def types() -> dict[str, TerminalType]:
    """Return every terminal type of the folder by model name."""
    found: dict[str, TerminalType] = {}
    for path in sorted(Path(__file__).parent.glob("*.py")):
        loaded = module(f"{__package__}.{path.stem}") if path.stem != "__init__" else None
        if loaded is not None and hasattr(loaded, "MODELS"):
            kind = cast("TerminalType", loaded)
            found.update(dict.fromkeys(kind.MODELS, kind))
    return found


def type_of(settings: TerminalSettings) -> TerminalType:
    """Return the type of a terminal. Raises InputError for an unknown model."""
    known = types()
    if settings.model not in known:
        raise InputError(
            f"terminal.{settings.name}.model: {settings.model!r} is not one of {', '.join(known)}"
        )
    return known[settings.model]


class Terminal:
    """One terminal in operation. `first` is its first row among all channels of the bench."""

    __slots__ = ("_due_ns", "_image", "_period_ns", "_rows", "_state", "_type", "layout", "settings")

    def __init__(self, settings: TerminalSettings, channels: Rows, first: int, cycle_ns: int) -> None:
        self.settings = settings
        self._type = type_of(settings)
        self.layout = self._type.layout(settings)
        self._period_ns = settings.period_us * NS_PER_US
        if settings.mode == SINGLE_EVENT and self._period_ns != cycle_ns:
            raise NotEmulated(f"terminal.{settings.name}: single_event with another period than the cycle")
        self._rows = channels[first : first + len(self._type.channels(settings))]
        self._state = self._rows.tobytes()
        self._image = ProcessImage(settings.name, self._type.image(self._rows))
        self._due_ns = Ns(self._period_ns)

    @property
    def period_ns(self) -> int:
        """Time between refreshes."""
        return self._period_ns

    @property
    def due_ns(self) -> Ns:
        """Instant of the next refresh; no stride may run across it without a step."""
        return self._due_ns

    def step(self, now_ns: Ns) -> ProcessImage:
        """Return the image at `now_ns`, refreshed when the period has passed."""
        if now_ns >= self._due_ns:
            state = self._rows.tobytes()
            if state != self._state:
                self._state = state
                self._image = ProcessImage(self.settings.name, self._type.image(self._rows))
            self._due_ns = Ns((now_ns // self._period_ns + 1) * self._period_ns)
        return self._image
