"""Which parameters the code of the bench reads, found in its syntax trees.

A parameter is read where an expression that holds a group of parameters (`Kenngr`, `Getriebe`, ...) is asked for
one of its fields. What an expression holds follows from annotations, assignments, loops and calls. Code in
`hli_bench/manual` checks and shows all parameters alike and does not count, but for the look-ups (`LOOK_UPS`) that
the rest of the bench calls.
"""

import ast
from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest

import hli_bench
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import catalogue
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.sheet import ARRAY, SHEET, Effect

PACKAGE = Path(hli_bench.__file__).parent
LOOK_UPS = (
    PACKAGE / "manual" / "axis" / "fallbacks.py",
    PACKAGE / "manual" / "measuring_methods.py",
)


@dataclass(frozen=True)
class Holds:
    """What an expression holds: a group of parameters, or an array of such groups."""

    group: str
    array: bool = False


@dataclass
class Names:
    """What the names of the package hold, wherever they are used."""

    groups: dict[str, dict[str, Holds | None]] = field(default_factory=dict)
    """Fields of each group; None: a parameter."""
    attributes: dict[str, Holds] = field(default_factory=dict)
    returned: dict[str, Holds] = field(default_factory=dict)


AT_START = frozenset({"kenngr.achs_mode"})
"""Acts when the machine is built: each of its bits is refused or not."""

Read = tuple[str, str]
"""Group and field."""


def groups_below(cls: type[Any], found: dict[str, dict[str, Holds | None]]) -> None:
    """Collect the fields of a group and of the groups below it."""
    hints = get_type_hints(cls)
    mine = found.setdefault(cls.__name__, {})
    for item in fields(cls):
        array, hint = item.metadata.get(ARRAY), hints[item.name]
        below = array.element if array is not None else hint
        if SHEET in item.metadata:
            mine[item.name] = None
        elif is_dataclass(below) and isinstance(below, type):
            mine[item.name] = Holds(below.__name__, array=array is not None)
            groups_below(below, found)
        else:
            raise AssertionError((cls, item.name, get_args(hint)))


@cache
def trees() -> Mapping[Path, ast.Module]:
    """Return the syntax trees of the package that count."""
    manual = PACKAGE / "manual"
    return {
        path: ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(PACKAGE.rglob("*.py"))
        if path in LOOK_UPS or manual not in path.parents
    }


@cache
def names() -> Names:
    """Return what annotations of fields, functions and properties say."""
    known = Names()
    for cls in (AxisParams, ChannelParams):
        groups_below(cls, known.groups)
    for tree in trees().values():
        groups = imported(tree) & known.groups.keys()
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                annotations = {
                    item.target.id: annotated(item.annotation, groups)
                    for item in node.body
                    if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
                }
                known.attributes |= {name: held for name, held in annotations.items() if held}
            elif isinstance(node, ast.FunctionDef) and (held := annotated(node.returns, groups)):
                known.returned[node.name] = held
    return known


def imported(tree: ast.Module) -> set[str]:
    """Return the names that a module takes from the manual: other classes may be called alike."""
    return {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("hli_bench.manual")
        for alias in node.names
    }


def annotated(annotation: ast.expr | None, groups: AbstractSet[str]) -> Holds | None:
    """Return what an annotation says, None when it names no group."""
    if annotation is None:
        return None
    words = {node.id for node in ast.walk(annotation) if isinstance(node, ast.Name)}
    for group in words & groups:
        return Holds(group, array=bool(words & {"tuple", "list", "Sequence", "Iterable", "Iterator"}))
    return None


