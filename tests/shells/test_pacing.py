"""Real pace on a clock that the test moves: deadlines, late cycles, gaps for the collector; and where it is told."""

import gc
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.base.errors import InputError
from hli_bench.cli.main import main
from hli_bench.shells.pacing import BINS, LEAST_SPIN_NS, MOST_SPIN_NS, Lateness, RealPace
from hli_bench.shells.realtime import FIRST_GAP_NS, SHARE, YOUNG, Garbage, ask, frozen_garbage

CYCLE = 1_000_000
QUIET = {"plc": []}
SHORT = "%short\nN10 G90 G01 X1 F6000\nN20 M30\n"


class Wall:
    """A clock that shows the same time until somebody sleeps, works or looks often enough."""

    def __init__(self, overshoot: int = 0, look: int = 0) -> None:
        self.now = 5_000
        self.overshoot = overshoot
        self.look = look
        self.sleeps: list[int] = []

    def clock(self) -> int:
        self.now += self.look
        return self.now

    def sleep(self, seconds: float) -> None:
        self.sleeps.append(round(seconds * 1e9))
        self.now += self.sleeps[-1] + self.overshoot

    def work(self, ns: int) -> None:
        self.now += ns


@pytest.fixture
def paced() -> Callable[..., tuple[RealPace, Wall]]:
    """Return what makes a pace and the clock it keeps to."""

    def make(**options: Any) -> tuple[RealPace, Wall]:
        idle = options.pop("idle", None)
        wall = Wall(**options)
        return RealPace(CYCLE, wall.clock, wall.sleep, idle), wall

    return make


def filled(lateness: Lateness) -> dict[int, int]:
    return {number: count for number, count in enumerate(lateness.bins) if count}


def test_each_cycle_begins_on_the_grid_whatever_was_done_in_between(paced: Any) -> None:
    pace, wall = paced(look=10)
    start = wall.now
    for number, work in enumerate((0, 300_000, 900_000, 10), 1):
        wall.work(work)
        pace.wait()
        assert 0 <= wall.now - (start + number * CYCLE) <= 10
    assert pace.lateness.cycles == 4
    assert pace.lateness.late == 0
    assert filled(pace.lateness) == {0: 4}


def test_a_cycle_is_late_when_it_begins_a_cycle_behind_its_deadline(paced: Any) -> None:
    pace, wall = paced(look=1)
    for work in (CYCLE + 400_000, 2 * CYCLE, 100_000):
        wall.work(work)
        pace.wait()
    # 0.4 ms, then 1.4 ms: a cycle has gone; the next one begins at its time again.
    assert pace.lateness.late == 1
    assert pace.lateness.worst_ns // 1000 == 1400
    assert filled(pace.lateness) == {(400).bit_length(): 1, (1400).bit_length(): 1, 0: 1}


