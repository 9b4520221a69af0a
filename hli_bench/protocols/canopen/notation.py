"""How the standards write the values of objects."""

from typing import Final

from hli_bench.protocols.canopen.datatypes import DataType
from hli_bench.protocols.canopen.eds import Entry

_WORDS: Final = (DataType.UNSIGNED8, DataType.UNSIGNED16, DataType.UNSIGNED32)
_COUNTED: Final = (
    *range(0x1003, 0x1004),
    *range(0x1010, 0x1020),
    *range(0x1200, 0x1300),
    *range(0x1600, 0x1C00),
)
"""Objects whose sub-index 0 counts the others."""
_IN_HEX: Final = (
    range(0x1000, 0x1004),
    (0x1005, 0x1014, 0x1016, 0x1018),
    range(0x1200, 0x1300),
    range(0x1600, 0x1800),
    range(0x1A00, 0x1C00),
    (0x603F, 0x6040, 0x6041, 0x60B8, 0x60B9, 0x60FD, 0x60FE, 0x6502, 0x67FF),
)
"""What is a word of bits, an identifier or a mapping entry."""


def written_in_hex(entry: Entry) -> bool:
    """Tell whether the standard writes an object in hexadecimal: words of bits, identifiers, mapping entries."""
    if entry.data_type not in _WORDS or (entry.subindex == 0 and entry.index in _COUNTED):
        return False
    return any(entry.index in one for one in _IN_HEX)
