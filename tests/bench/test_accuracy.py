"""How exactly each probing source measures (measurement manual 6.4, 7.1, 7.4)."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from hli_bench import Bench

FACE_MM = 12.3456
FEEDS = (100, 500, 2000, 6000)
CYCLE_MS = 1.0
INCREMENT_MM = 10.0 / 1_048_576
APPROACH_MM = {100: 0.5, 500: 0.5, 2000: 2.0, 6000: 6.0}
"""Long enough to be at feed when the face comes."""


def program(face_mm: float, feed: int) -> str:
    way = APPROACH_MM[feed]
    return (
        f"%accuracy\nN10 G00 G90 Z{face_mm + way:.4f}\nN20 G100 Z{face_mm - way:.4f} F{feed}\n"
        f"N30 G00 Z{face_mm + way:.4f}\nN40 M30\n"
    )


def settings(face_mm: float, source: str) -> dict[str, object]:
    return {
        "plant.probe.Z.face_mm": face_mm,
        "plant.probe.Z.material": "below",
        "axis.Z.kenngr.measure.signal": source,
        "axis.Z.start_mm": face_mm + 8.0,
    }


def measured(bench: Bench, face_mm: float, feed: int) -> float:
    result = bench.run(program(face_mm, feed))
    assert result.completed, result.errors
    (value,) = result.measurements
    return value.acs_mm


@pytest.mark.req("M-181", "M-183", "M-205")
@pytest.mark.parametrize("feed", FEEDS)
def test_timestamp_measures_within_a_tenth_of_a_micrometre(make, feed):
    bench = make(settings(FACE_MM, "PLC_TIMESTAMP"))

    assert abs(measured(bench, FACE_MM, feed) - FACE_MM) <= 1.0e-4 + 1e-9


@pytest.mark.req("M-006", "M-129", "M-202")
@pytest.mark.parametrize("feed", FEEDS)
def test_drive_latches_within_one_increment(make, feed):
    bench = make(settings(FACE_MM, "DRIVE"))
    value = measured(bench, FACE_MM, feed)
    latch = int(bench.kernel.rows.axis[2]["latch"][0])

    assert abs(latch * INCREMENT_MM - FACE_MM) <= INCREMENT_MM
    assert abs(value - FACE_MM) <= 1e-4 + 1e-9


@pytest.mark.req("M-015")
@pytest.mark.parametrize("source", ["PLC_TIMESTAMP", "DRIVE"])
def test_latched_value_holds_while_the_axis_accelerates(make, source):
    """The face comes in the middle of the ramp: the way back over a cubic is exact there, too."""
    bench = make(settings(FACE_MM, source))
    result = bench.run(f"%p\nN10 G00 Z{FACE_MM + 0.7:.4f}\nN20 G100 Z{FACE_MM - 6:.4f} F6000\nN30 M30\n")

    assert abs(result.measurements[0].acs_mm - FACE_MM) <= 2.0e-4


def random_faces(bench: Bench, count: int, seed: int) -> Iterator[float]:
    """Move the workpiece to random places, one after the other."""
    machine = bench.engine.link.rows
    (face,) = [row for row in machine.switch if row["axis"] == 2 and row["signal"] == 0]
    per_rad = 10.0 / math.tau
    for place in np.random.default_rng(seed).uniform(12.0, 13.0, count):
        face["high"] = place / per_rad
        yield float(place)


@pytest.mark.req("M-135", "M-137")
@pytest.mark.parametrize("period_ms", [1, 4])
def test_plc_is_off_by_what_its_sampling_explains(make, probing, period_ms):
    """Level at the next PLC tick, acted on one kernel cycle later: (T, T + PLC period] late, evenly spread."""
    feed, count = 6000, 200
    bench = make(settings(12.5, "PLC"), plc=[probing((3,), period_us=1000 * period_ms)])
    bench.start_up()
    late = []
    for place in random_faces(bench, count, seed=period_ms):
        result = bench.run(program(12.5, feed))
        late.append((place - result.measurements[0].acs_mm) / (feed / 60_000.0))
    delays = np.sort(late)
    rounding = 0.01  # 1 um of 100 um a millisecond: what is left of the ramp in the drive's speed
    longest = CYCLE_MS + period_ms
    evenly = (np.arange(count) + 0.5) / count
    spread = (delays - CYCLE_MS) / period_ms

    assert delays[0] >= CYCLE_MS - rounding
    assert delays[-1] <= longest + rounding
    assert np.mean(delays) == pytest.approx(CYCLE_MS + period_ms / 2, abs=0.07 * period_ms)
    assert np.max(np.abs(spread - evenly)) < 0.115, "not spread evenly (Kolmogorov-Smirnov, 1 %)"


@pytest.mark.req("M-135", "M-137")
@pytest.mark.parametrize("feed", FEEDS)
def test_deviation_of_the_plc_grows_with_the_feed(make, feed):
    """The same delay, so the way is feed times delay: never more than feed x (cycle + PLC period)."""
    bench = make(settings(FACE_MM, "PLC"))
    deviation = FACE_MM - measured(bench, FACE_MM, feed)
    per_ms = feed / 60_000.0

    assert per_ms * CYCLE_MS - 2e-4 <= deviation <= per_ms * 2.0 * CYCLE_MS + 2e-4


@pytest.mark.req("M-006", "M-136")
def test_timestamp_does_not_depend_on_where_in_the_cycle_the_edge_comes(make, probing):
    bench = make(settings(12.5, "PLC_TIMESTAMP"), plc=[probing((3,))])
    bench.start_up()
    worst = 0.0
    for place in random_faces(bench, 40, seed=7):
        result = bench.run(program(12.5, 6000))
        worst = max(worst, abs(result.measurements[0].acs_mm - place))

    assert worst <= 1.5e-4, "0.1 um and the rounding of the value to it"
