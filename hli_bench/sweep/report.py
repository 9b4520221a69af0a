"""The report of a campaign: how each metric is distributed over each varied key, one HTML page."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from hli_bench.scope.charts import HEIGHT, WIDTH, Chart, Floats, Panel, TimeAxis
from hli_bench.scope.style import CSS
from hli_bench.sweep.campaign import Campaign
from hli_bench.sweep.draws import Plain

MOST_GROUPS: Final = 12
"""A key with more values than this is shown in `BINS` ranges."""
BINS: Final = 8
MOST_TICKS: Final = 300
"""Runs of a group that get a stroke each; of more, so many evenly spread over their order."""
MOST_ERRORS: Final = 20
STYLE: Final = """
.box { fill: var(--position); opacity: .25; stroke: none; } .whisker { stroke: var(--position); fill: none;
  stroke-width: 1.5; } .median { stroke: var(--mark); stroke-width: 2.5; } .run { stroke: var(--soft); opacity: .35; }
.cell { white-space: nowrap; }
"""


@dataclass(frozen=True, slots=True)
class Group:
    """Runs that have something in common: its name and the rows they are."""

    name: str
    rows: Any


def report_html(campaign: Campaign, table: Any) -> str:
    """Return the page; `table` has the columns of the campaign."""
    columns = {name: table.column(name).to_numpy(zero_copy_only=False) for name in table.column_names}
    every = np.ones(table.num_rows, dtype=np.bool_)
    title = f"{Path(campaign.file).stem}: {campaign.job.program_name} on {Path(campaign.job.machine).name}"
    body = [_header(campaign, columns, title), _errors(columns)]
    body += [_metric(campaign, columns, name, every) for name in campaign.metrics]
    body.append(_settings(campaign))
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{CSS}{STYLE}</style></head><body>{''.join(body)}</body></html>\n"
    )


# -- groups -----------------------------------------------------------------------------------------------


def groups(campaign: Campaign, columns: Mapping[str, Any], key: str) -> list[Group]:
    """Return the runs by the value of a key: in the order of the grid, or in ranges of a random number."""
    column = columns[key]
    values: Sequence[Plain] = campaign.grid.get(key) or sorted(set(column.tolist()))
    if len(values) <= MOST_GROUPS or isinstance(values[0], str):
        return [Group(_shown(value), column == value) for value in values]
    edges = np.linspace(float(column.min()), float(column.max()), BINS + 1)
    place = np.clip(np.searchsorted(edges, column, side="right") - 1, 0, BINS - 1)
    names = [f"{low:g} .. {high:g}" for low, high in pairwise(edges)]
    return [Group(name, place == number) for number, name in enumerate(names)]


def divider(campaign: Campaign) -> str | None:
    """Return the key that divides the report: `report.by`, or the first of the grid with texts as values."""
    if campaign.by is not None:
        return campaign.by
    words = [key for key, values in campaign.grid.items() if isinstance(values[0], str) and len(values) > 1]
    return words[0] if words else None


# -- charts -----------------------------------------------------------------------------------------------


def _metric(campaign: Campaign, columns: Mapping[str, Any], name: str, every: Any) -> str:
    """Return the section of a metric: by the dividing key, then within each of its values by the others."""
    by = divider(campaign)
    others = [key for key in campaign.varied if key != by]
    html = f'<section><h2>{escape(name)}</h2><p class="soft">{escape(campaign.metrics[name])}</p>'
    if by is None:
        return html + "".join(_by_key(campaign, columns, name, key, every) for key in others) + "</section>"
    html += _by_key(campaign, columns, name, by, every)
    for group in groups(campaign, columns, by):
        inner = "".join(_by_key(campaign, columns, name, key, group.rows) for key in others)
        html += f"<h3>{escape(by)} = {escape(group.name)}</h3>{inner}" if inner else ""
    return html + "</section>"


def _by_key(campaign: Campaign, columns: Mapping[str, Any], name: str, key: str, rows: Any) -> str:
    """Return figures and chart of a metric by the values of a key, of these rows only."""
    measured = ~np.isnan(columns[name])
    parts = [
        (group.name, int(np.count_nonzero(group.rows & rows)), columns[name][group.rows & rows & measured])
        for group in groups(campaign, columns, key)
    ]
    parts = [part for part in parts if part[1]]
    heads = (escape(key), "runs", "without", "mean", "sigma", "min", "median", "max")
    cells = "".join(
        f'<tr><td class="cell">{escape(group)}</td><td class="n">{count}</td>'
        f'<td class="n">{count - len(values)}</td>{"".join(_figures(values))}</tr>'
        for group, count, values in parts
    )
    head = "".join(f'<th class="{"n" if at else "t"}">{text}</th>' for at, text in enumerate(heads))
    table = f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{cells}</tbody></table></div>'
    return table + _chart(name, [(group, values) for group, _, values in parts if len(values)])


def _figures(values: Floats) -> Iterator[str]:
    if not len(values):
        yield '<td class="n">\N{EN DASH}</td>' * 5
        return
    sigma = float(values.std(ddof=1)) if len(values) > 1 else 0.0
    for figure in (values.mean(), sigma, values.min(), np.median(values), values.max()):
        yield f'<td class="n">{_shown(float(figure))}</td>'


def _chart(name: str, parts: Sequence[tuple[str, Floats]]) -> str:
    """Return box plots, one below the other over one axis: quarters, median, all values as strokes."""
    if not parts:
        return ""
    low = min(float(values.min()) for _, values in parts)
    high = max(float(values.max()) for _, values in parts)
    air = (high - low) * 0.04 or abs(high) * 1e-3 or 1.0
    axis = TimeAxis(low - air, high + air, "", name)
    panels = [Panel(f"<b>{escape(group)}</b>", 1.3, _box(axis, values)) for group, values in parts]
    return Chart(axis, bare=True, panels=panels).html()


def _box(axis: TimeAxis, values: Floats) -> str:
    least, first, median, third, most = (
        axis.x(float(at)) for at in np.percentile(values, (0, 25, 50, 75, 100))
    )
    shown = values[np.unique(np.linspace(0, len(values) - 1, MOST_TICKS).astype(np.int64))]
    top, bottom, middle = HEIGHT * 0.2, HEIGHT * 0.8, HEIGHT / 2
    # A box of no width would not be seen.
    width = max(third - first, WIDTH / 500)
    strokes = "".join(f"M{axis.x(float(value)):.1f} {HEIGHT * 0.3:.0f}V{HEIGHT * 0.7:.0f}" for value in shown)
    return (
        f'<path class="run" d="{strokes}"/>'
        f'<path class="whisker" d="M{least:.1f} {middle:.0f}H{most:.1f}M{least:.1f} {top:.0f}V{bottom:.0f}'
        f'M{most:.1f} {top:.0f}V{bottom:.0f}"/>'
        f'<path class="box" d="M{first:.1f} {top:.0f}h{width:.1f}V{bottom:.0f}h-{width:.1f}Z"/>'
        f'<path class="median" d="M{median:.1f} {top:.0f}V{bottom:.0f}"/>'
    )


# -- texts ------------------------------------------------------------------------------------------------


def _header(campaign: Campaign, columns: Mapping[str, Any], title: str) -> str:
    errors = int(np.count_nonzero(columns["status"] != "completed"))
    kind = "error" if errors else "completed"
    facts = (("Runs", str(campaign.runs)), ("Seed", str(campaign.seed)), ("Repeats", str(campaign.repeats)))
    items = "".join(f"<li><span>{name}</span>{value}</li>" for name, value in facts)
    return (
        f'<header><h1>{escape(title)}</h1><ul class="facts">{items}'
        f'<li><span>Ended with an error</span><b class="status {kind}">{errors}</b></li></ul></header>'
    )


def _errors(columns: Mapping[str, Any]) -> str:
    """Return the errors of the CNC with the number of runs that had them."""
    counts: dict[str, int] = {}
    for text in columns["errors"]:
        if text:
            counts[text] = counts.get(text, 0) + 1
    if not counts:
        return ""
    most = sorted(counts.items(), key=lambda item: -item[1])
    items = "".join(f"<li><b>{count}</b>{escape(text)}</li>" for text, count in most[:MOST_ERRORS])
    rest = f'<p class="soft">{len(most) - MOST_ERRORS} other texts</p>' if len(most) > MOST_ERRORS else ""
    return f'<section><h2>Errors by number of runs</h2><ul class="texts">{items}</ul>{rest}</section>'


def _settings(campaign: Campaign) -> str:
    rows = [(key, _shown(value)) for key, value in campaign.fixed.items()]
    rows += [(key, "one of " + ", ".join(map(_shown, values))) for key, values in campaign.grid.items()]
    rows += [(key, f"random, {of}") for key, of in campaign.random.items()]
    cells = "".join(f"<tr><td>{escape(key)}</td><td>{escape(text)}</td></tr>" for key, text in rows)
    return (
        f'<section><h2>Settings</h2><div class="wide"><table><tbody>{cells}</tbody></table></div></section>'
    )


def _shown(value: Plain) -> str:
    """Return a value as the report shows it."""
    if isinstance(value, float):
        return f"{value:.6g}".replace("-", "\N{MINUS SIGN}")
    return str(value).lower() if isinstance(value, bool) else str(value)
