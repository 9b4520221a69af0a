"""A terminal whose clock is off: what it latches is off by as much, and so is what PLC_TIMESTAMP measures."""

import pytest

from hli_bench import Bench

PROGRAM = "N05 #MEAS MODE[1]\nN10 G90 G01 Z295 F6000\nN20 G100 Z200 F6000\nN30 M30"
SETTINGS = {
    "plant.probe.Z.face_mm": 250.0,
    "plant.probe.Z.material": "below",
    "axis.Z.kenngr.measure.signal": "PLC_TIMESTAMP",
}


@pytest.mark.parametrize("skew_us", [-500, 0, 7, 500])
def test_the_measured_value_is_off_by_the_way_of_the_skew(skew_us):
    with Bench("demo", {**SETTINGS, "terminal.probe.clock_skew_ns": skew_us * 1000}) as bench:
        result = bench.run(PROGRAM)
    # Z moves down with 0.1 um a us: a clock that is ahead takes a position farther down.
    assert result.measurements[0].acs_mm == pytest.approx(250.0 - skew_us * 1e-4, abs=2e-4)
