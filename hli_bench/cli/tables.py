"""Aligned columns and HLI values as the commands print them."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any


def lines(rows: Iterable[Sequence[object]]) -> Iterator[str]:
    """Yield rows as lines with aligned columns, two blanks between them."""
    texts = [[str(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*texts, strict=True)]
    for row in texts:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def value(item: object) -> str:
    """Return one value as `hli set` would take it: TRUE, FALSE, numbers, text."""
    if isinstance(item, bool):
        return "TRUE" if item else "FALSE"
    return str(item)


def tree(item: Any, indent: str = "") -> Iterator[str]:
    """Yield nested mappings and lists of records: a line a value, a table a list of equal records."""
    if isinstance(item, Mapping):
        for key, inner in item.items():
            if _is_leaf(inner):
                yield f"{indent}{key}: {_leaf(inner)}"
            elif inner:
                yield f"{indent}{key}:"
                yield from tree(inner, indent + "  ")
            else:
                yield f"{indent}{key}: none"
    elif _is_table(item):
        heads = list(item[0])
        rows = ([_leaf(row[head]) for head in heads] for row in item)
        yield from (indent + line for line in lines([heads, *rows]))
    elif isinstance(item, Sequence) and not isinstance(item, str):
        for inner in item:
            yield from tree(inner, indent) if not _is_leaf(inner) else [indent + _leaf(inner)]
    else:
        yield indent + _leaf(item)


def _is_leaf(item: object) -> bool:
    return item is None or isinstance(item, str | int | float)


def _leaf(item: object) -> str:
    return "-" if item is None or item == "" else value(item)


def _is_table(item: object) -> bool:
    """Tell whether this is a list of records with the same keys and plain values."""
    if not isinstance(item, Sequence) or isinstance(item, str) or not item:
        return False
    if not all(isinstance(row, Mapping) for row in item):
        return False
    return all(list(row) == list(item[0]) and all(map(_is_leaf, row.values())) for row in item)
