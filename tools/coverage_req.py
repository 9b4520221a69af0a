"""Prints how each requirement line is shown by tests, which lines are open and which do not apply.

The lines stand in `docs/requirements/*.md`, the marks `@pytest.mark.req("M-075", by="parsing")` over `tests/`; both are
read as text and syntax trees, nothing is imported. `docs/requirements/README.md` says what a mark claims. Ends with 1
if a mark or a line cannot be read, names a line that does not exist, or says two things that cannot both be.
"""

import ast
import re
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
LETTERS = "MHFE"

BEHAVIOUR, PARSING, TABLE, ACCEPTED = KINDS = ("behaviour", "parsing", "table", "accepted")
LABELS = {
    BEHAVIOUR: "by behaviour",
    PARSING: "by parsing or look-up",
    TABLE: "by table",
    ACCEPTED: "accepted but not emulated",
    "open": "open",
    "not applicable": "not applicable",
}
SCOPES = {
    "tests/tables/": (TABLE, ACCEPTED),
    "tests/unit/manual/": (PARSING, TABLE, ACCEPTED),
    "tests/unit/protocols/": (PARSING, TABLE, ACCEPTED),
    "tests/unit/kernel/decoder/test_golden.py": (PARSING,),
}
"""What a mark may claim by where its test stands; the first is meant where it does not say. Elsewhere: all KINDS."""

LINE = re.compile(
    r"- (?P<id>[A-Z]-\d{3}): (?P<text>.+) \[(?P<section>[^\[\]]+)\]"
    r"(?:\. (?P<state>Open|Not applicable): (?P<why>[^\[\]]+))?"
)


@dataclass(frozen=True)
class Requirement:
    """One line of a manual, and why it is not shown or cannot be."""

    id: str
    text: str
    section: str
    state: str = ""
    why: str = ""


class Mark(NamedTuple):
    """One id that a test is marked with."""

    requirement: str
    kind: str
    test: str


@dataclass
class Findings:
    """What was read, and what could not be."""

    requirements: dict[str, Requirement] = field(default_factory=dict)
    marks: list[Mark] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)

    def marks_by_line(self) -> dict[str, list[Mark]]:
        """Return the marks of each requirement."""
        found: dict[str, list[Mark]] = defaultdict(list)
        for mark in self.marks:
            found[mark.requirement].append(mark)
        return found


def read_requirements(root: Path, found: Findings) -> None:
    """Read the lines of `docs/requirements`; a list entry that has not their form is a fault."""
    for page in sorted((root / "docs" / "requirements").glob("*.md")):
        if page.name == "README.md":
            continue
        for number, text in enumerate(page.read_text(encoding="utf-8").splitlines(), start=1):
            if not text.startswith("- "):
                continue
            match = LINE.fullmatch(text)
            place = f"docs/requirements/{page.name}:{number}"
            if match is None:
                found.faults.append(f"{place}: not a requirement line: {text[:60]}")
            elif match["id"] in found.requirements:
                found.faults.append(f"{place}: {match['id']} stands twice")
            else:
                found.requirements[match["id"]] = Requirement(
                    match["id"],
                    match["text"],
                    match["section"],
                    (match["state"] or "").lower(),
                    match["why"] or "",
                )


def _is_req(node: ast.AST) -> bool:
    """Tell whether a node is `mark.req` or `pytest.mark.req`."""
    if not (isinstance(node, ast.Attribute) and node.attr == "req"):
        return False
    owner = node.value
    return (isinstance(owner, ast.Attribute) and owner.attr == "mark") or (
        isinstance(owner, ast.Name) and owner.id == "mark"
    )


def _is_off(decorator: ast.expr) -> bool:
    """Tell whether a decorator keeps a test from counting, whatever it finds."""
    node = decorator.func if isinstance(decorator, ast.Call) else decorator
    return isinstance(node, ast.Attribute) and node.attr in {"skip", "xfail"}


