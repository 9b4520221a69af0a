"""The report of a run as one HTML page: no other file, no script, no network."""

from collections.abc import Mapping, Sequence
from html import escape
from math import log10
from typing import Any, Final

import numpy as np

from hli_bench.base.time import NS_PER_MS, NS_PER_S
from hli_bench.base.units import TENTH_UM_PER_MM, mm
from hli_bench.runtime.recording import AxisInfo, Recording, Window
from hli_bench.scope.charts import Chart, Floats, Panel, TimeAxis, curve, digital, instants, words
from hli_bench.scope.style import CSS

MOVED_MM: Final = 0.001
"""An axis whose command changed by less has not moved."""
OPEN_WINDOWS: Final = 3
"""Measuring events that are shown at once; the others unfold."""
PROBE: Final = "probe"
_PROBING_UNIT: Final = "lr_mc_control/probing_signal"
_LOOK_BACK_CYCLES: Final = 40
"""An edge older than so many cycles than the instant of a measured value is not its edge."""


def report_html(recording: Recording, result: Mapping[str, Any], machine_name: str) -> str:
    """Return the page; `result` is what `--result` writes."""
    title = f"{result['program']} on {machine_name}"
    parts = [
        _header(recording, result, machine_name),
        _measurements(recording, result["measurements"]),
        _unmeasured(result.get("unmeasured", ())),
        _homing(result["homing"]),
        _texts(result),
        _overview(recording),
        _events(recording),
        _lateness(result),
        _plcs(result.get("plcs", ())),
        _variables(result["variables"]),
    ]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{CSS}</style></head><body>{''.join(parts)}</body></html>\n"
    )


# -- tables -----------------------------------------------------------------------------------------------


def _header(recording: Recording, result: Mapping[str, Any], machine_name: str) -> str:
    status = str(result["status"])
    facts = [
        ("Machine", machine_name),
        ("Machine time", f"{result['sim_s']:.3f} s"),
        ("Cycles", f"{result['cycles']:,} of {recording.cycle_ns / NS_PER_MS:g} ms".replace(",", "\u202f")),
    ]
    if result.get("late_cycles"):
        facts.append(("Late cycles", str(result["late_cycles"])))
    items = "".join(f"<li><span>{name}</span>{escape(value)}</li>" for name, value in facts)
    return (
        f"<header><h1>{escape(str(result['program']))}</h1>"
        f'<ul class="facts"><li><span>Status</span><b class="status {escape(status)}">{escape(status)}</b></li>'
        f"{items}</ul></header>"
    )


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]], numbers: Sequence[int] = ()) -> str:
    """Return a table of texts; the columns in `numbers` are set to the right, one called Text is broken."""
    kinds = [
        "n" if column in numbers else "w" if text == "Text" else "t" for column, text in enumerate(heads)
    ]
    head = "".join(_cell("th", kind, text) for kind, text in zip(kinds, heads, strict=True))
    body = "".join(
        "<tr>" + "".join(_cell("td", kind, text) for kind, text in zip(kinds, row, strict=True)) + "</tr>"
        for row in rows
    )
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _cell(tag: str, kind: str, text: str) -> str:
    return f'<{tag} class="{kind}">{escape(text)}</{tag}>'


def _measurements(recording: Recording, measurements: Sequence[Mapping[str, Any]]) -> str:
    if not measurements:
        return ""
    heads = ("Block", "Axis", "ACS", "PCS", "", "Source", "Edge", "At machine time")
    units = {axis.name: axis.unit for axis in recording.axes}
    rows = [
        (
            one["block"],
            one["axis"],
            _number(one["acs_mm"]),
            _number(one["pcs_mm"]),
            units.get(one["axis"], ""),
            one["source"],
            one["edge"],
            _seconds(one["dc_ns"] - recording.dc_epoch_ns),
        )
        for one in measurements
    ]
    return f"<section><h2>Measured values</h2>{_table(heads, rows, numbers=(2, 3, 7))}</section>"


def _unmeasured(missed: Sequence[Mapping[str, Any]]) -> str:
    """Return the runs that gave an axis no value, in red: what the program printed of them is an older value."""
    if not missed:
        return ""
    rows = [(one["block"], one["axis"], f"measured nothing: {one['why']}") for one in missed]
    table = _table(("Block", "Axis", "Text"), rows).replace('<td class="w">', '<td class="w error">')
    return f"<section><h2>Not measured</h2>{table}</section>"


def _homing(homing: Sequence[Mapping[str, Any]]) -> str:
    if not homing:
        return ""
    rows = [(one["axis"], _number(one["position_mm"]), one["method"]) for one in homing]
    return f"<section><h2>Homing</h2>{_table(('Axis', 'Position', 'Method'), rows, numbers=(1,))}</section>"


