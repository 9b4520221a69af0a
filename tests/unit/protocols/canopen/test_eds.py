"""EDS parser: python-canopen as oracle, and a clear place for every way a file can be broken."""

from pathlib import Path
from typing import Any

import canopen
import pytest
from canopen.objectdictionary import ODVariable

from hli_bench.base.errors import InputError
from hli_bench.protocols.canopen.datatypes import DataType
from hli_bench.protocols.canopen.eds import Access, load, parse_text

EDS = Path(__file__).with_name("node.eds")

SMALL = """[MandatoryObjects]
SupportedObjects=1
1=0x1000

[1000]
ParameterName=Device type
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=0x192
PDOMapping=0
[2001]
ParameterName=Record
ObjectType=9
SubNumber=1
[2001sub0]
ParameterName=Count ; how many
DataType=0x0005
AccessType=rw
LowLimit=0
HighLimit=10
DefaultValue=3
"""


def test_every_entry_is_read_as_python_canopen_reads_it(description: Any) -> None:
    oracle = canopen.import_od(str(EDS), 5)
    seen = 0
    for index in oracle:
        item = oracle[index]
        if index < 0x20:
            continue
        variables = [item] if isinstance(item, ODVariable) else [item[sub] for sub in item.subindices]
        for variable in variables:
            entry = description[variable.index, variable.subindex]
            assert entry.name == variable.name
            assert entry.data_type == variable.data_type
            assert entry.access == variable.access_type
            assert entry.pdo_mappable == variable.pdo_mappable
            assert (entry.low, entry.high) == (variable.min, variable.max)
            if variable.default is not None:
                assert entry.default_for(5) == variable.default
            seen += 1
    assert seen == len(description.entries)


def test_small_file() -> None:
    parsed = parse_text(SMALL)
    assert list(parsed.entries) == [(0x1000, 0), (0x2001, 0)]
    entry = parsed[0x2001, 0]
    assert (entry.name, entry.data_type, entry.access) == ("Count", DataType.UNSIGNED8, Access.RW)
    assert (entry.low, entry.high, entry.default) == (0, 10, 3)
    assert parsed.node_id is None
    assert (0x2001, 1) not in parsed


@pytest.mark.parametrize(
    ("old", "new", "line", "part"),
    [
        ("[1000]", "[1000", 5, "not closed"),
        ("[2001]", "[1000]", 12, "stands twice, the first in line 5 counts"),
        ("ObjectType=0x7", "ObjectType 0x7", 7, "neither"),
        ("[MandatoryObjects]", "Key=1", 1, "before the first"),
        ("ParameterName=Device type\n", "", 5, "lacks ParameterName"),
        ("DataType=0x0007\n", "", 5, "lacks DataType"),
        ("DataType=0x0007", "DataType=0x0099", 8, "0x0099"),
        ("DataType=0x0007", "DataType=seven", 8, "'seven'"),
        ("AccessType=ro", "AccessType=maybe", 9, "ro, wo, rw"),
        ("AccessType=ro\n", "", 5, "AccessType"),
        ("ObjectType=0x7", "ObjectType=0x5", 7, "7 VAR"),
        ("DefaultValue=0x192", "DefaultValue=0x100000000", 10, "0..4294967295"),
        ("DefaultValue=0x192", "DefaultValue=abc", 10, "'abc'"),
        ("SubNumber=1", "SubNumber=2", 15, "SubNumber of [2001] is 2, the file has 1"),
        ("LowLimit=0", "LowLimit=11", 20, "limit nothing"),
        ("DefaultValue=3", "DefaultValue=12", 22, "outside 0..10"),
        ("HighLimit=10", "HighLimit=300", 21, "0..255"),
        ("1=0x1000", "1=0x1001", 3, "no [1001]"),
        ("1=0x1000", "1=first", 3, "not an index"),
        ("SupportedObjects=1", "SupportedObjects=2", 2, "1 are listed"),
        ("[2001sub0]", "[2002sub0]", 15, "SubNumber"),
    ],
)
def test_what_is_wrong_is_remarked_with_file_line_and_value(old: str, new: str, line: int, part: str) -> None:
    parsed = parse_text(SMALL.replace(old, new, 1), "drive.eds")
    found = [remark for remark in parsed.remarks if part in remark]
    assert found[0].startswith(f"drive.eds:{line}: ")
    assert parsed.entries, "the rest is read"


