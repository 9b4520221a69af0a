"""Every parameter sheet against what the public books print, column by column (`books.csv`, `conftest.py`)."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from hli_bench.manual.catalogue import convert

TABLE = Path(__file__).with_name("books.csv").read_text(encoding="utf-8").splitlines()
NUMBERS = [line.partition(";")[0] for line in TABLE[1:]]


@pytest.mark.parametrize("number", NUMBERS)
def test_a_sheet_is_that_of_the_books(books: SimpleNamespace, number: str) -> None:
    assert books.differences(number) == []


def test_what_is_ours_differs(books: SimpleNamespace) -> None:
    for number, column in books.ours:
        entry = books.sheets[number]
        assert books.printed(entry)[column] != dict(books.expected(number, entry))[column]


@pytest.mark.parametrize("number", NUMBERS)
def test_the_words_of_the_books_are_permitted(books: SimpleNamespace, number: str) -> None:
    entry = books.sheets[number]
    for word in books.rows[number]["words"].split():
        convert(entry, entry.path, word)


def test_every_parameter_with_a_number_is_compared(books: SimpleNamespace) -> None:
    assert books.rows.keys() == books.sheets.keys()
