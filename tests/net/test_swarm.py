"""A fixed hundred seeds of the swarm; its checks do find what they look for; what fails is made small."""

import dataclasses
from pathlib import Path

import pytest
from net.grammar import Block
from net.invariants import CHECKS, findings
from net.machines import Machine
from net.outside import Act
from net.sameness import performed, same_behind, same_steps
from net.scenario import Scenario, Step, scenario
from net.shrinking import shrunk
from net.swarming import found_by, found_in
from net.trial import by_cycles, trial

SEEDS = 100
PARTS = 10
"""Tests that the seeds are spread over, so that workers share them."""
STARTS = {"X": 0.0, "Y": 0.0, "Z": 60.0}
SETTINGS = {f"axis.{axis}.start_mm": start for axis, start in STARTS.items()} | {
    "plant.probe.Z.face_mm": 40.0,
    "plant.probe.Z.material": "below",
}


def one(*blocks: str, axes: str = "XYZ", acts: tuple[Act, ...] = (), **settings: object) -> Scenario:
    """Return a scenario of one program on the machine demo."""
    machine = Machine("demo", SETTINGS | settings, ("X", "Y", "Z"), STARTS)
    step = Step(tuple(Block(text, frozenset(axes)) for text in (*blocks, "M30")), acts)
    return Scenario(1, machine, (("good", 1000),), (step,))


@pytest.mark.parametrize("part", range(PARTS))
def test_a_fixed_hundred_seeds_hold(part: int) -> None:
    found = {seed: [str(each) for each in found_in(seed)] for seed in range(part, SEEDS, PARTS)}
    assert {seed: each for seed, each in found.items() if each} == {}


def test_a_seed_gives_the_same_scenario_each_time_and_others_give_others() -> None:
    assert scenario(7) == scenario(7)
    assert len({scenario(seed).text() for seed in range(50)}) == 50


def test_the_seeds_do_all_that_the_bench_can() -> None:
    """What the net does not bring about it cannot find."""
    text = "\n".join(scenario(seed).text() for seed in range(200))
    words = (
        "G00",
        "G01",
        "G74",
        "G100",
        "G101",
        "G102",
        "G92",
        "G91",
        "G04",
        "#CS ON",
        "#MEAS",
        "#DRIVE",
        "#MSG",
    )
    words += (
        "$IF",
        "$WHILE",
        "$FOR",
        "interrupt@",
        "reset@",
        "put@",
        "M02",
        "NONSENSE",
        "probe_stuck",
        "plant.stop",
    )
    words += (
        "restless",
        "silent",
        "fails",
        "flicker",
        "three_axes",
        "eight_axes",
        "cycle_us",
        "abs_pos_gueltig",
    )
    assert [word for word in words if word not in text] == []


def test_a_plain_scenario_has_no_finding() -> None:
    plain = one("G90 G01 Z55 F9000", "G100 Z35 F2000", "G01 Z60 X5 F9000", "X0")
    assert found_by(plain, single=True) == []


def check_of(name: str, changed) -> list[str]:
    """Perform a plain scenario, let `changed` falsify what was seen, and return what a check finds then."""
    with trial(one("G90 G01 Z55 F9000", "G100 Z35 F2000", "G01 Z60 X5 F9000", axes="XZ")) as found:
        assert findings(found) == []
        changed(found, found.log)
        return list(CHECKS[name](found))


def test_an_axis_that_moves_without_an_order_is_found() -> None:
    def changed(found, log) -> None:
        log["position"][found.spans[0].first + 5, 1] += 100_000

    assert check_of("no axis moves that nobody ordered", changed)[0].startswith("Y moves ")


def test_an_axis_that_moves_in_an_idle_bench_is_found() -> None:
    def changed(found, log) -> None:
        log["position"][found.rests[1].first + 5, 0] += 100_000

    assert check_of("an idle bench stands", changed)[0].startswith("X moves ")


