"""Scales and shapes of the charts."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from hli_bench.scope.charts import (
    COLUMNS,
    WIDTH,
    Chart,
    TimeAxis,
    curve,
    digital,
    instants,
    labels,
    steps,
    words,
)

AXIS = TimeAxis(-2.0, 8.0, "ms", "ms after the edge")


def points(shapes: str) -> list[tuple[float, float]]:
    data = re.search(r'd="M([^"Z]*)', shapes)
    assert data
    return [(float(x), float(y)) for x, y in (point.split() for point in data[1].split("L"))]


@pytest.mark.parametrize(
    ("low", "high", "count", "expected"),
    [
        (0.0, 10.0, 5, [0, 2, 4, 6, 8, 10]),
        (-0.05, 0.05, 4, [-0.05, 0, 0.05]),
        (99.97, 100.03, 3, [99.98, 100.0, 100.02]),
        (0.0, 1e5, 4, [0, 5e4, 1e5]),
        (3.0, 3.0, 4, [3.0]),
    ],
)
def test_ticks_are_round_numbers(low: float, high: float, count: int, expected: list[float]) -> None:
    assert steps(low, high, count) == pytest.approx(expected)


def test_labels_have_the_decimals_of_their_distance_and_a_real_minus() -> None:
    assert labels([-0.05, 0.0, 0.05]) == ["\N{MINUS SIGN}0.05", "0.00", "0.05"]
    assert labels([0.0, 50_000.0]) == ["0", "50000"]
    assert labels([-0.0, 1.0]) == ["0", "1"]


def test_a_curve_keeps_its_corners() -> None:
    at = np.array([-2.0, 0.0, 2.0, 4.0, 8.0])
    y = np.array([0.0, 0.0, 0.0, 1.0, 1.0])
    drawn = points(curve("y", "position", AXIS, at, y, y).shapes)
    top, bottom = min(py for _, py in drawn), max(py for _, py in drawn)
    assert drawn[:4] == [(0, bottom), (400, bottom), (600, top), (WIDTH, top)]
    assert max(px for px, _ in drawn) == WIDTH


def test_a_long_curve_keeps_its_spikes_in_few_columns() -> None:
    at = np.linspace(-2, 8, 50_000)
    y = np.random.default_rng(5).normal(size=50_000)
    y[31_000] = 50.0
    panel = curve("y", "position", AXIS, at, y, y)
    drawn = points(panel.shapes)
    assert len(drawn) <= 2 * COLUMNS
    assert min(py for _, py in drawn) == pytest.approx(100 * 0.08 / 1.16, abs=1)


def test_a_level_changes_at_the_instant_of_its_edge() -> None:
    panel = digital("probe", AXIS, [(-3.0, True), (0.0, False), (3.0, True), (9.0, False)], start=False)
    line = points(panel.shapes.rpartition("<path")[2])
    assert line == [(0, 12), (200, 12), (200, 88), (500, 88), (500, 12), (WIDTH, 12)]


def test_a_whole_chart_is_well_formed_and_escapes_words() -> None:
    at = np.linspace(-2, 8, 11)
    chart = Chart(AXIS, marks=[0.5, 99.0])
    chart.panels = [
        curve("<b>Position</b> mm", "position", AXIS, at, at, at, 5.0, level=3.0),
        instants("PLC", AXIS, [-5, 0, 1], [1]),
        words("Drive", AXIS, [(-4.0, "<0001h>"), (2.0, "0003h")]),
    ]
    html = chart.html()
    figure = ElementTree.fromstring(html)
    assert len(figure.findall(".//svg")) == 3
    assert html.count('class="mark"') == 3
    assert "&lt;0001h&gt;" in html
    assert figure.findtext("p[@class='unit']") == "ms after the edge"
