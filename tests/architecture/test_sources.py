"""Habits that no linter knows: where object addresses may stand, what no tracked file may hold."""

import re
import subprocess
import sys
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

OBJECT_ADDRESS = re.compile(r"0x6[0-7][0-9a-f]{2}", re.IGNORECASE)
MAY_HOLD_OBJECT_ADDRESSES = ("drives", "hli_bench/protocols/canopen")
SOURCES = sorted(
    file for folder in ("hli_bench", "drives", "plc_scripts") for file in (ROOT / folder).rglob("*.py")
)

HOMES = re.compile(r"(?<![\w.-])(/home/[a-z]|/Users/[A-Za-z]|[A-Z]:\\Users\\)")


def _numbers(file: Path) -> list[str]:
    """The number literals of a Python file; comments and texts may name an object as they like."""
    with file.open("rb") as source:
        return [token.string for token in tokenize.tokenize(source.readline) if token.type == tokenize.NUMBER]


def _tracked() -> list[Path]:
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def _places_of_this_computer() -> list[str]:
    """Where this checkout, its user and its interpreter live; a path of one part would match too much."""
    places = [ROOT, Path.home(), Path(sys.base_prefix)]
    return [f"{place}/" for place in places if len(place.parts) > 2 and not str(place).startswith("/usr")]


def test_object_addresses_stand_with_the_drives_only() -> None:
    strays = {
        f"{file.relative_to(ROOT)}: {number}"
        for file in SOURCES
        if not str(file.relative_to(ROOT)).startswith(MAY_HOLD_OBJECT_ADDRESSES)
        for number in _numbers(file)
        if OBJECT_ADDRESS.fullmatch(number)
    }
    assert not strays


@pytest.mark.parametrize("number", ["0x6041", "0x607a", "0x60B8"])
def test_the_pattern_knows_an_object_address(number: str) -> None:
    assert OBJECT_ADDRESS.fullmatch(number)


@pytest.mark.parametrize("number", ["0x600", "0x0800", "6041", "0x1018"])
def test_the_pattern_leaves_identifiers_and_registers_alone(number: str) -> None:
    assert not OBJECT_ADDRESS.fullmatch(number)


def test_no_tracked_file_names_a_place_on_somebodys_computer() -> None:
    places = _places_of_this_computer()
    strays: list[str] = []
    for file in _tracked():
        text = file.read_text(encoding="utf-8", errors="replace")
        if file != Path(__file__).resolve() and (
            HOMES.search(text) or any(place in text for place in places)
        ):
            strays.append(str(file.relative_to(ROOT)))
    assert not strays
