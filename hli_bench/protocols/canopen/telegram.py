"""The standard telegram of a CiA 402 drive: which numbers travel cyclically in which PDO, for CNC, drives, recordings.

RPDO1 controlword, target position; RPDO2 touch probe function. TPDO1 statusword, actual position; TPDO2 touch probe
status, latched position of the first edge; TPDO3 torque, following error; TPDO4 digital inputs, latched position of
the second edge. Source: measurement manual 6.4 for what measuring needs.
"""

from collections.abc import Sequence
from functools import cache
from struct import Struct
from typing import Final, NamedTuple

from hli_bench.protocols.canopen.cia402_objects import LATCHES
from hli_bench.protocols.canopen.eds import ObjectDictionary

BITS: Final = {"H": 16, "h": 16, "i": 32, "I": 32}


class Number(NamedTuple):
    """One number: its name in rows of the laws (`element` of an array there), `struct` code, object (sub-index 0)."""

    name: str
    code: str
    object_index: int
    element: int | None = None

    @property
    def entry(self) -> int:
        """The mapping entry: index, sub-index, bits."""
        return self.object_index << 16 | BITS[self.code]


class Telegram:
    """One PDO: COB-ID of node 0, its numbers in order, their mapping entries, how the data bytes are packed."""

    __slots__ = ("base", "layout", "mapping", "numbers")

    def __init__(self, base: int, numbers: tuple[Number, ...]) -> None:
        self.base = base
        self.numbers = numbers
        self.mapping = tuple(number.entry for number in numbers)
        self.layout = Struct("<" + "".join(number.code for number in numbers))


RPDOS: Final = (
    Telegram(0x200, (Number("controlword", "H", 0x6040), Number("target", "i", 0x607A))),
    Telegram(0x300, (Number("probe_function", "H", 0x60B8),)),
)


@cache
def tpdos(probing_input: int = 0) -> tuple[Telegram, ...]:
    """Return the TPDOs that carry the latches of a probing input (0 or 1); 0 is the default map."""
    positive, negative = (one.object_index for one in LATCHES[2 * probing_input : 2 * probing_input + 2])
    return (
        Telegram(0x180, (Number("statusword", "H", 0x6041), Number("position", "i", 0x6064))),
        Telegram(0x280, (Number("probe_status", "H", 0x60B9), Number("latch", "i", positive, 0))),
        Telegram(0x380, (Number("torque_permille", "h", 0x6077), Number("following_error", "i", 0x60F4))),
        Telegram(0x480, (Number("digital_inputs", "I", 0x60FD), Number("latch", "i", negative, 1))),
    )


TPDOS: Final = tpdos()
TPDO_MAPPING: Final = 0x1A00


def changed(probing_input: int) -> Sequence[tuple[int, Telegram]]:
    """Return place and telegram of the TPDOs that are not the default ones for a probing input."""
    pairs = zip(TPDOS, tpdos(probing_input), strict=True)
    return [
        (place, other) for place, (default, other) in enumerate(pairs) if other.mapping != default.mapping
    ]


ALL_BASES: Final = frozenset(telegram.base for telegram in TPDOS)
MOTION: Final = TPDOS[0].base
"""Status word and actual position: without it nothing moves."""
PROBE: Final = TPDOS[1].base
"""Touch probe status and latch."""


def mapped(description: ObjectDictionary) -> frozenset[int]:
    """Return the base COB-IDs of the standard actual value telegrams that a drive with this dictionary sends."""
    found = set()
    for place, telegram in enumerate(TPDOS):
        mapping = TPDO_MAPPING + place
        given = [_default(description, mapping, number) for number in range(1, len(telegram.mapping) + 1)]
        counted = _default(description, mapping, 0) == len(telegram.mapping)
        if counted and tuple(given) == telegram.mapping:
            found.add(telegram.base)
    return frozenset(found)


def _default(description: ObjectDictionary, index: int, subindex: int) -> object:
    address = (index, subindex)
    return description[address].default if address in description else None
