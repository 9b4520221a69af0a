"""The last values of a bench, as queries get them: layout, image, units, members, terminals, records."""

import json
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from struct import Struct
from typing import Any, Final

from hli_bench.base.time import Ns
from hli_bench.protocols.hli.layout import Layout
from hli_bench.protocols.hli.packing import pack_image
from hli_bench.wire.images import STRUCT_CODE, TerminalLayout, size_of

KEPT_RECORDS: Final = 100
"""Refusals and CNC errors kept for a later get (decided here)."""

Answers = Iterator[tuple[str, bytes | str]]
"""(path without the machine, packed or JSON)."""


class LastValues:
    """What was published last. The methods yield the answers to a query, made only when they are sent."""

    def __init__(self, layout: Layout, terminals: Sequence[TerminalLayout]) -> None:
        self.layout = layout
        self.terminals = {terminal.name: terminal for terminal in terminals}
        self.io = {terminal.name: bytes(terminal.size) for terminal in terminals}
        self.cycle = 0
        self.dc_ns = Ns(0)
        self.image = bytes(layout.size)
        self.refused = 0
        self.refusals: deque[Mapping[str, Any]] = deque(maxlen=KEPT_RECORDS)
        self.errors: deque[Mapping[str, Any]] = deque(maxlen=KEPT_RECORDS)

    def whole_layout(self) -> Answers:
        """Yield `hli/layout`: the list of all elements."""
        yield "hli/layout", self.layout.to_json()

    def terminal_layouts(self) -> Answers:
        """Yield `hli/terminals`: name and entries (entry, type, offset) of each terminal."""
        yield "hli/terminals", json.dumps([asdict(terminal) for terminal in self.terminals.values()])

    def whole_image(self) -> Answers:
        """Yield `hli/image` as it was put last."""
        yield "hli/image", pack_image(self.cycle, self.dc_ns, self.image)

    def hli_errors(self) -> Answers:
        """Yield `hli/errors`: how many writes were refused, and the last of them."""
        yield "hli/errors", json.dumps({"refused": self.refused, "last": list(self.refusals)})

    def cnc_errors(self) -> Answers:
        """Yield `cnc/errors`: the last error records."""
        yield "cnc/errors", json.dumps(list(self.errors))

    def units(self, wanted: Callable[[str], bool], *, as_text: bool) -> Answers:
        """Yield all units and members whose path is wanted."""
        for path in (*self.layout.groups, *(element.path for element in self.layout.elements)):
            if wanted(f"hli/unit/{path}"):
                yield f"hli/unit/{path}", self.unit(path, as_text=as_text)

    def unit(self, path: str, *, as_text: bool) -> bytes | str:
        """Return a unit or member packed, or as JSON."""
        group = self.layout.groups.get(path)
        if group is not None:
            packed = group.pack(self.image)
            return json.dumps(group.values(packed)) if as_text else packed
        element = self.layout.element(path)
        packed = self.image[element.offset : element.offset + element.size]
        return json.dumps(Struct("<" + element.code).unpack(packed)[0]) if as_text else packed

    def terminal_images(self, wanted: Callable[[str], bool], *, as_text: bool) -> Answers:
        """Yield all images of terminals and entries of them whose path is wanted."""
        for name, terminal in self.terminals.items():
            data, path = self.io[name], f"io/{name}"
            values = {
                entry: Struct("<" + STRUCT_CODE[kind]).unpack_from(data, at)[0]
                for entry, kind, at in terminal.entries
            }
            if wanted(path):
                yield path, json.dumps(values) if as_text else data
            for entry, kind, at in terminal.entries:
                if wanted(f"{path}/{entry}"):
                    packed = data[at : at + size_of(kind)]
                    yield f"{path}/{entry}", json.dumps(values[entry]) if as_text else packed

    def take_terminal(self, name: str, data: bytes) -> list[tuple[str, bytes]]:
        """Keep a terminal's image; return (path, packed) of its changed entries and of the image, last."""
        before = self.io[name]
        if data == before:
            return []
        self.io[name] = data
        changed = []
        for entry, kind, at in self.terminals[name].entries:
            packed = data[at : at + size_of(kind)]
            if packed != before[at : at + len(packed)]:
                changed.append((f"io/{name}/{entry}", packed))
        return [*changed, (f"io/{name}", data)]
