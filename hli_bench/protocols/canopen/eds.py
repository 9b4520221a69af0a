"""EDS and DCF files (CiA 306) as an ObjectDictionary.

Files of the field bend the standard in many ways. What can be read in spite of it is read, and said in a remark with
file and line; what cannot is left out and said. Only a file without any object is an error: what a drive cannot do
without is known where it is built.
"""

import re
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import IntEnum, StrEnum
from functools import lru_cache
from itertools import takewhile
from pathlib import Path
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.protocols.canopen.datatypes import DataType, Value, integer_range, pack, parse
from hli_bench.protocols.canopen.eds_sections import Remarks, Section, sections, text_of

_INDEX: Final = re.compile(r"[0-9A-F]{4}")
_SUB: Final = re.compile(r"([0-9A-F]{4})SUB([0-9A-F]{1,2})")
_NODE_ID: Final = re.compile(r"\+?\$NODE_?ID\+?")
_MOST_SUBS: Final = 254
_OBJECT_LISTS: Final = ("MANDATORYOBJECTS", "OPTIONALOBJECTS", "MANUFACTUREROBJECTS")


class Access(StrEnum):
    """Access words of an EDS; `rww`/`rwr` are read-write objects for RPDOs/TPDOs."""

    RO = "ro"
    WO = "wo"
    RW = "rw"
    RWR = "rwr"
    RWW = "rww"
    CONST = "const"

    @property
    def readable(self) -> bool:
        """Whether an SDO upload is allowed."""
        return self is not Access.WO

    @property
    def writable(self) -> bool:
        """Whether an SDO download is allowed."""
        return self not in {Access.RO, Access.CONST}


class ObjectType(IntEnum):
    """Object codes of an EDS that hold values."""

    DOMAIN = 2
    VAR = 7
    ARRAY = 8
    RECORD = 9


@dataclass(frozen=True, slots=True)
class Entry:
    """One sub-index. `default` excludes the node id, which is added when `default_plus_node_id`."""

    index: int
    subindex: int
    name: str
    data_type: DataType
    access: Access
    pdo_mappable: bool
    default: Value | None = None
    default_plus_node_id: bool = False
    low: int | None = None
    high: int | None = None

    def default_for(self, node_id: int) -> Value:
        """Return the value after power-on in node `node_id`; zero or nothing where the EDS gives none."""
        if self.default is None:
            return _ZERO.get(self.data_type, 0)
        if self.default_plus_node_id and isinstance(self.default, int):
            return self.default + node_id
        return self.default


_ZERO: Final[Mapping[DataType, Value]] = {
    DataType.VISIBLE_STRING: "",
    DataType.UNICODE_STRING: "",
    DataType.OCTET_STRING: b"",
    DataType.DOMAIN: b"",
    DataType.REAL32: 0.0,
    DataType.REAL64: 0.0,
}


@dataclass(frozen=True, slots=True, eq=False)
class ObjectDictionary:
    """All entries of an EDS, in the order of index and sub-index, and the names of its objects.

    `node_id` is the one a DCF commissions, else None. One is made for one text, and is the same only as itself, so
    that what follows from it is worked out once for all nodes of its kind.
    """

    entries: Mapping[tuple[int, int], Entry]
    names: Mapping[int, str]
    device_info: Mapping[str, str] = field(default_factory=dict)
    node_id: int | None = None
    remarks: tuple[str, ...] = ()
    """What is wrong with the file, with file and line; it was read all the same."""

    def __contains__(self, address: tuple[int, int]) -> bool:
        return address in self.entries

    def __getitem__(self, address: tuple[int, int]) -> Entry:
        return self.entries[address]

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries.values())

    def subindices(self, index: int) -> tuple[int, ...]:
        """Return the sub-indices of an array or a record behind its count in 0."""
        return _subindices(self, index)

    def has_object(self, index: int) -> bool:
        """Whether any sub-index of `index` exists."""
        return index in self.names


