"""Bytes of typed values."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.protocols.canopen.datatypes import DataType, integer_range, pack, parse, size_of, unpack

INTEGERS = [kind for kind in DataType if integer_range(kind)]


@pytest.mark.parametrize("kind", INTEGERS)
def test_integers_at_their_limits(kind: Any) -> None:
    low, high = integer_range(kind)
    for value in (low, high):
        assert unpack(kind, pack(kind, value)) == value
        assert len(pack(kind, value)) == size_of(kind)
        assert parse(kind, str(value)) == value
    for outside in (low - 1, high + 1):
        with pytest.raises(ValueError, match="fit"):
            parse(kind, str(outside))
    with pytest.raises(ValueError, match="fit"):
        pack(kind, 1 << 70)


@given(st.text(alphabet=st.characters(max_codepoint=255)))
def test_strings(text: str) -> None:
    assert unpack(DataType.VISIBLE_STRING, pack(DataType.VISIBLE_STRING, text)) == text


def test_other_types() -> None:
    assert pack(DataType.UNICODE_STRING, "mä") == b"m\0\xe4\0"
    assert unpack(DataType.UNICODE_STRING, b"m\0\xe4\0") == "mä"
    assert parse(DataType.OCTET_STRING, "01 ff") == b"\x01\xff"
    assert unpack(DataType.OCTET_STRING, b"\x01") == b"\x01"
    assert unpack(DataType.REAL32, pack(DataType.REAL32, parse(DataType.REAL32, "1.5"))) == 1.5
    assert parse(DataType.INTEGER16, "0xFFFE") == -2
    assert parse(DataType.VISIBLE_STRING, "0x10") == "0x10"
    with pytest.raises(ValueError, match="takes 4 bytes, not 2"):
        unpack(DataType.INTEGER32, b"\0\0")
    with pytest.raises(ValueError, match="does not fit DOMAIN"):
        pack(DataType.DOMAIN, 1)
    with pytest.raises(ValueError, match="does not fit VISIBLE_STRING"):
        pack(DataType.VISIBLE_STRING, "\u20ac")