def _texts(result: Mapping[str, Any]) -> str:
    html = ""
    if result["errors"]:
        heads = ("", "Number", "Axis", "Block", "Text")
        rows = [
            (one["severity"], str(one["id"]), one["axis"], one["block"], one["text"])
            for one in result["errors"]
        ]
        table = _table(heads, rows).replace('<td class="t">error</td>', '<td class="t error">error</td>')
        html += f"<section><h2>Errors and warnings</h2>{table}</section>"
    if result["messages"]:
        items = "".join(
            f"<li><b>{escape(one['block'])}</b>{escape(one['text'])}</li>" for one in result["messages"]
        )
        html += f'<section><h2>Messages</h2><ul class="texts">{items}</ul></section>'
    return html


def _variables(variables: Mapping[str, float]) -> str:
    if not variables:
        return ""
    rows = [(name, _number(value)) for name, value in variables.items()]
    table = _table(("Variable", "Value"), rows, numbers=(1,))
    return f"<details><summary>NC variables ({len(rows)})</summary>{table}</details>"


def _number(value: float) -> str:
    return f"{value:.4f}".replace("-", "\N{MINUS SIGN}")


def _seconds(ns: int) -> str:
    """Return an instant to the nanosecond, in groups of three digits."""
    seconds, rest = divmod(ns, NS_PER_S)
    digits = f"{rest:09d}"
    return f"{seconds}.{digits[:3]}\u202f{digits[3:6]}\u202f{digits[6:]} s"


# -- real pace --------------------------------------------------------------------------------------------


def _lateness(result: Mapping[str, Any]) -> str:
    """Return how a paced bench kept its cycle: a bar for each range of lateness, on a logarithmic scale."""
    bins = result.get("lateness_histogram")
    if not bins:
        return ""
    most = log10(max(one["cycles"] for one in bins) + 1)
    rows = "".join(
        f'<li><span class="soft">{_range(one)}</span><span class="bar">'
        f'<i style="width:{log10(one["cycles"] + 1) / most:.1%}"></i></span><span>{one["cycles"]}</span></li>'
        for one in bins
    )
    return (
        f"<section><h2>Real pace</h2><p>{result['late_cycles']} times of a cycle were missed in "
        f"{result['cycles']} cycles, the worst of which began {result['worst_lateness_us']:.1f} µs behind its time.</p>"
        f'<p class="soft">Cycles by lateness in µs; bars are logarithmic.</p><ul class="bars">{rows}</ul></section>'
    )


def _plcs(plcs: Sequence[Mapping[str, Any]]) -> str:
    """Return how the PLC tasks of a bench in real pace kept their periods; overruns in red."""
    if not plcs:
        return ""
    heads = ("PLC", "Period µs", "Runs", "Overruns", "Shortest µs", "Mean µs", "Longest µs")
    rows = [
        (
            one["name"],
            *(str(one[key]) for key in ("period_us", "runs", "overruns")),
            *("" if one[key] is None else f"{one[key]:.0f}" for key in ("min_us", "mean_us", "max_us")),
        )
        for one in plcs
    ]
    table = _table(heads, rows, numbers=(1, 2, 3, 4, 5, 6))
    overran = any(one["overruns"] for one in plcs)
    html = f"<section><h2>PLC tasks</h2>{table}</section>"
    return html.replace("<section>", '<section class="error">') if overran else html


def _range(one: Mapping[str, Any]) -> str:
    """Return the range of a bin."""
    if one["below_us"] is None:
        return f"{one['from_us']} and more"
    return f"{one['from_us']} to {one['below_us']}"


# -- the whole run ----------------------------------------------------------------------------------------


def _overview(recording: Recording) -> str:
    span = (recording.last - recording.first) * recording.cycle_ns
    if span <= 0:
        return ""
    axis = TimeAxis(
        recording.first * recording.cycle_ns / NS_PER_S,
        recording.last * recording.cycle_ns / NS_PER_S,
        "s",
        "machine time in s",
    )
    marks = [(window.value.dc_ns - recording.dc_epoch_ns) / NS_PER_S for window in recording.windows]
    html = "".join(
        f"<section><h3>Axis {escape(info.name)}</h3>{chart}</section>"
        for info in recording.axes
        if (chart := _axis_chart(recording, info, axis, marks))
    )
    strips = [_signal(recording, signal, axis, 0, NS_PER_S) for signal in _signals(recording)]
    if strips:
        html += f"<section><h3>Signals</h3>{Chart(axis, marks=marks, panels=strips).html()}</section>"
    note = '<p class="soft">Dashed: instants of measured values.</p>' if marks else ""
    return f"<h2>Course of the run</h2>{note}{html or '<p>No axis moved.</p>'}"


