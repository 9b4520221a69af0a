"""What a bench does, kept whole: an observer for runs that are compared to the bit."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, Final

import numpy as np

from hli_bench import Bench
from hli_bench.laws.rows import LOG_CYCLES

UNIT_STATE: Final = re.compile(r"mc_control/\w+/state_r$")
"""What units acknowledge. Other elements of the CNC are filled at the end of a stretch: their last values count."""

Event = tuple[int, str, str]
"""Cycle, what it is about, value."""


class Recording:
    """Keeps the log of every cycle, edges, frames, what a PLC wrote, what changed on the HLI, and CNC records."""

    def __init__(self) -> None:
        self.blocks: list[np.ndarray] = []
        self.events: dict[str, list[Event]] = {name: [] for name in ("edges", "can", "plc", "hli", "cnc")}
        self._bench: Bench | None = None
        self._whole = self._shown = b""

    def watch(self, bench: Bench) -> None:
        """Hang itself on a bench that has not run yet."""
        self._bench = bench
        elements = bench.kernel.image.layout.elements
        self._elements = [one for one in elements if "w" in one.access or UNIT_STATE.search(one.path)]
        places = [np.arange(one.offset, one.offset + one.size) for one in self._elements]
        self._places = np.concatenate(places)
        self._image = np.frombuffer(bench.kernel.image.data, np.uint8)
        self._values = [bench.kernel.image.get(one.id) for one in self._elements]
        bench.engine.observers.append(self)

    @property
    def log(self) -> np.ndarray:
        """Rows of cycle 1, 2, ... by axis."""
        assert self._bench is not None
        if len(self.blocks) != 1:
            self.blocks = [np.concatenate([self._bench.kernel.rows.log[:0], *self.blocks])]
        return self.blocks[0]

    def cycles(self, first: int, count: int) -> None:
        """Keep the log, look at the HLI."""
        bench = self._bench
        assert bench is not None
        slots = np.arange(first, first + count) % LOG_CYCLES
        self.blocks.append(bench.kernel.rows.log[slots])
        whole = bytes(bench.kernel.image.data)
        if whole == self._whole:
            return
        self._whole = whole
        shown = self._image[self._places].tobytes()
        if shown != self._shown:
            self._shown = shown
            self._look(first + count - 1)

    def _look(self, cycle: int) -> None:
        assert self._bench is not None
        get = self._bench.kernel.image.get
        for number, element in enumerate(self._elements):
            value = get(element.id)
            if value != self._values[number]:
                self._values[number] = value
                self.events["hli"].append((cycle, element.path, repr(value)))

    def frames(self, cycle: int, frames: Sequence[Any]) -> None:
        """Keep frames beside the telegrams."""
        self.events["can"] += [
            (cycle, f"{one.cob_id:03X}", "remote" if one.remote else one.data.hex(" ")) for one in frames
        ]

    def edges(self, edges: Sequence[Any]) -> None:
        """Keep edges; their cycle is the one that ends next."""
        assert self._bench is not None
        cycle_ns = self._bench.config.cycle_ns
        self.events["edges"] += [
            (-(-one.at_ns // cycle_ns), one.signal, f"{one.level} at {one.at_ns} ns") for one in edges
        ]

    def emitted(self, cycle: int, records: Sequence[Any]) -> None:
        """Keep records of the CNC, field by field."""
        for record in records:
            kind = type(record).__name__
            self.events["cnc"] += [(cycle, f"{kind}.{name}", value) for name, value in _parts(record)]

    def commands(self, commands: Any) -> None:
        """Keep what a PLC wrote."""
        self.events["plc"] += [
            (commands.cycle, f"{commands.plc}: {one.path}", repr(one.value)) for one in commands.writes
        ]

    def refused(self, cycle: int, refusals: Sequence[Any]) -> None:
        """Keep what was refused."""
        self.events["plc"] += [(cycle, f"refused: {one.writer}: {one.path}", one.reason) for one in refusals]

    def end(self) -> dict[str, str]:
        """Return the value of every element and the position of every axis, as they stand now."""
        bench = self._bench
        assert bench is not None
        image = bench.kernel.image
        shown = {one.path: repr(image.get(one.id)) for one in image.layout.elements}
        return shown | {axis.name: repr(bench.position_mm(axis.name)) for axis in bench.config.axes}


def _parts(record: Any) -> list[tuple[str, str]]:
    """Return the fields of a record; a record in a record counts as its own text."""
    if not is_dataclass(record):
        return [("value", repr(record))]
    found = []
    for each in fields(record):
        value = getattr(record, each.name)
        value = dict(sorted(value.items())) if isinstance(value, Mapping) else value
        text = getattr(value, "name", None) if each.name == "source" else None
        found.append((each.name, text if isinstance(text, str) else repr(value)))
    return found
