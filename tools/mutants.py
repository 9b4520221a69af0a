"""Breaks the code on purpose and tells whether the marked tests notice: `tools/mutants.py --seed 1 --lines 40`.

A seeded sample of the lines that are shown by behaviour; `docs/requirements/places.toml` says where in the code each
is about. For each line a few single changes there (a comparison the other way round, a number, an operator, a
condition, a statement left out), each tried by the tests that are marked with this very line and by nothing else.
Works on copies; the tree stays as it is. Ends with 1 when fewer than `--floor` per cent are killed, or a place or a
marked test is no good.
"""

import argparse
import ast
import compileall
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from py_compile import PycInvalidationMode
from queue import SimpleQueue
from time import monotonic
from typing import TypeGuard

sys.path.insert(0, str(Path(__file__).resolve().parent))
import coverage_req

ROOT = coverage_req.ROOT
PLACES = ROOT / "docs" / "requirements" / "places.toml"
NEEDED = (
    *(
        "hli_bench",
        "drives",
        "tests",
        "programs",
        "plc_scripts",
        "eds",
        "campaigns",
        "tools",
        "docs",
        "benchmarks",
    ),
    *(
        "pyproject.toml",
        "README.md",
        "CHANGELOG.md",
        "Makefile",
        "requirements.lock",
        "requirements-dev.lock",
    ),
)
PATIENCE = 5.0
"""How many times as long as without a mutant the tests may take; then it is killed: it never ends."""
LEAST_S = 60.0
WITHOUT = ("-p", "no:hypothesispytest", "-p", "no:xdist")
"""Plugins that cost more than the tests of a line."""
OTHER_WAY = {
    ast.Lt: ">=",
    ast.GtE: "<",
    ast.Gt: "<=",
    ast.LtE: ">",
    ast.Eq: "!=",
    ast.NotEq: "==",
    ast.Is: "is not",
    ast.IsNot: "is",
    ast.In: "not in",
    ast.NotIn: "in",
}
OPERATORS = {
    ast.Add: "-",
    ast.Sub: "+",
    ast.Mult: "/",
    ast.Div: "*",
    ast.FloorDiv: "*",
    ast.BitAnd: "|",
    ast.BitOr: "&",
    ast.LShift: ">>",
    ast.RShift: "<<",
}
SELECT = """
import os


def claims(mark):
    return os.environ["MUTANTS_LINE"] in mark.args and mark.kwargs.get("by", "behaviour") == "behaviour"


def pytest_collection_modifyitems(items):
    items[:] = [item for item in items if any(claims(mark) for mark in item.iter_markers("req"))]
"""
"""The plugin that keeps the tests which claim one requirement line by behaviour."""


@dataclass(frozen=True)
class Mutant:
    """One change: the text between two places of a file becomes another one."""

    file: str
    line: int
    start: tuple[int, int]
    end: tuple[int, int]
    text: str
    what: str

    def applied(self, source: str) -> str:
        """Return the source with the change; columns are counted in bytes, as the syntax tree does."""
        lines = source.encode().splitlines(keepends=True)
        (first, left), (last, right) = self.start, self.end
        lines[first - 1 : last] = [lines[first - 1][:left] + self.text.encode() + lines[last - 1][right:]]
        return b"".join(lines).decode()


COMPUTED = (ast.Name, ast.Attribute, ast.Call, ast.Subscript, ast.Tuple)


def _shown(node: ast.AST) -> str:
    return ast.unparse(node).partition("\n")[0]


def _acts(node: ast.AST) -> TypeGuard[ast.stmt]:
    """Tell whether a statement does something beyond a name of its own, and can be left out."""
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Call)
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Attribute | ast.Subscript)
    return isinstance(node, ast.Delete) or (
        isinstance(node, ast.AugAssign) and not isinstance(node.target, ast.Name)
    )