def _axis_chart(recording: Recording, info: AxisInfo, axis: TimeAxis, marks: Sequence[float]) -> str:
    """Return position and lag of an axis, nothing when it has not moved."""
    samples = recording.curve(info.name)
    if not len(samples.at_ns) or samples.command_high.max() - samples.command_low.min() < MOVED_MM:
        return ""
    at = samples.at_ns / NS_PER_S
    chart = Chart(axis, marks=marks)
    position = f"<b>Position</b> {info.unit}"
    chart.panels.append(curve(position, "position", axis, at, samples.actual_low, samples.actual_high, 10.0))
    chart.panels.append(_lag(info, axis, at, samples.lag_low, samples.lag_high, 5.0))
    return chart.html()


def _lag(info: AxisInfo, axis: TimeAxis, at: Floats, low: Floats, high: Floats, height_rem: float) -> Panel:
    """Return the position lag: µm, or 0.001°."""
    unit = "µm" if info.kind == "T" else "0.001°"
    return curve(f"<b>Lag</b> {unit}", "lag", axis, at, low * 1e3, high * 1e3, height_rem)


def _signals(recording: Recording) -> list[str]:
    """Return the signals that changed, the probe first."""
    names = {edge.signal for edge in recording.edges_seen}
    return sorted(names, key=lambda name: (name != PROBE, name))


def _signal(recording: Recording, signal: str, axis: TimeAxis, origin_ns: int, unit_ns: int) -> Panel:
    changes = [
        ((edge.at_ns - origin_ns) / unit_ns, edge.level)
        for edge in recording.edges_seen
        if edge.signal == signal
    ]
    start = recording.level(signal, round(axis.low * unit_ns) + origin_ns)
    return digital(f"<b>{escape(signal)}</b>", axis, changes, start=start)


# -- measuring events -------------------------------------------------------------------------------------


def _events(recording: Recording) -> str:
    if not recording.windows:
        return ""
    windows = list(recording.windows)
    html = "".join(_event(recording, window) for window in windows[:OPEN_WINDOWS])
    if len(windows) > OPEN_WINDOWS:
        rest = "".join(_event(recording, window) for window in windows[OPEN_WINDOWS:])
        html += f"<details><summary>{len(windows) - OPEN_WINDOWS} more</summary>{rest}</details>"
    return f"<h2>Measuring events</h2>{html}"


def _event(recording: Recording, window: Window) -> str:
    """Return one measuring event: the motion around it, and who saw the signal when."""
    value, info = window.value, recording.axes[window.value.axis]
    latched_ns = value.dc_ns - recording.dc_epoch_ns
    edge_ns = _edge(recording, latched_ns, rising=value.edge == "POS")
    origin_ns = latched_ns if edge_ns is None else edge_ns
    taken = (window.emitted_ns - origin_ns) / NS_PER_MS
    if edge_ns is None:
        seen = f"{value.origin}. 0 ms is the instant of the measured value"
    else:
        seen = f"{value.origin}, {value.edge} edge. 0 ms is the edge of the probe"
    handshake = "" if edge_ns is None else _handshake(recording, window, info, origin_ns)
    return (
        f"<section><h3>{escape(value.source.number)} {escape(info.name)}: {_number(mm(value.acs_tenth_um))} {info.unit}"
        f'</h3><p class="soft">{escape(seen)} at {_seconds(origin_ns)}; the CNC has the value {taken:.3f} ms later.</p>'
        f"{_motion(recording, window, info, origin_ns)}{handshake}</section>"
    )


def _edge(recording: Recording, latched_ns: int, *, rising: bool) -> int | None:
    """Return the last edge of the probe that can have led to a value, None for one without (fixed stop)."""
    oldest = latched_ns - _LOOK_BACK_CYCLES * recording.cycle_ns
    found = [
        edge.at_ns
        for edge in recording.edges_seen
        if edge.signal == PROBE and edge.level is rising and oldest <= edge.at_ns <= latched_ns
    ]
    return found[-1] if found else None


def _motion(recording: Recording, window: Window, info: AxisInfo, origin_ns: int) -> str:
    rows = window.rows[:, window.value.axis]
    if len(rows) < 2:
        return ""
    at = (np.arange(window.first, window.first + len(rows)) * recording.cycle_ns - origin_ns) / NS_PER_MS
    axis = TimeAxis(float(at[0]), float(at[-1]), "ms", "ms")
    chart = Chart(axis, marks=[(window.value.dc_ns - recording.dc_epoch_ns - origin_ns) / NS_PER_MS])
    actual, lag = rows["actual"] / TENTH_UM_PER_MM, rows["lag"] / TENTH_UM_PER_MM
    name = f"<b>Position</b> {info.unit}, line: measured value"
    level = mm(window.value.acs_tenth_um)
    chart.panels.append(curve(name, "position", axis, at, actual, actual, 7.0, level))
    chart.panels.append(_lag(info, axis, at, lag, lag, 4.0))
    return chart.html()


