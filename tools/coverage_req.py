"""Prints which requirement lines are covered by tests, which are open and which do not apply.

Reads the marks `@pytest.mark.req("M-075", ...)` over `tests/` from the syntax trees (nothing is imported) and
the reasons in `docs/requirements_na.toml`. Ends with 1 if one of them names a line that does not exist.
"""

import ast
import sys
import tomllib
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LAST = {"M": 252, "H": 248, "F": 121, "E": 45}
"""Last number of each group of requirement lines: measuring, homing, fixed stop, extended programming."""


def requirement_ids() -> list[str]:
    """Return every requirement id in order."""
    return [f"{letter}-{number:03d}" for letter, last in LAST.items() for number in range(1, last + 1)]


def is_req_mark(node: ast.AST) -> bool:
    """Tell whether a call is `pytest.mark.req(...)`."""
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr == "req"
        and isinstance(node.func.value, ast.Attribute)
        and node.func.value.attr == "mark"
    )


def ids_in(node: ast.AST) -> Iterator[str]:
    """Yield the ids of every req mark below a node (decorators, pytestmark, pytest.param)."""
    for inner in ast.walk(node):
        if is_req_mark(inner) and isinstance(inner, ast.Call):
            for argument in inner.args:
                if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
                    yield argument.value


def marks_of(path: Path, root: Path) -> Iterator[tuple[str, str]]:
    """Yield (id, test) for one test file; a mark outside a test counts for its class or module."""
    place = path.relative_to(root).as_posix()
    for node in ast.parse(path.read_text(encoding="utf-8"), filename=str(path)).body:
        if isinstance(node, ast.ClassDef):
            for decorator in node.decorator_list:
                yield from ((found, f"{place}::{node.name}") for found in ids_in(decorator))
            for inner in node.body:
                yield from ((found, f"{place}::{_name(inner, node.name)}") for found in ids_in(inner))
        else:
            name = _name(node, "")
            yield from ((found, f"{place}::{name}" if name else place) for found in ids_in(node))


def _name(node: ast.AST, owner: str) -> str:
    """Return the test's name, with its class."""
    name = node.name if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) else ""
    return "::".join(part for part in (owner, name) if part)


def marks(root: Path) -> dict[str, list[str]]:
    """Return the tests of every id named by a mark below `root/tests`."""
    found: dict[str, list[str]] = defaultdict(list)
    for path in sorted((root / "tests").rglob("*.py")):
        for requirement, test in marks_of(path, root):
            found[requirement].append(test)
    return found


def reasons(root: Path) -> dict[str, str]:
    """Return why lines do not apply: `[M-035] reason = "..."`, or a table with `ids` and `reason`."""
    path = root / "docs" / "requirements_na.toml"
    tables = tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    found: dict[str, str] = {}
    for name, table in tables.items():
        for requirement in table.get("ids", [name]):
            found[requirement] = table["reason"]
    return found


def lines(covered: Mapping[str, list[str]], not_applicable: Mapping[str, str]) -> Iterator[str]:
    """Yield one line per requirement and a last line with the counts."""
    counts = {"covered": 0, "open": 0, "not applicable": 0}
    for requirement in requirement_ids():
        if requirement in covered:
            state, rest = "covered", " " + " ".join(dict.fromkeys(covered[requirement]))
        elif requirement in not_applicable:
            state, rest = "not applicable", " " + not_applicable[requirement]
        else:
            state, rest = "open", ""
        counts[state] += 1
        yield f"{state}: {requirement}{rest}"
    yield ", ".join(f"{count} {state}" for state, count in counts.items())


def main(root: Path = ROOT) -> int:
    """Print the report; return 1 if a mark or a reason names an unknown line."""
    covered, not_applicable = marks(root), reasons(root)
    for line in lines(covered, not_applicable):
        print(line)
    known = set(requirement_ids())
    unknown = [f"{name} in {tests[0]}" for name, tests in covered.items() if name not in known]
    unknown += [f"{name} in docs/requirements_na.toml" for name in not_applicable.keys() - known]
    for text in sorted(unknown):
        print(f"unknown requirement: {text}", file=sys.stderr)
    return 1 if unknown else 0


if __name__ == "__main__":
    sys.exit(main())
