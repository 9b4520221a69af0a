"""`hli` and `io` as a script sees them: objects with the elements as attributes, read when asked."""

from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from functools import cache, lru_cache
from struct import Struct
from typing import Any, NoReturn

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.access import unfit
from hli_bench.protocols.hli.image import Value
from hli_bench.protocols.hli.layout import Element, Layout
from hli_bench.protocols.hli.rows import MEMBER_ALIASES
from hli_bench.wire.images import STRUCT_CODE, TerminalLayout

Shape = tuple[tuple[str, str, int, bool], ...]
"""Of each member: name, struct code, offset from the start of its structure, whether the PLC may write it."""


class Frame:
    """What all names of a task share: the layout, the image of the cycle, the values written in it."""

    __slots__ = ("changes", "image", "layout", "nodes", "old_paths", "structures", "transient")

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.structures = _structures(layout)
        self.old_paths = _old_paths(layout)
        self.nodes: dict[str, Node] = {}
        self.image: bytes | bytearray = b""
        self.changes: dict[int, Value] = {}
        self.transient: list[tuple[dict[str, Value], str]] = []

    def begin(self, image: bytes | bytearray) -> None:
        """Start a cycle; members that both sides write are read from the image again."""
        self.image = image
        for written, name in self.transient:
            written.pop(name, None)
        self.transient.clear()

    def take_changes(self) -> dict[int, Value]:
        """Return what was written since the last call; a cycle that was interrupted hands over with the next one."""
        changes, self.changes = self.changes, {}
        return changes


class Node:
    """A structure of the HLI: members are properties of a class per shape, structures inside come on demand.

    Writing compares with what the script wrote last, so that only changes become commands.
    """

    _elements: Mapping[str, Element]
    _frame: Frame
    _path: str
    _written: dict[str, Value]

    def __init__(self, path: str, frame: Frame) -> None:
        group = frame.layout.groups.get(path)
        members = group.elements if group else ()
        vars(self).update(
            _path=path,
            _frame=frame,
            _base=group.start if group else 0,
            _elements={element.member: element for element in members},
            _written={},
        )

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        path = f"{self._path}/{name}"
        if path not in self._frame.structures:
            path = self._by_old_name(path)
        if path in self._frame.structures:
            node = node_at(path, self._frame)
            vars(self)[name] = node
            return node
        if any(old.startswith(f"{self._path}/{name}/") for old in self._frame.old_paths):
            return Renamed(f"{self._path}/{name}", self._frame)
        if (place := self._renamed(name)) is not None:
            return getattr(*place)
        return getattr(self, self._member(name))

    def __setattr__(self, name: str, value: Value) -> None:
        try:
            if self._written[name] == value:
                return
        except KeyError:
            pass
        self._write(name, value)

    def __dir__(self) -> list[str]:
        return sorted({*self._elements, *self._frame.structures[self._path]})

    def __bool__(self) -> bool:
        raise TypeError(f"{self._path} is a structure and has no value; it has {', '.join(dir(self))}")

    def __repr__(self) -> str:
        return f"<{self._path}>"

    def _write(self, name: str, value: Value) -> None:
        if name not in self._elements:
            return setattr(*(self._renamed(name) or (self, self._member(name))), value)
        element = self._elements[name]
        if "w" not in element.access:
            raise AttributeError(f"{element.path} is written by the CNC, a PLC may only read it")
        if reason := unfit(element, value):
            raise ValueError(f"{element.path}: {reason}")
        if element.access == "rw":
            if getattr(self, name) == value:
                return None
            self._frame.transient.append((self._written, name))
        self._written[name] = value
        self._frame.changes[element.id] = value
        return None

    def _renamed(self, name: str) -> "tuple[Node, str] | None":
        """Return where an element stands now whose path was `name` in this structure, None for any other name."""
        old = f"{self._path}/{name}"
        return place_of(old, self._frame) if old in self._frame.old_paths else None

    def _by_old_name(self, path: str) -> str:
        try:
            return self._frame.layout.resolve(path)
        except InputError:
            return ""

    def _member(self, name: str) -> str:
        """Return the member that an old name like X_Command means. Raises AttributeError for any other."""
        member = MEMBER_ALIASES.get(name.lower(), "")
        if f"{self._path}/{name}" in self._frame.structures:
            inside = ", ".join(dir(getattr(self, name)))
            raise AttributeError(f"{self._path}/{name} is a structure; write one of its members: {inside}")
        if member not in self._elements:
            _unknown(name, self._path, dir(self))
        return member


class Renamed:
    """A structure that was: its members are those of other structures now."""

    _frame: Frame
    _path: str

    def __init__(self, path: str, frame: Frame) -> None:
        vars(self).update(_path=path, _frame=frame)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        path = f"{self._path}/{name}"
        if any(old.startswith(f"{path}/") for old in self._frame.old_paths):
            return Renamed(path, self._frame)
        return getattr(*self._place(name))

    def __setattr__(self, name: str, value: Value) -> None:
        setattr(*self._place(name), value)

    def __bool__(self) -> bool:
        raise TypeError(f"{self._path} is a structure and has no value")

    def _place(self, name: str) -> tuple[Node, str]:
        path = f"{self._path}/{MEMBER_ALIASES.get(name.lower(), name)}"
        if path not in self._frame.old_paths:
            known = [
                old.rpartition("/")[2] for old in self._frame.old_paths if old.startswith(f"{self._path}/")
            ]
            _unknown(name, self._path, known)
        return place_of(path, self._frame)


def place_of(path: str, frame: Frame) -> tuple[Node, str]:
    """Return structure and member that a path, an earlier one too, means."""
    element = frame.layout.element(path)
    return node_at(element.group, frame), element.member