def _handshake(recording: Recording, window: Window, info: AxisInfo, origin_ns: int) -> str:
    """Return the way of the signal as a timing diagram, from a little before it to a little after the value."""
    cycle_ms = recording.cycle_ns / NS_PER_MS
    taken = (window.emitted_ns - origin_ns) / NS_PER_MS
    latched = (window.value.dc_ns - recording.dc_epoch_ns - origin_ns) / NS_PER_MS
    low, high = min(0.0, latched), max(taken, latched)
    air = max(2 * cycle_ms, 0.3 * (high - low))
    axis = TimeAxis(low - air, high + air, "ms", "ms after the edge of the probe")
    chart = Chart(axis, bare=True, marks=[latched])
    chart.panels += _machine_rows(recording, axis, origin_ns)
    chart.panels += _plc_rows(recording, info, axis, origin_ns)
    chart.panels += _drive_rows(recording, window, axis, origin_ns)
    cycles = _multiples(recording.cycle_ns, axis, origin_ns)
    cnc = f"<b>CNC</b> cycle {cycle_ms:g} ms; thick: takes the value"
    chart.panels.append(instants(cnc, axis, cycles, [taken]))
    return chart.html()


def _multiples(period_ns: int, axis: TimeAxis, origin_ns: int) -> list[float]:
    """Return the instants of a period on an axis in ms."""
    first = -(-(origin_ns + round(axis.low * NS_PER_MS)) // period_ns)
    last = (origin_ns + round(axis.high * NS_PER_MS)) // period_ns
    return [(number * period_ns - origin_ns) / NS_PER_MS for number in range(first, last + 1)]


def _machine_rows(recording: Recording, axis: TimeAxis, origin_ns: int) -> list[Panel]:
    """Return the probe and the terminal inputs that it is wired to."""
    panels = [_signal(recording, PROBE, axis, origin_ns, NS_PER_MS)]
    for tap in recording.inputs:
        if tap.signal != PROBE:
            continue
        refreshes = _multiples(tap.period_ns, axis, origin_ns)
        levels = [
            (at, recording.level(PROBE, round(at * NS_PER_MS) + origin_ns - tap.delay_ns)) for at in refreshes
        ]
        before = recording.level(
            PROBE, round(axis.low * NS_PER_MS) + origin_ns - tap.delay_ns - tap.period_ns
        )
        panels.append(digital(f"<b>{escape(tap.name)}</b> input", axis, levels, start=before))
    return panels


def _plc_rows(recording: Recording, info: AxisInfo, axis: TimeAxis, origin_ns: int) -> list[Panel]:
    """Return PLC cycles and the control unit of the axis, when a PLC serves it."""
    unit = f"ax/{info.number}/{_PROBING_UNIT}"
    changes = [change for change in recording.hli if change.path.startswith(f"{unit}/")]
    command = [change for change in changes if change.path.endswith("command_w")]
    if not command:
        return []
    wrote = [(change.at_ns - origin_ns) / NS_PER_MS for change in command]
    panels = [
        instants(
            f"<b>PLC {escape(name)}</b> cycle {period_ns / NS_PER_MS:g} ms; thick: writes command_w",
            axis,
            _multiples(period_ns, axis, origin_ns),
            wrote,
        )
        for name, period_ns in recording.plcs.items()
    ]
    for member in ("command_w", "state_r"):
        levels = [
            ((change.at_ns - origin_ns) / NS_PER_MS, bool(change.value))
            for change in changes
            if change.path.endswith(member)
        ]
        panels.append(digital(f"<b>probing_signal</b> {member}", axis, levels, start=False))
    return panels


def _drive_rows(recording: Recording, window: Window, axis: TimeAxis, origin_ns: int) -> list[Panel]:
    """Return the latch words of the drive, when they changed here."""
    rows = window.rows[:, window.value.axis]
    panels: list[Panel] = []
    for name, title in (("probe_function", "latch control word"), ("probe_status", "latch status word")):
        column = rows[name]
        if len(column) < 2 or (column == column[0]).all():
            continue
        starts = np.flatnonzero(np.diff(column.astype(np.int64), prepend=-1))
        values = [
            (
                ((window.first + int(at)) * recording.cycle_ns - origin_ns) / NS_PER_MS,
                f"{int(column[at]):04X}h",
            )
            for at in starts
        ]
        inside = [value for value in values if axis.low < value[0] <= axis.high]
        before = [value for value in values if value[0] <= axis.low][-1:]
        panels.append(words(f"<b>Drive</b> {title}", axis, [*before, *inside]))
    return panels
