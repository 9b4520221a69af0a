"""PLCs that do not keep their period in real pace: counted, told, and not obeyed when they answer to long ago."""

import json
import struct
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.bench.plc_ports import ANSWER_S, AttachedPlc
from hli_bench.cli.main import main
from hli_bench.shells.plc_times import KEPT, TOLD_FROM, PlcBook, PlcTimes
from hli_bench.shells.trace_file import read
from hli_bench.shells.zenoh_session import connect
from hli_bench.wire.hli import Commands

MS = 1_000_000
SLOW = """
import time

class Plc:
    period_us = 2000

    def cycle(self, hli, io):
        time.sleep(0.02)
"""
DWELL = "N10 G04 0.3\nN20 M30\n"


@pytest.fixture
def slow(tmp_path: Path) -> Path:
    """A PLC that needs ten times its period."""
    path = tmp_path / "slow.py"
    path.write_text(SLOW)
    return path


def test_times_and_overruns_are_counted_by_program_and_in_all() -> None:
    now = [0]
    book = PlcBook()
    times = book.enter("p", 2 * MS)
    times._clock = lambda: now[0]
    for took in (1 * MS, 3 * MS, 2 * MS):
        times.begin()
        now[0] += took
        assert times.ended() == (took > 2 * MS)
    assert book.rows() == [
        {
            "name": "p",
            "period_us": 2000,
            "runs": 3,
            "overruns": 1,
            "min_us": 1000.0,
            "mean_us": 2000.0,
            "max_us": 3000.0,
        }
    ]
    assert list(book.remarks()) == []
    book.begin(["p"])
    assert book.rows()[0]["runs"] == 0
    for _ in range(TOLD_FROM):
        times.begin()
        now[0] += 20 * MS
        assert times.ended()
    assert list(book.remarks()) == [
        f"PLC p: {TOLD_FROM} overruns of its period of 2 ms in {TOLD_FROM} runs, 20.0 ms at worst"
    ]
    assert (times.whole.runs, times.whole.overruns, times.whole.least_ns) == (
        3 + TOLD_FROM,
        1 + TOLD_FROM,
        MS,
    )
    book.begin([])
    assert book.rows() == []


def test_names_under_which_clients_come_are_not_gathered() -> None:
    book = PlcBook()
    for number in range(3 * KEPT):
        book.enter(f"p{number}", MS)
    assert len(book.rows()) == KEPT


def attached(
    answers: dict[int, int | None], period: int = 1
) -> tuple[AttachedPlc, PlcTimes, list[int], list[int]]:
    """A PLC that answers in cycle `c` to cycle `answers[c]`; overruns and the oldest answers that counted."""
    overran: list[int] = []
    oldest: list[int] = []
    times = PlcTimes("p", period * MS)

    def latest(plc: str, cycle: int, least: int) -> Commands | None:
        oldest.append(least)
        answered = answers.get(cycle)
        return None if answered is None or answered < least else Commands(plc, answered, ())

    port = AttachedPlc(
        "p",
        period,
        SimpleNamespace(latest_commands=latest, commands=None),
        lambda *_: None,
        lockstep=False,
        cycle_ns=MS,
        times=times,
        on_overrun=lambda _, cycle: overran.append(cycle),
    )
    return port, times, overran, oldest


def step(port: AttachedPlc, cycles: range) -> list[Any]:
    return [port.tick(cycle, 0, bytearray(), {}) for cycle in cycles]  # type: ignore[arg-type]


def test_an_image_that_is_not_answered_before_the_next_is_an_overrun() -> None:
    port, times, overran, _ = attached({2: 1, 3: 2, 4: None, 5: 3, 6: 5})
    step(port, range(1, 7))
    assert overran == [3, 4]
    assert (times.whole.runs, times.whole.overruns) == (5, 2)


def test_a_plc_that_has_not_answered_yet_is_starting_and_has_no_overruns() -> None:
    port, times, overran, _ = attached({})
    step(port, range(1, 500))
    assert overran == []
    assert times.whole.runs == 0
    assert port.patience_s == ANSWER_S


@pytest.mark.parametrize(("period", "lapse"), [(1, 100), (50, 500)])
def test_an_answer_to_long_ago_counts_for_nothing(period: int, lapse: int) -> None:
    port, _, _, oldest = attached({1000: 2}, period)
    step(port, range(1000, 1002))
    assert oldest == [0, 1001 - lapse], "however long its start took, what it answers first counts"


