"""Error sheets: numbers in the range of their stage, classes that the diagnosis pages print."""

import pytest

from hli_bench.manual import errors
from hli_bench.manual.errors import ErrorSheet, Severity, by_number

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
    filled = sheet.message([f"<{index}>" for index in range(len(sheet.values))])
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