class Reader(ast.NodeVisitor):
    """Collects the reads of one function (or of what stands outside of functions)."""

    def __init__(self, module: ast.Module) -> None:
        self.known = names()
        self.groups = imported(module) & self.known.groups.keys()
        self.module = module
        self.env: dict[str, Holds] = {}
        self.reads: set[Read] = set()
        self.called: set[str] = set()

    def held(self, node: ast.expr | None) -> Holds | None:
        """Return what an expression holds."""
        if isinstance(node, ast.Name):
            return self.env.get(node.id)
        if isinstance(node, ast.Attribute):
            holder = self.held(node.value)
            if holder is None:
                return self.known.attributes.get(node.attr)
            return None if holder.array else self.known.groups[holder.group].get(node.attr)
        if isinstance(node, ast.Subscript):
            holder = self.held(node.value)
            return Holds(holder.group) if holder and holder.array else None
        if isinstance(node, ast.Call):
            return self._returned(node)
        if isinstance(node, ast.IfExp):
            return self.held(node.body) or self.held(node.orelse)
        if isinstance(node, ast.BoolOp):
            return next((one for one in map(self.held, node.values) if one), None)
        if isinstance(node, ast.Tuple | ast.List):
            one = next((one for one in map(self.held, node.elts) if one), None)
            return Holds(one.group, array=True) if one else None
        if isinstance(node, ast.GeneratorExp | ast.ListComp):
            self._comprehension(node)
            one = self.held(node.elt)
            return Holds(one.group, array=True) if one else None
        if isinstance(node, ast.NamedExpr):
            return self.held(node.value)
        return None

    def _returned(self, node: ast.Call) -> Holds | None:
        name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        if name == "next" and node.args:
            one = self.held(node.args[0])
            return Holds(one.group) if one else None
        if name in self.groups:
            return Holds(name)
        return self.known.returned.get(name)

    def _comprehension(self, node: ast.GeneratorExp | ast.ListComp | ast.SetComp | ast.DictComp) -> None:
        for generator in node.generators:
            self._bind(generator.target, generator.iter, element=True)

    def _bind(self, target: ast.expr, value: ast.expr, *, element: bool = False) -> None:
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and not element:
            for one, its in zip(target.elts, value.elts, strict=False):
                self._bind(one, its)
        elif isinstance(target, ast.Name):
            held = self.held(value)
            if held is not None:
                self.env[target.id] = Holds(held.group) if element else held

    def visit_Assign(self, node: ast.Assign) -> None:
        for target in node.targets:
            self._bind(target, node.value)
        self.generic_visit(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        held = annotated(node.annotation, self.groups)
        if held is not None and isinstance(node.target, ast.Name):
            self.env[node.target.id] = held
        self.generic_visit(node)

    def visit_NamedExpr(self, node: ast.NamedExpr) -> None:
        self._bind(node.target, node.value)
        self.generic_visit(node)

    def visit_For(self, node: ast.For) -> None:
        self._bind(node.target, node.iter, element=True)
        self.generic_visit(node)

    def visit_GeneratorExp(self, node: ast.GeneratorExp) -> None:
        self._comprehension(node)
        self.generic_visit(node)

    def visit_ListComp(self, node: ast.ListComp) -> None:
        self._comprehension(node)
        self.generic_visit(node)

    def visit_SetComp(self, node: ast.SetComp) -> None:
        self._comprehension(node)
        self.generic_visit(node)

    def visit_DictComp(self, node: ast.DictComp) -> None:
        self._comprehension(node)
        self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> None:
        self.called.add(node.id)

    def visit_Call(self, node: ast.Call) -> None:
        """`getattr(group, name)` reads every field that a text of the module names."""
        if isinstance(node.func, ast.Name) and node.func.id == "getattr":
            holder = self.held(node.args[0])
            if holder is not None and not holder.array:
                texts = {one.value for one in ast.walk(self.module) if isinstance(one, ast.Constant)}
                items = self.known.groups[holder.group]
                self.reads.update((holder.group, name) for name in items.keys() & texts)
        self.generic_visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> None:
        holder = self.held(node.value)
        if holder is not None and not holder.array:
            if self.known.groups[holder.group].get(node.attr, holder) is None:
                self.reads.add((holder.group, node.attr))
        elif holder is None:
            self.reads.update(self._distinctive(node.attr))
        self.generic_visit(node)

    def _distinctive(self, name: str) -> Iterator[Read]:
        """Yield the parameter that a name alone tells: one that only one group has, and no other class."""
        owners = [group for group, items in self.known.groups.items() if items.get(name, name) is None]
        if len(owners) == 1 and name not in other_names():
            yield owners[0], name

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for argument in [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]:
            held = annotated(argument.annotation, self.groups)
            if held is not None:
                self.env[argument.arg] = held
            else:
                self.env.pop(argument.arg, None)
        self.generic_visit(node)


@cache
def other_names() -> frozenset[str]:
    """Return the names that classes and functions of the package define themselves."""
    found: set[str] = set()
    for node in (node for tree in trees().values() for node in ast.walk(tree)):
        if isinstance(node, ast.FunctionDef):
            found.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name | ast.Attribute):
            found.add(node.target.id if isinstance(node.target, ast.Name) else node.target.attr)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            found.add(node.attr)
    return frozenset(found)


