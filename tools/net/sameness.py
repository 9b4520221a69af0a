"""What must come out the same: however a bench is stepped, and whatever it has done before."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from hli_bench import Bench
from hli_bench.base.errors import InputError
from hli_bench.wire.hli import Commands, Write
from net.grammar import Block
from net.invariants import Finding
from net.outside import Outside
from net.performing import Performed
from net.scenario import Scenario, Step
from net.trial import Trial, bench_of, by_cycles, program, rest, trial

ROUNDING_TENTH_UM = 1e-6
STEADY = ("good", "looker")
"""PLC scripts that do the same whatever came before."""


def performed(found: Trial) -> Performed:
    """Return what came of a trial, as runs are compared."""
    assert found.bench is not None
    assert found.recording is not None
    outcomes = [span.outcome for span in found.spans] + [found.refused, found.crash]
    return Performed(
        cycle_us=found.bench.config.cycle_ns // 1000,
        axes=[axis.name for axis in found.bench.config.axes],
        outcomes=outcomes,
        results=[span.result for span in found.spans],
        events={channel: list(events) for channel, events in found.recording.events.items()},
        elements=[one.path for one in found.bench.kernel.image.layout.elements],
        end=found.recording.end(),
        notes=[],
        log=found.log,
    )


def same_steps(scenario: Scenario, strides: Performed, *, processes: bool = False) -> Iterator[Finding]:
    """Perform the scenario again cycle by cycle, or by processes; yield what is not the same to the bit."""
    from net.comparing import Shapes, compare

    way = {"processes": True} if processes else {"way": by_cycles}
    with trial(scenario, **way) as found:  # type: ignore[arg-type]
        if found.bench is None:
            return
        other = performed(found)
    strides.outcomes, other.outcomes = (
        [_placeless(one) for one in each.outcomes] for each in (strides, other)
    )
    difference = compare(strides, other, Shapes())
    if difference.first is not None:
        name = "processes" if processes else "single cycles"
        yield Finding(f"{name} give the bits of strides", difference.text())


def _placeless(outcome: str) -> str:
    """Return an outcome without the folder of the PLC scripts, which is another one each time."""
    return " ".join(word.rpartition("/")[2] if word.startswith("/") else word for word in outcome.split(" "))


def same_behind(found: Trial) -> Iterator[Finding]:
    """Run a reference program behind the trial and on a fresh bench; yield what is not the same.

    What may differ lawfully is kept out: units that clients put are given back, drive objects are written anew by
    both; a bench whose PLC is restless, or has failed, is not asked; nor one on which motion needs a reference that
    the programs may have given, or on which an axis cannot go back because it was homed to another place than the
    program expects.
    """
    scenario = found.scenario
    machine = scenario.machine
    plcs = ("good",) if scenario.plcs is None else tuple(name for name, _ in scenario.plcs)
    homed = any("G74" in block.text for step in scenario.steps for block in step.blocks)
    if found.refused or found.crash or homed or not set(plcs) <= {*STEADY, "good"}:
        return
    if any("requires_homing" in key for key in machine.settings):
        return
    bench = found.bench
    assert bench is not None
    give_back(bench, scenario)
    bench.reset()
    rest(bench)
    behind = _reference(bench, scenario)
    with bench_of(replace(scenario, steps=())) as fresh:
        alone = _reference(fresh, scenario)
    for name, one in alone.items():
        if not _equal(one, behind[name]):
            yield Finding(
                "a reference program behind anything is the one on a fresh bench",
                _told(name, one, behind[name]),
            )
            return


def give_back(bench: Bench, scenario: Scenario) -> None:
    """Let the units that clients have put count no more."""
    for step in scenario.steps:
        for act in step.acts:
            if act.what == "put" and act.path.endswith("enable_w"):
                with suppress(InputError):
                    element = bench.kernel.image.layout.element(act.path)
                    bench.engine.apply(Commands("", bench.engine.cycle, (Write(element.path, False),)))


def _reference(bench: Bench, scenario: Scenario) -> dict[str, Any]:
    """Return to the start, then run the reference program; return what is to be the same."""
    outside = Outside(bench)
    starts = scenario.machine.starts
    words = " ".join(f"{axis}{start}" for axis, start in starts.items())
    writes = [
        Block(f"#DRIVE WR SYN [AX={axis} KEY={key} VAL={value} WAIT]")
        for axis in starts
        for key, value in (("TORQUE_LIMIT", 300), ("MON_WINDOW", 1_048_575))
    ]
    end = Block("M30")
    back = program(bench, outside, Step((*writes, Block(f"G90 G01 {words} F9000"), end)))
    rest(bench)
    x, y, z = starts["X"], starts["Y"], starts["Z"]
    moves = [
        f"G90 G01 X{x + 10} F12000",
        f"X{x + 12} Y{y + 3}",
        f"G00 Z{z + 4} Y{y}",
        "G04 0.05",
        f"G01 X{x} Z{z}",
    ]
    first = bench.engine.cycle
    kept: list[np.ndarray] = []
    observer = _Commands(bench, kept)
    bench.engine.observers.append(observer)
    span = program(bench, outside, Step((*(Block(move) for move in moves), end)))
    bench.engine.observers.remove(observer)
    names = [axis.index for axis in bench.config.axes if axis.name in starts]
    return {
        "the way back": [back.outcome, [error["id"] for error in back.result.get("errors", ())]],
        "outcome": span.outcome,
        "errors": [error["id"] for error in span.result.get("errors", ())],
        "cycles": bench.engine.cycle - first,
        "set points": np.concatenate(kept)[:, names],
    }


class _Commands:
    """Observer that keeps set points only."""

    def __init__(self, bench: Bench, kept: list[np.ndarray]) -> None:
        self._log, self._kept = bench.kernel.rows.log, kept

    def cycles(self, first: int, count: int) -> None:
        """Keep the set points of these cycles."""
        self._kept.append(self._log["command"][np.arange(first, first + count) % len(self._log)])

    def frames(self, *_: object) -> None:
        """Nothing of the rest."""

    edges = emitted = commands = refused = frames


def _equal(alone: Any, behind: Any) -> bool:
    """Tell whether both are the same; a set point at the start comes from increments, and is not a round number."""
    if not isinstance(alone, np.ndarray):
        return bool(alone == behind)
    return alone.shape == behind.shape and bool(np.all(np.abs(alone - behind) < ROUNDING_TENTH_UM))


def _told(name: str, alone: Any, behind: Any) -> str:
    if not isinstance(alone, np.ndarray):
        return f"{name}: {alone} alone, {behind} behind"
    if alone.shape != behind.shape:
        return f"{name}: {len(alone)} cycles alone, {len(behind)} behind"
    at, axis = np.argwhere(np.abs(alone - behind) >= ROUNDING_TENTH_UM)[0]
    return f"{name}: cycle {at} of the program, axis {axis}: {alone[at, axis]!r} alone, {behind[at, axis]!r} behind"
