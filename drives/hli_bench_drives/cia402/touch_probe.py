"""Touch probe function (0x60B8) and status (0x60B9), and the function words a CNC writes."""

from enum import IntEnum, IntFlag
from typing import Final


class ProbeFunction(IntFlag):
    """Bits of 0x60B8 for touch probe 1; touch probe 2 has the same, eight bits higher."""

    ENABLE = 0x01
    CONTINUOUS = 0x02
    ZERO_PULSE = 0x04
    SOURCE_BY_60D0 = 0x08
    POSITIVE_EDGE = 0x10
    NEGATIVE_EDGE = 0x20


class ProbeStatus(IntFlag):
    """Bits of 0x60B9 for touch probe 1; touch probe 2 has the same, eight bits higher."""

    ENABLED = 0x01
    POSITIVE_STORED = 0x02
    NEGATIVE_STORED = 0x04


class ProbeSource(IntEnum):
    """Values of 0x60D0."""

    INPUT_1 = 1
    INPUT_2 = 2
    ZERO_PULSE = 5


def touch_probe(number: int, function: ProbeFunction) -> int:
    """Return the bits of touch probe 1 or 2 in place, for 0x60B8 or 0x60B9."""
    return int(function) << 8 * (number - 1)


_ANY_BY_60D0: Final = int(ProbeFunction.SOURCE_BY_60D0) * 0x0101


def probe_input(number: int, *, positive: bool, drive_defined: bool = False) -> int:
    """Return the 0x60B8 that arms touch probe `number` for one edge, once.

    `drive_defined` leaves the source to 0x60D0 instead of the input of that number.
    """
    function = ProbeFunction.ENABLE
    function |= ProbeFunction.POSITIVE_EDGE if positive else ProbeFunction.NEGATIVE_EDGE
    if drive_defined:
        function |= ProbeFunction.SOURCE_BY_60D0
    return touch_probe(number, function)


def zero_pulse(number: int) -> int:
    """Return the 0x60B8 that arms touch probe `number` for the next zero pulse, once."""
    function = ProbeFunction.ENABLE | ProbeFunction.ZERO_PULSE | ProbeFunction.POSITIVE_EDGE
    return touch_probe(number, function)


def resolve_source(function: int, sources: tuple[int, int]) -> int:
    """Return the function word with `SOURCE_BY_60D0` replaced by what 0x60D0 says for each touch probe."""
    if not function & _ANY_BY_60D0:
        return function
    resolved = function
    for number, source in enumerate(sources, start=1):
        by_object = touch_probe(number, ProbeFunction.SOURCE_BY_60D0)
        if not function & by_object:
            continue
        resolved &= ~by_object & ~touch_probe(number, ProbeFunction.ZERO_PULSE)
        if source == ProbeSource.ZERO_PULSE:
            resolved |= touch_probe(number, ProbeFunction.ZERO_PULSE)
    return resolved
