"""Performs a scenario on a bench and keeps what its invariants look at."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

from hli_bench import Bench
from hli_bench.base.errors import BenchError, InputError, NotEmulated
from hli_bench.laws.rows import LOG_CYCLES
from net.grammar import program_text
from net.outside import Outside
from net.performing import place_of
from net.recording import Recording
from net.scenario import LIMIT_S, Scenario, Step

REST_MS: Final = 60
"""Stretch in which a bench is watched for standing still."""
SETTLE: Final = 333
"""Stretches after which it must: 20 s of the machine, for drives that coast."""
STILL_TENTH_UM: Final = 50.0
"""How far an axis that stands moves in a stretch: a position loop settles slowly in friction."""

Way = Callable[[Bench], None]


def by_strides(bench: Bench) -> None:
    """Step a bench as it does itself."""


def by_cycles(bench: Bench) -> None:
    """Step a bench cycle by cycle."""
    engine, step = bench.engine, bench.engine.step
    engine.step = lambda limit: step(min(limit, engine.cycle + 1))  # type: ignore[method-assign]


@dataclass(slots=True)
class Span:
    """A program or a rest: cycles behind `first` up to `last`, and what came of it."""

    first: int
    last: int = 0
    axes: frozenset[str] = frozenset()
    """Axes that may move."""
    outcome: str = ""
    result: dict[str, Any] = field(default_factory=dict)
    held: bool = False
    """It was reset because something held it."""
    stands: bool = True
    """All stood in time when it was over."""
    referenced: tuple[bool, ...] = ()
    """Which axes were referenced at its end."""


@dataclass(slots=True)
class Trial:
    """What came of a scenario. `spans` are programs, `rests` the time behind each."""

    scenario: Scenario
    refused: str = ""
    """Why there was no bench, "" when there was."""
    crash: str = ""
    bench: Bench | None = None
    recording: Recording | None = None
    spans: list[Span] = field(default_factory=list)
    rests: list[Span] = field(default_factory=list)

    @property
    def log(self) -> np.ndarray:
        """The log of all cycles."""
        assert self.recording is not None
        return self.recording.log


@contextmanager
def bench_of(scenario: Scenario, *, processes: bool = False) -> Iterator[Bench]:
    """Make the bench of a scenario. Raises InputError, NotEmulated."""
    with TemporaryDirectory() as place:
        scripts = scenario.scripts()
        plcs: list[str | Path] | None = None
        if scripts is not None:
            plcs = [Path(place) / f"{name}.py" for name in scripts]
            for path, text in zip(plcs, scripts.values(), strict=True):
                Path(path).write_text(text)
        folder = place_of(scenario.machine.folder)
        with Bench(folder, scenario.machine.settings, plc=plcs, processes=processes) as bench:
            yield bench


@contextmanager
def trial(scenario: Scenario, way: Way = by_strides, *, processes: bool = False) -> Iterator[Trial]:
    """Perform a scenario; the bench stays up for those who look."""
    found = Trial(scenario)
    try:
        with bench_of(scenario, processes=processes) as bench:
            found.bench, found.recording = bench, Recording()
            found.recording.watch(bench)
            way(bench)
            outside = Outside(bench)
            outside.patience = True
            _perform(found, bench, outside)
            yield found
    except (InputError, NotEmulated) as error:
        if found.bench is not None:
            raise
        found.refused = f"{type(error).__name__}: {error}"
        yield found


def _perform(found: Trial, bench: Bench, outside: Outside) -> None:
    try:
        bench.start_up()
    except (InputError, NotEmulated) as error:  # what a PLC script does wrong shows here
        found.refused = f"{type(error).__name__}: {error}"
        return
    except BenchError as error:
        found.crash = f"{type(error).__name__}: {error}"
        return
    try:
        found.rests.append(rest(bench))
        for step in found.scenario.steps:
            found.spans.append(program(bench, outside, step))
            if found.spans[-1].outcome.startswith(("crashed", "failed")):
                found.crash = found.spans[-1].outcome
                return
            found.rests.append(rest(bench))
    except (InputError, NotEmulated) as error:  # as a PLC script's
        found.refused = f"{type(error).__name__}: {error}"
    except Exception as error:
        found.crash = f"crashed in a rest: {type(error).__name__}: {error}"


def program(bench: Bench, outside: Outside, step: Step) -> Span:
    """Run a step's program."""
    axes = frozenset(axis for block in step.blocks for axis in block.axes)
    span = Span(bench.engine.cycle, axes=axes)
    outside.plan(step.acts)
    bench.interrupted = None
    try:
        result = bench.run(program_text(step.blocks), limit_s=LIMIT_S)
    except KeyboardInterrupt:
        span.outcome, result = "interrupted", bench.interrupted
    except (InputError, NotEmulated) as error:
        span.outcome, result = f"refused: {type(error).__name__}: {error}", None
    except BenchError as error:
        span.outcome, result = f"failed: {type(error).__name__}: {error}", None
    except Exception as error:
        span.outcome, result = f"crashed: {type(error).__name__}: {error}", None
    span.held = outside.gave_up
    outside.plan(())
    if result is not None:
        span.result = result.to_dict()
        span.result.pop("wall_s", None)
        span.outcome = span.outcome or span.result["status"]
    span.last = bench.engine.cycle
    span.referenced = tuple(bench.kernel.core.referenced)
    return span


def rest(bench: Bench) -> Span:
    """Wait until all stand, then a while longer: what moves in that while is what the span is about."""
    cycles = max(REST_MS * 1_000_000 // bench.config.cycle_ns, 4)
    stands = False
    for _ in range(SETTLE):
        bench.advance(cycles)
        if standing(bench, cycles):
            stands = True
            break
    span = Span(bench.engine.cycle, stands=stands)
    bench.advance(cycles)
    span.last = bench.engine.cycle
    span.referenced = tuple(bench.kernel.core.referenced)
    return span


def standing(bench: Bench, cycles: int) -> bool:
    """Tell whether set points stand and no axis has moved in the last cycles."""
    if np.any(bench.kernel.rows.axis["velocity"] != 0.0) or not bench.kernel.core.at_rest:
        return False
    slots = np.arange(bench.engine.cycle - cycles, bench.engine.cycle) + 1
    position = bench.kernel.rows.log["position"][slots % LOG_CYCLES].astype(np.int64)
    scale = np.abs(bench.kernel.rows.axis["increments_per_unit"])
    return bool(np.all(np.ptp(position, axis=0) / scale < STILL_TENTH_UM))
