"""The mutation check: what it changes, and that the places it changes are there."""

import ast
import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

TOOL = Path(__file__).parents[3] / "tools" / "mutants.py"

SOURCE = '''
def width(row, low, high=3):
    """Never changed: 1 < 2."""
    if row.ready and not row.held:
        row.value = max(low, high) - 0.5
        row.tell("µm", low)
    name: int = 7
    return low <= high
'''


@pytest.fixture
def tool() -> Iterator[ModuleType]:
    spec = importlib.util.spec_from_file_location("mutants", TOOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    before = list(sys.path)
    spec.loader.exec_module(module)
    yield module
    sys.path[:] = before
    del sys.modules[spec.name]


def test_each_change_is_one_and_leaves_the_rest_as_it_is(tool: ModuleType) -> None:
    (function,) = tool.functions(ast.parse(SOURCE), "width")
    mutants = tool.Sites("a.py", function).found
    changed = {}
    for mutant in mutants:
        after = mutant.applied(SOURCE)
        ast.parse(after)
        (difference,) = [
            (old.strip(), new.strip())
            for old, new in zip(SOURCE.splitlines(), after.splitlines(), strict=True)
            if old != new
        ]
        changed[mutant.what] = difference[1]
    assert changed == {
        "not: row.ready and (not row.held)": "if (not (row.ready and (not row.held))):",
        "row.ready and (not row.held) -> ((row.ready) or (not row.held))": "if ((row.ready) or (not row.held)):",
        "not row.held -> row.held": "if row.ready and (row.held):",
        "left out: row.value = max(low, high) - 0.5": "pass",
        "max(low, high) - 0.5 -> ((max(low, high)) + (0.5))": "row.value = ((max(low, high)) + (0.5))",
        "max -> min": "row.value = min(low, high) - 0.5",
        "0.5 -> 1.5": "row.value = max(low, high) - (1.5)",
        "left out: row.tell('µm', low)": "pass",
        "7 -> 8": "name: int = (8)",
        "low <= high -> (low > high)": "return (low > high)",
    }


def test_every_place_is_there_and_its_lines_are_shown_by_behaviour(tool: ModuleType) -> None:
    found = tool.coverage_req.read()
    states = tool.coverage_req.states(found)
    assert tool.faults(tool.places(), {line for line, state in states.items() if state == "behaviour"}) == []
