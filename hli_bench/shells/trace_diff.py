"""Two traces compared to the bit: block by block, event by event, in constant memory."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any, Final

import numpy as np

from hli_bench.base.time import Ns
from hli_bench.laws.rows import Rows
from hli_bench.shells.trace_file import BLOCK_CYCLES, Stretch, TraceEvent, TraceMeta, TraceReader, axes_text

MISSING: Final = "nothing"
"""Shown for the trace that lacks what the other has."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """One value that differs; `axis` is empty where none is concerned."""

    channel: str
    at_ns: Ns
    cycle: int
    field: str
    left: object
    right: object
    axis: str = ""


@dataclass(slots=True)
class Comparison:
    """What differs: `meta`, the first of what was recorded, how much in each channel (values of axes, events)."""

    meta: list[Difference] = field(default_factory=list)
    first: Difference | None = None
    counts: Counter[str] = field(default_factory=Counter)

    def take(self, found: Difference) -> None:
        """Count a difference; of what was recorded the first one in time is kept."""
        self.counts[found.channel] += 1
        if found.channel == "meta":
            self.meta.append(found)
        elif self.first is None or found.at_ns < self.first.at_ns:
            self.first = found


def compare(left: TraceReader, right: TraceReader) -> Comparison:
    """Compare two traces. Cycles and axes must be the same ones for more than `meta` to be compared."""
    found = Comparison()
    for difference in _meta_differences(left.meta, right.meta):
        found.take(difference)
    if (left.meta.cycle_ns, left.meta.axes) != (right.meta.cycle_ns, right.meta.axes):
        return found
    for pair in _pairs(left, right):
        _compare_rows(found, left.meta, *pair)
        _compare_events(found, left.meta, *pair)
    return found


def _meta_differences(left: TraceMeta, right: TraceMeta) -> Iterator[Difference]:
    values: list[tuple[str, Any, Any]] = [
        (name, getattr(left, name), getattr(right, name)) for name in ("machine", "cycle_ns", "dc_epoch_ns")
    ]
    values.append(("axes", axes_text(left), axes_text(right)))
    values += [
        (f"set {key}", left.overrides.get(key, MISSING), right.overrides.get(key, MISSING))
        for key in sorted({*left.overrides, *right.overrides})
    ]
    for name, ours, theirs in values:
        if ours != theirs:
            yield Difference(channel="meta", at_ns=Ns(0), cycle=0, field=name, left=ours, right=theirs)


def _pairs(left: TraceReader, right: TraceReader) -> Iterator[tuple[Stretch | None, Stretch | None]]:
    """Yield the stretches of the same cycles, None where one trace has none."""
    waiting = [left.stretches(), right.stretches()]
    ours, theirs = (next(stretches, None) for stretches in waiting)
    while ours is not None or theirs is not None:
        places = [_place(one) for one in (ours, theirs) if one is not None]
        take = [one is not None and _place(one) == min(places) for one in (ours, theirs)]
        yield ours if take[0] else None, theirs if take[1] else None
        if take[0]:
            ours = next(waiting[0], None)
        if take[1]:
            theirs = next(waiting[1], None)


def _place(stretch: Stretch) -> int:
    return stretch.block.first // BLOCK_CYCLES if len(stretch.block.rows) else -1


# -- axes -------------------------------------------------------------------------------------------------


def _compare_rows(found: Comparison, meta: TraceMeta, left: Stretch | None, right: Stretch | None) -> None:
    spans = [
        range(one.block.first, one.block.first + len(one.block.rows)) if one is not None else range(0)
        for one in (left, right)
    ]
    for cycle in sorted(set(spans[0]) ^ set(spans[1])):
        sides = [f"cycle {cycle}" if cycle in span else MISSING for span in spans]
        found.take(_row_difference(meta, cycle, "cycle", *sides))
    first, end = max(span.start for span in spans), min(span.stop for span in spans)
    if left is not None and right is not None and first < end:
        ours, theirs = (one.block.rows[first - one.block.first :][: end - first] for one in (left, right))
        _compare_values(found, meta, first, ours, theirs)


def _compare_values(found: Comparison, meta: TraceMeta, first: int, left: Rows, right: Rows) -> None:
    """Compare rows of the same cycles, shape (cycles, axes), field by field; fields in order of the log."""
    if left.dtype != right.dtype:
        names = [", ".join(rows.dtype.names or ()) for rows in (left, right)]
        found.take(_row_difference(meta, first, "fields", *names))
        return
    if left.tobytes() == right.tobytes():
        return
    differs = {name: _unequal(left[name], right[name]) for name in left.dtype.names or ()}
    any_field = np.logical_or.reduce(list(differs.values()))
    cycle, axis = (int(place) for place in np.argwhere(any_field)[0])
    name = next(name for name, where in differs.items() if where[cycle, axis])
    one, other = (rows[name][cycle, axis].tolist() for rows in (left, right))
    found.take(_row_difference(meta, first + cycle, name, one, other, meta.axes[axis].name))
    found.counts["axes"] += sum(int(where.sum()) for where in differs.values()) - 1


def _unequal(left: Rows, right: Rows) -> Rows:
    """Tell where values differ in a bit, shape (cycles, axes)."""
    bits = [
        np.ascontiguousarray(values).view(np.uint8).reshape(*left.shape[:2], -1) for values in (left, right)
    ]
    unequal: Rows = (bits[0] != bits[1]).any(axis=2)
    return unequal


def _row_difference(
    meta: TraceMeta, cycle: int, name: str, left: object, right: object, axis: str = ""
) -> Difference:
    at_ns = Ns(cycle * meta.cycle_ns)
    return Difference(channel="axes", at_ns=at_ns, cycle=cycle, field=name, left=left, right=right, axis=axis)


# -- events -----------------------------------------------------------------------------------------------


def _compare_events(found: Comparison, meta: TraceMeta, left: Stretch | None, right: Stretch | None) -> None:
    """Compare events of the same channel and instant in their order."""
    sides = [_by_place(stretch) for stretch in (left, right)]
    for place in sorted({*sides[0], *sides[1]}):
        for one, other in zip_longest(sides[0].get(place, ()), sides[1].get(place, ())):
            if one != other:
                found.take(_event_difference(meta, *place, one, other))


def _by_place(stretch: Stretch | None) -> dict[tuple[Ns, str], list[TraceEvent]]:
    places: dict[tuple[Ns, str], list[TraceEvent]] = {}
    for event in stretch.events if stretch is not None else ():
        places.setdefault((event.at_ns, event.topic), []).append(event)
    return places


def _event_difference(
    meta: TraceMeta, at_ns: Ns, topic: str, one: TraceEvent | None, other: TraceEvent | None
) -> Difference:
    values: list[Any] = [MISSING if event is None else event.value for event in (one, other)]
    name = "event"
    if all(isinstance(value, dict) for value in values):
        ours, theirs = values
        name = next(key for key in sorted({*ours, *theirs}) if ours.get(key) != theirs.get(key))
        values = [value.get(name, MISSING) for value in values]
    return Difference(
        channel=topic,
        at_ns=at_ns,
        cycle=-(-at_ns // meta.cycle_ns),
        field=name,
        left=values[0],
        right=values[1],
    )