def test_a_plc_that_only_answers_to_long_ago_is_silent() -> None:
    port, _, overran, _ = attached({10: 9, **{cycle: cycle - 200 for cycle in range(300, 2000)}})
    answers = step(port, range(1, 1500))
    assert None in answers
    assert overran


def test_a_script_of_20_ms_in_a_task_of_2_ms_shows_everywhere(slow: Path, tmp_path: Path) -> None:
    program, result = tmp_path / "p.nc", tmp_path / "r.json"
    trace, report = tmp_path / "t.mcap", tmp_path / "r.html"
    program.write_text(DWELL)
    outputs = ("--result", str(result), "--trace", str(trace), "--report", str(report))
    assert main(["run", str(program), "--plc", str(slow), "--pace", "real", *outputs]) == 0
    (plc,) = json.loads(result.read_text())["plcs"]
    assert plc["name"] == "slow"
    assert plc["overruns"] >= plc["runs"] - 1 >= TOLD_FROM
    assert plc["min_us"] >= 20_000
    topics = [entry.topic for entry in read(trace) if hasattr(entry, "topic")]
    assert topics.count("overruns") >= plc["overruns"]
    assert f'<td class="n">{plc["overruns"]}</td>' in report.read_text()


def test_overruns_stand_in_the_state_and_are_told_once(slow: Path) -> None:
    lines: list[str] = []
    with Bench("demo", plc=[slow], pace="real", on_note=lines.append) as bench:
        first = bench.run(DWELL)
        second = bench.run(DWELL)
        (plc,) = bench.state()["plcs"]
    assert plc["overruns"] >= first.plcs[0]["overruns"] + second.plcs[0]["overruns"]
    assert first.plcs[0]["overruns"] == first.plcs[0]["runs"]
    assert any("PLC slow:" in note and "overruns of its period of 2 ms" in note for note in second.notes)
    assert len([line for line in lines if "PLC slow does not keep its period" in line]) == 1


def test_time_in_lock_step_waits_so_that_there_are_no_overruns(slow: Path) -> None:
    with Bench("demo", plc=[slow]) as bench:
        result = bench.run("N10 G04 0.02\nN20 M30\n")
        assert bench.state()["plcs"] == [{"name": "slow", "period_cycles": 2}]
    assert "plcs" not in result.to_dict()


def test_an_attached_plc_of_20_ms_in_a_task_of_2_ms_has_overruns(
    serve: Callable[..., Any], slow: Path
) -> None:
    bench = serve("--plc", "none", "--pace", "real")
    bench.plc(slow)
    bench.settled(lambda state: state["plcs"] and state["plcs"][0]["overruns"] > 20)
    (plc,) = bench.state()["plcs"]
    assert plc["overruns"] > plc["runs"] // 2
    assert plc["mean_us"] is None


def test_answers_of_a_plc_that_lags_are_refused_and_told(serve: Callable[..., Any]) -> None:
    bench = serve("--plc", "none", "--pace", "real")
    with connect(bench.endpoint) as session, bench.client() as client:
        token = session.liveliness().declare_token("demo/plc/late/alive")
        first = json.loads(client.ask_packed("plc/late/attach", '{"period_us": 1000}'))["cycle"]
        bench.settled(lambda state: state["cycle"] > first + 500)
        session.put("demo/plc/late/commands", struct.pack("<Q", bench.state()["cycle"]))
        bench.settled(lambda state: state["plcs"][0]["runs"] > 0)
        unit = "ax/3/lr_mc_control/timestamp/enable_w"
        write = struct.pack("<H?", client.layout.element(unit).id, True)
        session.put("demo/plc/late/commands", struct.pack("<Q", first) + write)
        bench.settled(lambda _: client.hli_errors()["refused"])
        last = client.hli_errors()["last"][-1]
        assert last["path"] == "plc/late/commands"
        assert "too old to count" in last["reason"]
        assert client.get(unit) is False
        # A PLC sends changes: what it wrote in vain counts with the next answer that is in time.
        session.put("demo/plc/late/commands", struct.pack("<Q", bench.state()["cycle"]))
        bench.settled(lambda _: client.get(unit))
        token.undeclare()
