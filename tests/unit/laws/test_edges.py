"""Edges: exact instants between cycles, hysteresis, order, bounce, spread, forced signals."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.laws.switches import crossing
from hli_bench.plant.settings import Cam, Face, Probe
from hli_bench.terminals.settings import Channel

EPOCH_NS = 820_540_800_000_000_000
INCREMENTS_PER_MM = 104_857.6


@given(st.floats(-1e3, 1e3), st.floats(-1.0, 1.0).filter(lambda x: abs(x) > 1e-9), st.floats(0.0, 1.0))
def test_crossing_lies_within_the_sub_step_and_on_the_line(before: float, way: float, part: float) -> None:
    threshold = before + part * way
    at = crossing(before, before + way, threshold, 1000, 125_000)
    assert 1001 <= at <= 126_000
    there = before + way * (at - 1000) / 125_000
    assert abs(there - threshold) <= abs(way) * 1.01 / 125_000 + 1e-12 * abs(before)


@pytest.mark.parametrize("velocity", [1.0, 33.333, 250.0])
@pytest.mark.parametrize("material", ["above", "below"])
def test_an_edge_is_exact_between_cycles(rig: Any, axis: Any, velocity: float, material: str) -> None:
    sign = 1.0 if material == "above" else -1.0
    face = sign * (velocity * 0.15 + 0.123456)
    bench = rig([axis(face=Face(mm=face, material=material), probe_inputs=("probe", ""))])
    bench.rows.servo["probe_function"] = 0x0011
    angles = [float(bench.rows.servo[0]["angle"])]
    servo = bench.rows.servo
    for k in range(1, 1001):
        servo[0]["target"] = round(sign * velocity * k * 1e-3 * INCREMENTS_PER_MM)
        bench.step()
        angles.append(float(servo[0]["angle"]))
        if bench.edges():
            break
    bench.move(sign * velocity, 4)
    [(at, signal, level)] = bench.edges()
    assert (signal, level) == (0, 1)
    assert (bench.cycle - 5) * 1_000_000 < at <= (bench.cycle - 4) * 1_000_000
    assert at % 125_000 != 0
    # the touch probe's position latch is the position of that instant, not of a cycle
    assert abs(int(servo[0]["latch"][0]) - face * INCREMENTS_PER_MM) <= max(
        1.0, velocity * INCREMENTS_PER_MM * 1e-9
    )
    assert int(servo[0]["latch_time"][0]) == (EPOCH_NS + at) % 2**32
    # in steady motion the instant is where the straight line through the cycle's ends meets the face
    first, second = angles[-2], angles[-1]
    part = (face * 2.0 * math.pi / 10.0 - first) / (second - first)
    assert abs((bench.cycle - 5 + part) * 1_000_000 - at) < 2_000


def test_a_cam_has_hysteresis_on_both_sides(rig: Any, axis: Any) -> None:
    cam = Cam(from_mm=1.0, to_mm=2.0, hysteresis_um=100.0)
    bench = rig([axis(cam=cam)], [Channel("cam.Z")])
    bench.move(10.0, 300)
    bench.wait(200)
    bench.move(-10.0, 300)
    bench.wait(200)
    found = [(signal, level) for _, signal, level in bench.edges()]
    assert found == [(1, 1), (1, 0), (1, 1), (1, 0)]
    assert bench.rows.channel[0]["input"] == 0


def _positions_of_edges(bench: Any, velocity: float, cycles: int) -> list[float]:
    found = []
    for _ in range(cycles):
        before, known, start = bench.mm(), len(bench.edges()), bench.now_ns
        bench.move(velocity, 1)
        for at, _, _ in bench.edges()[known:]:
            found.append(before + (bench.mm() - before) * (at - start) / 1_000_000)
    return found


def test_cam_positions(rig: Any, axis: Any) -> None:
    bench = rig([axis(cam=Cam(from_mm=1.0, to_mm=2.0, hysteresis_um=100.0))])
    there = _positions_of_edges(bench, 10.0, 300)
    bench.wait(300)
    back = _positions_of_edges(bench, -10.0, 300)
    assert there == pytest.approx([1.0, 2.1], abs=2e-4)
    assert back == pytest.approx([2.0, 0.9], abs=2e-4)


def test_pretravel_goes_into_the_material_and_release_is_at_the_face(rig: Any, axis: Any) -> None:
    bench = rig([axis(face=Face(mm=1.0, material="above"))], probe=Probe(pretravel_um=30.0))
    on = _positions_of_edges(bench, 10.0, 150)
    bench.wait(300)
    off = _positions_of_edges(bench, -10.0, 150)
    assert on == pytest.approx([1.03], abs=2e-4)
    assert off == pytest.approx([1.0], abs=2e-4)


def test_the_probe_is_operated_inside_all_faces_of_the_main_axes(rig: Any, axis: Any) -> None:
    faces = [axis("X", face=Face(mm=1.0, material="above")), axis("Z", face=Face(mm=-1.0, material="below"))]
    bench = rig(faces)
    bench.move(10.0, 150, axis=0)
    bench.wait(200)
    assert (bench.rows.signal[0]["operated"], bench.rows.signal[0]["level"]) == (1, 0)
    bench.move(-10.0, 150, axis=1)
    bench.wait(200)
    assert [(s, level) for _, s, level in bench.edges()] == [(0, 1)]
    assert bench.rows.signal[0]["operated"] == 2
    bench.move(-10.0, 150, axis=0)
    bench.wait(200)
    assert [(s, level) for _, s, level in bench.edges()] == [(0, 1), (0, 0)]
    assert bench.rows.signal[0]["operated"] == 1


def test_bounce_is_a_train_of_edges_that_ends_at_the_new_level(rig: Any, axis: Any) -> None:
    bench = rig([axis(face=Face(mm=1.0, material="above"))], probe=Probe(bounce_us=2000.0))
    bench.move(10.0, 200)
    edges = bench.edges()
    assert [level for _, _, level in edges] == [1, 0, 1]
    first = edges[0][0]
    assert [at - first for at, _, _ in edges] == [0, 1_000_000, 2_000_000]
    bench.wait(200)
    bench.move(-10.0, 200)
    bench.wait(200)
    assert [level for _, _, level in bench.edges()] == [1, 0, 1, 0, 1, 0]
    assert bench.rows.signal[0]["operated"] == 0


def test_a_switch_that_chatters_faster_than_it_bounces_ends_as_it_stands(rig: Any, axis: Any) -> None:
    bench = rig([axis(face=Face(mm=1.0, material="above"), kv_per_s=150.0)], probe=Probe(bounce_us=100_000.0))
    bench.move(10.0, 100)
    bench.wait(300)
    bench.move(100.0, 5)
    for turn in range(100):
        bench.move(100.0 if turn % 2 else -100.0, 8)
    assert len(bench.edges()) > 30
    bench.wait(500)
    row = bench.rows.signal[0]
    assert (row["operated"], row["level"], bench.rows.switch[0]["state"]) == (1, 1, 1)


def test_spread_is_seeded_and_leaves_without_chatter(rig: Any, axis: Any) -> None:
    def touches(seed: int) -> list[int]:
        bench = rig([axis(face=Face(mm=0.5, material="above"))], probe=Probe(sigma_um=5.0), seed=seed)
        for _ in range(8):
            bench.move(10.0, 70)
            bench.wait(100)
            bench.move(-10.0, 70)
            bench.wait(100)
        assert [level for _, _, level in bench.edges()] == [1, 0] * 8
        return [at for at, _, level in bench.edges() if level]

    first = touches(1)
    assert first == touches(1)
    assert first != touches(2)
    gaps = np.diff(first)
    assert gaps.std() > 0.0


def test_a_switch_operated_at_the_start_shows_everywhere(rig: Any, axis: Any) -> None:
    one = axis(
        cam=Cam(from_mm=-1.0, to_mm=1.0, hysteresis_um=0.0),
        inputs=("", "", "cam.Z", "", "", "", "", ""),
    )
    bench = rig([one], [Channel("cam.Z")])
    rows = bench.rows
    assert (rows.switch[0]["state"], rows.signal[1]["level"], rows.channel[0]["input"]) == (1, 1, 1)
    assert rows.servo[0]["digital_inputs"] == 0b100
    bench.wait(3)
    assert bench.edges() == []
    assert rows.channel[0]["input"] == 1
    bench.move(20.0, 120)
    assert [level for _, _, level in bench.edges()] == [0]
    assert rows.servo[0]["digital_inputs"] == 0


def test_a_forced_signal_changes_at_once_and_ignores_its_switch(rig: Any, axis: Any) -> None:
    bench = rig([axis(face=Face(mm=1.0, material="above"))], [Channel("probe")])
    bench.wait(2)
    bench.plant.force("probe", 1)
    bench.step()
    assert bench.edges() == [(2_000_001, 0, 1)]
    assert bench.rows.channel[0]["input"] == 1
    bench.move(10.0, 200)
    assert len(bench.edges()) == 1
    bench.plant.force("probe", None)
    bench.step()
    assert len(bench.edges()) == 1
    assert bench.rows.signal[0]["level"] == 1


def test_edges_of_one_sub_step_come_in_the_order_of_their_instants(rig: Any, axis: Any) -> None:
    cams = [Cam(from_mm=20.0 + shift, to_mm=50.0, hysteresis_um=0.0) for shift in (0.003, 0.001, 0.002)]
    bench = rig([axis(name, cam=cam) for name, cam in zip("XYZ", cams, strict=True)])
    servo = bench.rows.servo
    for k in range(1, 250):
        servo["target"] = round(100.0 * k * 1e-3 * INCREMENTS_PER_MM)
        bench.step()
    edges = bench.edges()
    assert [signal for _, signal, _ in edges] == [2, 3, 1]
    instants = [at for at, _, _ in edges]
    assert instants == sorted(instants)
    assert instants[-1] - instants[0] == pytest.approx(20_000, abs=50)
