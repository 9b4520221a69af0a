"""Servo and mechanics: following, torque clamp at a fixed stop, friction, following error supervision, 32 bits."""

import math
from typing import Any

import pytest

from hli_bench.plant.settings import Stop

PER_MM = 104_857.6


def _lag_mm(bench: Any) -> float:
    servo = bench.rows.servo[0]
    return (int(servo["demand"]) - int(servo["position"])) / PER_MM


def test_a_moving_axis_follows_and_stands_still_where_it_was_told(rig: Any, axis: Any) -> None:
    bench = rig([axis()])
    bench.move(100.0, 500)
    assert abs(_lag_mm(bench)) < 1e-3
    bench.wait(500)
    assert bench.mm() == pytest.approx(50.0, abs=2e-4)
    at_rest = int(bench.rows.servo[0]["position"])
    bench.wait(200)
    assert int(bench.rows.servo[0]["position"]) == at_rest


@pytest.mark.parametrize("side", ["above", "below"])
def test_the_press_force_at_a_stop_is_the_torque_limit(rig: Any, axis: Any, side: str) -> None:
    sign = 1.0 if side == "above" else -1.0
    bench = rig([axis(stop=Stop(mm=sign * 2.0, side=side, stiffness_n_per_um=100.0))])
    servo = bench.rows.servo
    servo["torque_limit_permille"] = 100.0
    deepest = 0.0
    for _ in range(3000):
        bench.move(sign * 100.0 / 60.0, 1)
        deepest = max(deepest, sign * bench.mm() - 2.0)
    assert servo[0]["torque_permille"] == sign * 100
    assert servo[0]["status_flags"] & 0x0800
    assert abs(servo[0]["speed"]) < 1e-3
    # spring force against the motor: torque limit (within friction), penetration as in theory
    row = servo[0]
    press = row["stop_stiffness"] * abs(row["angle"] - row["stop_angle"])
    assert press == pytest.approx(1.5, abs=0.07)
    assert deepest == pytest.approx(0.0069 * 1.5 / 1.5, rel=0.5)
    assert sign * _lag_mm(bench) == pytest.approx(3000 * 1e-3 * 100.0 / 60.0 - 2.0, abs=0.02)


def test_one_per_cent_of_torque_still_moves_the_axis(rig: Any, axis: Any) -> None:
    bench = rig([axis()])
    bench.rows.servo["torque_limit_permille"] = 10.0
    bench.move(100.0 / 60.0, 3000)
    bench.wait(500)
    assert bench.mm() == pytest.approx(5.0, abs=1e-3)


def test_friction_above_the_limit_holds_the_axis(rig: Any, axis: Any) -> None:
    bench = rig([axis(static_nm=0.62, coulomb_nm=0.5)])
    bench.rows.servo["torque_limit_permille"] = 10.0
    bench.move(1.0, 500)
    assert bench.mm() == 0.0
    assert _lag_mm(bench) == pytest.approx(0.5, abs=1e-3)


def test_an_axis_without_power_coasts_to_a_stand_and_its_demand_follows(rig: Any, axis: Any) -> None:
    bench = rig([axis(coulomb_nm=5.0, static_nm=6.0)])
    bench.move(100.0, 200)
    bench.rows.servo["enabled"] = 0
    there = bench.mm()
    bench.move(100.0, 100)
    # 5 Nm on 3.3e-3 kg m2 are 2411 mm/s2
    assert bench.mm() - there == pytest.approx(100.0**2 / 2 / 2411.0, rel=0.1)
    rests = bench.mm()
    bench.move(100.0, 50)
    assert bench.mm() == rests
    assert bench.rows.servo[0]["demand"] == bench.rows.servo[0]["position"]
    assert bench.rows.servo[0]["torque_permille"] == 0


@pytest.mark.parametrize(("timeout_ms", "cycles"), [(0, 1), (5, 6), (100, 101)])
def test_following_error_faults_after_the_time_out(rig: Any, axis: Any, timeout_ms: int, cycles: int) -> None:
    bench = rig([axis(static_nm=10.0, coulomb_nm=10.0)])
    servo = bench.rows.servo
    servo["torque_limit_permille"] = 10.0
    servo["following_window"] = 1000
    servo["following_timeout_ms"] = timeout_ms
    servo["target"] = 1000
    bench.wait(200)
    assert bench.faults == 0
    assert not servo[0]["status_flags"] & 0x2000
    servo["target"] = 1001
    bench.wait(cycles - 1)
    assert bench.faults == 0
    bench.wait(1)
    assert bench.faults == 1
    assert servo[0]["fault"] == 0x8611
    assert servo[0]["status_flags"] & 0x2000
    bench.wait(50)
    assert bench.faults == 1


def test_back_inside_the_window_starts_the_time_out_again(rig: Any, axis: Any) -> None:
    bench = rig([axis(static_nm=10.0, coulomb_nm=10.0)])
    servo = bench.rows.servo
    servo["torque_limit_permille"] = 10.0
    servo["following_window"] = 1000
    servo["following_timeout_ms"] = 5
    for _ in range(10):
        servo["target"] = 5000
        bench.wait(5)
        servo["target"] = 0
        bench.wait(1)
    assert bench.faults == 0


@pytest.mark.parametrize("window", [0, 0xFFFFFFFF])
def test_an_open_window_is_not_watched(rig: Any, axis: Any, window: int) -> None:
    bench = rig([axis(static_nm=10.0, coulomb_nm=10.0)])
    bench.rows.servo["torque_limit_permille"] = 10.0
    bench.rows.servo["following_window"] = window
    bench.rows.servo["target"] = 2_000_000_000
    bench.wait(50)
    assert bench.faults == 0


def test_positions_wrap_at_32_bits(rig: Any, axis: Any) -> None:
    bench = rig([axis(start_mm=20_479.0)])
    servo = bench.rows.servo
    target = int(servo[0]["target"])
    for _ in range(400):
        target += round(0.1 * PER_MM)
        servo["target"] = (target + 2**31) % 2**32 - 2**31
        bench.step()
    bench.wait(300)
    assert int(servo[0]["position"]) < 0
    assert bench.mm() == pytest.approx(20_479.0 + 40.0, abs=1e-2)


def test_a_rotary_axis_presses_its_stop_with_the_same_law(rig: Any, axis: Any) -> None:
    stop = Stop(mm=10.0, side="above", stiffness_n_per_um=1.0)
    bench = rig([axis("A", rotary=True, pitch_mm=36.0, stop=stop)])
    row = bench.rows.servo[0]
    # 1 Nm per 0.001 degree of the axis, seen by a motor that turns ten times
    assert row["stop_stiffness"] == pytest.approx(1000.0 * 180.0 / math.pi / 100.0)
    assert row["stop_angle"] == pytest.approx(math.radians(100.0))


def test_mass_counts_over_the_pitch(rig: Any, axis: Any) -> None:
    bench = rig([axis(mass_kg=100.0)])
    assert bench.rows.servo[0]["inertia"] == pytest.approx(3.3e-3 + 100.0 * (0.01 / math.tau) ** 2)