class Sites:
    """Every change that can be made within one function."""

    def __init__(self, file: str, function: ast.FunctionDef) -> None:
        self._file = file
        self._compiled = any("law" in ast.unparse(one) for one in function.decorator_list)
        self.found: list[Mutant] = []
        for statement in function.body:
            self._walk(statement)

    def _walk(self, node: ast.AST) -> None:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            return  # a docstring
        self._statement(node)
        if isinstance(node, ast.expr):
            self._expression(node)
        for name, value in ast.iter_fields(node):
            if name in {"annotation", "returns", "decorator_list"}:
                continue
            for inner in value if isinstance(value, list) else [value]:
                if isinstance(inner, ast.AST) and not isinstance(inner, ast.arguments | ast.JoinedStr):
                    self._walk(inner)

    def _put(self, node: ast.stmt | ast.expr, text: str, what: str) -> None:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start, end = (node.lineno, node.col_offset), (node.end_lineno, node.end_col_offset)
        self.found.append(Mutant(self._file, node.lineno, start, end, text, what))

    def _statement(self, node: ast.AST) -> None:
        if _acts(node):
            self._put(node, "pass", f"left out: {_shown(node)}")
        if isinstance(node, ast.Return) and isinstance(node.value, COMPUTED) and not self._compiled:
            self._put(node, "return None", f"None for: {_shown(node)}")
        if isinstance(node, ast.If | ast.While | ast.IfExp) and not isinstance(
            node.test, ast.Compare | ast.Constant
        ):
            self._put(node.test, f"(not ({ast.unparse(node.test)}))", f"not: {ast.unparse(node.test)}")

    def _expression(self, node: ast.expr) -> None:
        said = ast.unparse(node)
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            operator = OTHER_WAY[type(node.ops[0])]
            text = f"({ast.unparse(node.left)} {operator} {ast.unparse(node.comparators[0])})"
            self._put(node, text, f"{said} -> {text}")
        elif isinstance(node, ast.BoolOp):
            word = " or " if isinstance(node.op, ast.And) else " and "
            text = f"({word.join(f'({ast.unparse(value)})' for value in node.values)})"
            self._put(node, text, f"{said} -> {text}")
        elif isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            operator = OPERATORS[type(node.op)]
            text = f"(({ast.unparse(node.left)}) {operator} ({ast.unparse(node.right)}))"
            self._put(node, text, f"{said} -> {text}")
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not | ast.USub):
            self._put(node, f"({ast.unparse(node.operand)})", f"{said} -> {ast.unparse(node.operand)}")
        elif isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float):
            value = not node.value if isinstance(node.value, bool) else node.value + 1
            self._put(node, f"({value!r})", f"{said} -> {value!r}")
        elif isinstance(node, ast.Name) and node.id in {"min", "max"}:
            other = "max" if node.id == "min" else "min"
            self._put(node, other, f"{said} -> {other}")


def functions(tree: ast.Module, name: str) -> Iterator[ast.FunctionDef]:
    """Yield the functions and methods of that name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and node.name == name:
            yield node


def sites(place: str, root: Path = ROOT) -> list[Mutant]:
    """Return every change at `path.py:function`; empty where there is no such function."""
    file, _, name = place.partition(":")
    if not (root / file).is_file():
        return []
    tree = ast.parse((root / file).read_text(encoding="utf-8"))
    return [mutant for function in functions(tree, name) for mutant in Sites(file, function).found]


def places(file: Path = PLACES) -> dict[str, list[str]]:
    """Return the places of each requirement line."""
    found: dict[str, list[str]] = {}
    for table in tomllib.loads(file.read_text(encoding="utf-8"))["place"]:
        for line in table["lines"]:
            found.setdefault(line, []).extend(
                place for place in table["code"] if place not in found.get(line, ())
            )
    return found


def faults(known: dict[str, list[str]], behaviour: set[str]) -> list[str]:
    """Return what is wrong with the places: none there, nothing to change, a line not shown by behaviour."""
    used = sorted({place for here in known.values() for place in here})
    return [f"{PLACES.name}: nothing to change at {place}" for place in used if not sites(place)] + [
        f"{PLACES.name}: {line} is not shown by behaviour" for line in sorted(known.keys() - behaviour)
    ]


class Tree:
    """A copy of the project in which one mutant lives at a time."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in NEEDED:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
            elif source.is_file():
                shutil.copy(source, folder / name)
        (folder / "mutants_select.py").write_text(SELECT)
        # By hash: a mutant and what it came from may be of the same second and size.
        compileall.compile_dir(folder, quiet=2, invalidation_mode=PycInvalidationMode.CHECKED_HASH)

    def passes(self, line: str, files: Sequence[str], timeout_s: float = 1200.0) -> bool:
        """Run the tests marked with a line and tell whether they pass; no test, or no end in time, is no pass."""
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "-x",
            "-m",
            "not vcan",
            "-p",
            "mutants_select",
            *files,
        ]
        places = f"{self.folder}{os.pathsep}{self.folder / 'drives'}"
        environment = {**os.environ, "MUTANTS_LINE": line, "PYTHONPATH": places}
        environment |= {"PYTHONDONTWRITEBYTECODE": "1"}
        quiet = subprocess.DEVNULL
        run = subprocess.Popen(
            command, cwd=self.folder, env=environment, stdout=quiet, stderr=quiet, start_new_session=True
        )
        try:
            return run.wait(timeout_s) == 0
        except subprocess.TimeoutExpired:
            return False
        finally:
            with suppress(ProcessLookupError):
                os.killpg(run.pid, signal.SIGKILL)
            run.wait()

    def survives(self, mutant: Mutant, line: str, files: Sequence[str], timeout_s: float) -> bool:
        """Tell whether the marked tests pass with the mutant."""
        path = self.folder / mutant.file
        source = path.read_text(encoding="utf-8")
        path.write_text(mutant.applied(source), encoding="utf-8")
        try:
            return self.passes(line, files, timeout_s)
        finally:
            path.write_text(source, encoding="utf-8")


