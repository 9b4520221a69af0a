"""Settings to rows: encoders, signals, wiring, seeds."""

import math
from typing import Any

import numpy as np
import pytest

from hli_bench.bench.folder import load
from hli_bench.plant.build import NOISE_LIMIT, Plant, build

PER_MM = 104_857.6


def _plant(**given: Any) -> Plant:
    overrides = {key.replace("__", "."): value for key, value in given.items()}
    config = load("demo", overrides)
    return build(config.plant, config.channels())


def test_an_absolute_encoder_shows_the_machine_position() -> None:
    row = _plant(axis__Z__start_mm=300.0).rows.servo[2]
    assert row["encoder_offset"] == 0
    assert row["position"] == row["target"] == row["demand"] == round(300.0 * PER_MM)
    assert row["angle"] == pytest.approx(300.0 / 10.0 * math.tau)


def test_an_incremental_encoder_shows_zero_at_power_on() -> None:
    row = _plant(axis__Z__kenngr__abs_pos_gueltig=0).rows.servo[2]
    assert (row["position"], row["target"], row["demand_from"]) == (0, 0, 0.0)
    assert row["encoder_offset"] == -round(300.0 * PER_MM)
    assert row["angle"] == pytest.approx(300.0 / 10.0 * math.tau)


def test_signals_and_wiring_of_the_demo() -> None:
    plant = _plant()
    assert plant.signals.names == ("probe", "cam.X", "cam.Y", "cam.Z", "cam.X2", "cam.A", "cam.B", "cam.S")
    assert plant.signals.index("") == -1
    assert plant.rows.servo["probe_signal"].tolist() == [[0, -1]] * 7
    assert plant.rows.channel["signal"].tolist() == [-1, 0, 1, 2, 3, 4, 5, 6, -1, -1]
    assert not plant.rows.signal["level"].any()
    assert (plant.pending[:, 1] == -1).all()


def test_every_face_feeds_the_probe() -> None:
    plant = _plant(
        plant__probe__X__face_mm=10.0,
        plant__probe__X__material="above",
        plant__probe__Z__face_mm=100.0,
        plant__probe__Z__material="below",
    )
    faces = plant.rows.switch[plant.rows.switch["signal"] == 0]
    assert faces["axis"].tolist() == [0, 2]
    rad = math.tau / 10.0
    assert (faces[0]["low"], faces[0]["high"]) == (pytest.approx(10.0 * rad), math.inf)
    assert (faces[1]["low"], faces[1]["high"]) == (-math.inf, pytest.approx(100.0 * rad))


def test_a_start_inside_the_material_is_a_deflected_probe() -> None:
    plant = _plant(plant__probe__Z__face_mm=400.0, plant__probe__Z__material="below")
    assert (plant.rows.signal[0]["level"], plant.rows.channel[1]["input"]) == (1, 1)


def test_spread_depends_on_seed_and_axis() -> None:
    given = {"plant__probe__sigma_um": 2.0}
    for axis in "XZ":
        given[f"plant__probe__{axis}__face_mm"] = -1.0
        given[f"plant__probe__{axis}__material"] = "below"

    def noise(seed: int) -> np.ndarray:
        switch = _plant(seed=seed, **given).rows.switch
        return switch[switch["signal"] == 0]["noise"] * 10.0 / math.tau * 1e3

    one = noise(1)
    assert np.array_equal(one, noise(1))
    assert not np.array_equal(one, noise(2))
    assert not np.array_equal(one[0], one[1])
    assert one.std() == pytest.approx(2.0, rel=0.1)
    assert abs(one).max() <= NOISE_LIMIT * 2.0 + 1e-9


def test_friction_stays_below_one_per_cent_of_the_rated_torque() -> None:
    servo = _plant().rows.servo
    assert (servo["static"] < 0.01 * servo["rated_torque"]).all()
    assert (servo["coulomb"] <= servo["static"]).all()


def test_a_hole_in_the_wiring_stays_open() -> None:
    row = _plant(axis__Z__input__home="cam.Z", axis__Z__probe_input_1="").rows.servo[2]
    assert row["input_signal"].tolist() == [-1, -1, 3, -1, -1, -1, -1, -1]
    assert row["probe_signal"].tolist() == [-1, -1]
