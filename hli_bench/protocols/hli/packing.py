"""Packed messages of the HLI: image, commands of a PLC, single members. All little-endian."""

import struct
from struct import Struct
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.base.time import Ns
from hli_bench.protocols.hli.image import Value
from hli_bench.protocols.hli.layout import Element, Layout
from hli_bench.wire.hli import Commands, Write

IMAGE_HEADER: Final = Struct("<Qq")
"""Cycle and DC time in ns in front of the elements."""

REPEATED: Final = 4
"""How often a PLC may write each element of the layout in one message (decided here)."""
LONGEST_TEXT: Final = 64
"""Characters of a value as text; the longest that fits a type has 20 digits (decided here)."""

_CYCLE: Final = Struct("<Q")
_WORDS: Final = {"true": True, "false": False}


def pack_image(cycle: int, dc_ns: Ns, image: bytes) -> bytes:
    """Return the message `hli/image`."""
    return IMAGE_HEADER.pack(cycle, dc_ns) + image


def unpack_image(message: bytes, size: int) -> tuple[int, Ns, bytes]:
    """Return cycle, DC ns and the `size` element bytes of the message `hli/image`.

    Raises InputError for one of another size: anybody may put to the key.
    """
    if len(message) != IMAGE_HEADER.size + size:
        raise InputError(f"an image of {len(message)} bytes, {IMAGE_HEADER.size + size} expected")
    cycle, dc_ns = IMAGE_HEADER.unpack_from(message)
    return cycle, Ns(dc_ns), message[IMAGE_HEADER.size :]


class CommandsPacking:
    """Packs and unpacks `plc/<name>/commands`: u64 cycle answered, then u16 element id, value and so on."""

    __slots__ = ("_entries", "_layout", "_longest")

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        structs = {code: Struct("<H" + code) for code in {element.code for element in layout.elements}}
        self._entries = [structs[element.code] for element in layout.elements]
        self._longest = _CYCLE.size + REPEATED * sum(entry.size for entry in self._entries)

    def pack(self, commands: Commands) -> bytes:
        """Return the message. Raises InputError for a path or value the layout does not have."""
        answered = _CYCLE.pack(commands.cycle)
        if not commands.writes:
            return answered
        message = [answered]
        for write in commands.writes:
            element = self._layout.element(write.path)
            try:
                message.append(self._entries[element.id].pack(element.id, write.value))
            except struct.error as error:
                raise InputError(f"{write.path}: {write.value!r} is no {element.type}") from error
        return b"".join(message)

    def cycle(self, message: bytes) -> int:
        """Return the cycle that the message answers. Raises InputError when it is shorter than that."""
        if len(message) < _CYCLE.size:
            raise InputError(f"{len(message)} bytes: commands begin with the cycle answered, 8 bytes")
        answered: int = _CYCLE.unpack_from(message)[0]
        return answered

    def unpack(self, plc: str, message: bytes) -> Commands:
        """Return the commands of `plc`. Raises InputError for an unknown element id or a cut-off entry."""
        cycle, at = self.cycle(message), _CYCLE.size
        if len(message) == at:
            return Commands(plc, cycle, ())
        if len(message) > self._longest:
            raise InputError(
                f"{len(message)} bytes: commands have at most {self._longest}, each element {REPEATED} times"
            )
        writes: list[Write] = []
        while at < len(message):
            number = int.from_bytes(message[at : at + 2], "little")
            if number >= len(self._entries):
                raise InputError(
                    f"byte {at}: no element with id {number}, the layout ends at {len(self._entries) - 1}"
                )
            entry = self._entries[number]
            if at + entry.size > len(message):
                raise InputError(f"byte {at}: entry of {self._layout.elements[number].path} is cut off")
            element = self._layout.elements[number]
            value = entry.unpack_from(message, at)[1]
            # A byte that is no BOOL stays a number, and is refused as one.
            as_it_is = message[at + 2] if element.type == "BOOL" and message[at + 2] > 1 else value
            writes.append(Write(element.path, as_it_is))
            at += entry.size
        return Commands(plc, cycle, tuple(writes))


def as_text(value: Value) -> str:
    """Return the value as people and JSON write it: true, false, 123."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def decoded(element: Element, payload: bytes, *, is_text: bool = False) -> Value:
    """Return the value in `payload`: packed by the element's type, or text such as `TRUE`, `123`, `16#1F`.

    Raises InputError with the reason when it is not of the element's type or size.
    """
    if is_text:
        return _from_text(element, payload)
    if len(payload) != element.size:
        raise InputError(f"{len(payload)} bytes, {element.type} takes {element.size}")
    if element.type == "BOOL" and payload[0] > 1:
        raise InputError(f"{payload[0]} is no BOOL: 0 or 1 expected")
    value: Value = Struct("<" + element.code).unpack(payload)[0]
    return value


def _from_text(element: Element, payload: bytes) -> Value:
    if len(payload) > LONGEST_TEXT:
        raise InputError(f"{len(payload)} bytes of text: a {element.type} takes at most {LONGEST_TEXT}")
    text = payload.decode("utf-8", "replace").strip()
    if text.lower() in _WORDS:
        return _WORDS[text.lower()]
    try:
        base, sharp, digits = text.partition("#")
        return int(digits, int(base)) if sharp else int(text)
    except ValueError as error:
        raise InputError(f"{text!r} is no {element.type}") from error
