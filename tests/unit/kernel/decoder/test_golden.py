"""Every folder of tests/nc decodes to the items it expects."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

CASES = Path(__file__).parents[3] / "nc"
FOLDERS = [
    pytest.param("continuation", marks=pytest.mark.req("M-013")),
    "control",
    pytest.param("drive", marks=pytest.mark.req("F-055")),
    "homing",
    pytest.param(
        "meas1",
        marks=pytest.mark.req(
            "M-052",
            "M-055",
            "M-063",
            "M-065",
            "M-068",
            "M-070",
            "M-071",
            "M-073",
            "M-075",
            "M-076",
            "M-077",
            "M-078",
            "M-079",
            "M-080",
            "M-081",
            "M-082",
            "M-083",
        ),
    ),
    pytest.param(
        "meas2", marks=pytest.mark.req("M-084", "M-085", "M-086", "M-087", "M-088", "M-089", "M-090")
    ),
    pytest.param(
        "meas3",
        marks=pytest.mark.req(
            "M-069", "M-072", "M-091", "M-092", "M-093", "M-094", "M-095", "M-096", "M-097"
        ),
    ),
    pytest.param(
        "meas4",
        marks=pytest.mark.req("M-098", "M-099", "M-100", "M-101", "M-102", "M-103", "M-104", "M-105"),
    ),
    pytest.param("meas_fixed_stop", marks=pytest.mark.req("M-169")),
    pytest.param("meas_mode", marks=pytest.mark.req("M-032", "M-033", "E-005")),
    "meas_run",
    pytest.param("meas_run_cs", marks=pytest.mark.req("M-047", "M-048")),
    pytest.param("meas_run_standard", marks=pytest.mark.req("M-041", "M-042")),
    pytest.param("meas_settings", marks=pytest.mark.req("E-024", "E-033", "E-042")),
    "offsets",
]


def test_every_folder_is_a_case() -> None:
    named = {case if isinstance(case, str) else case.values[0] for case in FOLDERS}
    assert named == {folder.name for folder in CASES.iterdir() if folder.is_dir()}


@pytest.mark.parametrize("name", FOLDERS)
def test_case(name: str, decode: Any, state: Any) -> None:
    folder = CASES / name
    script = folder / "answers.json"
    answers = [state(**answer) for answer in json.loads(script.read_text())] if script.exists() else []
    with (folder / "program.nc").open() as program:
        items = decode(program, answers)
    got = [repr(item) for item in items]
    expected = folder / "expected.blocks"
    if os.environ.get("HLI_BENCH_WRITE_GOLDEN"):
        expected.write_text("\n".join(got) + "\n")
        pytest.fail(f"{expected} is written; a run that writes its expectations shows nothing")
    assert got == expected.read_text().splitlines()
