"""Time as whole nanoseconds, always passed in, and the distributed-clock epoch."""

from datetime import UTC, datetime
from typing import Final, NewType

Ns = NewType("Ns", int)
"""Whole nanoseconds of bench time (since bench start) or, where the name says `dc`, of DC time."""

NS_PER_US: Final = 1_000
NS_PER_MS: Final = 1_000_000
NS_PER_S: Final = 1_000_000_000

DC_EPOCH: Final = datetime(2000, 1, 1, tzinfo=UTC)
"""Zero of DC time: 64-bit nanoseconds since 2000-01-01 00:00 UTC (EtherCAT distributed clocks)."""

DC_END: Final = datetime(2200, 1, 1, tzinfo=UTC)
"""A bench begins before this, so that its DC time fits into 64 bits for as long as it runs (decided here)."""


def dc_ns(instant: datetime) -> Ns:
    """Return the DC time of `instant` (timezone aware) in ns since 2000-01-01 UTC."""
    span = instant.astimezone(UTC) - DC_EPOCH
    return Ns((span.days * 86_400 + span.seconds) * NS_PER_S + span.microseconds * NS_PER_US)
