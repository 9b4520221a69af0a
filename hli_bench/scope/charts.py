"""Charts as HTML with stretched SVG inside: shapes follow the width of the page, texts keep their size."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import pairwise
from math import ceil, floor, log10
from typing import Final

import numpy as np
from numpy.typing import NDArray

WIDTH: Final = 1000
HEIGHT: Final = 100
COLUMNS: Final = 900
"""A curve is drawn in at most so many columns, each from its least to its greatest value."""

Floats = NDArray[np.float64]


def steps(low: float, high: float, count: int) -> list[float]:
    """Return about `count` round numbers (1, 2, 5 times a power of ten) in [low, high]."""
    if not high > low:
        return [low]
    rough = (high - low) / count
    power = 10.0 ** floor(log10(rough))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= rough * 0.999)
    return [
        round(number * step, 12) for number in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)
    ]


def labels(ticks: Sequence[float]) -> list[str]:
    """Return tick labels with as many decimals as their distance needs."""
    step = min((after - before for before, after in pairwise(ticks)), default=1.0)
    decimals = max(0, -floor(log10(step) + 1e-9))
    return [f"{tick + 0.0:.{decimals}f}".replace("-", "\N{MINUS SIGN}") for tick in ticks]


@dataclass(frozen=True, slots=True)
class TimeAxis:
    """The common x axis of a chart: shows `low` .. `high` in `unit`."""

    low: float
    high: float
    unit: str
    title: str

    def x(self, at: float) -> float:
        """Return the place of a time, 0..WIDTH."""
        return (at - self.low) / (self.high - self.low) * WIDTH

    @property
    def ticks(self) -> list[float]:
        """Return round times."""
        return steps(self.low, self.high, 8)

    def html(self) -> str:
        """Return labels below the last panel; every other one may go on a phone."""
        spans = []
        for number, (tick, text) in enumerate(zip(self.ticks, labels(self.ticks), strict=True)):
            share = self.x(tick) / WIDTH
            place = "first " if share < 0.03 else "last " if share > 0.97 else ""
            odd = "odd" if number % 2 else ""
            spans.append(f'<span class="{place}{odd}" style="left:{share:.2%}">{text}</span>')
        return f'<div class="x">{"".join(spans)}</div><p class="unit">{escape(self.title)}</p>'


@dataclass(frozen=True, slots=True)
class Panel:
    """One strip of a chart: `shapes` are SVG, `y` the labelled values with their share of the height from the top."""

    name: str
    height_rem: float
    shapes: str
    y: Sequence[tuple[float, str]] = ()
    texts: str = ""


@dataclass(slots=True)
class Chart:
    """Panels over one time axis; `bare` without room for y labels; `marks` are times of dashed lines."""

    axis: TimeAxis
    bare: bool = False
    marks: Sequence[float] = ()
    panels: list[Panel] = field(default_factory=list)

    def html(self) -> str:
        """Return the figure."""
        grid = "".join(_vertical("grid", self.axis.x(tick)) for tick in self.axis.ticks)
        marks = "".join(
            _vertical("mark", self.axis.x(mark))
            for mark in self.marks
            if self.axis.low <= mark <= self.axis.high
        )
        panels = "".join(self._panel(panel, grid, marks) for panel in self.panels)
        return f'<figure class="{"bare" if self.bare else "chart"}">{panels}{self.axis.html()}</figure>'

    def _panel(self, panel: Panel, grid: str, marks: str) -> str:
        y = "".join(f'<span style="top:{share:.2%}">{text}</span>' for share, text in panel.y)
        lines = "".join(_horizontal("grid", share * HEIGHT) for share, _ in panel.y)
        return (
            f'<div class="name">{panel.name}</div><div class="panel" style="height:{panel.height_rem}rem">'
            + ("" if self.bare else f'<div class="y">{y}</div>')
            + f'<div class="plot"><svg viewBox="0 0 {WIDTH} {HEIGHT}" preserveAspectRatio="none" aria-hidden="true">'
            f"{grid}{lines}{panel.shapes}{marks}</svg>{panel.texts}</div></div>"
        )


def _vertical(kind: str, x: float) -> str:
    return f'<path class="{kind}" d="M{x:.1f} 0V{HEIGHT}"/>'


def _horizontal(kind: str, y: float) -> str:
    return f'<path class="{kind}" d="M0 {y:.1f}H{WIDTH}"/>'


def curve(
    name: str,
    kind: str,
    axis: TimeAxis,
    at: Floats,
    low: Floats,
    high: Floats,
    height_rem: float = 8.0,
    level: float | None = None,
) -> Panel:
    """Return a panel with a curve that spans `low` .. `high` at the times `at`; `level` is a line across."""
    shown = (at >= axis.low) & (at <= axis.high)
    at, low, high = at[shown], low[shown], high[shown]
    bottom, top = _range(low, high)
    at, low, high = _columns(at, low, high)
    scale = HEIGHT / (top - bottom)
    upper = [(axis.x(x), (top - y) * scale) for x, y in zip(at, high, strict=True)]
    lower = [(axis.x(x), (top - y) * scale) for x, y in zip(at[::-1], low[::-1], strict=True)]
    shapes = _path(kind, upper, lower)
    if level is not None:
        shapes += _horizontal("level", (top - level) * scale)
    ticks = [tick for tick in steps(bottom, top, 4) if bottom <= tick <= top]
    y = [((top - tick) / (top - bottom), text) for tick, text in zip(ticks, labels(ticks), strict=True)]
    return Panel(name, height_rem, shapes, y)


def _range(low: Floats, high: Floats) -> tuple[float, float]:
    """Return the y range: the values with a little air."""
    bottom, top = (float(low.min()), float(high.max())) if len(low) else (0.0, 1.0)
    air = (top - bottom) * 0.08 or 0.001
    return bottom - air, top + air


def _columns(at: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats, Floats]:
    if len(at) <= COLUMNS:
        return at, low, high
    starts = np.unique(np.linspace(0, len(at) - 1, COLUMNS).astype(np.int64))
    return at[starts], np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)


def _path(kind: str, *lines: Iterable[tuple[float, float]]) -> str:
    """Return a path through one line, or the area between two; points on a level line are left out."""
    data = "L".join(f"{x} {y}" for line in lines for x, y in _corners(line))
    return f'<path class="{kind}" d="M{data}{"Z" if len(lines) > 1 else ""}"/>' if data else ""


def _corners(line: Iterable[tuple[float, float]]) -> list[tuple[str, str]]:
    kept: list[tuple[str, str]] = []
    for x, y in line:
        point = (f"{x:.1f}", f"{y:.2f}")
        if len(kept) > 1 and kept[-1][1] == kept[-2][1] == point[1]:
            kept[-1] = point
        else:
            kept.append(point)
    return kept


def digital(
    name: str, axis: TimeAxis, changes: Iterable[tuple[float, bool]], *, start: bool, height_rem: float = 1.5
) -> Panel:
    """Return a panel with a level over time: `start` at the left, then `changes` in order."""
    top, bottom = HEIGHT * 0.12, HEIGHT * 0.88
    spans: list[tuple[float, float, bool]] = []
    begin, level = axis.low, start
    for at, value in changes:
        if at <= axis.low or at > axis.high:
            level = value if at <= axis.low else level
            continue
        spans.append((begin, at, level))
        begin, level = at, value
    spans.append((begin, axis.high, level))
    points: list[tuple[float, float]] = []
    fills = ""
    for left, right, on in spans:
        y = top if on else bottom
        x, end = axis.x(left), axis.x(right)
        points += [(x, y), (end, y)]
        if on:
            fills += f'<path class="high" d="M{x:.1f} {top:.0f}H{end:.1f}V{bottom:.0f}H{x:.1f}Z"/>'
    return Panel(name, height_rem, fills + _path("signal", points))


def words(name: str, axis: TimeAxis, values: Sequence[tuple[float, str]], height_rem: float = 1.5) -> Panel:
    """Return a panel with a word that changes: (from when on, text), the first at or before the left end."""
    shapes = _horizontal("signal", HEIGHT * 0.12) + _horizontal("signal", HEIGHT * 0.88)
    texts = ""
    for at, text in values:
        x = axis.x(max(at, axis.low))
        shapes += (
            f'<path class="signal" d="M{x:.1f} {HEIGHT * 0.12:.0f}V{HEIGHT * 0.88:.0f}"/>' if x > 0 else ""
        )
        texts += f'<span class="value" style="left:{x / WIDTH:.2%}">{escape(text)}</span>'
    return Panel(name, height_rem, shapes, texts=texts)


def instants(
    name: str, axis: TimeAxis, ticks: Iterable[float], wrote: Iterable[float] = (), height_rem: float = 1.1
) -> Panel:
    """Return a panel with a stroke at each instant; those of `wrote` stand out."""
    shapes = "".join(_vertical("tick", axis.x(at)) for at in ticks if axis.low <= at <= axis.high)
    shapes += "".join(_vertical("wrote", axis.x(at)) for at in wrote if axis.low <= at <= axis.high)
    return Panel(name, height_rem, shapes)
