"""#MEAS MODE, #MEAS [...], #MEAS DEFAULT: type and probing parameters (measurement manual, chapter 3)."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from hli_bench.kernel.blocks import MeasureSettings
from hli_bench.kernel.decoder.configuration import DecoderAxis
from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.expressions import evaluate
from hli_bench.kernel.decoder.faults import CncStop
from hli_bench.kernel.decoder.keywords import Keyword, Kind, axis_of, keywords
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables
from hli_bench.manual.axis.kenngr import Measure
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.errors import decoder as errors
from hli_bench.manual.errors import path_interpolator as path_errors
from hli_bench.manual.sheet import entries

if TYPE_CHECKING:
    from hli_bench.base.ids import AxisIndex

_WORD = re.compile(r"[A-Z]+", re.IGNORECASE)
_KEYS: dict[str, Kind] = {
    "TYPE": "value",
    "ERR_NO_SIGNAL": "value",
    "SIMU_OFFSET": "value",
    "TRIGGER": "flag",
    "AX": "word",
    "AXNR": "value",
    "SIGNAL": "word",
    "EDGE": "word",
    "INPUT": "value",
    "G107": "flag",
    "G108": "flag",
}
_AXIS_KEYS: dict[str, Kind] = {"AX": "word", "AXNR": "value"}
_NOT_BUILT: Final = {
    "SIMU_OFFSET": "offset of the measuring simulation",
    "TRIGGER": "edge banding",
    "G107": "edge banding",
    "G108": "edge banding",
}
_SIGNAL: Final = next(one.sheet for one in entries(Measure) if one.path == "signal")
SIGNALS: Final = tuple(str(word) for word in _SIGNAL.choices if word)
"""Values of P-AXIS-00516 that SIGNAL= takes."""

MAX_TYPE: Final = 8
FIXED_STOP_TYPE: Final = 7
LARGEST_INPUT: Final = 255


@dataclass(slots=True)
class _Group:
    """Axes that are named one after the other, and the keywords behind them."""

    axes: list[DecoderAxis] = field(default_factory=list)
    seen: dict[str, Keyword] = field(default_factory=dict)
    at: int = 0


def run(context: Context, memory: Variables, scanner: Scanner) -> Steps:
    """Set the type, or yield the settings that the position controller takes."""
    found = scanner.match(_WORD)
    word = found.group().upper() if found else ""
    match word:
        case "MODE":
            _mode(context, memory, scanner)
        case "DEFAULT":
            yield from _default(context, memory, scanner)
        case "":
            yield from _settings(context, memory, scanner)
        case "ON" | "OFF" | "PREPARE":
            raise scanner.not_emulated(f"#MEAS {word}: preparation and runs over several blocks")
        case _:
            raise scanner.error(f"expected MODE, DEFAULT or '[' after #MEAS, found '{word}'")


def _mode(context: Context, memory: Variables, scanner: Scanner) -> None:
    if scanner.at_end():
        context.measuring_type = context.defaults.measuring_type
        return
    scanner.expect("[")
    if scanner.accept("]"):
        context.measuring_type = context.defaults.measuring_type
        return
    value = evaluate(scanner, memory)
    scanner.expect("]")
    _set_type(context, scanner, value)


def _set_type(context: Context, scanner: Scanner, value: float) -> None:
    if value != int(value) or not 1 <= value <= MAX_TYPE:
        raise CncStop(errors.MEASURING_TYPE_RANGE, scanner.block.source, value, 1, MAX_TYPE)
    if value == MAX_TYPE:
        raise scanner.not_emulated("measurement type 8: edge banding over several blocks")
    context.measuring_type = int(value)


def _default(context: Context, memory: Variables, scanner: Scanner) -> Steps:
    axes: list[AxisIndex | None] = []
    if scanner.peek() == "[":
        axes += [axis_of(scanner, context, key).index for key in keywords(scanner, memory, _AXIS_KEYS)]
    for axis in axes or [None]:
        yield MeasureSettings(
            source=scanner.block.source,
            axis=axis,
            signal=None,
            edge=None,
            input=None,
            error_no_signal=None,
            reset=True,
        )


def _settings(context: Context, memory: Variables, scanner: Scanner) -> Steps:
    groups = [_Group()]
    for keyword in keywords(scanner, memory, _KEYS):
        if keyword.name in _NOT_BUILT:
            raise scanner.not_emulated(f"#MEAS {keyword.name}: {_NOT_BUILT[keyword.name]}", keyword.at)
        if keyword.name in ("AX", "AXNR"):
            if groups[-1].seen or not groups[-1].axes:
                groups.append(_Group(at=keyword.at))
            groups[-1].axes.append(axis_of(scanner, context, keyword))
        elif keyword.name in groups[-1].seen:
            raise CncStop(errors.MEAS_KEYWORD_TWICE, scanner.block.source)
        else:
            groups[-1].seen[keyword.name] = keyword
    if not any(group.seen or group.axes for group in groups):
        raise scanner.error(f"expected one of {', '.join(_KEYS)} in #MEAS [...]")
    general = list(_general(context, scanner, groups))
    for group in groups[1:]:
        if not group.seen:
            raise scanner.error(f"expected SIGNAL, EDGE or INPUT for axis {group.axes[0].name}", group.at)
    if not groups[0].axes and groups[0].seen:
        first = next(iter(groups[0].seen.values()))
        raise scanner.error(f"expected AX= or AXNR= before {first.name}", first.at)
    yield from general
    for group in groups[1:]:
        for axis in group.axes:
            yield _block(scanner, group, axis)


def _general(context: Context, scanner: Scanner, groups: list[_Group]) -> Iterator[MeasureSettings]:
    """Take TYPE and ERR_NO_SIGNAL, which belong to no axis.

    TYPE without ERR_NO_SIGNAL asks for the error (the keyword's default, decided here); of type 7
    P-CHAN-00266 decides then.
    """
    wanted: bool | None = None
    for group in groups:
        if (keyword := group.seen.pop("TYPE", None)) is not None:
            _set_type(context, scanner, keyword.value)
            wanted = True if wanted is None and keyword.value != FIXED_STOP_TYPE else wanted
        if (keyword := group.seen.pop("ERR_NO_SIGNAL", None)) is not None:
            wanted = bool(_whole(scanner, keyword, 0, 1))
    if wanted is not None:
        yield MeasureSettings(
            source=scanner.block.source,
            axis=None,
            signal=None,
            edge=None,
            input=None,
            error_no_signal=wanted,
            reset=False,
        )


def _block(scanner: Scanner, group: _Group, axis: DecoderAxis) -> MeasureSettings:
    seen = group.seen
    return MeasureSettings(
        source=scanner.block.source,
        axis=axis.index,
        signal=_signal(scanner, seen.get("SIGNAL")),
        edge=_one_of(scanner, seen.get("EDGE"), ("POS", "NEG")),
        input=_input(scanner, seen.get("INPUT"), axis),
        error_no_signal=None,
        reset=False,
    )


def _signal(scanner: Scanner, keyword: Keyword | None) -> str | None:
    word = _one_of(scanner, keyword, SIGNALS)
    if keyword is not None and word in _SIGNAL.not_emulated:
        raise scanner.not_emulated(f"SIGNAL={word}: this probing source is not built", keyword.at)
    return word


def _input(scanner: Scanner, keyword: Keyword | None, axis: DecoderAxis) -> int | None:
    """Take a probing input; which of them a source has the position controller knows."""
    if keyword is None:
        return None
    if keyword.value != int(keyword.value):
        raise scanner.error(f"INPUT={keyword.value:g}: expected a whole number", keyword.at)
    if not 1 <= keyword.value <= LARGEST_INPUT:
        raise CncStop(
            path_errors.MEAS_INPUT_INVALID,
            scanner.block.source,
            axis.number,
            int(DriveType.CANOPEN),  # the only drive type that is built
            int(keyword.value),
            LARGEST_INPUT,
            axis=axis.name,
        )
    return int(keyword.value)


def _one_of(scanner: Scanner, keyword: Keyword | None, allowed: tuple[str, ...]) -> str | None:
    if keyword is None:
        return None
    if keyword.word.upper() not in allowed:
        raise scanner.error(
            f"{keyword.name}={keyword.word}: expected one of {', '.join(allowed)}", keyword.at
        )
    return keyword.word.upper()


def _whole(scanner: Scanner, keyword: Keyword | None, low: int, high: int) -> int | None:
    if keyword is None:
        return None
    if keyword.value != int(keyword.value) or not low <= keyword.value <= high:
        raise scanner.error(
            f"{keyword.name}={keyword.value:g}: expected a whole number from {low} to {high}", keyword.at
        )
    return int(keyword.value)
