"""The pytest plugin: the fixture `bench`, and traces of the benches of failed tests.

Loaded by every pytest run in an environment that has the package, so it imports nothing of it before a test asks.
"""

import re
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from hli_bench.bench.bench import Bench
    from hli_bench.shells.recorder import Recorder

TRACES = pytest.StashKey["Traces"]()
FAILED = pytest.StashKey[bool]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare where traces of failed tests go."""
    parser.getgroup("hli-bench").addoption(
        "--hli-bench-traces",
        metavar="DIR",
        help="folder for the traces of the benches of failed tests (default: each test's own tmp_path)",
    )


class Traces:
    """The benches of one test with their traces."""

    def __init__(self, folder: Path, prefix: str) -> None:
        self._folder = folder
        self._prefix = prefix
        self._closing = ExitStack()
        self._open: list[Recorder] = []
        self.files: list[Path] = []

    def bench(self, machine: str | Path = "demo", settings: Any = None, **options: Any) -> "Bench":
        """Return a bench as `Bench(machine, settings, **options)` does, recorded and closed at the end."""
        from hli_bench.bench.bench import Bench
        from hli_bench.shells.recorder import What, record

        made = self._closing.enter_context(Bench(machine, settings, **options))
        self._folder.mkdir(parents=True, exist_ok=True)
        file = self._folder / f"{self._prefix}{len(self.files)}.mcap"
        what = What("trace", file, made.kernel.setup, made.config.name, settings or {})
        trace = record(what, made.kernel.rows.log, paced=options.get("pace") == "real")
        self._closing.callback(trace.close)
        made.engine.observers.append(trace)
        self._open.append(trace)
        self.files.append(file)
        return made

    def finish_traces(self) -> None:
        """Write what the traces still hold, so that they can be looked at."""
        for trace in self._open:
            trace.close()

    def close(self, *, keep: bool) -> None:
        """Close all benches; the traces stay when they are wanted."""
        self._closing.close()
        if not keep:
            for file in self.files:
                file.unlink(missing_ok=True)


@pytest.fixture
def bench(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Callable[..., "Bench"]]:
    """A factory like `Bench`; what it makes is closed at the end, the trace of a failed test is kept."""
    chosen = request.config.getoption("--hli-bench-traces")
    name = re.sub(r"[^\w.-]+", "_", request.node.nodeid)
    traces = Traces(Path(chosen), f"{name}-") if chosen else Traces(tmp_path, "bench-")
    request.node.stash[TRACES] = traces
    yield traces.bench
    traces.close(keep=request.node.stash.get(FAILED, False))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Name the traces of a failed test in its report."""
    report = yield
    traces = item.stash.get(TRACES, None)
    if traces is not None and traces.files and call.when == "call" and report.failed:
        item.stash[FAILED] = True
        traces.finish_traces()
        report.sections.append(("hli-bench traces", "\n".join(map(str, traces.files))))
    return report
