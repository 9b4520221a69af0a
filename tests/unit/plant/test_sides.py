"""Faces of several main axes bound one body."""

import pytest

from hli_bench import Bench

CORNER = {
    "plant.probe.X.face_mm": 30,
    "plant.probe.X.material": "above",
    "plant.probe.Z.face_mm": 100,
    "plant.probe.Z.material": "below",
    "axis.Z.start_mm": 400.0,
}
ALONG_X = "N10 G90 G01 X0 F20000\nN20 Z{z}\nN30 G100 X60 F2000\nN40 M30\n"
DOWN = "N10 G90 G01 X{x} F20000\nN20 G100 Z80 F3000\nN30 M30\n"


def measured(program: str, **more: object) -> list[tuple[str, float]]:
    with Bench("demo", CORNER | {key.replace("__", "."): value for key, value in more.items()}) as bench:
        result = bench.run(program)
    assert result.completed, result.errors
    assert len(result.measurements) + len(result.unmeasured) == 1
    return [(one.axis, one.acs_mm) for one in result.measurements]


@pytest.mark.parametrize(("z", "found"), [(400, []), (100.1, []), (99.9, [("X", 30.0)]), (0, [("X", 30.0)])])
def test_a_side_is_touched_beside_the_body_only(z: float, found: list[tuple[str, float]]) -> None:
    assert measured(ALONG_X.format(z=z)) == found


@pytest.mark.parametrize(("x", "found"), [(29.9, []), (30.1, [("Z", 100.0)]), (300, [("Z", 100.0)])])
def test_the_top_is_touched_above_the_body_only(x: float, found: list[tuple[str, float]]) -> None:
    assert measured(DOWN.format(x=x)) == found


def test_a_probe_that_bounces_at_an_edge_of_the_body() -> None:
    ((axis, position),) = measured(ALONG_X.format(z=50), plant__probe__bounce_us=300)
    assert (axis, position) == ("X", pytest.approx(30.0, abs=0.02))


def test_a_face_of_another_axis_counts_alone() -> None:
    turned = {"plant__probe__A__face_mm": 30, "plant__probe__A__material": "above"}
    program = "N10 G90 G100 A60 F3000\nN20 M30\n"
    assert measured(program, **turned) == [("A", 30.0)]
