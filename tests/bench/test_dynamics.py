"""Accelerations of a measuring run, before and after the event, linear slopes (measurement manual 2.1)."""

import numpy as np
import pytest

from hli_bench.kernel.records import MeasuredValue

SLOPE = "axis.Z.getriebe[0].lslope_profil"
RAPID, RAPID_DOWN, FEED, FEED_DOWN, FEEDHOLD = 1500, 1200, 700, 500, 2600
BASE = {
    "plant.probe.Z.face_mm": 100.0,
    "plant.probe.Z.material": "below",
    "axis.Z.start_mm": 130.0,
    "axis.Z.kenngr.measure.signal": "DRIVE",
    f"{SLOPE}.a_grenz_stufe_1": RAPID,
    f"{SLOPE}.a_grenz_stufe_2": RAPID,
    f"{SLOPE}.d_grenz_stufe_1": RAPID_DOWN,
    f"{SLOPE}.d_grenz_stufe_2": RAPID_DOWN,
    f"{SLOPE}.a_stufe_1": FEED,
    f"{SLOPE}.a_stufe_2": FEED,
    f"{SLOPE}.d_stufe_1": FEED_DOWN,
    f"{SLOPE}.d_stufe_2": FEED_DOWN,
    f"{SLOPE}.a_feedh": FEEDHOLD,
    "axis.Z.getriebe[0].dynamik.a_max": 4000,
}
Z = 2
T = 1e-3

# P-CHAN-00296, 00214, 00097 -> acceleration of the profile, deceleration of the profile, after the event
TABLE = [
    pytest.param(0, 0, 0, RAPID, RAPID_DOWN, RAPID_DOWN, marks=pytest.mark.req("M-020"), id="row-1"),
    pytest.param(0, 0, 1, RAPID, RAPID_DOWN, FEEDHOLD, marks=pytest.mark.req("M-021"), id="row-2"),
    pytest.param(0, 1, 0, RAPID, RAPID_DOWN, RAPID_DOWN, marks=pytest.mark.req("M-022"), id="row-3"),
    pytest.param(0, 1, 1, RAPID, RAPID_DOWN, RAPID_DOWN, marks=pytest.mark.req("M-022"), id="row-3x"),
    pytest.param(1, 0, 0, FEED, FEED_DOWN, FEEDHOLD, marks=pytest.mark.req("M-023"), id="row-4"),
    pytest.param(1, 0, 1, FEED, FEED_DOWN, FEEDHOLD, marks=pytest.mark.req("M-023"), id="row-4x"),
    pytest.param(1, 1, 0, FEED, FEED_DOWN, FEEDHOLD, marks=pytest.mark.req("M-023"), id="row-4y"),
    pytest.param(1, 1, 1, FEED, FEED_DOWN, FEEDHOLD, marks=pytest.mark.req("M-023"), id="row-4z"),
]


def channel(std: int, deceleration: int, current: int) -> dict[str, object]:
    return {
        "channel.meas_use_std_dynamic": std,
        "channel.meas_deceleration_mode": deceleration,
        "channel.use_drive_curr_limit": current,
    }


def rates(velocity: np.ndarray) -> np.ndarray:
    return np.diff(velocity) / T


def steady(changes: np.ndarray) -> float:
    """Return the one rate of a ramp: of its inner cycles, which no ramp begin or end falls into."""
    inner = changes[2:-2]
    assert np.ptp(inner) < 1.0
    return float(np.mean(inner))


@pytest.mark.req("M-014", "M-015", "M-190", "M-193", "M-194", "M-197", "M-198")
@pytest.mark.parametrize(("std", "mode", "current", "up", "down", "after"), TABLE)
def test_row_of_the_table(make, recorder, std, mode, current, up, down, after):
    bench = make(BASE | channel(std, mode, current), recorder=recorder)
    result = bench.run("%p\nN10 G100 Z50 F6000\nN20 M30\n")
    speed = -recorder.velocity(Z)
    change = rates(speed)
    (found,) = recorder.cycle_of(MeasuredValue)

    assert result.completed
    accelerating = np.flatnonzero(change[: found - 3] > 50.0)
    braking = np.flatnonzero(change < -50.0)
    assert steady(change[accelerating]) == pytest.approx(up, abs=1.0)
    assert steady(change[braking]) == pytest.approx(-after, abs=1.0)
    assert braking[0] >= found - 3, "the ramp begins with the event"


@pytest.mark.req("M-014", "M-015")
@pytest.mark.parametrize(("std", "mode", "current", "up", "down", "after"), TABLE)
def test_profile_brakes_to_the_target_without_an_event(make, recorder, std, mode, current, up, down, after):
    bench = make(BASE | channel(std, mode, current) | {"plant.probe.Z.face_mm": -200.0}, recorder=recorder)
    bench.run("%p\nN10 G100 Z100 F6000\nN20 M30\n")
    change = rates(-recorder.velocity(Z))

    assert steady(change[np.flatnonzero(change < -50.0)]) == pytest.approx(-down, abs=1.0)
    assert recorder.column("command", Z)[-1] == 1_000_000.0


@pytest.mark.req("M-020", "M-023")
def test_two_steps_change_over_at_their_speed(make, recorder):
    """P-AXIS-00005 below and 00006 above the changeover speed P-AXIS-00211."""
    settings = BASE | {
        f"{SLOPE}.a_grenz_stufe_1": 2000,
        f"{SLOPE}.a_grenz_stufe_2": 800,
        f"{SLOPE}.d_grenz_stufe_1": 0,
        f"{SLOPE}.d_grenz_stufe_2": 0,
        f"{SLOPE}.vb_grenz_stufe_1_2": 60_000,
    }
    bench = make(settings, recorder=recorder)
    bench.run("%p\nN10 G100 Z50 F6000\nN20 M30\n")
    speed = -recorder.velocity(Z)
    change = rates(speed)
    up = change[: np.argmax(speed)]
    below, above = speed[: np.argmax(speed)] < 57.0, speed[: np.argmax(speed)] > 61.0

    assert np.all(np.abs(up[below & (speed[: len(up)] > 3.0)] - 2000.0) < 1.0)
    rising = up[above & (up > 50.0)][:-1]
    assert np.all(np.abs(rising - 800.0) < 1.0)


@pytest.mark.req("M-025", "M-014")
def test_feed_is_that_of_the_f_word_and_the_slower_axis_sets_the_path(make, recorder):
    """X allows half the acceleration: a run of both under 45 degrees keeps to it."""
    settings = BASE | {f"axis.X.getriebe[0].lslope_profil.a_grenz_stufe_{n}": RAPID // 2 for n in (1, 2)}
    settings |= {"axis.X.kenngr.measure.signal": "DRIVE"}
    bench = make(settings, recorder=recorder)
    bench.run("%p\nN10 G100 X-25 Z105 F3000\nN20 M30\n")
    x, z = -recorder.velocity(0), -recorder.velocity(Z)

    assert np.hypot(x, z).max() == pytest.approx(50.0, abs=1e-6)
    assert rates(x).max() == pytest.approx(RAPID / 2, abs=1.0)
    assert rates(z).max() == pytest.approx(RAPID / 2, abs=1.0)
