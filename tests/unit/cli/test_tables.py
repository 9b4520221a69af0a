"""Columns and values as the commands print them."""

from hli_bench.cli import tables


def test_columns_are_as_wide_as_their_widest_cell() -> None:
    assert list(tables.lines([("A", "B"), ("long", 1), ("x", "")])) == ["A     B", "long  1", "x"]


def test_values_are_printed_as_they_are_set() -> None:
    assert [tables.value(item) for item in (True, False, 5, 0.5, "x")] == ["TRUE", "FALSE", "5", "0.5", "x"]


def test_a_tree_prints_records_as_tables() -> None:
    state = {
        "mode": "automatic",
        "block": None,
        "axes": [{"name": "X", "mm": 1.5}, {"name": "X2", "mm": 10.25}],
        "io": {"probe": True},
        "plcs": [],
        "notes": ["one", "two"],
        "mixed": [{"a": 1}, {"b": 2}],
    }
    assert list(tables.tree(state)) == [
        "mode: automatic",
        "block: -",
        "axes:",
        "  name  mm",
        "  X     1.5",
        "  X2    10.25",
        "io:",
        "  probe: TRUE",
        "plcs: none",
        "notes:",
        "  one",
        "  two",
        "mixed:",
        "  a: 1",
        "  b: 2",
    ]
