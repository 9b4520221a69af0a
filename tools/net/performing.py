"""Performs a run and keeps what came of it; run from any commit, with that commit's packages on the path."""

import json
import pickle
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
import zstandard

import hli_bench
from hli_bench import Bench
from hli_bench.base.errors import BenchError, InputError, NotEmulated
from net.outside import Outside
from net.recording import Event, Recording
from net.runs import Run

KEPT_AS: Final = ".run"


@dataclass(slots=True)
class Performed:
    """What came of a run: `outcomes` and `results` by program, `events` by channel, `log` by cycle and axis."""

    cycle_us: int
    axes: list[str]
    outcomes: list[str]
    results: list[dict[str, Any]]
    events: dict[str, list[Event]]
    elements: list[str]
    end: dict[str, str]
    notes: list[str]
    log: np.ndarray

    def save(self, path: Path, places: Sequence[Path] = ()) -> None:
        """Write it to a file; `places` are folders that the texts are to name no more."""
        facts = {name: getattr(self, name) for name in self.__slots__ if name != "log"}
        text = json.dumps(facts)
        for place in places:
            text = text.replace(f"{place}/", "")
        names = self.log.dtype.names or ()
        # field by field: one that stands still takes no room
        columns = [self.log[name].tobytes() for name in names]
        whole = pickle.dumps((text, self.log.shape, self.log.dtype, columns))
        path.write_bytes(zstandard.compress(whole, 1))

    @classmethod
    def load(cls, path: Path) -> "Performed":
        """Read it again."""
        text, shape, dtype, columns = pickle.loads(zstandard.decompress(path.read_bytes()))
        log = np.zeros(shape, dtype)
        for name, column in zip(dtype.names or (), columns, strict=True):
            kind = dtype[name]
            log[name] = np.frombuffer(column, kind.base).reshape(*shape, *kind.shape)
        return cls(log=log, **json.loads(text))


def place_of(machine: str) -> str | Path:
    """Return a machine by name, or its folder in the tree whose packages are in use."""
    return Path(hli_bench.__file__).parents[1] / machine if "/" in machine else machine


def perform(run: Run, folder: Path) -> Performed:
    """Perform a run; its PLC scripts are written into `folder`."""
    notes: list[str] = []
    with ExitStack() as stack:
        plcs: list[str | Path] | None = None
        if run.plcs is not None:
            plcs = []
            for name, words in run.plcs.items():
                (folder / f"{name}.py").write_text(words)
                plcs.append(folder / f"{name}.py")
        recording = Recording()
        options: dict[str, Any] = {"plc": plcs, "processes": run.processes, "on_note": notes.append}
        try:
            bench = stack.enter_context(Bench(place_of(run.machine), run.settings, **options))
        except (InputError, NotEmulated) as error:
            return _nothing(f"refused: {type(error).__name__}: {error}")
        recording.watch(bench)
        outside = Outside(bench)
        outcomes, results = _programs(bench, run, outside)
        return Performed(
            cycle_us=bench.config.cycle_ns // 1000,
            axes=[axis.name for axis in bench.config.axes],
            outcomes=outcomes,
            results=results,
            events=recording.events,
            elements=[one.path for one in bench.kernel.image.layout.elements],
            end=recording.end(),
            notes=[note for note in notes if "compiling" not in note],
            log=recording.log,
        )


def _programs(bench: Bench, run: Run, outside: Outside) -> tuple[list[str], list[dict[str, Any]]]:
    """Run the programs behind one another; what one of them raises is its outcome."""
    outcomes: list[str] = []
    results: list[dict[str, Any]] = []
    for number, program in enumerate(run.programs):
        bench.interrupted = None
        outcome = ""
        try:
            bench.start_up()
            outside.plan(run.acts.get(number, ()))
            result = bench.run(program, limit_s=run.limit_s)
        except KeyboardInterrupt:
            outcome, result = "interrupted", bench.interrupted
        except (InputError, NotEmulated) as error:
            outcome, result = f"refused: {type(error).__name__}: {error}", None
        except BenchError as error:
            outcome, result = f"failed: {type(error).__name__}: {error}", None
        except Exception as error:
            outcome, result = f"crashed: {type(error).__name__}: {error}", None
        outside.plan(())
        found = {} if result is None else result.to_dict()
        found.pop("wall_s", None)
        results.append(found)
        outcomes.append(outcome or found["status"])
        if not outcome.startswith("crashed"):
            bench.advance(run.rest_ms * 1_000_000 // bench.config.cycle_ns)
    return outcomes, results


def _nothing(outcome: str) -> Performed:
    return Performed(1000, [], [outcome], [], {}, [], {}, [], np.zeros(0))


def perform_all(runs: Sequence[Run], folder: Path) -> None:
    """Perform runs and write each into a file of its name."""
    tree = Path(hli_bench.__file__).parents[1]
    for run in runs:
        with TemporaryDirectory() as scripts:
            perform(run, Path(scripts)).save(folder / f"{run.name}{KEPT_AS}", [Path(scripts), tree])
