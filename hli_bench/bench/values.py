"""The values of a machine folder by dotted path: taken one by one, checked by the schema, what is wrong collected."""

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from hli_bench.base.errors import InputError
from hli_bench.bench.config import MachineConfig
from hli_bench.bench.schema import BITS, KEYS, SIZES, Key, Kind, Plain, pattern, sizeable
from hli_bench.bench.sources import Given
from hli_bench.manual.lists import Finding, Severity

MACHINE_FILE: Final = "machine.toml"
LONGEST: Final = 200
"""Characters of a value that a message repeats."""
PATTERNS: Final = tuple((pattern(key), key) for key in KEYS)


@dataclass(slots=True)
class Values:
    """What is given of a machine, and what is wrong with it.

    Values that it began with it keeps, and a part of the machine that none of the `changed` values touches.
    """

    folder: Path
    given: Mapping[str, Given]
    """What machine.toml gives, with overrides on top."""
    texts: Mapping[Path, str | None] = field(default_factory=dict)
    """Texts of list files that have been read already."""
    base: MachineConfig | None = None
    changed: Sequence[str] = ()
    """Paths whose values differ from those of `base`."""
    accepted: Mapping[str, Plain] = field(default_factory=dict)
    """Values of the other paths, which have been checked."""
    machine: MachineConfig | None = None
    errors: list[InputError] = field(default_factory=list)
    notes: list[Finding] = field(default_factory=list)
    checked: dict[str, Plain] = field(default_factory=dict)
    """Values in the types of their keys."""
    lists: dict[str, dict[str, Given]] = field(default_factory=dict)
    """List parameters that stand in machine.toml or an override, by owner (`channel`, `axis.Z`)."""
    places: dict[str, Mapping[str, Given]] = field(default_factory=dict)
    """Where the list parameters of each owner stand."""
    refused: list[InputError] = field(default_factory=list)
    """Values that the bench cannot emulate, with their places."""

    def begin_with(self, plain: "Values") -> None:
        """Take over what was found of the same folder without overrides."""
        self.texts = plain.texts
        self.places = dict(plain.places)
        self.base = plain.machine
        differ = [path for path, given in self.given.items() if plain.given.get(path) is not given]
        self.changed = [*differ, *(path for path in plain.given if path not in self.given)]
        gone = set(self.changed)
        self.accepted = {path: value for path, value in plain.checked.items() if path not in gone}

    def untouched(self, *below: str) -> MachineConfig | None:
        """Return the base if none of the values below these paths differs from it."""
        return None if any(path.startswith(below) for path in self.changed) else self.base

    def take(self, path: str, given: Given, axes: Sequence[str]) -> None:
        """Check one value and keep it under its path."""
        found = _key(path)
        if found is not None:
            if self._names_hold(found[1], axes, path, given):
                self._keep(path, found[0], given)
            return
        owner, rest = _list_path(path)
        if owner == "channel" or (owner and owner.removeprefix("axis.") in axes):
            self.lists.setdefault(owner, {})[rest] = given
        elif owner:
            self._unknown_axis(path, owner.removeprefix("axis."), axes, given)
        else:
            self.fail(given, f"{path}: unknown key{_hint(path, axes)}; `hli-bench machine schema` lists them")

    def _names_hold(self, names: Mapping[str, str], axes: Sequence[str], path: str, given: Given) -> bool:
        """Check the names within a path: axes, bits."""
        if names.get("AXIS", axes[0]) not in axes:
            self._unknown_axis(path, names["AXIS"], axes, given)
            return False
        if names.get("BIT", BITS[0]) not in BITS:
            self.fail(given, f"{path}: {names['BIT']!r} is not one of {', '.join(BITS)}")
            return False
        return True

    def _unknown_axis(self, path: str, name: str, axes: Sequence[str], given: Given) -> None:
        self.fail(given, f"{path}: {name!r} is not an axis of this machine ({', '.join(axes)})")

    def _keep(self, path: str, key: Key, given: Given) -> None:
        try:
            self.checked[path] = key.accept(given.value)
        except (ValueError, OverflowError):
            value = str(given.value) if isinstance(given.value, date) else repr(given.value)
            if len(value) > LONGEST:
                value = value[:LONGEST] + "..."
            number = (
                key.kind is Kind.NUMBER and isinstance(given.value, int | float) and not sizeable(given.value)
            )
            size = f", 0 or {SIZES[0]:g} to {SIZES[1]:g} in size" if number else ""
            self.fail(given, f"{path}: {value} is not valid, expected {key.expected()}{size}")

    def fail(self, given: Given | None, message: str) -> None:
        """Keep what is wrong with a value, None: with the folder."""
        self.errors.append(
            given.error(message) if given else InputError(message, str(self.folder / MACHINE_FILE))
        )

    def refuse(self, given: Given, message: str) -> None:
        """Keep a value that is right and asks for something that is not built."""
        self.refused.append(given.error(message))

    def value(self, path: str) -> Any:
        """Return a value, in the type of its key, or the default of its key."""
        if path in self.checked:
            return self.checked[path]
        found = _key(path)
        assert found is not None
        return found[0].default

    def note(self, error: InputError, severity: Severity) -> None:
        """Keep a remark about a list: an error stops, the rest is noted."""
        if severity is Severity.ERROR:
            self.errors.append(error)
        else:
            self.notes.append(Finding(severity, error.message, error.file, error.line, error.column))

    def place(self, axis: str, path: str) -> Given | None:
        """Return where a parameter or key of an axis was given, None when it was not."""
        return self.places.get(f"axis.{axis}", {}).get(path) or self.given.get(f"axis.{axis}.{path}")


@lru_cache(maxsize=4096)
def _key(path: str) -> tuple[Key, Mapping[str, str]] | None:
    """Return the key of machine.toml that a path is, with the names within it."""
    for expression, key in PATTERNS:
        match = expression.fullmatch(path)
        if match is not None:
            return key, match.groupdict()
    return None


def _list_path(path: str) -> tuple[str, str]:
    """Return (owner, list path) of a path that may be a parameter's, or empty texts."""
    parts = path.split(".", 2)
    if parts[0] == "channel" and len(parts) > 1:
        return "channel", path.removeprefix("channel.")
    if parts[0] == "axis" and len(parts) > 2:
        return f"axis.{parts[1]}", parts[2]
    return "", ""


def _hint(path: str, axes: Sequence[str]) -> str:
    """Return ' (did you mean ...?)' for the nearest keys."""
    known = [
        key.path.replace("<AXIS>", axis).replace("<N>", "0").replace("<BIT>", "home")
        for key in KEYS
        for axis in (axes if "<AXIS>" in key.path else axes[:1])
    ]
    near = difflib.get_close_matches(path, known, n=2, cutoff=0.7)
    return f" (did you mean {' or '.join(near)}?)" if near else ""