class Check:
    """Tries mutants, some at a time, each in a tree of its own."""

    def __init__(self, folder: Path, jobs: int, tests: dict[str, list[str]]) -> None:
        self._tests = tests
        self._patience_s: dict[str, float] = {}
        self._trees: SimpleQueue[Tree] = SimpleQueue()
        for number in range(jobs):
            self._trees.put(Tree(folder / str(number)))

    def baseline(self, line: str) -> bool:
        """Tell whether the tests of a line pass as they are; how long they take is how long they may take."""
        tree, begin = self._trees.get(), monotonic()
        try:
            return tree.passes(line, self._tests[line])
        finally:
            self._trees.put(tree)
            self._patience_s[line] = max(PATIENCE * (monotonic() - begin), LEAST_S)

    def survives(self, line: str, mutant: Mutant) -> bool:
        """Tell whether a mutant goes unnoticed by the tests of a line."""
        tree = self._trees.get()
        try:
            return tree.survives(mutant, line, self._tests[line], self._patience_s[line])
        finally:
            self._trees.put(tree)


def main(arguments: Sequence[str] | None = None) -> int:
    """Take the sample, try the mutants, print one line each and the figure."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--lines", type=int, default=40, metavar="N", help="requirement lines in the sample")
    parser.add_argument("--each", type=int, default=2, metavar="N", help="mutants of each line")
    parser.add_argument(
        "--only", nargs="*", metavar="LINE", help="these lines and no sample, all their mutants"
    )
    parser.add_argument("--jobs", type=int, default=2, metavar="N")
    parser.add_argument("--floor", type=float, default=95.0, metavar="PERCENT")
    given = parser.parse_args(arguments)

    found = coverage_req.read()
    tests = {
        name: sorted({mark.test.partition("::")[0] for mark in marks if mark.kind == coverage_req.BEHAVIOUR})
        for name, marks in found.marks_by_line().items()
    }
    behaviour = {
        name for name, state in coverage_req.states(found).items() if state == coverage_req.BEHAVIOUR
    }
    known = places()
    wrong = faults(known, behaviour)
    for fault in wrong:
        print(fault, file=sys.stderr)

    chance = random.Random(given.seed)
    chosen = given.only or sorted(chance.sample(sorted(known), min(given.lines, len(known))))
    work: list[tuple[str, Mutant]] = []
    for line in chosen:
        here = [mutant for place in known[line] for mutant in sites(place)]
        work += [
            (line, one) for one in (here if given.only else chance.sample(here, min(given.each, len(here))))
        ]

    with tempfile.TemporaryDirectory(prefix="mutants-") as folder, ThreadPoolExecutor(given.jobs) as pool:
        check = Check(Path(folder), given.jobs, tests)
        for line, good in zip(chosen, pool.map(check.baseline, chosen), strict=True):
            if not good:
                wrong.append(line)
                print(f"{line}: its tests do not pass without a mutant", file=sys.stderr)
        survived = 0
        for (line, mutant), lives in zip(work, pool.map(lambda one: check.survives(*one), work), strict=True):
            survived += lives
            word = "survived" if lives else "killed"
            print(f"{word}: {line} {mutant.file}:{mutant.line} {mutant.what}", flush=True)
    killed = len(work) - survived
    percent = 100.0 * killed / len(work) if work else 0.0
    print(
        f"{killed} of {len(work)} mutants killed ({percent:.1f} %), {len(chosen)} of {len(behaviour)} lines shown by "
        f"behaviour ({len(behaviour - known.keys())} without a place), seed {given.seed}"
    )
    return 1 if wrong or percent < given.floor else 0


if __name__ == "__main__":
    sys.exit(main())
