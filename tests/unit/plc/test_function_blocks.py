from contextlib import contextmanager
from contextvars import Context
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.plc import CTU, F_TRIG, R_TRIG, RS, SR, TOF, TON, TP
from hli_bench.plc.function_blocks import TASK_TIME


@contextmanager
def at_ms(ms: Any) -> Any:
    token = TASK_TIME.set(ms * 1_000_000)
    yield
    TASK_TIME.reset(token)


def run(timer: Any, inputs: Any, pt: Any) -> Any:
    """(ms, IN) in order -> (Q, ET) of each call."""
    seen = []
    for ms, level in inputs:
        with at_ms(ms):
            timer(IN=level, PT=pt)
        seen.append((timer.Q, timer.ET))
    return seen


@given(st.lists(st.booleans()))
def test_r_trig_counts_rising_edges_from_false(levels: Any) -> None:
    edge = R_TRIG()
    assert [edge(CLK=level) for level in levels] == [
        level and not before for before, level in zip([False, *levels], levels, strict=False)
    ]


@given(st.lists(st.booleans()))
def test_f_trig_counts_falling_edges_from_true(levels: Any) -> None:
    edge = F_TRIG()
    assert [edge(CLK=level) for level in levels] == [
        before and not level for before, level in zip([True, *levels], levels, strict=False)
    ]


def test_ton_waits_for_pt_and_falls_with_in() -> None:
    inputs = [(0, True), (4, True), (5, True), (9, True), (10, False), (11, True), (15, True), (16, True)]
    assert run(TON(), inputs, 5) == [
        (False, 0), (False, 4), (True, 5), (True, 5), (False, 0), (False, 0), (False, 4), (True, 5),
    ]  # fmt: skip


def test_tof_holds_for_pt_after_in() -> None:
    inputs = [(0, False), (1, True), (2, False), (4, False), (5, True), (6, False), (10, False), (11, False)]
    assert run(TOF(), inputs, 5) == [
        (False, 0), (True, 0), (True, 0), (True, 2), (True, 0), (True, 0), (True, 4), (False, 5),
    ]  # fmt: skip


def test_tp_gives_one_pulse_whatever_in_does_meanwhile() -> None:
    inputs = [
        (0, True),
        (1, False),
        (2, True),
        (4, True),
        (5, True),
        (6, True),
        (7, False),
        (8, True),
        (9, False),
    ]
    assert run(TP(), inputs, 5) == [
        (True, 0), (True, 1), (True, 2), (True, 4), (False, 5), (False, 5), (False, 0), (True, 0), (True, 1),
    ]  # fmt: skip


def test_a_timer_outside_of_a_task_has_no_time() -> None:
    with pytest.raises(LookupError):
        Context().run(lambda: TON()(IN=True, PT=1))


@pytest.mark.parametrize(
    ("first", "second", "after_both"), [(SR, ("S1", "R"), True), (RS, ("S", "R1"), False)]
)
def test_bistables_differ_when_both_inputs_are_true(first: Any, second: Any, after_both: Any) -> None:
    block, (set_input, reset) = first(), second
    assert block(**{set_input: False, reset: False}) is False
    assert block(**{set_input: True, reset: False}) is True
    assert block(**{set_input: False, reset: False}) is True
    assert block(**{set_input: True, reset: True}) is after_both
    assert block(**{set_input: False, reset: True}) is False


def test_ctu_counts_rising_edges_and_reset_wins() -> None:
    counter = CTU()
    levels = [
        (True, False),
        (True, False),
        (False, False),
        (True, False),
        (False, True),
        (True, True),
        (True, False),
    ]
    assert [(counter(CU=cu, R=r, PV=2), counter.CV) for cu, r in levels] == [
        (False, 1), (False, 1), (False, 1), (True, 2), (False, 0), (False, 0), (False, 0),
    ]  # fmt: skip


def test_blocks_take_the_names_of_tc2_standard_too() -> None:
    for first, second in ((SR(), SR()), (RS(), RS())):
        names = (
            ({"S1": True, "R": True}, {"SET1": True, "RESET": True})
            if isinstance(first, SR)
            else (
                {"S": True, "R1": True},
                {"SET": True, "RESET1": True},
            )
        )
        assert first(**names[0]) is second(**names[1]) is isinstance(first, SR)
    counter = CTU()
    assert counter(CU=True, RESET=False, PV=1)
    assert not counter(CU=True, RESET=True, PV=1)
    with pytest.raises(TypeError, match="RESTE"):
        counter(CU=True, RESTE=False, PV=1)