def test_a_set_point_beyond_a_limit_is_found() -> None:
    def changed(found, log) -> None:
        log["command"][found.spans[0].first + 5, 0] = 1e9

    assert "X is at" in check_of("referenced axes stay within their software limits", changed)[0]


def test_motion_under_an_acknowledged_hold_is_found() -> None:
    def changed(found, log) -> None:
        first = found.spans[0].first
        found.recording.events["hli"].append((first - 5000, "ch/1/bahn_mc_control/feedhold/state_r", "True"))

    assert "moves in cycle" in check_of("an acknowledged hold holds", changed)[0]


def test_a_value_that_is_not_the_face_is_found() -> None:
    def changed(found, log) -> None:
        for value in found.spans[0].result["measurements"]:
            value["acs_mm"] += 0.02

    assert "the face is 40" in check_of("a measured value is the face", changed)[0]


@pytest.mark.parametrize(
    ("name", "outcome", "errors"),
    [
        ("completed is completed", "completed", [{"id": 1, "severity": "error"}]),
        ("completed is completed", "error", []),
        ("every program ends, or the bench says what holds it", "aborted", []),
        ("an error names file and line", "refused: InputError: something", []),
    ],
)
def test_an_end_that_is_not_what_it_says_is_found(name: str, outcome: str, errors: list) -> None:
    def changed(found, log) -> None:
        found.spans[0].outcome = outcome
        found.spans[0].result["errors"] = errors

    assert len(check_of(name, changed)) == 1


def test_a_bench_that_gives_other_bits_by_single_cycles_is_found() -> None:
    plain = one("G90 G01 X5 F9000")
    with trial(plain) as found:
        strides = performed(found)
    strides.log["command"][100, 0] += 1.0
    (finding,) = same_steps(plain, strides)
    assert "cycle 101 (0.101 s), axes: X command" in str(finding)


def test_what_a_bench_has_kept_is_found_by_the_reference_program() -> None:
    with trial(one("G90 G01 X5 F9000")) as found:
        assert list(same_behind(found)) == []
        found.bench.kernel.rows.path[0]["override"] = 0.5
        (finding,) = same_behind(found)
    assert "reference program" in str(finding)


def test_a_crash_is_a_finding_and_not_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    import hli_bench.kernel.channel as channel

    monkeypatch.setattr(channel.Channel, "_hand_out_texts", lambda _: 1 / 0)
    assert "ZeroDivisionError" in str(found_by(one("G04 0.1"))[0])


def test_what_fails_is_made_small() -> None:
    acts = (Act("reset", 500.0), Act("put", 1.0, "ch/1/head/plc_present_w", 1))
    large = one("G90 G01 X5 F9000", "G04 0.1\nG04 0.2", "Y7", "G00 Z58", acts=acts)
    large = dataclasses.replace(large, steps=(large.steps[0],) * 3)
    small = shrunk(
        large, lambda each: any("Y7" in block.text for step in each.steps for block in step.blocks)
    )
    assert len(small.steps) == 1
    assert [block.text for block in small.steps[0].blocks] == ["Y7"]
    assert small.steps[0].acts == ()
    assert small.machine.settings == {}


def test_acts_come_at_their_cycle_however_the_bench_is_stepped() -> None:
    acts = (Act("put", 100.0, "ch/1/head/plc_present_w", 1), Act("reset", 250.0))
    seen = []
    for way in (None, by_cycles):
        with trial(one("G90 G01 X50 F6000", acts=acts), *([way] if way else [])) as found:
            writes = [cycle for cycle, name, _ in found.recording.events["plc"] if name.startswith(": ")]
            seen.append((found.spans[0].first + 100 in writes, found.spans[0].last - found.spans[0].first))
    assert seen[0] == seen[1]
    assert seen[0][0]


def test_tool_ends_with_what_it_found(capsys: pytest.CaptureFixture[str]) -> None:
    import swarm

    assert swarm.main(["--seeds", "6:7"]) == 0
    assert capsys.readouterr().out == "1 seeds from 6 on, 0 findings\n"
    assert Path(swarm.__file__).name == "swarm.py"
