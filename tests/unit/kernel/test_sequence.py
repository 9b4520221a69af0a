"""Tables of phases: which way is taken, what stays armed."""

from dataclasses import dataclass, field
from functools import partial

import numpy as np
import pytest

from hli_bench.base.errors import BenchError
from hli_bench.kernel.sequence import END, Level, Phase, Sequence, Then, always
from hli_bench.kernel.watches import ROOM, Watches, cycle_reached, lag_over, path_done
from hli_bench.laws.control import ask_watches
from hli_bench.laws.rows import W_NONE, KernelRows


@dataclass
class Run:
    """What the phases of a test write down."""

    done: list[str] = field(default_factory=list)
    levels: set[str] = field(default_factory=set)


@pytest.fixture
def rows() -> KernelRows:
    return KernelRows.allocate(2, ROOM)


@pytest.fixture
def watches(rows) -> Watches:
    return Watches(rows.watch)


def say(text: str):
    return lambda run: run.done.append(text)


def level(name: str):
    return lambda run: Level(lambda: name in run.levels)


def armed(rows) -> int:
    return int((rows.watch["kind"] != W_NONE).sum())


def test_first_way_that_is_met_decides(rows, watches):
    table = {
        "one": Phase(say("in one"), (Then(level("a"), "two", say("a")), Then(level("b"), END, say("b")))),
        "two": Phase(say("in two"), (Then(level("c"), END),)),
    }
    run = Run()
    sequence = Sequence(table, run, "one", watches)
    sequence.step()
    assert (sequence.phase, run.done) == ("one", ["in one"])
    run.levels |= {"a", "b"}
    sequence.step()

    assert (sequence.phase, run.done) == ("two", ["in one", "a", "in two"])


def test_phases_that_need_nothing_are_left_at_once(watches):
    run = Run()
    table = {name: Phase(say(name), (Then(always, following),)) for name, following in ("12", "23")}
    table["3"] = Phase(say("3"), (Then(always, END),))
    sequence = Sequence(table, run, "1", watches)
    sequence.step()

    assert sequence.ended
    assert run.done == ["1", "2", "3"]


def test_way_back_to_its_own_phase_is_used_up_and_the_others_stay_armed(rows, watches):
    """A condition that has held for half its time must not begin anew because another one was met."""
    slow = Then(lambda _: lag_over(0, 10.0, cycles=4), END, say("slow"))
    again = Then(level("a"), "one", say("a"))
    run = Run()
    sequence = Sequence({"one": Phase(say("in one"), (again, slow))}, run, "one", watches)
    rows.axis[0]["lag"] = 20.0
    run.levels.add("a")
    for cycle in range(1, 5):
        ask_watches(rows.axis, rows.path, rows.watch, rows.history, cycle)
        sequence.step()
        assert run.done.count("a") == 1
        assert sequence.ended == (cycle == 4)

    assert run.done == ["in one", "a", "slow"]
    assert armed(rows) == 0


def test_next_phase_may_depend_on_the_run(watches):
    run = Run(levels={"x"})
    table = {
        "one": Phase(say("1"), (Then(always, lambda run: "two" if "x" in run.levels else END),)),
        "two": Phase(say("2"), (Then(level("never"), END),)),
    }
    sequence = Sequence(table, run, "one", watches)
    sequence.step()

    assert sequence.phase == "two"


def test_abort_takes_its_conditions_back(rows, watches):
    other = watches.watch(path_done())
    ways = tuple(Then(partial(lambda n, _: cycle_reached(n), n), END) for n in (10, 20))
    sequence = Sequence({"one": Phase(say(""), ways)}, Run(), "one", watches)
    assert armed(rows) == 3
    sequence.abort()

    assert sequence.ended
    assert armed(rows) == 1
    assert rows.watch["kind"][other] != W_NONE


def test_watch_row_is_fresh_when_it_is_handed_out_again(rows, watches):
    first = watches.watch(cycle_reached(1))
    ask_watches(rows.axis, rows.path, rows.watch, rows.history, 5)
    assert watches.met(first)
    watches.forget(first)
    second = watches.watch(cycle_reached(100))

    assert second == first
    assert not watches.met(second)
    assert np.all(rows.watch["count"][second] == 0)


def test_gap_is_handed_out_again_and_the_scan_ends_behind_the_last(rows, watches):
    first, second, third = (watches.watch(cycle_reached(n)) for n in (1, 2, 3))
    watches.forget(second)
    assert ask_watches(rows.axis, rows.path, rows.watch, rows.history, 3) == 2, "a gap does not end the scan"
    assert watches.watch(cycle_reached(4)) == second
    watches.forget(second)
    watches.forget(third)

    assert armed(rows) == 1, "rows behind the last in use are not looked at"
    assert watches.met(first)


def test_no_row_left_is_said_by_name(rows, watches):
    for n in range(ROOM):
        watches.watch(cycle_reached(n))

    with pytest.raises(BenchError, match="more than 64 conditions"):
        watches.watch(path_done())


def test_a_condition_taken_back_twice_frees_one_row(rows, watches):
    first, second, third = (watches.watch(cycle_reached(n)) for n in (1, 2, 3))
    for handle in (first, first, third, third):
        watches.forget(handle)
    assert armed(rows) == 2, "the gap in front of the second, and the second"
    handles = [watches.watch(path_done()) for _ in range(4)]
    assert len({second, *handles}) == 5
    for handle in (second, *handles):
        watches.forget(handle)
    assert armed(rows) == 0
    assert watches.watch(path_done()) == first
