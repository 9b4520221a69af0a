"""EDS parser: python-canopen as oracle, and a clear place for every way a file can be broken."""

import re
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
        ("[2001]", "[1000]", 12, "stands twice, first in line 5"),
        ("ObjectType=0x7", "ObjectType 0x7", 7, "neither"),
        ("[MandatoryObjects]", "Key=1", 1, "before the first"),
        ("ParameterName=Device type\n", "", 5, "lacks ParameterName"),
        ("DataType=0x0007\n", "", 5, "lacks DataType"),
        ("DataType=0x0007", "DataType=0x0099", 8, "0x0099"),
        ("DataType=0x0007", "DataType=seven", 8, "'seven'"),
        ("AccessType=ro", "AccessType=maybe", 9, "ro, wo, rw"),
        ("AccessType=ro\n", "", 5, "lacks AccessType"),
        ("ObjectType=0x7", "ObjectType=0x5", 7, "7 VAR"),
        ("DefaultValue=0x192", "DefaultValue=0x100000000", 10, "0..4294967295"),
        ("DefaultValue=0x192", "DefaultValue=abc", 10, "'abc'"),
        ("SubNumber=1", "SubNumber=2", 15, "SubNumber of [2001] is 2, the file has 1"),
        ("LowLimit=0", "LowLimit=11", 20, "above HighLimit 10"),
        ("DefaultValue=3", "DefaultValue=12", 22, "outside 0..10"),
        ("HighLimit=10", "HighLimit=300", 21, "0..255"),
        ("1=0x1000", "1=0x1001", 3, "no [1001]"),
        ("1=0x1000", "1=first", 3, "not an index"),
        ("SupportedObjects=1", "SupportedObjects=2", 2, "1 are listed"),
        ("[2001sub0]", "[2002sub0]", 15, "SubNumber"),
    ],
)
def test_broken_files_name_file_line_and_value(old: str, new: str, line: int, part: str) -> None:
    with pytest.raises(InputError, match=re.escape(part)) as error:
        parse_text(SMALL.replace(old, new, 1), "drive.eds")
    if old != "[2001sub0]":
        assert (error.value.file, error.value.line) == ("drive.eds", line)


def test_sub_section_without_object() -> None:
    with pytest.raises(InputError, match=r"\[3000sub1\] has no \[3000\]") as error:
        parse_text(SMALL + "[3000sub1]\nParameterName=lost\n")
    assert error.value.line == 23


def test_empty_and_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no \\[section\\]"):
        parse_text("; nothing\n", "x.eds")
    with pytest.raises(InputError, match="cannot read") as error:
        load(tmp_path / "none.eds")
    assert error.value.file.endswith("none.eds")


def test_dcf_values_and_node_id() -> None:
    text = SMALL.replace("DefaultValue=3", "DefaultValue=3\nParameterValue=4")
    parsed = parse_text(text + "[DeviceComissioning]\nNodeID=0x11\n")
    assert parsed[0x2001, 0].default == 4
    assert parsed.node_id == 0x11
    with pytest.raises(InputError, match=r"allowed 1\.\.127"):
        parse_text(SMALL + "[DeviceComissioning]\nNodeID=128\n")


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
    with pytest.raises(InputError, match="2100Value"):
        parse_text(text.replace("3=-5", "3=x"))


@pytest.mark.parametrize("text", ["$NODEID+0x180", "0x180+$NODEID", "0x180 + $nodeid"])
def test_node_id_is_added(text: str) -> None:
    parsed = parse_text(SMALL.replace("0x192", text))
    assert parsed[0x1000, 0].default_for(3) == 0x183


@pytest.mark.parametrize(("text", "value"), [("010", 8), ("0", 0), ("0x10", 16), ("10", 10)])
def test_numbers_as_in_c(text: str, value: int) -> None:
    assert parse_text(SMALL.replace("0x192", text))[0x1000, 0].default == value
