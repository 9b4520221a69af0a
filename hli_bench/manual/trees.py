"""Parameter trees from values: building, immutable replacement, and what the bench refuses."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, replace
from enum import IntEnum, IntFlag
from typing import Any, TypeVar, cast

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis.fixed_stop import PRESETS, DriveIdent
from hli_bench.manual.axis.words import HomingType
from hli_bench.manual.catalogue import INDEX, PLACEHOLDER, Catalogue, catalogue, convert
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.measuring_methods import unbuilt
from hli_bench.manual.modulo import unbuilt_modulo
from hli_bench.manual.sheet import ARRAY, Array, Effect, Entry, Value

P = TypeVar("P")


def flatten(tree: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """Return nested TOML tables as list paths: `{"kenngr": {"x": 1}}` gives `{"kenngr.x": 1}`."""
    flat: dict[str, object] = {}
    for key, value in tree.items():
        if isinstance(value, Mapping):
            flat.update(flatten(value, f"{prefix}{key}."))
        elif isinstance(value, list):
            for index, item in enumerate(value):
                here = f"{prefix}{key}[{index}]"
                flat.update(flatten(item, here + ".") if isinstance(item, Mapping) else {here: item})
        else:
            flat[prefix + key] = value
    return flat


def converted(cls: type[Any], raw: Mapping[str, object]) -> dict[str, Value]:
    """Return raw values (texts or TOML values) by full path; raise InputError for the first wrong one."""
    values: dict[str, Value] = {}
    for path, item in raw.items():
        located = catalogue(cls).locate(path)
        values[located.path] = convert(located.entry, located.path, item)
    return values


def build(cls: type[P], values: Mapping[str, Value]) -> P:
    """Return the tree with these values (as `parse_list` or `converted` return them).

    An axis follows its drive type where the manuals say so: the homing type if it is not given, and the drive
    objects of the fixed stop, whose presets overwrite the list unless switched off (P-AXIS-00746, 00821).
    """
    params = cls()
    given = dict(values)
    if cls is AxisParams:
        drive_type = DriveType(int(values.get("kenngr.antr_typ", DriveType.SIMULATION)))
        if drive_type is DriveType.SERCOS:
            given.setdefault("kenngr.homing.homing_type", HomingType.DRIVE_CONTROLLED)
        given |= _fixed_stop_presets(drive_type, values)
    for path, value in given.items():
        params = _replaced(params, _steps(path), value)
    return params


def _fixed_stop_presets(drive_type: DriveType, values: Mapping[str, Value]) -> dict[str, Value]:
    """Return the drive objects preset at start-up. Source: fixed stop manual 5.1."""
    presets: dict[str, Value] = {}
    for index, ident in enumerate(PRESETS.get(drive_type, ())):
        here = f"antr.fixed_stop.drive_ident[{index}]."
        switch = values.get(here + "default_ident", -1)
        if values.get(here + "default", True) if switch == -1 else switch:
            presets.update((here + item.name, getattr(ident, item.name)) for item in fields(DriveIdent))
    return presets


def with_value(params: P, path: str, value: object) -> P:
    """Return the tree with one value (list text or TOML value) replaced; raise InputError."""
    located = catalogue(type(params)).locate(path)
    return _replaced(params, _steps(located.path), convert(located.entry, located.path, value))


def value_at(params: Any, path: str) -> Value:
    """Return the value at a full path; elements that an array does not have yet hold their defaults."""
    located = catalogue(type(params)).locate(path)
    node: Any = params
    for name, index in _steps(located.path):
        node = getattr(node, name)
        if index is not None:
            if index >= len(node):
                return located.entry.default
            node = node[index]
    return cast("Value", node)


def _steps(path: str) -> list[tuple[str, int | None]]:
    """Return `getriebe[0].vb_max` as [("getriebe", 0), ("vb_max", None)]."""
    steps: list[tuple[str, int | None]] = []
    for part in path.split("."):
        name, bracket, rest = part.partition("[")
        steps.append((name, int(rest.rstrip("]")) if bracket else None))
    return steps


def _replaced(node: P, steps: list[tuple[str, int | None]], value: Value) -> P:
    """Return the group with the value at the end of the steps replaced; arrays grow as needed."""
    (name, index), rest = steps[0], steps[1:]
    current = getattr(node, name)
    if index is None:
        new = _replaced(current, rest, value) if rest else value
    else:
        array: Array | None = _metadata(node, name).get(ARRAY)
        items = list(current)
        while array is not None and len(items) <= index:
            items.append(array.element())
        items[index] = _replaced(items[index], rest, value) if rest else value
        new = tuple(items)
    return cast("P", replace(cast("Any", node), **{name: new}))


def _metadata(node: Any, name: str) -> Mapping[str, Any]:
    return next(item.metadata for item in fields(node) if item.name == name)


def refusals(cls: type[Any], values: Mapping[str, Value]) -> list[tuple[str, str]]:
    """Return what of these values the bench cannot emulate: (path of a value, text for NotEmulated).

    An element of an array that is given only in part is refused for its defaults as well.
    """
    known = catalogue(cls)
    found = [
        (path, text)
        for path, value in values.items()
        for text in _refused(known.locate(path).entry, path, value)
    ]
    for path, entry, beside in _defaults(known, values):
        found += [(beside, f"{text}, its default") for text in _refused(entry, path, entry.default)]
    return [*found, *unbuilt(values), *unbuilt_modulo(values)]


def _refused(entry: Entry, path: str, value: Value) -> Iterator[str]:
    """Yield why a value is not emulated."""
    sheet = entry.sheet
    name = f"{sheet.number}: {path}" if sheet.number else path
    if isinstance(value, IntFlag):
        for bit in type(value):
            if bit in value and bit in sheet.not_emulated:
                yield f"{name} = {value:#x}: {bit.name} ({bit.value:#x}) is not emulated"
    elif value in sheet.not_emulated or (sheet.effect is Effect.REFUSED and value != entry.default):
        yield f"{name} = {_shown(value)} is not emulated"


def _defaults(known: Catalogue, values: Mapping[str, Value]) -> Iterator[tuple[str, Entry, str]]:
    """Yield what is not given of array elements that are given in part, with the path of what is given."""
    elements: dict[str, str] = {}
    for path in values:
        if "]." in path:
            elements.setdefault(path[: path.rindex("].") + 1], path)
    for entry in known.unbuilt_defaults if elements else ():
        array, _, leaf = PLACEHOLDER.sub("[]", entry.path).rpartition("].")
        for element, beside in elements.items():
            if INDEX.sub("[]", element) == f"{array}]" and f"{element}.{leaf}" not in values:
                yield f"{element}.{leaf}", entry, beside


def _shown(value: Value) -> str:
    """Return a value as lists have it, with the name of a number that has one."""
    if isinstance(value, IntEnum):
        return f"{value.value} ({value.name})"
    return str(int(value)) if isinstance(value, bool) else str(value)
