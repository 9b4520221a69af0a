"""Error sheets: numbers in the range of their stage, classes that the diagnosis pages print."""

import csv
from pathlib import Path

import pytest

from hli_bench.manual import errors
from hli_bench.manual.errors import ErrorSheet, Severity, by_number
from hli_bench.manual.errors.record import NOT_IN_BOOK, SYSTEM

ALL = [
    pytest.param(module, name, sheet, id=str(sheet.number))
    for module in errors.RANGES
    for name, sheet in errors.sheets(module)
]

# number, reaction class, remedy class
CLASSES = [
    (20138, 2, 3),
    (50050, 4, 6),
    (50052, 4, 6),
    (50059, 4, 6),
    (50061, 4, 6),
    (70541, 7, 6),
    (70689, 7, 3),
    (21964, 2, 3),
    (21968, 2, 3),
    (110586, 1, 1),
]


@pytest.mark.parametrize(("module", "name", "sheet"), ALL)
def test_sheet(module: object, name: str, sheet: ErrorSheet) -> None:
    assert sheet.number in errors.RANGES[module]  # type: ignore[index]
    assert sheet.name == name.lower()
    assert by_number()[sheet.number] is sheet
    filled = sheet.message([f"<{index}>" for index in range(len(sheet.names))])
    assert len(set(sheet.names)) == len(sheet.names)
    assert "{" not in filled
    assert (sheet.severity is Severity.WARNING) == (sheet.reaction_class == 1)


def test_numbers_are_unique() -> None:
    numbers = [sheet.number for module in errors.RANGES for _, sheet in errors.sheets(module)]
    assert len(numbers) == len(set(numbers))


@pytest.mark.parametrize(("number", "reaction", "remedy"), CLASSES)
def test_printed_classes(number: int, reaction: int, remedy: int) -> None:
    sheet = by_number()[number]
    assert (sheet.reaction_class, sheet.remedy_class) == (reaction, remedy)


def test_missing_values_are_visible() -> None:
    assert by_number()[50059].message([3]) == "axis 3 is not a measurement axis (P-AXIS-00118)"
    assert by_number()[50059].message() == "axis ? is not a measurement axis (P-AXIS-00118)"


# -- against the public diagnosis book (TF5200 diagnosis 1.251) ----------------------------------------

BOOK = {
    int(row["number"]): row
    for row in csv.DictReader(
        Path(__file__).with_name("diagnosis.csv").read_text(encoding="utf-8").splitlines(), delimiter=";"
    )
}
OURS = {
    51026: "the measurement manual ends the program with it; the book prints a warning",
    70222: "class 0 is 'controlled or abrupt'",
}
"""Messages whose class is another one here."""


@pytest.mark.parametrize("number", sorted(BOOK))
def test_class_and_number_of_values_are_those_of_the_book(number: int) -> None:
    sheet, row = by_number()[number], BOOK[number]
    assert len(sheet.values) == int(row["values"])
    if row["reaction"] and number not in OURS:
        assert sheet.reaction_class == int(row["reaction"])
        assert sheet.remedy_class == int(row["remedy"])


def test_what_the_book_does_not_have_says_so() -> None:
    for number in by_number().keys() - BOOK.keys():
        assert by_number()[number].source in (NOT_IN_BOOK, SYSTEM), number


def test_values_that_are_known_need_not_be_handed_over() -> None:
    sheet = by_number()[70020]
    known = {"drive type": 8, "block number": "N10"}
    assert list(sheet.named([3, 20001, 20000], known).values()) == [3, 8, 20001, 20000, "N10"]
    assert list(sheet.named([3, 8, 20001, 20000, "N11"], known).values()) == [3, 8, 20001, 20000, "N11"]
    assert (
        sheet.message_of(sheet.named([3, 20001, 20000], known))
        == "position lag of axis 3 is 20001, allowed 20000"
    )