def test_who_is_always_too_slow_leaves_out_as_many_cycles_as_it_is_slow(paced: Any) -> None:
    pace, wall = paced(look=1)
    start = wall.now
    for _ in range(100):
        wall.work(CYCLE * 13 // 10)
        pace.wait()
    # 130 cycles of time have passed in 100.
    assert (wall.now - start) // CYCLE == 130
    assert pace.lateness.cycles == 100
    assert pace.lateness.late == 30


def test_a_long_outage_counts_every_cycle_that_it_cost_and_keeps_the_grid(paced: Any) -> None:
    pace, wall = paced(look=1)
    start = wall.now
    wall.work(500 * CYCLE + 123_456)
    pace.wait()
    pace.wait()
    assert (wall.now - start) % CYCLE < 10
    assert pace.lateness.late == 499
    assert pace.lateness.cycles == 2


def test_the_spin_settles_a_little_above_what_sleeps_take_too_long(paced: Any) -> None:
    pace, wall = paced(look=10, overshoot=60_000)
    assert pace.spin_ns == MOST_SPIN_NS
    for _ in range(10_000):
        pace.wait()
    assert 59_000 < pace.spin_ns < 65_000
    wall.overshoot = 0
    for _ in range(10_000):
        pace.wait()
    assert pace.spin_ns == LEAST_SPIN_NS
    wall.overshoot = MOST_SPIN_NS + 1_000
    for _ in range(50):
        pace.wait()
    assert pace.spin_ns == LEAST_SPIN_NS


def test_no_sleep_when_the_deadline_is_near(paced: Any) -> None:
    pace, wall = paced(look=100)
    wall.work(CYCLE - MOST_SPIN_NS)
    pace.wait()
    assert wall.sleeps == []


def test_what_came_before_a_restart_and_pauses_are_nobodys_lateness(paced: Any) -> None:
    pace, wall = paced(look=1)
    wall.work(5 * CYCLE)
    pace.wait()
    pace.restart()
    assert pace.lateness == Lateness()
    pace.wait()
    wall.work(700 * CYCLE)
    pace.resume()
    pace.wait()
    assert (pace.lateness.cycles, pace.lateness.late) == (2, 0)


def test_a_program_has_its_own_count_and_the_bench_that_of_all(paced: Any) -> None:
    pace, wall = paced(look=1)
    wall.work(3 * CYCLE)
    pace.wait()
    assert pace.take_part().late == 2
    pace.wait()
    part = pace.take_part()
    assert (part.cycles, part.late) == (1, 0)
    assert (pace.lateness.cycles, pace.lateness.late) == (2, 2)
    assert pace.lateness.worst_ns // 1000 == 2000


def test_the_histogram_goes_by_powers_of_two_and_is_open_at_its_end() -> None:
    lateness = Lateness(bins=[5, 0, 3, *[0] * (BINS - 4), 1])
    shown = lateness.figures()["lateness_histogram"]
    assert len(shown) == BINS
    assert shown[:3] == [
        {"from_us": 0, "below_us": 1, "cycles": 5},
        {"from_us": 1, "below_us": 2, "cycles": 0},
        {"from_us": 2, "below_us": 4, "cycles": 3},
    ]
    assert shown[-1] == {"from_us": 2**20, "below_us": None, "cycles": 1}
    assert Lateness().figures()["lateness_histogram"] == []
    assert len(Lateness(bins=[1, *[0] * (BINS - 1)]).figures()["lateness_histogram"]) == 1


def test_a_gap_is_what_is_left_before_the_spin_and_what_is_done_in_it_counts(paced: Any) -> None:
    gaps: list[int] = []

    def idle(rest: int) -> None:
        gaps.append(rest)
        wall.work(rest // 2)

    pace, wall = paced(look=1, idle=idle)
    wall.work(400_000)
    pace.wait()
    assert gaps[0] == pytest.approx(CYCLE - 400_000 - MOST_SPIN_NS, abs=10)
    assert sum(wall.sleeps) == pytest.approx(gaps[0] / 2, abs=10)
    wall.work(CYCLE)
    pace.wait()
    assert len(gaps) == 1


class Heap:
    """Young objects, and a collector that takes its time."""

    def __init__(self, wall: Wall) -> None:
        self.wall = wall
        self.young = 0
        self.takes = 0
        self.collected: list[int] = []

    def collect(self, generation: int) -> None:
        self.collected.append(generation)
        self.wall.work(self.takes)
        self.young = 0


def test_young_objects_are_collected_in_gaps_that_are_long_enough() -> None:
    wall = Wall()
    heap = Heap(wall)
    garbage = Garbage(wall.clock, lambda: heap.young, heap.collect)
    garbage.idle(10 * FIRST_GAP_NS)
    assert heap.collected == []
    heap.young = YOUNG
    garbage.idle(FIRST_GAP_NS - SHARE)
    assert heap.collected == []
    heap.takes = FIRST_GAP_NS
    garbage.idle(FIRST_GAP_NS)
    assert heap.collected == [0]
    heap.young = YOUNG
    garbage.idle(SHARE * FIRST_GAP_NS - 1)
    assert heap.collected == [0]
    garbage.idle(SHARE * FIRST_GAP_NS)
    assert heap.collected == [0, 0]
    garbage.between_programs()
    assert heap.collected == [0, 0, 2]


def test_the_collector_rests_and_comes_back() -> None:
    assert gc.isenabled()
    with frozen_garbage():
        assert not gc.isenabled()
        assert gc.get_freeze_count() > 0
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0


def test_the_collector_rests_as_long_as_any_bench_wants_it() -> None:
    with frozen_garbage():
        with frozen_garbage():
            pass
        assert not gc.isenabled()
        assert gc.get_freeze_count() > 0
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0


def test_what_was_asked_of_the_operating_system_is_told_and_given_back() -> None:
    calm = ask(realtime=True)
    assert len(calm.notes) == 2
    assert all(note.startswith("real time: ") for note in calm.notes)
    calm.close()
    calm = ask(realtime=False)
    assert calm.notes == []
    calm.close()


def test_a_paced_bench_tells_how_it_kept_its_cycle() -> None:
    with Bench("demo", QUIET, pace="real") as bench:
        result = bench.run(SHORT)
        told = result.to_dict()
        assert gc.isenabled() is False
        assert sum(one["cycles"] for one in told["lateness_histogram"]) == result.cycles
        state = bench.state()
        assert state["late_cycles"] == told["late_cycles"] == result.late_cycles
        assert state["worst_lateness_us"] == told["worst_lateness_us"]
        again = bench.run(SHORT)
        assert again.lateness is not None
        assert again.lateness.cycles == again.cycles
    assert gc.isenabled()


def test_a_bench_in_free_pace_has_nothing_to_tell() -> None:
    with Bench("demo", QUIET) as bench:
        told = bench.run(SHORT).to_dict()
    assert not {"late_cycles", "worst_lateness_us", "lateness_histogram", "lateness"} & set(told)


def test_real_time_is_for_a_bench_by_the_clock(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match="pace real"):
        Bench("demo", realtime=True)
    assert main(["run", "meas1.nc", "--realtime"]) == 2
    assert "--realtime: only with --pace real" in capsys.readouterr().err


def test_run_says_what_it_got_and_writes_how_it_kept_its_cycle(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, result, report = (tmp_path / name for name in ("short.nc", "result.json", "report.html"))
    program.write_text(SHORT)
    options = [
        "--plc",
        "none",
        "--pace",
        "real",
        "--realtime",
        "--result",
        str(result),
        "--report",
        str(report),
    ]
    assert main(["run", str(program), *options]) == 0
    told = json.loads(result.read_text())
    assert {"late_cycles", "worst_lateness_us", "lateness_histogram"} <= set(told)
    assert sum(one["cycles"] for one in told["lateness_histogram"]) == told["cycles"]
    assert len([line for line in capsys.readouterr().err.splitlines() if line.startswith("real time: ")]) == 2
    page = report.read_text()
    assert "<h2>Real pace</h2>" in page
    assert page.count("<li><span") >= len(told["lateness_histogram"])
