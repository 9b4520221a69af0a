"""CiA 301 data types: how a value looks as bytes on the bus."""

import struct
from enum import IntEnum
from typing import Final

Value = int | float | str | bytes
"""What an object holds; BOOLEAN is an int of 0 or 1."""


class DataType(IntEnum):
    """Data type codes of an EDS that this dictionary stores (CiA 301, static data types)."""

    BOOLEAN = 0x01
    INTEGER8 = 0x02
    INTEGER16 = 0x03
    INTEGER32 = 0x04
    UNSIGNED8 = 0x05
    UNSIGNED16 = 0x06
    UNSIGNED32 = 0x07
    REAL32 = 0x08
    VISIBLE_STRING = 0x09
    OCTET_STRING = 0x0A
    UNICODE_STRING = 0x0B
    DOMAIN = 0x0F
    REAL64 = 0x11
    INTEGER64 = 0x15
    UNSIGNED64 = 0x1B


STRUCT_CODES: Final = {
    DataType.BOOLEAN: "B",
    DataType.INTEGER8: "b",
    DataType.INTEGER16: "h",
    DataType.INTEGER32: "i",
    DataType.UNSIGNED8: "B",
    DataType.UNSIGNED16: "H",
    DataType.UNSIGNED32: "I",
    DataType.REAL32: "f",
    DataType.REAL64: "d",
    DataType.INTEGER64: "q",
    DataType.UNSIGNED64: "Q",
}
"""`struct` codes (little endian) of the types of fixed size."""

_CODECS: Final = {kind: struct.Struct("<" + code) for kind, code in STRUCT_CODES.items()}
_SIGNED: Final = {
    DataType.INTEGER8: 8,
    DataType.INTEGER16: 16,
    DataType.INTEGER32: 32,
    DataType.INTEGER64: 64,
}
_UNSIGNED: Final = {
    DataType.BOOLEAN: 1,
    DataType.UNSIGNED8: 8,
    DataType.UNSIGNED16: 16,
    DataType.UNSIGNED32: 32,
    DataType.UNSIGNED64: 64,
}
_TEXT: Final = {DataType.VISIBLE_STRING: "latin-1", DataType.UNICODE_STRING: "utf-16-le"}
_REAL: Final = (DataType.REAL32, DataType.REAL64)


def size_of(kind: DataType) -> int | None:
    """Return the bytes a value takes on the bus, None for strings and domains."""
    codec = _CODECS.get(kind)
    return None if codec is None else codec.size


def integer_range(kind: DataType) -> tuple[int, int] | None:
    """Return the least and greatest integer of an integer type, None for other types."""
    if kind in _SIGNED:
        half = 1 << (_SIGNED[kind] - 1)
        return -half, half - 1
    if kind in _UNSIGNED:
        return 0, (1 << _UNSIGNED[kind]) - 1
    return None


def pack(kind: DataType, value: Value) -> bytes:
    """Return the value as bytes. Raises ValueError when it does not fit the type."""
    codec = _CODECS.get(kind)
    try:
        if codec is not None:
            return codec.pack(value)
        if isinstance(value, str):
            return value.encode(_TEXT.get(kind, "latin-1"))
        if isinstance(value, bytes):
            return value
    except (struct.error, UnicodeEncodeError, OverflowError) as error:
        raise ValueError(f"{value!r} does not fit {kind.name}: {error}") from error
    raise ValueError(f"{value!r} does not fit {kind.name}")


def unpack(kind: DataType, data: bytes) -> Value:
    """Return the value of `data`. Raises ValueError when the length does not match the type."""
    codec = _CODECS.get(kind)
    if codec is not None:
        if len(data) != codec.size:
            raise ValueError(f"{kind.name} takes {codec.size} bytes, not {len(data)}")
        value: Value = codec.unpack(data)[0]
        return value
    encoding = _TEXT.get(kind)
    return bytes(data) if encoding is None else data.decode(encoding, errors="replace")


def parse(kind: DataType, text: str) -> Value:
    """Return the value that an EDS prints as `text`. Raises ValueError when it is none of the type.

    Negative numbers of signed types may be printed as two's complement in hexadecimal, as is usual.
    """
    if kind in _TEXT:
        return text
    if kind in _REAL:
        return _real(kind, text)
    limits = integer_range(kind)
    if limits is None:
        return bytes.fromhex(text)
    number = _integer(text)
    if kind in _SIGNED and text.strip().lower().startswith("0x") and number > limits[1]:
        number -= 1 << _SIGNED[kind]
    if not limits[0] <= number <= limits[1]:
        raise ValueError(f"{text} does not fit {kind.name} ({limits[0]}..{limits[1]})")
    return number


def _real(kind: DataType, text: str) -> float:
    """Return a decimal number, or the one whose bits are printed in hexadecimal."""
    if not text.strip().lower().startswith("0x"):
        return float(text)
    codec = _CODECS[kind]
    bits = int(text, 16)
    if bits >> 8 * codec.size:
        raise ValueError(f"{text} has more bits than {kind.name}")
    return float(codec.unpack(bits.to_bytes(codec.size, "little"))[0])


def _integer(text: str) -> int:
    """Return a decimal or 0x number; a leading zero means octal, as CiA 306 takes from the C language."""
    bare = text.strip()
    sign = -1 if bare.startswith("-") else 1
    digits = bare.lstrip("+-")
    if len(digits) > 1 and digits[0] == "0" and digits.isdigit():
        return sign * int(digits, 8)
    return sign * int(digits, 0)