def test_all_remarks_come_at_once_in_the_order_of_the_file() -> None:
    text = SMALL.replace("1=0x1000", "1=first").replace("AccessType=ro", "AccessType=maybe")
    lines = [int(remark.split(":")[1]) for remark in parse_text(text, "x.eds").remarks]
    assert lines == [3, 9]
    assert parse_text(SMALL).remarks == ()


def test_sub_section_without_object() -> None:
    (remark,) = parse_text(SMALL + "[3000sub1]\nParameterName=lost\n").remarks
    assert "[3000sub1] is left out: there is no [3000]" in remark


@pytest.mark.parametrize(
    ("kind", "text", "value"),
    [
        (8, "0x40490FDB", pytest.approx(3.14159265, rel=1e-6)),
        (0x11, "0x400921FB54442D18", pytest.approx(3.141592653589793)),
        (8, "2.5", 2.5),
        (2, "0xFF", -1),
        (3, "-0x10", -16),
        (4, "0xFFFFFFF6", -10),
        (4, "-10", -10),
    ],
)
def test_values_as_vendors_print_them(kind: int, text: str, value: Any) -> None:
    parsed = parse_text(SMALL.replace("DataType=0x0007", f"DataType={kind}").replace("0x192", text))
    assert parsed[0x1000, 0].default == value
    assert parsed.remarks == ()


def test_limits_of_an_unsigned_byte_on_a_signed_one_limit_nothing() -> None:
    text = SMALL.replace("DataType=0x0005", "DataType=2").replace("HighLimit=10", "HighLimit=0xFF")
    entry = parse_text(text)[0x2001, 0]
    assert (entry.low, entry.high, entry.default) == (None, None, 3)


@pytest.mark.parametrize("mark", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_is_read_over(tmp_path: Path, mark: str) -> None:
    path = tmp_path / "marked.eds"
    path.write_bytes(SMALL.encode(mark))
    described = load(path)
    assert described.remarks == ()
    assert described[0x1000, 0].default == 0x192


def test_empty_and_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no \\[section\\]"):
        parse_text("; nothing\n", "x.eds")
    with pytest.raises(InputError, match="no object in it"):
        parse_text("[FileInfo]\nFileName=x\n", "x.eds")
    with pytest.raises(InputError, match="cannot read") as error:
        load(tmp_path / "none.eds")
    assert error.value.file.endswith("none.eds")


def test_dcf_values_and_node_id() -> None:
    text = SMALL.replace("DefaultValue=3", "DefaultValue=3\nParameterValue=4")
    parsed = parse_text(text + "[DeviceComissioning]\nNodeID=0x11\n")
    assert parsed[0x2001, 0].default == 4
    assert parsed.node_id == 0x11
    other = parse_text(SMALL + "[DeviceComissioning]\nNodeID=128\n")
    assert other.node_id is None
    assert "allowed 1..127" in other.remarks[0]


def test_compact_arrays_with_names_and_values() -> None:
    text = """[2100]
ParameterName=Limit
ObjectType=8
CompactSubObj=3
DataType=0x0003
AccessType=rw
DefaultValue=0xFFFF
[2100Name]
NrOfEntries=1
2=Second
[2100Value]
NrOfEntries=1
3=-5
"""
    parsed = parse_text(text)
    assert [entry.subindex for entry in parsed] == [0, 1, 2, 3]
    assert [parsed[0x2100, sub].default for sub in range(4)] == [3, -1, -1, -5]
    assert [parsed[0x2100, sub].name for sub in (1, 2, 3)] == ["Limit1", "Second", "Limit3"]
    assert "2100Value" in parse_text(text.replace("3=-5", "3=x")).remarks[0]


@pytest.mark.parametrize(
    "text", ["$NODEID+0x180", "0x180+$NODEID", "0x180 + $nodeid", "$NodeID + 384", "384+$NODEID"]
)
def test_node_id_is_added(text: str) -> None:
    parsed = parse_text(SMALL.replace("0x192", text))
    assert parsed[0x1000, 0].default_for(3) == 0x183


def test_the_node_id_alone() -> None:
    for text in ("$NODEID", "$NODEID+0", "$NODEID+0x0"):
        assert parse_text(SMALL.replace("0x192", text))[0x1000, 0].default_for(3) == 3


@pytest.mark.parametrize(("text", "value"), [("010", 8), ("0", 0), ("0x10", 16), ("10", 10)])
def test_numbers_as_in_c(text: str, value: int) -> None:
    assert parse_text(SMALL.replace("0x192", text))[0x1000, 0].default == value
