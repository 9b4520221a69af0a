import pytest

from hli_bench.bench.result import Error, Measurement, Result
from hli_bench.sweep.expressions import metric

RESULT = Result(
    program="p",
    status="completed",
    messages=[],
    errors=[Error(50886, "error", "Z", "N10", "text", {"speed": 7, "word": "x"})],
    variables={"V.A.MESS.Z": 100.5},
    measurements=[
        Measurement("Z", "N1", "PLC", 100.0, 99.0, 12, "POS", 100.0, 99.0, "mm"),
        Measurement("Z", "N2", "PLC", 103.0, 99.0, 15, "POS", 103.0, 99.0, "mm"),
    ],
    homing=[],
    sim_s=1.5,
    wall_s=0.1,
    cycles=1500,
)
SETTINGS = {"plant.probe.Z.face_mm": 99.5, "plc[0].period_us": 2000, "axis.Z.drive": "m"}
KEYS = frozenset(SETTINGS)


def value(text):
    return metric(text, KEYS)(RESULT, SETTINGS)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1000 * (measurements.0.acs_mm - settings['plant.probe.Z.face_mm'])", 500.0),
        ("measurements[-1].acs_mm - measurements.1.acs_mm", 0.0),
        ("measurements.1.dc_ns - measurements.0.dc_ns", 3.0),
        ("abs(-cycles) / 3.0", 500.0),
        ("max(1, sim_s, 0.5) + min(2, 3)", 3.5),
        ("len(errors) + 0.5", 1.5),
        ("variables['V.A.MESS.Z']", 100.5),
        ("errors.0.values['speed']", 7.0),
        ("settings['plc[0].period_us'] / 1000", 2.0),
    ],
)
def test_values(text, expected):
    assert value(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "measurements.7.acs_mm",
        "homing.0.position_mm",
        "variables['V.A.MESS.X']",
        "cycles / (sim_s - 1.5)",
        "errors.0.values['word']",
        "settings['axis.Z.drive'] + 1",
        "1e200 * 1e200 - 1e200 * 1e200",
    ],
)
def test_what_a_run_does_not_have_is_empty(text):
    assert value(text) is None


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("measurements.0.mcs", "acs_mm, pcs_mm"),
        ("measurement.0.acs_mm", "measurements"),
        ("measurements.acs_mm", "a number in brackets"),
        ("variables.A", "a quoted name in brackets"),
        ("settings['face']", "plant.probe.Z.face_mm"),
        ("status", "is no number"),
        ("measurements.0.axis + 1", "is no number"),
        ("measurements", "is no number"),
        ("wall_s", "differs from one execution"),
        ("1 +", "no expression"),
        ("cycles ** 2", "expected numbers"),
        ("__import__('os').system('true')", "expected numbers"),
        ("cycles.__class__", "has no '__class__'"),
        ("(lambda: 1)()", "expected numbers"),
        ("[x for x in measurements]", "expected numbers"),
        ("measurements['a'].acs_mm", "a whole number"),
        ("abs(1, 2)", "one number"),
        ("len(cycles)", "one list"),
        ("1+" * 600 + "1", "longer than"),
    ],
)
def test_what_is_no_metric_says_why(text, named):
    with pytest.raises(ValueError, match=named.replace("[", r"\[")):
        metric(text, KEYS)
