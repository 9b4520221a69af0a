"""Where values of a machine folder come from: machine.toml with its lines, `--set` texts, Python mappings."""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.bench.schema import canonical
from hli_bench.manual.lists import flatten
from hli_bench.shells.texts import text_of

SET: Final = "--set"
"""Named as the file of a value that an override gave."""
HEADER: Final = re.compile(r"^\s*(\[\[?)\s*([^\]]+?)\s*\]\]?\s*(#.*)?$")
ASSIGNMENT: Final = re.compile(
    r"""^\s*((?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[\w-]+|"[^"]*"|'[^']*'))*)\s*="""
)
PART: Final = re.compile(r"""[\w-]+|"[^"]*"|'[^']*'""")
NUMBERED: Final = re.compile(r"^(plc|fault)\.(\d+)(?=\.|$)")
WHOLE: Final = ("plc", "fault")
"""Lists that an override may replace as a whole."""


@dataclass(frozen=True, slots=True)
class Given:
    """One value as it was given, with its place."""

    value: object
    file: str
    line: int = 0

    def error(self, message: str) -> InputError:
        """Return the usage error about this value."""
        return InputError(message, self.file, self.line)


def toml_text(path: Path) -> str:
    """Return the text of a TOML file. Raises InputError when it cannot be read."""
    return text_of(path)


@lru_cache(maxsize=64)
def toml_values(text: str, file: str) -> Mapping[str, Given]:
    """Return the values of a TOML text by dotted path, once a process for the same text.

    Raises InputError with file and line.
    """
    lines = line_numbers(text)
    values: dict[str, Given] = {}
    for key, value in flatten(toml_tree(text, file)).items():
        path, line = canonical(key), line_of(lines, key)
        if path in values:
            raise InputError(
                f"{key}: the same as {path}, which is given in line {values[path].line}", file, line
            )
        values[path] = Given(value, file, line)
    return MappingProxyType(values)


def toml_tree(text: str, file: str) -> dict[str, object]:
    """Return a TOML text as nested tables. Raises InputError with file and line."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"\(at line (\d+), column (\d+)\)", str(error))
        line, column = (int(place[1]), int(place[2])) if place else (0, 0)
        message = re.sub(r"\s*\(at [^)]*\)", "", str(error))
        raise InputError(f"not valid TOML: {message}", file, line, column) from error
    except RecursionError as error:
        raise InputError("not valid TOML: nested too deeply", file) from error
    except ValueError as error:  # of Python, for a number of more than 4300 digits
        raise InputError(f"not valid TOML: {error}", file) from error


def line_numbers(text: str) -> dict[str, int]:
    """Return the line of every table header and assignment of a TOML text by dotted path."""
    found: dict[str, int] = {}
    counts: dict[str, int] = {}
    table = ""
    for number, line in enumerate(text.splitlines(), start=1):
        header = HEADER.match(line)
        assignment = ASSIGNMENT.match(line)
        if header:
            table = _joined(header[2])
            if header[1] == "[[":
                index = counts.get(table, 0)
                counts[table] = index + 1
                table = f"{table}[{index}]"
            found[table] = number
        elif assignment:
            key = _joined(assignment[1])
            found.setdefault(f"{table}.{key}" if table else key, number)
    return found


def _joined(key: str) -> str:
    """Return a TOML key, quoted parts bare, as a dotted path."""
    return ".".join(part.strip("\"'") for part in PART.findall(key))


def line_of(lines: Mapping[str, int], path: str) -> int:
    """Return the line of a path, or of the innermost assignment that contains it."""
    while path:
        if path in lines:
            return lines[path]
        path = path[: max(path.rfind("."), path.rfind("["), 0)]
    return 0


def parse_set(texts: Sequence[str]) -> dict[str, object]:
    """Return `KEY=VALUE` texts as overrides; a value is TOML if it can be, else text. Raises InputError."""
    found: dict[str, object] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise InputError(f"{text!r}: expected KEY=VALUE, e.g. plant.probe.Z.face_mm=100", file=SET)
        found[key.strip()] = toml_value(value.strip())
    return found


def toml_value(text: str) -> object:
    """Return the text as a TOML value, or as it is."""
    try:
        tree = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return tree["value"] if len(tree) == 1 else text


def override(base: Mapping[str, Given], overrides: Mapping[str, object]) -> dict[str, Given]:
    """Return the values with overrides on top; `plc` or `fault` given as a list replaces the whole list."""
    values = dict(base)
    for key, value in overrides.items():
        path = NUMBERED.sub(r"\1[\2]", key)
        if path in WHOLE and isinstance(value, Sequence) and not isinstance(value, str):
            values = {old: given for old, given in values.items() if not old.startswith(f"{path}[")}
        for leaf, item in _leaves(path, value):
            values[canonical(leaf)] = Given(item, SET)
    return values


def _leaves(path: str, value: object) -> Iterator[tuple[str, object]]:
    """Yield the dotted paths below an override."""
    if isinstance(value, Sequence) and not isinstance(value, str):
        value = list(value)
    yield from flatten({path: value}).items()