def reader_of(node: ast.AST, module: ast.Module) -> Reader:
    """Return what a piece of code of a module reads and calls."""
    reader = Reader(module)
    reader.visit(node)
    return reader


@cache
def reads() -> frozenset[Read]:
    """Return every (group, field) that the bench reads."""
    found: set[Read] = set()
    called: set[str] = set()
    functions: dict[str, tuple[ast.FunctionDef, ast.Module]] = {}
    for path, tree in trees().items():
        if path in LOOK_UPS:
            functions |= {one.name: (one, tree) for one in tree.body if isinstance(one, ast.FunctionDef)}
        else:
            reader = reader_of(tree, tree)
            found |= reader.reads
            called |= reader.called
    due, done = called & functions.keys(), set[str]()
    while due:
        name = due.pop()
        done.add(name)
        reader = reader_of(*functions[name])
        found |= reader.reads
        due |= (reader.called & functions.keys()) - done
    return frozenset(found)


def paths_read() -> frozenset[str]:
    """Return the paths of all parameters that the bench reads, as the catalogue spells them."""
    return frozenset(
        path for cls in (AxisParams, ChannelParams) for path, owner in _owners(cls, "") if owner in reads()
    )


def _owners(cls: type[Any], prefix: str, depth: int = 0) -> Iterator[tuple[str, Read]]:
    hints = get_type_hints(cls)
    for item in fields(cls):
        array = item.metadata.get(ARRAY)
        path, index = prefix + item.name, f"[{'ijk'[depth]}]"
        if array is not None:
            yield from _owners(array.element, f"{path}{index}.", depth + 1)
        elif SHEET in item.metadata:
            is_tuple = "tuple" in str(hints[item.name])
            yield path + (index if is_tuple else ""), (cls.__name__, item.name)
        else:
            yield from _owners(hints[item.name], path + ".", depth)


def acting() -> frozenset[str]:
    """Return the paths that change what the bench does: those read, and those that bound one that is read."""
    read = paths_read()
    bounding = {
        number.rpartition("*")[2]
        for cls in (AxisParams, ChannelParams)
        for entry in catalogue(cls).entries
        if entry.path in read
        for number in (entry.sheet.low, entry.sheet.high)
        if isinstance(number, str)
    }
    bounds = {entry.path for entry in catalogue(AxisParams).entries if entry.sheet.number in bounding}
    return read | bounds | AT_START


@pytest.mark.parametrize("cls", [AxisParams, ChannelParams])
def test_the_effect_of_a_sheet_is_what_the_code_does(cls: type[Any]) -> None:
    acts = acting()
    untrue = {
        entry.path: "is read" if entry.path in acts else "nothing reads it"
        for entry in catalogue(cls).entries
        if (entry.path in acts) != (entry.sheet.effect is Effect.EMULATED)
        and not (entry.sheet.effect is Effect.REFUSED and entry.path in acts)
    }
    assert untrue == {}


@pytest.mark.parametrize(
    ("code", "read"),
    [
        ("def f(axis: AxisParams): return axis.kenngr.vb_messen", {("Kenngr", "vb_messen")}),
        ("def f(axis: AxisParams):\n gear = axis.getriebe[0]\n return gear.kv", {("Getriebe", "kv")}),
        ("def f(axis: AxisParams): return axis.kenngr.measure.input", {("Measure", "input")}),
        ("def f(other): return other.input", set()),
        ("def f(axis: AxisParams): return [one.id for one in axis.antr.function]", {("Function", "id")}),
        (
            "def f(axis: AxisParams): return getattr(axis.kenngr, n)\nNAMES = ('vb_messen',)",
            {("Kenngr", "vb_messen")},
        ),
        ("def f(other): return other.zero_pulse_search_max_dist", {("LrHw", "zero_pulse_search_max_dist")}),
    ],
)
def test_reads_are_found(code: str, read: set[Read]) -> None:
    module = ast.parse(f"from hli_bench.manual.axis import AxisParams\n{code}")
    assert reader_of(module, module).reads == read