class Areas(dict[int, Node]):
    """The axes or channels by number; an axis is an attribute by its name too: `hli.ax.Z` is `hli.ax[3]`."""

    def __init__(self, area: str, frame: Frame) -> None:
        super().__init__(
            {int(name): node_at(f"{area}/{name}", frame) for name in frame.structures.get(area, ())}
        )
        self._area = area
        self._names = frame.layout.axes if area == "ax" else {}

    def __getattr__(self, name: str) -> Node:
        number = None if name.startswith("_") else self._names.get(name.casefold())
        if number is None:
            raise AttributeError(
                f"no {name!r} in {self._area}; there are {', '.join(map(str, self))}"
                + (f", by name {', '.join(self._names).upper()}" if self._names else "")
            )
        return self[number]

    def __missing__(self, number: object) -> NoReturn:
        raise KeyError(f"no {self._area}[{number!r}] on this machine; there are {', '.join(map(str, self))}")


class Hli:
    """Root of the HLI for a script: `ax` and `ch`, each by number."""

    __slots__ = ("ax", "ch")

    def __init__(self, frame: Frame) -> None:
        self.ax = Areas("ax", frame)
        self.ch = Areas("ch", frame)

    def __getattr__(self, name: str) -> NoReturn:
        _unknown(name, "hli", ("ax", "ch"))


class Terminal:
    """Holder of a terminal's image in the cycle."""

    __slots__ = ("data",)

    def __init__(self, size: int) -> None:
        self.data = bytes(size)


class IoNode:
    """A part of the process images: entries are properties, parts inside are attributes."""

    _path = "io"

    def __getattr__(self, name: str) -> NoReturn:
        _unknown(name, self._path, self._inside())

    def __bool__(self) -> bool:
        raise TypeError(f"{self._path} is a structure and has no value; it has {', '.join(self._inside())}")

    def __repr__(self) -> str:
        return f"<{self._path}>"

    def _inside(self) -> list[str]:
        return [key for key in (*vars(type(self)), *vars(self)) if not key.startswith("_")]

    def __setattr__(self, name: str, value: object) -> None:
        getattr(self, name)
        raise AttributeError(f"{self._path}/{name} is an input, a PLC may only read it")


def io_root(layouts: Sequence[TerminalLayout]) -> tuple[IoNode, dict[str, Terminal]]:
    """Return `io` for a script and the holders of the images behind it, by terminal name."""
    root, holders = IoNode(), {}
    for layout in layouts:
        holder = holders[layout.name] = Terminal(layout.size)
        entries = [(entry.split("/"), _io_getter(holder, kind, at)) for entry, kind, at in layout.entries]
        vars(root)[layout.name] = _io_node(f"io/{layout.name}", entries)
    return root, holders


@cache
def shape_class(shape: Shape) -> type[Node]:
    """Return the class of all structures with these members."""
    members = {
        name: property(_getter(name, code, relative, writable=writable))
        for name, code, relative, writable in shape
    }
    return type("Structure", (Node,), members)


def node_at(path: str, frame: Frame) -> Node:
    """Return the structure at `path`, the same one for every name it is reached by."""
    known = frame.nodes.get(path)
    if known is not None:
        return known
    group = frame.layout.groups.get(path)
    members = group.elements if group else ()
    start = group.start if group else 0
    shape = tuple((e.member, e.code, e.offset - start, "w" in e.access) for e in members)
    node = frame.nodes[path] = shape_class(shape)(path, frame)
    return node


def _getter(name: str, code: str, relative: int, *, writable: bool) -> Callable[[Any], Value]:
    unpack = Struct("<" + code).unpack_from

    def read(self: Any) -> Value:
        value: Value = unpack(self._frame.image, self._base + relative)[0]
        return value

    def written_or_read(self: Any) -> Value:
        try:
            value: Value = self._written[name]
        except KeyError:
            value = unpack(self._frame.image, self._base + relative)[0]
        return value

    return written_or_read if writable else read


def _io_getter(holder: Terminal, data_type: str, offset: int) -> Callable[[Any], Value]:
    unpack = Struct("<" + STRUCT_CODE[data_type]).unpack_from

    def read(_node: Any) -> Value:
        value: Value = unpack(holder.data, offset)[0]
        return value

    return read


def _io_node(path: str, entries: Sequence[tuple[list[str], Callable[[Any], Value]]]) -> IoNode:
    leaves = {parts[0]: property(getter) for parts, getter in entries if len(parts) == 1}
    node: IoNode = type("Io", (IoNode,), {**leaves, "_path": path})()
    for name in dict.fromkeys(parts[0] for parts, _ in entries if len(parts) > 1):
        inside = [(parts[1:], getter) for parts, getter in entries if parts[0] == name]
        vars(node)[name] = _io_node(f"{path}/{name}", inside)
    return node


@lru_cache(maxsize=32)
def _structures(layout: Layout) -> Mapping[str, tuple[str, ...]]:
    """Return the names inside of every structure, from `ax` down to the control units."""
    inside: dict[str, dict[str, None]] = {}
    for path in layout.groups:
        parts = path.split("/")
        for depth in range(1, len(parts)):
            inside.setdefault("/".join(parts[:depth]), {})[parts[depth]] = None
        inside.setdefault(path, {})
    return {path: tuple(names) for path, names in inside.items()}


@lru_cache(maxsize=32)
def _old_paths(layout: Layout) -> frozenset[str]:
    """Return all earlier paths of elements."""
    return frozenset(old for element in layout.elements for old in element.old_paths)


def _unknown(name: str, path: str, known: Sequence[str]) -> NoReturn:
    near = get_close_matches(name, known, n=3)
    hint = f"; near names: {', '.join(near)}" if near else f"; there are {', '.join(known)}" if known else ""
    raise AttributeError(f"no {name!r} in {path}{hint}")