class Reader:
    """Reads the marks of one test file."""

    def __init__(self, path: Path, root: Path, found: Findings) -> None:
        self.place = path.relative_to(root).as_posix()
        self.found = found
        self.kinds = next((kinds for start, kinds in SCOPES.items() if self.place.startswith(start)), KINDS)
        self.collected = path.name.startswith("test_") or path.stem.endswith("_test")

    def read(self, tree: ast.Module) -> None:
        """Read a module: marks of its tests, classes, and of rows that stand beside them."""
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                self._decorators(node, node.name)
                for inner in node.body:
                    self._statement(inner, node.name)
            else:
                self._statement(node, "")

    def _statement(self, node: ast.stmt, owner: str) -> None:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            test = "::".join(part for part in (owner, node.name) if part)
            self._decorators(node, test)
            for inner in node.body:
                self._refuse_all(inner, "stands inside a function, where it marks nothing")
        else:
            self._take_all([node], owner)

    def _decorators(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef, test: str) -> None:
        wanted = "Test" if isinstance(node, ast.ClassDef) else "test"
        if not node.name.startswith(wanted):
            for decorator in node.decorator_list:
                self._refuse_all(decorator, f"{node.name} is no test")
        elif any(_is_off(decorator) for decorator in node.decorator_list):
            for decorator in node.decorator_list:
                self._refuse_all(decorator, f"{node.name} is switched off")
        else:
            self._take_all(node.decorator_list, test)

    def _take_all(self, nodes: Iterable[ast.AST], test: str) -> None:
        for outer in nodes:
            calls = {id(node.func): node for node in ast.walk(outer) if isinstance(node, ast.Call)}
            for node in ast.walk(outer):
                if _is_req(node):
                    self._take(node, calls.get(id(node)), test)

    def _take(self, node: ast.AST, call: ast.Call | None, test: str) -> None:
        if not self.collected:
            self._refuse(node, "stands in a file that pytest does not collect")
        elif call is None or not call.args:
            self._refuse(node, "names no requirement")
        else:
            ids = [self._text(argument) for argument in call.args]
            kinds = [self._text(word.value) for word in call.keywords if word.arg == "by"] or [self.kinds[0]]
            if None in ids or None in kinds or any(word.arg != "by" for word in call.keywords):
                self._refuse(node, 'cannot be read: plain texts only, e.g. req("M-001", by="parsing")')
            elif kinds[0] not in self.kinds:
                self._refuse(node, f"by={kinds[0]!r} is none of those possible here: {', '.join(self.kinds)}")
            else:
                where = f"{self.place}::{test}" if test else self.place
                self.found.marks += [Mark(str(name), str(kinds[0]), where) for name in ids]

    @staticmethod
    def _text(node: ast.expr) -> str | None:
        return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None

    def _refuse_all(self, outer: ast.AST, why: str) -> None:
        for node in ast.walk(outer):
            if _is_req(node):
                self._refuse(node, why)

    def _refuse(self, node: ast.AST, why: str) -> None:
        self.found.faults.append(f"{self.place}:{getattr(node, 'lineno', 0)}: the mark {why}")


def read(root: Path = ROOT) -> Findings:
    """Read the lines and the marks of a project and hold the ones against the others."""
    found = Findings()
    read_requirements(root, found)
    for path in sorted((root / "tests").rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
        Reader(path, root, found).read(tree)
    for name, marks in found.marks_by_line().items():
        line, kinds = found.requirements.get(name), {mark.kind for mark in marks}
        if line is None:
            found.faults.append(f"unknown requirement: {name} in {marks[0].test}")
        elif line.state == "not applicable":
            found.faults.append(f"{name} does not apply, but {marks[0].test} is marked with it")
        elif {BEHAVIOUR, ACCEPTED} <= kinds:
            found.faults.append(
                f"{name} is marked both as behaviour and as accepted without one: {marks[0].test}"
            )
    return found


def state_of(line: Requirement, marks: Iterable[Mark]) -> str:
    """Return how a line stands. What is accepted without effect is not shown by its table or its parsing."""
    kinds = {mark.kind for mark in marks}
    if line.state or not kinds:
        return line.state or "open"
    return next(kind for kind in (ACCEPTED, *KINDS) if kind in kinds)


def states(found: Findings) -> dict[str, str]:
    """Return the state of every line, in the order of the manuals."""
    marks = found.marks_by_line()
    ordered = sorted(found.requirements.values(), key=lambda line: (LETTERS.find(line.id[0]), line.id))
    return {line.id: state_of(line, marks.get(line.id, ())) for line in ordered}


def lines(found: Findings) -> Iterator[str]:
    """Yield one line per requirement and a last line with the counts."""
    all_marks, all_states = found.marks_by_line(), states(found)
    for name, state in all_states.items():
        line, tests = found.requirements[name], dict.fromkeys(mark.test for mark in all_marks.get(name, ()))
        parts = [f"{LABELS[state]}: {name}", line.why, "(in part:" if line.why and tests else "", *tests]
        yield " ".join(part for part in parts if part) + (")" if line.why and tests else "")
    yield counts(all_states)


def counts(all_states: Mapping[str, str]) -> str:
    """Return the one line that says how many lines stand how."""
    values = list(all_states.values())
    return ", ".join(f"{values.count(state)} {label}" for state, label in LABELS.items())


def main(root: Path = ROOT) -> int:
    """Print the report; return 1 if anything in it cannot be relied on."""
    found = read(root)
    for fault in sorted(found.faults):
        print(fault, file=sys.stderr)
    for line in lines(found):
        print(line)
    return 1 if found.faults else 0


if __name__ == "__main__":
    sys.exit(main())
