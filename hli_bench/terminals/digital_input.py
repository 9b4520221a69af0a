"""Plain digital input terminals: eight channels, one bit each, behind an input filter."""

from collections.abc import Mapping
from typing import Final

from hli_bench.laws.rows import Rows
from hli_bench.terminals.settings import Channel, TerminalSettings, wired
from hli_bench.wire.images import TerminalLayout

FILTER_NS: Final[Mapping[str, int]] = {"EL1008": 3_000_000, "EL1018": 10_000}
"""Input filter by model: 3 ms and 10 us."""
MODELS: Final = tuple(FILTER_NS)
CHANNELS: Final = 8


def layout(settings: TerminalSettings) -> TerminalLayout:
    """Return where the entries lie in the image: a byte a channel (decided here)."""
    entries = tuple((f"ch{number + 1}/input", "BOOL", number) for number in range(CHANNELS))
    return TerminalLayout(settings.name, entries)


def channels(settings: TerminalSettings) -> tuple[Channel, ...]:
    """Return the eight inputs behind the filter of the model."""
    return wired(settings, CHANNELS, FILTER_NS[settings.model])


def image(rows: Rows) -> bytes:
    """Return the process image from the eight channel rows."""
    return bytes(int(value) for value in rows["input"])
