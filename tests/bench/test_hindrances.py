"""A PLC that holds motion, or whose commands count for nothing, is spoken of: a run would stand in silence."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.bench.result import Result

RELEASE = "ax/1/lr_mc_control/release_feedhold"
FEEDHOLD = "ch/1/bahn_mc_control/feedhold"
WRITES = """
from hli_bench.plc import Plc

class Writes(Plc):
    period_us = 100_000

    def start(self, hli, io):
        self.cycles = 0

    def cycle(self, hli, io):
        self.cycles += 1
        for path, value in {writes}.items():
            area, number, *parts, member = path.split("/")
            element = getattr(hli, area)[int(number)]
            for part in parts:
                element = getattr(element, part)
            setattr(element, member, value(self.cycles) if callable(value) else value)
"""

OVERRIDE_0 = repr(
    {
        "ch/1/head/plc_present_w": True,
        "ch/1/bahn_mc_control/override/enable_w": True,
    }
)

Run = Callable[..., tuple[Result, list[str]]]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Return what runs a program with a PLC that writes so in every cycle; gives result and notes."""

    def run(writes: str, program: str, settings: Mapping[str, Any] | None = None) -> tuple[Result, list[str]]:
        script, notes = tmp_path / "writes.py", list[str]()
        script.write_text(WRITES.replace("{writes}", writes))
        with Bench("demo", settings, plc=[script], on_note=notes.append) as bench:
            return bench.run(program, limit_s=35.0), notes

    return run


def held(unit: str, command: object, present: str = "ax/1") -> str:
    return repr(
        {f"{present}/head/plc_present_w": True, f"{unit}/enable_w": True, f"{unit}/command_w": command}
    )


@pytest.mark.parametrize(
    ("writes", "reason"),
    [
        (held(RELEASE, False), f"{RELEASE} is FALSE"),
        (held("ax/1/ipo_mc_control/feedhold", True), "ax/1/ipo_mc_control/feedhold is TRUE"),
        (held(FEEDHOLD, True, "ch/1"), f"{FEEDHOLD} is TRUE"),
        (
            OVERRIDE_0,
            "ch/1/bahn_mc_control/override_feedrate is 0",
        ),
    ],
)
def test_what_holds_the_path_is_named_once_a_block_and_in_the_result(
    run: Run, writes: str, reason: str
) -> None:
    result, notes = run(writes, "N10 G01 X1 Y1 F600\nN20 M30\n")
    assert (result.status, result.sim_s) == ("aborted", 35.0)
    assert notes == [f"N10 stands for 10 s and more: {reason}"]
    assert result.notes == (f"motion was held: {reason}",)


def test_what_holds_homing_is_named(run: Run) -> None:
    result, notes = run(held(RELEASE, False), "N10 G74 X1\nN20 M30\n")
    assert notes == [f"N10 stands for 10 s and more: {RELEASE} is FALSE"]
    assert result.notes == (f"motion was held: {RELEASE} is FALSE",)


def test_an_axis_that_does_not_move_holds_nothing(run: Run) -> None:
    result, notes = run(held(RELEASE, False), "N10 G01 Y10 F20\nN20 M30\n")
    assert (result.status, notes, result.notes) == ("completed", [], ())


def test_a_hold_that_ends_is_no_remark(run: Run) -> None:
    writes = held(RELEASE, 0).replace("_w': 0", "_w': lambda cycles: cycles > 80")
    result, notes = run(writes, "N10 G01 X1 F600\nN20 M30\n")
    assert (result.status, notes, result.notes) == ("completed", [], ())
    assert result.sim_s > 8


def test_commands_without_a_present_plc_are_named(run: Run) -> None:
    result, notes = run(f"{{'{RELEASE}/enable_w': True}}", "N10 G04 0.5\nN20 M30\n")
    assert (result.status, notes) == ("completed", [])
    assert result.notes == (f"enabled in vain: {RELEASE}: ax/1/head/plc_present_w is FALSE",)
