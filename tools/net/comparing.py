"""Two performances of a run, compared to the bit: where they differ first, and by what."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any, Final

import numpy as np

from net.performing import Performed

NOTHING: Final = "nothing"
"""Shown for the side that lacks what the other has."""
LATER: Final = 1 << 62
"""Cycle of what belongs to no cycle: it is told when nothing else is."""
CHANNELS: Final = ("edges", "plc", "cnc", "can", "hli")
"""Channels of events in the order in which one brings about the other within a cycle."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One place at which two performances differ."""

    cycle: int
    channel: str
    what: str
    base: object
    now: object

    def text(self, cycle_us: int) -> str:
        """Return it for people."""
        at = "" if self.cycle == LATER else f"cycle {self.cycle} ({self.cycle * cycle_us / 1e6:.6g} s), "
        return f"{at}{self.channel}: {self.what}: {self.base} -> {self.now}"


@dataclass(slots=True)
class Comparison:
    """What differs in a run: the first place, how many places by channel."""

    first: Difference | None = None
    counts: Counter[str] = field(default_factory=Counter)
    cycle_us: int = 1000

    def take(self, found: Difference | None) -> None:
        """Count a difference and keep the earliest."""
        if found is None:
            return
        self.counts[found.channel] += 1
        if self.first is None or found.cycle < self.first.cycle:
            self.first = found

    def text(self) -> str:
        """Return where and by what it differs, in a line."""
        assert self.first is not None
        more = ", ".join(f"{channel} {count}" for channel, count in self.counts.items())
        return f"{self.first.text(self.cycle_us)} (places: {more})"


@dataclass(slots=True)
class Shapes:
    """What one side alone can tell: fields, elements, keys. No run has moved because of them."""

    base: dict[str, None] = field(default_factory=dict)
    now: dict[str, None] = field(default_factory=dict)

    def take(self, kind: str, base: Iterator[str] | Any, now: Iterator[str] | Any) -> None:
        """Keep the names that only one side has."""
        ours, theirs = set(base), set(now)
        self.base.update(dict.fromkeys(f"{kind} {name}" for name in sorted(ours - theirs)))
        self.now.update(dict.fromkeys(f"{kind} {name}" for name in sorted(theirs - ours)))


def compare(base: Performed, now: Performed, shapes: Shapes) -> Comparison:
    """Compare two performances of the same run."""
    found = Comparison(cycle_us=base.cycle_us)
    for number, (one, other) in enumerate(zip_longest(base.outcomes, now.outcomes, fillvalue=NOTHING), 1):
        if one != other:
            found.take(Difference(LATER, "outcome", f"program {number}", one, other))
    if not base.axes or not now.axes:
        return found
    if (base.axes, base.cycle_us) != (now.axes, now.cycle_us):
        found.take(
            Difference(0, "machine", "axes, cycle_us", (base.axes, base.cycle_us), (now.axes, now.cycle_us))
        )
        return found
    _logs(found, base, now, shapes)
    shapes.take("element", base.elements, now.elements)
    for channel in CHANNELS:
        _events(found, channel, base, now, shapes)
    for number, (ours, theirs) in enumerate(zip(base.results, now.results, strict=False), 1):
        if ours and theirs:
            for path, one, other in _tree(f"program {number}", ours, theirs, shapes):
                found.take(Difference(LATER, "result", path, one, other))
    for name in base.end.keys() & now.end.keys():
        if base.end[name] != now.end[name]:
            found.take(Difference(LATER, "end", name, base.end[name], now.end[name]))
    if base.notes != now.notes:
        pairs = zip_longest(base.notes, now.notes, fillvalue=NOTHING)
        one, other = next((one, other) for one, other in pairs if one != other)
        found.take(Difference(LATER, "notes", "first", one, other))
    return found


def _logs(found: Comparison, base: Performed, now: Performed, shapes: Shapes) -> None:
    """Compare the log field by field, each axis for itself."""
    ours, theirs = base.log.dtype.names or (), now.log.dtype.names or ()
    shapes.take("log field", ours, theirs)
    cycles = min(len(base.log), len(now.log))
    for name in (name for name in ours if name in theirs):
        left, right = base.log[name][:cycles], now.log[name][:cycles]
        if left.tobytes() == right.tobytes():
            continue
        for number, axis in enumerate(base.axes):
            differ = (left[:, number] != right[:, number]).reshape(cycles, -1).any(axis=1)
            if differ.any():
                at = int(np.argmax(differ))
                values = left[at, number], right[at, number]
                found.take(Difference(at + 1, "axes", f"{axis} {name}", *values))
    if len(base.log) != len(now.log):
        found.take(Difference(cycles + 1, "axes", "cycles in all", len(base.log), len(now.log)))


def _events(found: Comparison, channel: str, base: Performed, now: Performed, shapes: Shapes) -> None:
    """Compare a channel's events: the first that differs, and how many there are of each."""
    left, right = base.events.get(channel, []), now.events.get(channel, [])
    if left == right:
        return
    if channel in ("hli", "plc", "cnc"):
        known = _known(channel, base, left), _known(channel, now, right)
        if channel == "cnc":
            shapes.take("record field", known[0], known[1])
        both = known[0] & known[1]
        left = [one for one in left if _about(one[1]) in both]
        right = [one for one in right if _about(one[1]) in both]
    for one, other in zip_longest(left, right):
        if one != other:
            cycle = min(each[0] for each in (one, other) if each is not None)
            names = {each[1] for each in (one, other) if each is not None}
            values = [
                f"{each[2]} (cycle {each[0]})" if each is not None else NOTHING for each in (one, other)
            ]
            found.take(Difference(cycle, channel, " / ".join(sorted(names)), *values))
            if len(left) != len(right):
                found.counts[channel] += abs(len(left) - len(right))
            return


def _about(name: str) -> str:
    """Return the element of an event of a PLC (`task: path`), or what it is about."""
    return name.rpartition(": ")[2]


def _known(channel: str, performed: Performed, events: Any) -> set[str]:
    """Return what a side can tell about; a kind of record that never came is known by nobody."""
    return {_about(one[1]) for one in events} if channel == "cnc" else set(performed.elements)


def _tree(path: str, one: Any, other: Any, shapes: Shapes) -> Iterator[tuple[str, object, object]]:
    """Yield the leaves of two results that differ. Keys of records that one side lacks are a matter of shape."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        free = path.endswith((".variables", ".values"))
        if not free:
            shapes.take("result", one, other)
        for key in sorted({*one, *other} if free else one.keys() & other.keys()):
            yield from _tree(f"{path}.{key}", one.get(key, NOTHING), other.get(key, NOTHING), shapes)
    elif isinstance(one, list) and isinstance(other, list):
        for number, pair in enumerate(zip_longest(one, other, fillvalue=NOTHING)):
            yield from _tree(f"{path}[{number}]", *pair, shapes)
    elif one != other:
        yield path, one, other