@lru_cache(maxsize=1024)
def _subindices(description: ObjectDictionary, index: int) -> tuple[int, ...]:
    return tuple(takewhile(lambda sub: (index, sub) in description.entries, range(1, 0xFF)))


def load(path: Path) -> ObjectDictionary:
    """Read an EDS or DCF file, once a process as long as it is not written. Raises InputError with file and line."""
    try:
        status = path.stat()
        return _read(path, (status.st_ino, status.st_ctime_ns, status.st_size))
    except OSError as error:
        raise InputError(f"cannot read: {error.strerror}", file=str(path)) from error


@lru_cache(maxsize=64)
def _read(path: Path, written: tuple[int, int, int]) -> ObjectDictionary:
    """Read a file that was last `written` so (inode, time of change in ns, size)."""
    return parse_text(text_of(path.read_bytes()), str(path))


@lru_cache(maxsize=64)
def parse_text(text: str, file: str = "") -> ObjectDictionary:
    """Parse the text of an EDS or DCF, once a process for the same text. Raises InputError with `file`."""
    remarks = Remarks(file)
    return _Reader(remarks, sections(text.removeprefix("\ufeff"), remarks)).dictionary()


class _Reader:
    """Turns sections into entries, and what is wrong with them into remarks."""

    __slots__ = ("_remarks", "_sections")

    def __init__(self, remarks: Remarks, sections: dict[str, Section]) -> None:
        self._remarks = remarks
        self._sections = sections

    def dictionary(self) -> ObjectDictionary:
        """Return the dictionary of the whole file. Raises InputError when there is no object in it."""
        names: dict[int, str] = {}
        entries: dict[tuple[int, int], Entry] = {}
        indices = sorted(int(name, 16) for name in self._sections if _INDEX.fullmatch(name))
        for index in indices:
            section = self._sections[f"{index:04X}"]
            found = list(self._object(index, section))
            if found:
                names[index] = self._name(section)
            for entry in found:
                entries[index, entry.subindex] = entry
        self._check_lists(indices)
        self._check_orphans(indices)
        info = self._sections.get("DEVICEINFO")
        node_id = self._commissioned_node()
        if not entries:
            about = "".join(f"\n{remark}" for remark in self._remarks.lines())
            raise InputError(f"not an EDS: no object in it{about}", self._remarks.file)
        return ObjectDictionary(
            entries,
            names,
            {} if info is None else {key: value for key, (value, _) in info.keys.items()},
            node_id,
            self._remarks.lines(),
        )

    def _object(self, index: int, section: Section) -> Iterable[Entry]:
        """Return the entries of one object by its ObjectType (missing: VAR)."""
        code = self._number(section, "ObjectType", ObjectType.VAR)
        try:
            kind = ObjectType(code)
        except ValueError:
            known = ", ".join(f"{item.value} {item.name}" for item in ObjectType)
            self._remark(
                section, "ObjectType", f"[{section.name}] is left out: ObjectType {code} is none of {known}"
            )
            return []
        if kind in {ObjectType.VAR, ObjectType.DOMAIN}:
            return self._entry(section, index, 0, kind)
        compact = self._number(section, "CompactSubObj", 0)
        if compact > _MOST_SUBS:
            self._remark(
                section, "CompactSubObj", f"CompactSubObj {compact} of [{section.name}] is above {_MOST_SUBS}"
            )
        if compact:
            return self._compact(index, section, min(compact, _MOST_SUBS))
        return self._subs(index, section)

    def _subs(self, index: int, section: Section) -> list[Entry]:
        """Return the entries of the [xxxxsubN] sections; their count should be SubNumber."""
        found: dict[int, Section] = {}
        for name, sub_section in self._sections.items():
            match = _SUB.fullmatch(name)
            if match and int(match[1], 16) == index:
                found[int(match[2], 16)] = sub_section
        expected = self._number(section, "SubNumber", len(found))
        if len(found) != expected:
            message = f"SubNumber of [{section.name}] is {expected}, the file has {len(found)}"
            self._remark(section, "SubNumber", message)
        return [
            entry for sub in sorted(found) for entry in self._entry(found[sub], index, sub, ObjectType.VAR)
        ]

    def _compact(self, index: int, section: Section, count: int) -> list[Entry]:
        """Return sub 0 and `count` like entries; names and values may stand in [xxxxName], [xxxxValue]."""
        entries = [
            Entry(
                index,
                0,
                "Number of entries",
                DataType.UNSIGNED8,
                Access.RO,
                pdo_mappable=False,
                default=count,
            )
        ]
        named = self._sections.get(f"{index:04X}NAME", Section("", 0)).keys
        valued = self._sections.get(f"{index:04X}VALUE", Section("", 0)).keys
        for like in self._entry(section, index, 1, ObjectType.VAR):
            for sub in range(1, count + 1):
                name = named.get(str(sub), (f"{like.name}{sub}", 0))[0]
                default, plus_node = like.default, like.default_plus_node_id
                if str(sub) in valued:
                    key = f"{index:04X}Value"
                    default, plus_node = self._value(like.data_type, *valued[str(sub)], key=key)
                entries.append(
                    replace(like, subindex=sub, name=name, default=default, default_plus_node_id=plus_node)
                )
        return entries

    def _entry(self, section: Section, index: int, subindex: int, kind: ObjectType) -> list[Entry]:
        """Return the entry that one section describes, none when its type cannot be stored."""
        domain = DataType.DOMAIN if kind is ObjectType.DOMAIN else None
        data_type = self._data_type(section, domain)
        if data_type is None:
            return []
        key = "PARAMETERVALUE" if "PARAMETERVALUE" in section.keys else "DEFAULTVALUE"
        default: Value | None = None
        plus_node = False
        if section.value(key)[0]:
            default, plus_node = self._value(data_type, *section.value(key), key=f"{key} of [{section.name}]")
        low, high = self._limits(section, data_type)
        if isinstance(default, int) and not plus_node and not _within(default, low, high):
            self._remark(section, key, f"{key} {default} of [{section.name}] is outside {low}..{high}")
        return [
            Entry(
                index,
                subindex,
                self._name(section),
                data_type,
                self._access(section, domain),
                bool(self._number(section, "PDOMapping", 0)),
                default,
                plus_node,
                low,
                high,
            )
        ]

    def _data_type(self, section: Section, missing: DataType | None) -> DataType | None:
        """Return the DataType key as an enum member, None for one that is missing or cannot be stored."""
        text, _ = section.value("DataType")
        if not text:
            if missing is None:
                self._remark(section, "DataType", f"[{section.name}] is left out: it lacks DataType")
            return missing
        code = self._number(section, "DataType", 0)
        try:
            return DataType(code)
        except ValueError:
            message = f"[{section.name}] is left out: DataType 0x{code:04X} is no type this dictionary stores"
            self._remark(section, "DataType", message)
            return None

    def _access(self, section: Section, domain: DataType | None) -> Access:
        """Return the AccessType key as an enum member; a domain without one is rw, anything else ro."""
        text, _ = section.value("AccessType")
        if not text and domain is not None:
            return Access.RW
        try:
            return Access(text.lower())
        except ValueError:
            allowed = ", ".join(Access)
            message = f"AccessType {text!r} of [{section.name}] is none of {allowed}: taken as ro"
            self._remark(section, "AccessType", message)
            return Access.RO

    def _limits(self, section: Section, data_type: DataType) -> tuple[int | None, int | None]:
        """Return the limits of an integer object; those that make no sense limit nothing."""
        low, high = self._limit(section, "LowLimit", data_type), self._limit(section, "HighLimit", data_type)
        if low is not None and high is not None and low > high:
            texts = " and ".join(section.value(key)[0] for key in ("LowLimit", "HighLimit"))
            message = (
                f"LowLimit and HighLimit of [{section.name}], {texts}, limit nothing: as {data_type.name} "
            )
            self._remark(section, "LowLimit", message + f"they are {low} and {high}")
            return None, None
        return low, high

    def _limit(self, section: Section, key: str, data_type: DataType) -> int | None:
        """Return a limit of an integer object, None when the key is missing, empty or the type has none."""
        text, line = section.value(key)
        if not text or integer_range(data_type) is None:
            return None
        value, _ = self._value(data_type, text, line, key=f"{key} of [{section.name}]")
        return value if isinstance(value, int) else None

    def _value(self, data_type: DataType, text: str, line: int, *, key: str) -> tuple[Value | None, bool]:
        """Return a printed value, None for one that cannot be read, and whether the node id is to be added."""
        bare = text
        plus_node = False
        if integer_range(data_type) is not None:
            bare = text.replace(" ", "").upper()
            plus_node = _NODE_ID.search(bare) is not None
            bare = _NODE_ID.sub("", bare) or "0"
        try:
            value = parse(data_type, bare)
            pack(data_type, value)
        except ValueError as error:
            self._remarks.add(line, f"{key}: {text!r} is no {data_type.name}, it is left out: {error}")
            return None, False
        return value, plus_node

    def _name(self, section: Section) -> str:
        """Return the name of an object."""
        text, _ = section.value("ParameterName")
        if not text:
            self._remark(section, "ParameterName", f"[{section.name}] lacks ParameterName")
        return text or section.name

    def _number(self, section: Section, key: str, missing: int) -> int:
        """Return an integer key, `missing` when it is missing or cannot be read."""
        text, line = section.value(key)
        if not text:
            return missing
        try:
            return int(parse(DataType.UNSIGNED32, text))
        except ValueError:
            message = f"{key} of [{section.name}] is {text!r}, not a number of 0..0xFFFFFFFF"
            self._remarks.add(line, message)
            return missing

    def _remark(self, section: Section, key: str, message: str) -> None:
        """Note something at the line of `key`, or of its section when the key is missing."""
        self._remarks.add(section.value(key)[1], message)

    def _check_lists(self, indices: Container[int]) -> None:
        """Note when a list section names an object that has no section, or counts otherwise."""
        for list_name in _OBJECT_LISTS:
            section = self._sections.get(list_name, Section("", 0))
            listed = {key: value for key, value in section.keys.items() if key != "SUPPORTEDOBJECTS"}
            for text, line in listed.values():
                try:
                    index = int(text, 0)
                except ValueError:
                    self._remarks.add(line, f"[{section.name}] lists {text!r}, not an index")
                    continue
                if index not in indices:
                    self._remarks.add(
                        line, f"[{section.name}] lists 0x{index:04X}, there is no [{index:04X}]"
                    )
            count = self._number(section, "SupportedObjects", len(listed))
            if count != len(listed):
                message = f"SupportedObjects of [{section.name}] is {count}, {len(listed)} are listed"
                self._remark(section, "SupportedObjects", message)

    def _check_orphans(self, indices: Container[int]) -> None:
        """Note sub-index sections without an object section."""
        for name, section in self._sections.items():
            match = _SUB.fullmatch(name)
            if match and int(match[1], 16) not in indices:
                self._remarks.add(section.line, f"[{section.name}] is left out: there is no [{match[1]}]")

    def _commissioned_node(self) -> int | None:
        """Return the node id of a DCF; the section is spelt with one m in the standard."""
        section = self._sections.get("DEVICECOMISSIONING") or self._sections.get("DEVICECOMMISSIONING")
        if section is None or not section.value("NodeID")[0]:
            return None
        node_id = self._number(section, "NodeID", 0)
        if not 1 <= node_id <= 127:
            self._remark(section, "NodeID", f"NodeID is {node_id}, allowed 1..127: it is left out")
            return None
        return node_id


def _within(value: int, low: int | None, high: int | None) -> bool:
    """Tell whether a value is within the limits that there are."""
    return (low is None or value >= low) and (high is None or value <= high)
