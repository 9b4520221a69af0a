"""The drive's touch probe: arming, single and continuous, both edges, the zero pulse."""

from typing import Any

import pytest

from hli_bench.plant.settings import Face

PER_MM = 104_857.6
SINGLE_POS = 0x0011
CONTINUOUS_BOTH = 0x0033
ZERO_PULSE = 0x0015
TURN = 1_048_576


@pytest.fixture
def bench(rig: Any, axis: Any) -> Any:
    return rig([axis(face=Face(mm=1.0, material="above"), probe_inputs=("probe", "probe"))])


def _status(bench: Any) -> int:
    return int(bench.rows.servo[0]["probe_status"])


def _latch(bench: Any, slot: int) -> int:
    return int(bench.rows.servo[0]["latch"][slot])


def _touch(bench: Any) -> None:
    bench.move(10.0, 120)
    bench.wait(150)


def _leave(bench: Any) -> None:
    bench.move(-10.0, 120)
    bench.wait(150)


def test_single_latches_the_first_edge_until_it_is_armed_again(bench: Any) -> None:
    servo = bench.rows.servo
    servo["probe_function"] = SINGLE_POS
    bench.step()
    assert _status(bench) == 0x01
    _touch(bench)
    assert _status(bench) == 0x03
    assert _latch(bench, 0) == pytest.approx(PER_MM, abs=1)
    servo[0]["latch"][0] = 77
    _leave(bench)
    _touch(bench)
    assert (_status(bench), _latch(bench, 0)) == (0x03, 77)
    servo["probe_function"] = 0
    bench.step()
    assert _status(bench) == 0
    servo["probe_function"] = SINGLE_POS
    _leave(bench)
    assert _status(bench) == 0x01
    _touch(bench)
    assert _status(bench) == 0x03
    assert _latch(bench, 0) == pytest.approx(PER_MM, abs=1)


def test_a_level_that_is_high_at_arming_does_not_fire(bench: Any) -> None:
    _touch(bench)
    bench.rows.servo["probe_function"] = SINGLE_POS
    bench.wait(10)
    assert _status(bench) == 0x01
    _leave(bench)
    assert _status(bench) == 0x01


def test_continuous_overwrites_and_both_edges_have_their_own_value(bench: Any) -> None:
    bench.rows.servo["probe_function"] = CONTINUOUS_BOTH
    _touch(bench)
    assert _status(bench) == 0x03
    _leave(bench)
    assert _status(bench) == 0x07
    assert _latch(bench, 1) == pytest.approx(PER_MM, abs=1)
    bench.rows.servo[0]["latch"][0] = 77
    _touch(bench)
    assert _latch(bench, 0) == pytest.approx(PER_MM, abs=1)


def test_the_second_input_has_its_own_half_of_the_words(bench: Any) -> None:
    bench.rows.servo["probe_function"] = 0x2100
    _touch(bench)
    assert _status(bench) == 0x0100
    _leave(bench)
    assert _status(bench) == 0x0500
    assert _latch(bench, 3) == pytest.approx(PER_MM, abs=1)
    assert [_latch(bench, slot) for slot in (0, 1, 2)] == [0, 0, 0]


@pytest.mark.parametrize(
    ("start_mm", "velocity", "pulse_mm"),
    [(0.0, 50.0, 5.0), (0.0, -50.0, -5.0), (5.0, 50.0, 15.0), (27.3, -50.0, 25.0)],
)
@pytest.mark.parametrize("absolute", [True, False])
def test_the_zero_pulse_is_latched_where_it_is(
    rig: Any, axis: Any, start_mm: float, velocity: float, pulse_mm: float, absolute: bool
) -> None:
    bench = rig([axis(start_mm=start_mm, absolute=absolute)])
    bench.rows.servo["probe_function"] = ZERO_PULSE
    bench.move(velocity, 250)
    shown = pulse_mm if absolute else pulse_mm - start_mm
    assert _status(bench) == 0x03
    assert _latch(bench, 0) == pytest.approx(shown * PER_MM, abs=1)
    assert (_latch(bench, 0) - int(bench.rows.servo[0]["encoder_offset"])) % TURN == TURN // 2


def test_an_armed_zero_pulse_ignores_the_input_and_the_other_way_round(bench: Any) -> None:
    bench.rows.servo["probe_function"] = ZERO_PULSE
    _touch(bench)
    assert _status(bench) == 0x01
    _leave(bench)
    bench.rows.servo["probe_function"] = 0
    bench.step()
    bench.rows.servo["probe_function"] = SINGLE_POS
    bench.move(-50.0, 150)
    assert _status(bench) == 0x01
