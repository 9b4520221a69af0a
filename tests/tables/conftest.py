"""Every parameter sheet against what the public books print, column by column (`books.csv`).

The books are TF5200 axis parameters 1.172 and channel parameters 1.33. An empty cell: the book prints nothing there
that can be compared. `MIN` and `MAX` are those of the data type, and a bound that the books exclude counts as the
bound itself: they print `<` and `<=` for the same ranges.
"""

import csv
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import catalogue
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.sheet import LIMITS, DataType, Entry

TABLE = Path(__file__).with_name("books.csv").read_text(encoding="utf-8")
ROWS = {row["number"]: row for row in csv.DictReader(TABLE.splitlines(), delimiter=";")}
SHEETS = {
    **catalogue(AxisParams).by_number,
    **catalogue(ChannelParams).by_number,
}
OURS = {
    ("P-AXIS-00112", "drives"): "the parameters of the simulation belong to drive type Simulation",
    ("P-AXIS-00112", "low"): "0: no simulated event, as kernelv has it",
    ("P-AXIS-00425", "low"): "-1, the default, means no bit",
    ("P-AXIS-00286", "low"): "a ramp time that is too small is replaced, as its text says",
    ("P-AXIS-00344", "unit R"): "a length of a rotary axis is in 0.0001 degrees",
    ("P-AXIS-00345", "unit R"): "a length of a rotary axis is in 0.0001 degrees",
    ("P-AXIS-00348", "unit R"): "a length of a rotary axis is in 0.0001 degrees",
    ("P-AXIS-00349", "unit R"): "a length of a rotary axis is in 0.0001 degrees",
    ("P-AXIS-00354", "unit R"): "a length of a rotary axis is in 0.0001 degrees",
    ("P-AXIS-00399", "words"): "examples of the manuals use UNS16 and UNS32",
    ("P-AXIS-00401", "words"): "the measurement manual's example uses LINEAR",
    ("P-AXIS-00412", "key"): "the key printed belongs to P-AXIS-00416; the range names this one",
    ("P-AXIS-00771", "low"): "negative means not set",
    ("P-AXIS-00772", "high"): "above 1000 is kept with a warning (measurement manual 8.2.2)",
    ("P-AXIS-00777", "high"): "above 1000 is kept with a warning (measurement manual 8.2.2)",
}
"""Cells in which the bench keeps something else, and why."""


def printed(entry: Entry) -> dict[str, str]:
    """Return a sheet in the words of `books.csv`."""
    sheet = entry.sheet
    plain = [one + 0 if isinstance(one, int) else str(one) for one in sheet.choices if one != ""]
    return {
        "key": entry.path,
        "type": str(sheet.data_type),
        "low": bound_text(entry, "MIN" if sheet.low is None else str(sheet.low)),
        "high": bound_text(entry, "MAX" if sheet.high is None else str(sheet.high)),
        "default": value_text(entry, entry.default),
        "axes": sheet.axis_types,
        "unit T": sheet.units.t if "T" in sheet.axis_types else "",
        "unit R": sheet.units.r if "R" in sheet.axis_types else "",
        "drives": " ".join(sorted([*(one.name for one in sheet.drive_types), *sheet.other_drives.split()])),
        "words": " ".join(sorted(map(str, plain))),
    }


def bound_text(entry: Entry, text: str) -> str:
    """Return a bound with the limits of the data type as numbers."""
    low, high = LIMITS.get(entry.sheet.data_type, ("MIN", "MAX"))
    return {"MIN": str(low), "MAX": str(high)}.get(text, text)


def value_text(entry: Entry, value: object) -> str:
    """Return a default as text that compares: `0` and `0.0` are the same real number."""
    if entry.sheet.data_type is DataType.REAL64:
        return str(float(str(value)))
    return str(int(value)) if isinstance(value, int) else str(value)


def expected(number: str, entry: Entry) -> Iterator[tuple[str, str]]:
    """Yield the cells of a row that can be compared."""
    row = ROWS[number]
    for column in ("key", "type"):
        yield column, row[column]
    if number.startswith("P-AXIS"):
        yield "axes", row["axes"]
        yield "unit T", row["unit T"] if "T" in row["axes"] else ""
        yield "unit R", row["unit R"]
        yield "drives", " ".join(sorted(row["drives"].split()))
    elif row["unit T"]:
        yield "unit T", row["unit T"]
    for column in ("low", "high"):
        if row[column] and not entry.sheet.choices:
            yield column, bound_text(entry, row[column])
    if row["default"]:
        yield "default", value_text(entry, row["default"])
    if row["words"] and (entry.sheet.choices or not row["words"].replace(" ", "").isdigit()):
        yield "words", " ".join(sorted(row["words"].split()))


def differences(number: str) -> list[str]:
    """Return the cells in which a sheet differs from the books, without those that are ours."""
    entry = SHEETS[number]
    ours = printed(entry)
    return [
        f"{column}: {ours[column]!r}, the books print {text!r}"
        for column, text in expected(number, entry)
        if ours[column] != text and (number, column) not in OURS
    ]


@pytest.fixture
def books() -> SimpleNamespace:
    """Return the comparison of sheets with the books."""
    return SimpleNamespace(
        rows=ROWS, sheets=SHEETS, ours=OURS, differences=differences, printed=printed, expected=expected
    )
