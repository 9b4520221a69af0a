"""Process images of terminals as a PLC sees them in a cycle, and how they are laid out."""

from collections.abc import Mapping
from dataclasses import dataclass
from struct import calcsize, unpack_from
from typing import Final

STRUCT_CODE: Final[Mapping[str, str]] = {
    "BOOL": "?",
    "SGN08": "b",
    "UNS08": "B",
    "SGN16": "h",
    "UNS16": "H",
    "SGN32": "i",
    "UNS32": "I",
    "SGN64": "q",
    "UNS64": "Q",
    "REAL64": "d",
}
"""The manuals' data types and the `struct` code of each; every packed message is little-endian."""


def size_of(data_type: str) -> int:
    """Return the bytes of a value of `data_type` (BOOL: one)."""
    return calcsize("<" + STRUCT_CODE[data_type])


@dataclass(frozen=True, slots=True)
class TerminalLayout:
    """Where the entries of a terminal lie in its image: (`ch2/latch_pos`, `UNS64`, byte offset)."""

    name: str
    entries: tuple[tuple[str, str, int], ...]

    @property
    def size(self) -> int:
        """Bytes of the whole image."""
        return max((offset + size_of(data_type) for _, data_type, offset in self.entries), default=0)

    def values(self, image: bytes) -> dict[str, bool | int | float]:
        """Return the entries of an image by name."""
        return {
            entry: unpack_from("<" + STRUCT_CODE[data_type], image, offset)[0]
            for entry, data_type, offset in self.entries
        }


@dataclass(frozen=True, slots=True)
class ProcessImage:
    """The image of one terminal at the instant of a cycle, little-endian; latch times in DC ns."""

    terminal: str
    data: bytes
