"""What must hold after every scenario, whatever it was. A check is a row in CHECKS; it yields what it finds."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from net.machines import FACE_MM
from net.trial import Span, Trial

TENTH_UM_PER_MM: Final = 1e4
STILL_MM: Final = 0.02
"""An axis that nobody ordered may settle in its friction, no more."""
LIMIT_MM: Final = 0.001
"""A set point may not pass a software limit."""
BRAKED_S: Final = 0.6
"""Longest time in which an axis brakes: 500 mm/s at 1000 mm/s², and what is on its way."""
HELD: Final = ("motion was held",)
PLACE: Final = re.compile(r"[^:\s]+:\d+|plc \w+: ")
"""File and line of an error."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What does not hold: the name of the check and what was seen."""

    check: str
    text: str

    def __str__(self) -> str:
        return f"{self.check}: {self.text}"


Check = Callable[[Trial], Iterator[str]]


def findings(trial: Trial) -> list[Finding]:
    """Return all that does not hold; of each check the first."""
    found = []
    if trial.crash:
        found.append(Finding("no exception but InputError and NotEmulated", trial.crash))
    if trial.refused or not trial.spans:
        return found
    for name, check in CHECKS.items():
        first = next(check(trial), None)
        if first is not None:
            found.append(Finding(name, first))
    return found


def _ends(trial: Trial) -> Iterator[str]:
    """A program that is broken off by its limit was held by something that the bench names."""
    for number, span in enumerate(trial.spans, 1):
        if span.outcome == "aborted" and not (span.held or _by_reset(trial, number) or _held(span)):
            yield f"program {number} had not ended when its limit came, and nothing is said to hold it"


def _held(span: Span) -> bool:
    return any(note.startswith(HELD) for note in span.result.get("notes", ()))


def _by_reset(trial: Trial, number: int) -> bool:
    return any(act.what == "reset" for act in trial.scenario.steps[number - 1].acts)


def _says_where(trial: Trial) -> Iterator[str]:
    for number, span in enumerate(trial.spans, 1):
        if span.outcome.startswith("refused: ") and not PLACE.search(span.outcome):
            yield f"program {number}: neither file nor line in {span.outcome!r}"


def _success(trial: Trial) -> Iterator[str]:
    """A program that counts as completed has no error, one that counts as stopped by an error has one."""
    for number, span in enumerate(trial.spans, 1):
        errors = [one for one in span.result.get("errors", ()) if one["severity"] == "error"]
        if span.outcome == "completed" and errors:
            yield f"program {number} is completed with P-ERR-{errors[0]['id']}"
        if span.outcome == "error" and not errors:
            yield f"program {number} ended with an error, and there is none"


def _stands(trial: Trial) -> Iterator[str]:
    for number, span in enumerate(trial.rests):
        if not span.stands:
            assert trial.bench is not None
            speeds = np.abs(np.diff(trial.log["command"][span.first - 2 : span.first], axis=0))[0]
            names = [axis.name for axis, speed in zip(trial.bench.config.axes, speeds, strict=True) if speed]
            yield f"20 s behind program {number} {', '.join(names) or 'a motor'} still moves"


def _idle(trial: Trial) -> Iterator[str]:
    """No set point and no axis moves while nothing is to be done."""
    for number, span in enumerate(trial.rests):
        if span.stands:
            yield from _moved(trial, span, frozenset(), f"in the rest behind program {number}")


def _unnamed(trial: Trial) -> Iterator[str]:
    """An axis that a program does not name stands while it runs."""
    for number, span in enumerate(trial.spans, 1):
        if trial.rests[number - 1].stands:
            yield from _moved(trial, span, span.axes, f"in program {number}, which does not name it")


def _moved(trial: Trial, span: Span, free: frozenset[str], when: str) -> Iterator[str]:
    assert trial.bench is not None
    rows = trial.log[max(span.first - 1, 0) : span.last]
    for axis in trial.bench.config.axes:
        if axis.name in free or not len(rows):
            continue
        scale = abs(float(trial.bench.kernel.rows.axis[axis.index]["increments_per_unit"]))
        position = rows["position"][:, axis.index].astype(np.int64)
        way_mm = float(np.abs(position - position[0]).max()) / scale / TENTH_UM_PER_MM
        if way_mm > STILL_MM:
            at = int(np.argmax(np.abs(position - position[0]) / scale / TENTH_UM_PER_MM > STILL_MM))
            yield f"{axis.name} moves {way_mm:.3f} mm {when} (cycle {span.first + at})"


