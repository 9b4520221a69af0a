"""EDS and DCF files (CiA 306) as an ObjectDictionary; broken files are reported with file and line."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from functools import lru_cache
from itertools import takewhile
from pathlib import Path
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.protocols.canopen.datatypes import DataType, Value, integer_range, parse

_INDEX: Final = re.compile(r"[0-9A-F]{4}")
_SUB: Final = re.compile(r"([0-9A-F]{4})SUB([0-9A-F]{1,2})")
_NODE_ID: Final = re.compile(r"\+?\$NODEID\+?")
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
    return parse_text(path.read_text(encoding="latin-1"), str(path))


@lru_cache(maxsize=64)
def parse_text(text: str, file: str = "") -> ObjectDictionary:
    """Parse the text of an EDS or DCF, once a process for the same text. Raises InputError with `file` and line."""
    return _Reader(file, _sections(text, file)).dictionary()


@dataclass(frozen=True, slots=True)
class _Section:
    """One bracketed section: where it starts, and value and line per upper-case key."""

    name: str
    line: int
    keys: dict[str, tuple[str, int]] = field(default_factory=dict)


def _sections(text: str, file: str) -> dict[str, _Section]:
    """Split into sections by upper-case name. Raises InputError for lines that fit nowhere."""
    sections: dict[str, _Section] = {}
    current: _Section | None = None
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.split(";", 1)[0].strip()
        if not line:
            continue
        if line.startswith("["):
            if not line.endswith("]"):
                raise InputError(f"section {line!r} is not closed with ]", file, number)
            name = line[1:-1].strip()
            if name.upper() in sections:
                first = sections[name.upper()].line
                raise InputError(f"section [{name}] stands twice, first in line {first}", file, number)
            current = sections[name.upper()] = _Section(name, number)
            continue
        key, equals, value = line.partition("=")
        if not equals:
            raise InputError(f"{line!r} is neither [section] nor key=value", file, number)
        if current is None:
            raise InputError(f"key {key.strip()!r} stands before the first [section]", file, number)
        current.keys[key.strip().upper()] = (value.strip(), number)
    if not sections:
        raise InputError("not an EDS: no [section] in it", file)
    return sections


class _Reader:
    """Turns sections into entries; keeps the file name for messages."""

    __slots__ = ("_file", "_sections")

    def __init__(self, file: str, sections: dict[str, _Section]) -> None:
        self._file = file
        self._sections = sections

    def dictionary(self) -> ObjectDictionary:
        """Return the dictionary of the whole file."""
        names: dict[int, str] = {}
        entries: dict[tuple[int, int], Entry] = {}
        indices = sorted(int(name, 16) for name in self._sections if _INDEX.fullmatch(name))
        for index in indices:
            section = self._sections[f"{index:04X}"]
            names[index] = self._text(section, "ParameterName")
            for entry in self._object(index, section):
                entries[index, entry.subindex] = entry
        self._check_lists(names)
        self._check_orphans(names)
        info = self._sections.get("DEVICEINFO")
        return ObjectDictionary(
            entries,
            names,
            {} if info is None else {key: value for key, (value, _) in info.keys.items()},
            self._commissioned_node(),
        )

    def _object(self, index: int, section: _Section) -> Iterable[Entry]:
        """Yield the entries of one object by its ObjectType (missing: VAR)."""
        code = self._number(section, "ObjectType", ObjectType.VAR)
        try:
            kind = ObjectType(code)
        except ValueError:
            known = ", ".join(f"{item.value} {item.name}" for item in ObjectType)
            raise self._error(section, "ObjectType", f"ObjectType {code} is none of {known}") from None
        if kind in {ObjectType.VAR, ObjectType.DOMAIN}:
            return [self._entry(section, index, 0, kind)]
        compact = self._number(section, "CompactSubObj", 0)
        if compact:
            return self._compact(index, section, compact)
        return self._subs(index, section)

    def _subs(self, index: int, section: _Section) -> list[Entry]:
        """Return the entries of the [xxxxsubN] sections; their count must be SubNumber."""
        found = []
        for name, sub_section in self._sections.items():
            match = _SUB.fullmatch(name)
            if match and int(match[1], 16) == index:
                found.append(self._entry(sub_section, index, int(match[2], 16), ObjectType.VAR))
        expected = self._number(section, "SubNumber", len(found))
        if len(found) != expected:
            message = f"SubNumber of [{section.name}] is {expected}, the file has {len(found)}"
            raise self._error(section, "SubNumber", message)
        return sorted(found, key=lambda entry: entry.subindex)

    def _compact(self, index: int, section: _Section, count: int) -> list[Entry]:
        """Return sub 0 and `count` like entries; names and values may stand in [xxxxName], [xxxxValue]."""
        like = self._entry(section, index, 1, ObjectType.VAR)
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
        named = self._sections.get(f"{index:04X}NAME", _Section("", 0)).keys
        valued = self._sections.get(f"{index:04X}VALUE", _Section("", 0)).keys
        for sub in range(1, count + 1):
            name = named.get(str(sub), (f"{like.name}{sub}", 0))[0]
            default, plus_node = like.default, like.default_plus_node_id
            if str(sub) in valued:
                default, plus_node = self._value(like.data_type, *valued[str(sub)], key=f"{index:04X}Value")
            entries.append(
                Entry(
                    index,
                    sub,
                    name,
                    like.data_type,
                    like.access,
                    like.pdo_mappable,
                    default,
                    plus_node,
                    like.low,
                    like.high,
                )
            )
        return entries

    def _entry(self, section: _Section, index: int, subindex: int, kind: ObjectType) -> Entry:
        """Return the entry that one section describes."""
        domain = DataType.DOMAIN if kind is ObjectType.DOMAIN else None
        data_type = self._data_type(section, domain)
        access = self._access(section, domain)
        low, high = self._limit(section, "LowLimit", data_type), self._limit(section, "HighLimit", data_type)
        if low is not None and high is not None and low > high:
            raise self._error(
                section, "LowLimit", f"LowLimit {low} of [{section.name}] is above HighLimit {high}"
            )
        default: Value | None = None
        plus_node = False
        key = "PARAMETERVALUE" if "PARAMETERVALUE" in section.keys else "DEFAULTVALUE"
        if section.keys.get(key, ("", 0))[0]:
            default, plus_node = self._value(data_type, *section.keys[key], key=f"{key} of [{section.name}]")
        if isinstance(default, int) and not plus_node:
            self._check_range(section, key, default, (low, high))
        return Entry(
            index,
            subindex,
            self._text(section, "ParameterName"),
            data_type,
            access,
            bool(self._number(section, "PDOMapping", 0)),
            default,
            plus_node,
            low,
            high,
        )

    def _check_range(
        self, section: _Section, key: str, value: int, limits: tuple[int | None, int | None]
    ) -> None:
        """Raise InputError when the default is outside the limits of its own section."""
        low, high = limits
        if (low is not None and value < low) or (high is not None and value > high):
            raise self._error(section, key, f"{key} {value} of [{section.name}] is outside {low}..{high}")

    def _data_type(self, section: _Section, missing: DataType | None) -> DataType:
        """Return the DataType key as an enum member."""
        if missing is not None and "DATATYPE" not in section.keys:
            return missing
        code = self._number(section, "DataType", None)
        try:
            return DataType(code)
        except ValueError:
            message = f"DataType 0x{code:04X} of [{section.name}] is no type this dictionary stores"
            raise self._error(section, "DataType", message) from None

    def _access(self, section: _Section, domain: DataType | None) -> Access:
        """Return the AccessType key as an enum member; a domain without one is rw."""
        if domain is not None and "ACCESSTYPE" not in section.keys:
            return Access.RW
        word = self._text(section, "AccessType").lower()
        try:
            return Access(word)
        except ValueError:
            allowed = ", ".join(Access)
            message = f"AccessType {word!r} of [{section.name}] is none of {allowed}"
            raise self._error(section, "AccessType", message) from None

    def _limit(self, section: _Section, key: str, data_type: DataType) -> int | None:
        """Return a limit of an integer object, None when the key is missing, empty or the type has none."""
        text, line = section.keys.get(key.upper(), ("", 0))
        if not text or integer_range(data_type) is None:
            return None
        value, _ = self._value(data_type, text, line, key=f"{key} of [{section.name}]")
        return value if isinstance(value, int) else None

    def _value(self, data_type: DataType, text: str, line: int, *, key: str) -> tuple[Value, bool]:
        """Return a printed value and whether the node id is to be added."""
        bare = text
        plus_node = False
        if integer_range(data_type) is not None:
            bare = text.replace(" ", "").upper()
            plus_node = "$NODEID" in bare
            bare = _NODE_ID.sub("", bare) or "0"
        try:
            return parse(data_type, bare), plus_node
        except ValueError as error:
            message = f"{key}: {text!r} is no {data_type.name}: {error}"
            raise InputError(message, self._file, line) from None

    def _text(self, section: _Section, key: str) -> str:
        """Return a key that must be there."""
        if key.upper() not in section.keys:
            raise InputError(f"[{section.name}] lacks {key}", self._file, section.line)
        return section.keys[key.upper()][0]

    def _number(self, section: _Section, key: str, missing: int | None) -> int:
        """Return an integer key; `missing` None means that it must be there."""
        if missing is not None and not section.keys.get(key.upper(), ("", 0))[0]:
            return int(missing)
        text = self._text(section, key)
        try:
            number = parse(DataType.UNSIGNED32, text)
        except ValueError:
            message = f"{key} of [{section.name}] is {text!r}, not a number of 0..0xFFFFFFFF"
            raise self._error(section, key, message) from None
        return int(number)

    def _error(self, section: _Section, key: str, message: str) -> InputError:
        """Return an error at the line of `key`, or of its section when the key is missing."""
        return InputError(message, self._file, section.keys.get(key.upper(), ("", section.line))[1])

    def _check_lists(self, names: Mapping[int, str]) -> None:
        """Raise when a list section names an object that has no section."""
        for list_name in _OBJECT_LISTS:
            section = self._sections.get(list_name, _Section("", 0))
            listed = {key: value for key, value in section.keys.items() if key != "SUPPORTEDOBJECTS"}
            for text, line in listed.values():
                try:
                    index = int(text, 0)
                except ValueError:
                    raise InputError(
                        f"[{section.name}] lists {text!r}, not an index", self._file, line
                    ) from None
                if index not in names:
                    message = f"[{section.name}] lists 0x{index:04X}, there is no [{index:04X}]"
                    raise InputError(message, self._file, line)
            if "SUPPORTEDOBJECTS" in section.keys:
                count = self._number(section, "SupportedObjects", None)
                if count != len(listed):
                    message = f"SupportedObjects of [{section.name}] is {count}, {len(listed)} are listed"
                    raise self._error(section, "SupportedObjects", message)

    def _check_orphans(self, names: Mapping[int, str]) -> None:
        """Raise when a sub-index section has no object section."""
        for name, section in self._sections.items():
            match = _SUB.fullmatch(name)
            if match and int(match[1], 16) not in names:
                raise InputError(f"[{section.name}] has no [{match[1]}]", self._file, section.line)

    def _commissioned_node(self) -> int | None:
        """Return the node id of a DCF; the section is spelt with one m in the standard."""
        section = self._sections.get("DEVICECOMISSIONING")
        if section is None or not section.keys.get("NODEID", ("", 0))[0]:
            return None
        node_id = self._number(section, "NodeID", None)
        if not 1 <= node_id <= 127:
            raise self._error(section, "NodeID", f"NodeID is {node_id}, allowed 1..127")
        return node_id
