"""EL1252: two fast digital inputs whose edges are latched in DC time.

The image is the terminal's input bits, each in a byte of its own here, followed by the 34 bytes of its latch
unit: status, then the times of the last positive and negative edge of each channel.
"""

from typing import Final

from hli_bench.laws.rows import Rows
from hli_bench.terminals.settings import Channel, TerminalSettings, wired
from hli_bench.wire.images import TerminalLayout

MODELS: Final = ("EL1252",)
CHANNELS: Final = 2
DELAY_NS: Final = 0
"""The data sheet says below 1 us; a calibrated terminal is the default (decided here)."""


def layout(settings: TerminalSettings) -> TerminalLayout:
    """Return where the entries lie in the image."""
    return TerminalLayout(
        settings.name,
        (
            ("ch1/input", "BOOL", 0),
            ("ch2/input", "BOOL", 1),
            ("ch1/status", "UNS08", 2),
            ("ch2/status", "UNS08", 3),
            ("ch1/latch_pos", "UNS64", 4),
            ("ch1/latch_neg", "UNS64", 12),
            ("ch2/latch_pos", "UNS64", 20),
            ("ch2/latch_neg", "UNS64", 28),
        ),
    )


def channels(settings: TerminalSettings) -> tuple[Channel, ...]:
    """Return the two inputs with their latch mode."""
    return wired(settings, CHANNELS, DELAY_NS)


def image(rows: Rows) -> bytes:
    """Return the process image from the two channel rows."""
    flags = bytes(int(value) for field in ("input", "status") for value in rows[field])
    times = (int(row[field]) for row in rows for field in ("latch_pos", "latch_neg"))
    return flags + b"".join(time.to_bytes(8, "little") for time in times)