def _limits(trial: Trial) -> Iterator[str]:
    """The set point of an axis that is referenced all along stays within its software limits.

    Axes without limits, and rotary ones, which are another matter, are not looked at; nor are programs in which
    the axis is homed: its reference may lie anywhere.
    """
    assert trial.bench is not None
    for axis in trial.bench.config.axes:
        kenngr = axis.params.kenngr
        if kenngr.swe_neg >= kenngr.swe_pos or axis.kind != "T":
            continue
        before = trial.rests[0].referenced
        for number, span in enumerate(trial.spans, 1):
            homed = "G74" in str([block.text for block in trial.scenario.steps[number - 1].blocks])
            referenced = before[axis.index] and span.referenced[axis.index] and not homed
            before = span.referenced
            if not referenced:
                continue
            command = trial.log["command"][span.first : span.last, axis.index]
            inside = len(command) and kenngr.swe_neg <= command[0] <= kenngr.swe_pos
            room = LIMIT_MM * TENTH_UM_PER_MM
            if inside and (command.max() > kenngr.swe_pos + room or command.min() < kenngr.swe_neg - room):
                yield (
                    f"{axis.name} is at {command.min() / 1e4:.3f} .. {command.max() / 1e4:.3f} mm in program {number}, "
                    f"limits {kenngr.swe_neg / 1e4:g} .. {kenngr.swe_pos / 1e4:g}"
                )


def _holds(trial: Trial) -> Iterator[str]:
    """While a hold is acknowledged, all that it concerns stands, as soon as it has had the time to brake."""
    assert trial.bench is not None
    numbers = {axis.number: axis.index for axis in trial.bench.config.axes}
    every = list(numbers.values())
    for path, value, first, last in _acknowledged(trial, re.compile(r"feedhold/state_r$")):
        area, number, *_ = path.split("/")
        held = value == "False" if "release_feedhold" in path else value == "True"
        if not held:
            continue
        braked = first + int(BRAKED_S * 1e9 / trial.bench.config.cycle_ns)
        for index in every if area == "ch" else [numbers[int(number)]]:
            command = trial.log["command"][braked:last, index]
            enabled = trial.log["controlword"][braked:last, index] & 0xF == 0xF
            moves = np.flatnonzero(np.diff(command) * enabled[1:])
            if len(moves):
                name = trial.bench.config.axes[index].name
                yield f"{path} = {value} since cycle {first}, and {name} moves in cycle {braked + int(moves[0]) + 2}"


def _acknowledged(trial: Trial, path: re.Pattern[str]) -> Iterator[tuple[str, str, int, int]]:
    """Yield element, value, first and last cycle of every stretch in which a PLC's or client's value holds."""
    assert trial.recording is not None
    assert trial.bench is not None
    since: dict[str, tuple[str, int]] = {}
    for cycle, name, value in trial.recording.events["hli"]:
        if path.search(name):
            if name in since:
                yield name, since[name][0], since[name][1], cycle - 1
            since[name] = value, cycle
    for name, (value, first) in since.items():
        yield name, value, first, trial.bench.engine.cycle


def _face(trial: Trial) -> Iterator[str]:
    """A value that the face gave, with a source that is exact, is the face.

    Until an axis is homed its coordinates are those of the plant; homing may set them elsewhere, as its list says.
    """
    settings = trial.scenario.machine.settings
    ideal = not any(
        key.startswith(("plant.probe.pre", "plant.probe.b", "plant.probe.s", "fault")) for key in settings
    )
    served = trial.scenario.plcs is None or trial.scenario.plcs[:1] == (
        ("good", trial.scenario.machine.cycle_us),
    )
    homed = False
    for number, span in enumerate(trial.spans, 1):
        text = str([block.text for block in trial.scenario.steps[number - 1].blocks])
        homed = homed or "G74" in text
        if (
            not ideal
            or homed
            or "#CS" in text
            or any(act.what == "put" for act in trial.scenario.steps[number - 1].acts)
        ):
            continue
        for value in span.result.get("measurements", ()):
            exact = value["source"] == "DRIVE" or (value["source"] == "PLC_TIMESTAMP" and served)
            acs = value.get("acs_mm", value.get("acs"))
            if value["axis"] == "Z" and exact and abs(acs - FACE_MM) > 0.01:
                where = f"in block {value['block']} of program {number}"
                yield f"{value['source']} measures {acs} {where}, the face is {FACE_MM}"


CHECKS: Final[dict[str, Check]] = {
    "every program ends, or the bench says what holds it": _ends,
    "an error names file and line": _says_where,
    "completed is completed": _success,
    "behind any end all stand": _stands,
    "an idle bench stands": _idle,
    "no axis moves that nobody ordered": _unnamed,
    "referenced axes stay within their software limits": _limits,
    "an acknowledged hold holds": _holds,
    "a measured value is the face": _face,
}
