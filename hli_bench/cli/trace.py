"""`hli-bench trace show / diff / export`: what a recorded run holds, compared with another, for other programs."""

import argparse
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from hli_bench.base.errors import InputError
from hli_bench.base.time import NS_PER_MS, NS_PER_S
from hli_bench.base.units import mm
from hli_bench.cli.console import say, tell
from hli_bench.cli.options import Commands

if TYPE_CHECKING:
    from hli_bench.shells.trace_diff import Difference
    from hli_bench.shells.trace_file import AxesBlock, Stretch, TraceEvent, TraceMeta, TraceReader
    from hli_bench.wire.can import CanFrame

CHANNELS: Final = ("meta", "axes", "can", "edges", "plc", "refused", "cnc", "overruns", "gaps")
SUFFIXES: Final[Mapping[str, str]] = {
    "csv": ".csv",
    "parquet": ".parquet",
    "candump": ".log",
    "pcap": ".pcap",
}
"""Formats of `export` and how their files are named unless told otherwise."""
EVERY_S: Final = 0.1
"""Distance of the lines of an axis (decided here)."""
LONG: Final = 200
"""Lines from which `show` says how to get fewer (decided here)."""
EQUAL: Final = 0
DIFFERENT: Final = 1
FUNCTIONS: Final[Mapping[int, str]] = {
    0x000: "NMT",
    0x080: "EMCY of",
    0x580: "SDO answer of",
    0x600: "SDO request to",
    0x700: "heartbeat of",
}
"""What an identifier of a frame beside the telegrams stands for, by its function code."""
LSS: Final = (0x7E4, 0x7E5)
AXIS_HEAD: Final = (
    f"{'':37}{'command':>12} {'actual':>12} {'lag':>9} {'target':>11} {'position':>11} control status torque"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """What `show` prints: channels, instants from `begin` to `end` ns, axes; an axis every `every` ns."""

    channels: frozenset[str]
    begin: int
    end: int
    axes: frozenset[str]
    every: int


def add(commands: Commands) -> None:
    """Declare the commands."""
    parser = commands.add_parser("trace", help="recorded runs: show, compare, export")
    actions = parser.add_subparsers(dest="action", required=True, title="commands")
    show = actions.add_parser(
        "show",
        help="print what a recorded run holds",
        description="Prints what happened in order of time (s, ns since the bench began), axes at intervals "
        "in mm or degrees and increments. lag is the command of two cycles earlier, which is the one that this actual "
        "position answers, minus actual: 0 for a drive that follows exactly, at any velocity. "
        "A file that was cut off is shown up to its last chunk.",
    )
    show.add_argument("file", metavar="FILE")
    show.add_argument("--channel", choices=CHANNELS, action="append", help="only this one; repeatable")
    show.add_argument("--from", metavar="S", dest="begin", type=_seconds, default=0, help="not before")
    show.add_argument("--to", metavar="S", dest="end", type=_seconds, help="not after")
    show.add_argument("--axis", metavar="NAME", action="append", help="only this axis; repeatable")
    show.add_argument(
        "--every",
        metavar="S",
        type=_seconds,
        default=_seconds(str(EVERY_S)),
        help=f"distance of the lines of an axis, 0: every cycle (default {EVERY_S})",
    )
    show.set_defaults(execute=show_trace)
    diff = actions.add_parser(
        "diff",
        help="compare two recorded runs",
        description="Prints the first difference and how much differs; ends with 0 when nothing does, else 1.",
    )
    diff.add_argument("file", metavar="FILE")
    diff.add_argument("other", metavar="OTHER")
    diff.set_defaults(execute=diff_traces)
    export = actions.add_parser("export", help="write a recorded run in another form")
    export.add_argument("file", metavar="FILE")
    export.add_argument(
        "--format",
        choices=tuple(SUFFIXES),
        required=True,
        help="csv, parquet: all axes, a row a cycle and axis; candump, pcap: every frame of the bus",
    )
    export.add_argument("--out", metavar="FILE", help="default: FILE with the suffix of the format")
    export.set_defaults(execute=export_trace)


def _seconds(text: str) -> int:
    """Return seconds as ns."""
    try:
        seconds = round(float(text) * NS_PER_S)
    except (ValueError, OverflowError):
        seconds = -1
    if seconds < 0:
        raise argparse.ArgumentTypeError(f"{text!r}: expected seconds from 0 on, e.g. 1.25")
    return seconds


def _reader(file: str) -> "TraceReader":
    """Open a trace. Raises InputError."""
    from hli_bench.shells.trace_file import TraceReader

    try:
        return TraceReader(Path(file))
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", file=file) from error


def _warn_if_torn(reader: "TraceReader") -> None:
    if reader.torn:
        text = "cut off: the recording was not ended, this is what stands in its complete chunks"
        tell(f"warning: {reader.path}: {text}")


# -- show -------------------------------------------------------------------------------------------------


def show_trace(arguments: argparse.Namespace) -> int:
    """Print a trace."""
    reader = _reader(arguments.file)
    known = [axis.name for axis in reader.meta.axes]
    for name in arguments.axis or ():
        if name not in known:
            raise InputError(f"--axis {name}: expected one of {', '.join(known)}", file=arguments.file)
    end = sys.maxsize if arguments.end is None else arguments.end
    if arguments.begin > end:
        raise InputError("lies behind --to", file="--from")
    selection = Selection(
        channels=frozenset(arguments.channel or CHANNELS),
        begin=arguments.begin,
        end=end,
        axes=frozenset(arguments.axis or known),
        every=arguments.every,
    )
    count = 0
    for line in shown(reader, selection):
        say(line)
        count += 1
    if count > LONG and not arguments.channel and not arguments.axis:
        choices = f"--channel ({'|'.join(CHANNELS)}), --axis ({'|'.join(known)})"
        tell(f"{count} lines; fewer with {choices}, --from, --to or a larger --every")
    _warn_if_torn(reader)
    return 0


def shown(reader: "TraceReader", selection: Selection) -> Iterator[str]:
    """Yield the lines of `show`."""
    meta = reader.meta
    if "meta" in selection.channels:
        yield from _meta_lines(meta)
    if "axes" in selection.channels:
        yield AXIS_HEAD
    for stretch in reader.stretches():
        if stretch.block.first * meta.cycle_ns > selection.end:
            return
        lines = [*_axis_lines(stretch.block, meta, selection), *_event_lines(stretch, meta, selection)]
        yield from (f"{_stamp(at_ns)}  {text}" for at_ns, text in sorted(lines, key=lambda line: line[0]))


def _stamp(at_ns: int) -> str:
    """Return an instant in s and in ns."""
    seconds, rest = divmod(at_ns, NS_PER_S)
    return f"{seconds:6d}.{rest // NS_PER_MS:03d} s {at_ns:15d} ns"


def _meta_lines(meta: "TraceMeta") -> Iterator[str]:
    from hli_bench.shells.trace_file import axes_text

    yield f"machine {meta.machine}, cycle {meta.cycle_ns} ns, DC time {meta.dc_epoch_ns} ns at the start"
    yield f"axes {axes_text(meta)}"
    for key, value in meta.overrides.items():
        yield f"set {key}={value}"


def _axis_lines(block: "AxesBlock", meta: "TraceMeta", selection: Selection) -> Iterator[tuple[int, str]]:
    """Yield the chosen cycles of a block with their instants; a line an axis."""
    if "axes" not in selection.channels:
        return
    step = max(selection.every // meta.cycle_ns, 1)
    for offset in range(-block.first % step, len(block.rows), step):
        at_ns = (block.first + offset) * meta.cycle_ns
        if not selection.begin <= at_ns <= selection.end:
            continue
        for axis, row in zip(meta.axes, block.rows[offset], strict=True):
            if axis.name in selection.axes:
                yield at_ns, f"axes {axis.name:<3}{_axis_values(row)}"


def _axis_values(row: Any) -> str:
    lengths = f"{mm(row['command']):12.4f} {mm(row['actual']):12.4f} {mm(row['lag']):9.4f}"
    counts = f"{row['target']:11d} {row['position']:11d}"
    return f"{lengths} {counts}    {row['controlword']:04X}   {row['statusword']:04X} {row['torque_permille']:6d}"


def _event_lines(stretch: "Stretch", meta: "TraceMeta", selection: Selection) -> Iterator[tuple[int, str]]:
    for event in stretch.events:
        if event.topic not in selection.channels or not selection.begin <= event.at_ns <= selection.end:
            continue
        for text in _event_texts(event, meta, selection):
            yield event.at_ns, f"{event.topic:<7} {text}"


def _event_texts(event: "TraceEvent", meta: "TraceMeta", selection: Selection) -> Iterator[str]:
    """Yield what an event says; nothing for one of an axis that is not wanted."""
    value = event.value
    numbers = {axis.number: axis.name for axis in meta.axes}
    if event.topic == "can":
        nodes = {axis.node: axis.name for axis in meta.axes}
        if nodes.get(value.cob_id & 0x7F) in {None, *selection.axes}:
            yield _frame_text(value)
    elif event.topic == "edges":
        yield f"{value['signal']} {_level(value['level'])}"
    elif event.topic == "plc":
        for path, written in value["writes"]:
            if _axis_of(path, numbers) in {"", *selection.axes}:
                yield f"{value['plc'] or 'client'}: {path} = {_level(written)}"
    elif event.topic == "refused":
        if _axis_of(value["path"], numbers) in {"", *selection.axes}:
            yield f"{value['writer'] or 'client'}: {value['path']}: {value['reason']}"
    elif event.topic == "overruns":
        yield f"PLC {value['plc']} has not kept its period"
    elif event.topic == "gaps":
        yield f"{value['count']} cycles are missing, from {value['first']} on"
    else:
        yield from _record_texts(value, meta, selection)


def _axis_of(path: str, numbers: Mapping[int, str]) -> str:
    """Return the axis that an HLI element belongs to, "" for one of none."""
    area, _, rest = path.partition("/")
    number = rest.partition("/")[0]
    return numbers.get(int(number), "") if area == "ax" and number.isdigit() else ""


def _level(value: Any) -> str:
    return {True: "TRUE", False: "FALSE"}[value] if isinstance(value, bool) else str(value)


def _frame_text(frame: "CanFrame") -> str:
    data = "R" if frame.remote else frame.data.hex().upper()
    text = f"{frame.cob_id:03X}#{data}"
    if frame.cob_id in LSS:
        return f"{text:<20} LSS"
    function = FUNCTIONS.get(frame.cob_id & 0x780)
    if function is None:
        return text
    node = frame.cob_id & 0x7F
    return f"{text:<20} {function}" + (f" node {node}" if node else "")


def _record_texts(value: Mapping[str, Any], meta: "TraceMeta", selection: Selection) -> Iterator[str]:
    """Yield a record of the CNC: its kind, its block, what it holds; axes by name."""
    held = {key: item for key, item in value.items() if key not in ("kind", "source")}
    axis = held.get("axis")
    if isinstance(axis, int):
        held["axis"] = axis = meta.axes[axis].name
    if axis and axis not in selection.axes:
        return
    source = value.get("source", {})
    place = source.get("number") or f"line {source.get('line', 0)}"
    texts = [f"{key}={item}" for key, item in held.items() if item not in ("", {})]
    yield f"{value['kind']} {place} {' '.join(sorted(texts))}"


# -- diff -------------------------------------------------------------------------------------------------


def diff_traces(arguments: argparse.Namespace) -> int:
    """Print the first difference and how many there are; return whether there is any."""
    from hli_bench.shells.trace_diff import compare

    readers = [_reader(arguments.file), _reader(arguments.other)]
    found = compare(readers[0], readers[1])
    for reader in readers:
        _warn_if_torn(reader)
    if not found.counts:
        say("equal")
        return EQUAL
    for difference in (*found.meta, *([found.first] if found.first else [])):
        say(_difference_text(difference))
        for reader, value in zip(readers, (difference.left, difference.right), strict=True):
            say(f"  {reader.path}: {_value_text(value)}")
    counts = ", ".join(f"{found.counts[name]} in {name}" for name in CHANNELS if found.counts[name])
    total = found.counts.total()
    say(f"{total} difference{'s' if total > 1 else ''}: {counts}")
    return DIFFERENT


def _difference_text(found: "Difference") -> str:
    if found.channel == "meta":
        return f"meta: {found.field}"
    axis = f", axis {found.axis}" if found.axis else ""
    place = f"{found.at_ns / NS_PER_S:.3f} s ({found.at_ns} ns), cycle {found.cycle}"
    return f"first difference: {found.channel} at {place}{axis}, {found.field}"


def _value_text(value: object) -> str:
    from hli_bench.wire.can import CanFrame

    return _frame_text(value) if isinstance(value, CanFrame) else str(value)


# -- export -----------------------------------------------------------------------------------------------


def export_trace(arguments: argparse.Namespace) -> int:
    """Write a trace in another form."""
    from hli_bench.shells.trace_export import export

    reader = _reader(arguments.file)
    out = Path(arguments.out or Path(arguments.file).with_suffix(SUFFIXES[arguments.format]))
    if out.exists() and out.samefile(reader.path):
        raise InputError("is the trace itself, choose another name", file=f"--out {out}")
    try:
        export(reader, arguments.format, out)
    except OSError as error:
        raise InputError(f"--out: cannot be written: {error.strerror}", file=str(out)) from error
    _warn_if_torn(reader)
    tell(f"{out}: {arguments.format}")
    return 0
