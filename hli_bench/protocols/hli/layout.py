"""The order of all HLI elements in the image: paths, types, offsets, and the names they can be called by."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from functools import lru_cache
from struct import Struct
from typing import Final, Self

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.rows import GROUP_ALIASES, MEMBER_ALIASES, Member, axis_members, channel_members
from hli_bench.wire.images import STRUCT_CODE, size_of

_ST_AREA: Final = re.compile(r"^(?:gp|p)?(Ax|AC|Ch)\[(\d+)\]\^?[./]?", re.IGNORECASE)
_OLD_DATA_AREA: Final = re.compile(r"^(addr|mccontrol\w*_data)$")


@dataclass(frozen=True, slots=True)
class Element:
    """One value on the HLI: `access` is "r", "w" or "rw" seen from the PLC, `offset` a byte of the image."""

    id: int
    path: str
    type: str
    unit: str
    offset: int
    size: int
    access: str
    old_paths: tuple[str, ...] = ()
    """Paths by which it was called before."""
    axis: str = ""
    """Name of the axis whose it is; `ax/<name>/...` is its path too."""

    @property
    def group(self) -> str:
        """Path of the control unit or structure that the element is a member of."""
        return self.path.rpartition("/")[0]

    @property
    def member(self) -> str:
        """Last part of the path, e.g. `command_w`."""
        return self.path.rpartition("/")[2]

    @property
    def code(self) -> str:
        """Its `struct` code."""
        return STRUCT_CODE[self.type]


_WRITTEN: Final = ("id", "path", "type", "unit", "offset", "size", "access")
"""What of an element must stand in a layout from elsewhere."""


class Group:
    """The elements with one parent path, e.g. a control unit; knows its bytes in the image and packed."""

    __slots__ = ("_in_image", "_packed", "elements", "ids", "index", "path", "start")

    def __init__(self, index: int, path: str, elements: Sequence[Element]) -> None:
        self.index = index
        self.path = path
        self.elements = tuple(elements)
        self.ids = {element.member: element.id for element in elements}
        """Element ids by member."""
        self.start = self.elements[0].offset
        text, at = "<", self.start
        for element in self.elements:
            text += "x" * (element.offset - at) + element.code
            at = element.offset + element.size
        self._in_image = Struct(text)
        self._packed = Struct("<" + "".join(element.code for element in self.elements))

    def pack(self, image: bytes | bytearray) -> bytes:
        """Return all members without gaps, in order (unit: request_r, enable_w, command_w, state_r)."""
        return self._packed.pack(*self._in_image.unpack_from(image, self.start))

    def values(self, packed: bytes) -> dict[str, int | bool]:
        """Return the members by name from what `pack` made."""
        return dict(zip(self.ids, self._packed.unpack(packed), strict=True))


class Layout:
    """All elements of a machine's HLI, in an order that depends on nothing but its axes and channels."""

    __slots__ = (
        "_aliases",
        "_canonical",
        "_elements_by_path",
        "axes",
        "elements",
        "group_of",
        "groups",
        "offsets",
        "packing",
        "size",
    )

    def __init__(self, axes: Sequence[tuple[int, str, str]], channels: int = 1) -> None:
        """Lay out the areas of `axes`, each (number, name, kind: linear|rotary|spindle), and the channels."""
        areas: list[Member] = []
        for number, _, kind in axes:
            areas += axis_members(number, rotary=kind != "linear")
        for number in range(1, channels + 1):
            areas += channel_members(number)
        names = {f"ax/{number}/": name for number, name, _ in axes}
        self._index(_placed(areas, names), {member.group: member.group_aliases for member in areas})

    @classmethod
    def from_json(cls, text: str | bytes) -> Self:
        """Read what `to_json` wrote. Raises InputError when it is something else."""
        self = cls.__new__(cls)
        try:
            rows = json.loads(text)
            aliases = {row["path"].rpartition("/")[0]: tuple(row.get("aliases", ())) for row in rows}
            elements = [
                Element(
                    **{key: row[key] for key in _WRITTEN},
                    old_paths=tuple(row.get("old_paths", ())),
                    axis=str(row.get("axis", "")),
                )
                for row in rows
            ]
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise InputError(f"not a layout of an HLI: {error}") from error
        self._index(elements, aliases)
        return self

    def to_json(self) -> str:
        """Return a list of all elements: the fields of `Element`, and in `aliases` old names of its unit."""
        rows = [{**asdict(e), "aliases": list(self._aliases.get(e.group, ()))} for e in self.elements]
        return json.dumps(rows)

    @property
    def aliases(self) -> Mapping[str, tuple[str, ...]]:
        """Old names of a unit by its path."""
        return self._aliases

    def resolve(self, name: str) -> str:
        """Return the path that `name` means: a path, its ST form or old names, of an element or a unit.

        Upper and lower case are the same, as in ST. Raises InputError with near names for anything else.
        """
        path = name if name in self._elements_by_path else self._canonical.get(self._numbered(_normal(name)))
        if path is None:
            raise InputError(f"no HLI element {name!r}{self._near(name)}")
        return path

    def element(self, name: str) -> Element:
        """Return the element that `name` means. Raises InputError when it names none, or a whole unit."""
        path = self.resolve(name)
        element = self._elements_by_path.get(path)
        if element is None:
            names = ", ".join(self.groups[path].ids)
            raise InputError(f"{name!r} is a whole unit; name one of its members: {names}")
        return element

    def group(self, name: str) -> Group:
        """Return the unit that `name` means. Raises InputError when it names none, or a single element."""
        path = self.resolve(name)
        if path not in self.groups:
            raise InputError(f"{name!r} is one element, not a unit")
        return self.groups[path]

    def _numbered(self, path: str) -> str:
        """Return a path with the number of its axis for its name: `ax/z/...` is `ax/3/...`."""
        area, _, rest = path.partition("/")
        name, slash, inside = rest.partition("/")
        number = self.axes.get(name) if area == "ax" else None
        return path if number is None else f"ax/{number}{slash}{inside}"

    def _near(self, name: str) -> str:
        names = get_close_matches(_normal(name), self._canonical, n=3, cutoff=0.7)
        return "; near names: " + ", ".join(self._canonical[near] for near in names) if names else ""

    def _index(self, elements: Sequence[Element], aliases: Mapping[str, tuple[str, ...]]) -> None:
        self.elements = tuple(elements)
        self._aliases = {path: names for path, names in aliases.items() if names}
        self.size = -(-max((e.offset + e.size for e in elements), default=0) // 8) * 8
        self._elements_by_path = {element.path: element for element in elements}
        self.axes = {e.axis.casefold(): int(e.path.split("/")[1]) for e in elements if e.axis}
        """Numbers of the axes by name, in small letters."""
        packing = {code: Struct("<" + code) for code in {element.code for element in elements}}
        self.packing = [packing[element.code] for element in elements]
        """How each element is packed, by its id; as the next two."""
        self.offsets = [element.offset for element in elements]
        by_group: dict[str, list[Element]] = {}
        for element in elements:
            by_group.setdefault(element.group, []).append(element)
        self.groups = {path: Group(at, path, of) for at, (path, of) in enumerate(by_group.items())}
        self.group_of = [self.groups[element.group].index for element in elements]
        self._canonical = {path.casefold(): path for path in (*self._elements_by_path, *self.groups)}
        for element in elements:
            for old in element.old_paths:
                self._canonical.setdefault(old.casefold(), element.path)
        for path, names in self._aliases.items():
            places = {"/".join(path.split("/", 2)[:2]), path.rpartition("/")[0]}
            for old in sorted(f"{place}/{name}".casefold() for place in places for name in names):
                self._canonical.setdefault(old, path)
                for element in by_group[path]:
                    self._canonical.setdefault(f"{old}/{element.member}", element.path)


@lru_cache(maxsize=32)
def layout_of(axes: tuple[tuple[int, str, str], ...]) -> Layout:
    """Return the layout of these axes and one channel, made once a process: benches of a sweep have the same."""
    return Layout(axes)


def _placed(areas: Sequence[Member], names: Mapping[str, str]) -> list[Element]:
    """Give every member its offset: aligned to its size, each group begins at a multiple of 8.

    `names` are the names of the axes by the beginning of their paths.
    """
    elements: list[Element] = []
    at, group = 0, ""
    for member in areas:
        size = size_of(member.type)
        step = size if member.group == group else 8
        at, group = -(-at // step) * step, member.group
        elements.append(
            Element(
                len(elements),
                f"{group}/{member.name}",
                member.type,
                member.unit,
                at,
                size,
                member.access,
                member.old_paths,
                names.get("/".join(group.split("/", 2)[:2]) + "/", ""),
            )
        )
        at += size
    return elements


def _normal(name: str) -> str:
    """Return `name` as a lower-case path: `gpAx[2]^.lr_state.error_r` -> `ax/2/lr_state/error_r`."""
    found = _ST_AREA.match(name)
    if found:
        area = "ch" if found[1].lower() == "ch" else "ax"
        name = f"{area}/{found[2]}/{name[found.end() :]}"
    parts = [part.strip("^") for part in name.casefold().replace(".", "/").split("/")]
    parts = [GROUP_ALIASES.get(part, part) for part in parts if not _OLD_DATA_AREA.match(part)]
    return "/".join([*parts[:-1], MEMBER_ALIASES.get(parts[-1], parts[-1])])
