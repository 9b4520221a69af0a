"""Every folder of tests/nc decodes to the items it expects."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

CASES = Path(__file__).parents[3] / "nc"
FOLDERS = sorted(folder for folder in CASES.iterdir() if folder.is_dir())
REQUIREMENTS = {
    "continuation": ("M-013",),
    "meas_fixed_stop": ("M-169",),
    "meas_run": ("M-011",),
    "meas_mode": ("M-032", "M-033"),
    "meas_run_cs": ("M-047", "M-048"),
    "meas_run_standard": ("M-041", "M-042"),
    "meas1": tuple(f"M-{number:03}" for number in (52, 55, 63, 65, 68, 70, 71, 73, *range(75, 84))),
    "meas2": tuple(f"M-{number:03}" for number in range(84, 91)),
    "meas3": tuple(f"M-{number:03}" for number in (69, 72, *range(91, 98))),
    "meas4": tuple(f"M-{number:03}" for number in range(98, 106)),
}


def case(folder: Path) -> object:
    marks = [pytest.mark.req(*REQUIREMENTS[folder.name])] if folder.name in REQUIREMENTS else []
    return pytest.param(folder, id=folder.name, marks=marks)


@pytest.mark.parametrize("folder", [case(folder) for folder in FOLDERS])
def test_case(folder: Path, decode: Any, state: Any) -> None:
    script = folder / "answers.json"
    answers = [state(**answer) for answer in json.loads(script.read_text())] if script.exists() else []
    with (folder / "program.nc").open() as program:
        items = decode(program, answers)
    got = [repr(item) for item in items]
    expected = folder / "expected.blocks"
    if os.environ.get("HLI_BENCH_WRITE_GOLDEN"):
        expected.write_text("\n".join(got) + "\n")
    assert got == expected.read_text().splitlines()
