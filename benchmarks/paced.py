"""How well a paced bench keeps a cycle of 1 ms with 8 axes, and which share of a core its kernel takes.

The reference is a bare paced loop: the same waiting, and nothing to do. In each turn bench and loop alternate every 50
cycles, so that what else the computer does spoils both alike; the figure is the ratio of their p99 lateness in a turn,
and the median of it over all turns. A PLC task runs in every cycle; two axes move all the time.
"""

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from hli_bench import Bench
from hli_bench.bench import bench as bench_module
from hli_bench.shells.pacing import RealPace
from hli_bench.shells.processes import free_endpoint
from hli_bench.shells.realtime import ask, frozen_garbage
from hli_bench.shells.recorder import Recorder, What, record

MACHINE = Path(__file__).parent / "machines" / "eight_axes"
CYCLE_NS = 1_000_000
WARM_UP = 3000
SLICE = 50
TO_AND_FRO = ["%to_and_fro", *["N10 G90 G01 X100 Y50 F2000", "N20 G01 X0 Y0"] * 1000, "M30"]


class Slice(NamedTuple):
    """What some cycles gave: lateness of each in ns, processor time of the kernel's process, wall time, late cycles."""

    lateness: list[int]
    cpu_s: float
    wall_s: float
    late: int


Take = Callable[[int], Slice]
"""Runs so many cycles."""


class Figures(NamedTuple):
    """What a turn gives: p50 and p99 lateness in us, share of a core, late cycles."""

    p50_us: float
    p99_us: float
    share: float
    late: int

    @classmethod
    def of(cls, slices: list[Slice]) -> "Figures":
        """Put the slices of a turn together."""
        parts = statistics.quantiles([late for one in slices for late in one.lateness], n=100)
        share = sum(one.cpu_s for one in slices) / sum(one.wall_s for one in slices)
        return cls(parts[49] / 1000, parts[98] / 1000, share, sum(one.late for one in slices))


class Noted(RealPace):
    """A pace that keeps the lateness of each cycle."""

    __slots__ = ("notes",)
    newest: "Noted"

    def __init__(self, *arguments: Any, **options: Any) -> None:
        self.notes: list[int] = []
        Noted.newest = self
        super().__init__(*arguments, **options)

    def _count(self, late: int) -> int:
        self.notes.append(late)
        return super()._count(late)


def measured(pace: Noted, run: Callable[[], None]) -> Slice:
    """Run cycles and measure them."""
    pace.notes.clear()
    pace.restart()
    cpu, wall = time.process_time(), time.perf_counter()
    run()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    return Slice(pace.notes.copy(), cpu, wall, pace.lateness.late)


@contextmanager
def bare(*, realtime: bool) -> Iterator[Take]:
    """A loop that only waits."""
    pace = Noted(CYCLE_NS)

    def wait(cycles: int) -> None:
        for _ in range(cycles):
            pace.wait()

    calm = ask(realtime=realtime)
    with frozen_garbage():
        yield lambda cycles: measured(pace, lambda: wait(cycles))
    calm.close()


@contextmanager
def paced(*, realtime: bool, processes: bool) -> Iterator[Take]:
    """A bench that moves two of its axes."""
    endpoint = free_endpoint() if processes else None
    with Bench(MACHINE, pace="real", processes=processes, zenoh=endpoint, realtime=realtime) as bench:
        yield from moving(bench)


@contextmanager
def traced(*, realtime: bool) -> Iterator[Take]:
    """The bench in one process, recorded as `run --trace` does."""
    with (
        tempfile.TemporaryDirectory() as folder,
        Bench(MACHINE, pace="real", realtime=realtime) as bench,
        closing(recorded(bench, Path(folder) / "run.mcap")) as recorder,
    ):
        bench.engine.observers.append(recorder)
        yield from moving(bench)


def recorded(bench: Bench, path: Path) -> Recorder:
    what = What("trace", path, bench.kernel.setup, bench.config.name)
    return record(what, bench.kernel.rows.log, paced=True, on_note=print)


def moving(bench: Bench) -> Iterator[Take]:
    """Let it move two of its axes."""
    pace = Noted.newest
    bench.start_up()
    bench.kernel.start(TO_AND_FRO, "to_and_fro")
    bench.engine.wake()
    yield lambda cycles: measured(pace, lambda: bench.advance(cycles))
    assert bench.kernel.channel.running


def measure(name: str, opened: AbstractContextManager[Take], arguments: argparse.Namespace) -> None:
    """Print the figures of one kind of bench beside the bare loop."""
    benches: list[Figures] = []
    loops: list[Figures] = []
    with opened as run, bare(realtime=arguments.realtime) as wait:
        run(WARM_UP)
        wait(WARM_UP)
        for _ in range(arguments.turns):
            pairs = [(run(SLICE), wait(SLICE)) for _ in range(arguments.cycles // SLICE)]
            benches.append(Figures.of([pair[0] for pair in pairs]))
            loops.append(Figures.of([pair[1] for pair in pairs]))
    middle = statistics.median
    ratios = [one.p99_us / other.p99_us for one, other in zip(benches, loops, strict=True)]
    print(f"{name}: p99 lateness / that of a bare loop: median {middle(ratios):.2f}", end="")
    print(f" ({min(ratios):.2f} to {max(ratios):.2f})")
    for kind, figures in (("bench", benches), ("bare loop", loops)):
        p50, p99, share = (middle(values) for values in list(zip(*figures, strict=True))[:3])
        late = sum(one.late for one in figures)
        print(
            f"  {kind:<9}  p50 {p50:5.1f} us   p99 {p99:7.1f} us   {share:5.1%} of a core   {late} late",
            flush=True,
        )


def main() -> None:
    """Measure the bench in one process, the same with a trace, and the bench of processes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--turns", type=int, default=9)
    parser.add_argument("--cycles", type=int, default=1000, help="of each turn")
    parser.add_argument("--realtime", action="store_true", help="SCHED_FIFO and locked memory for both")
    arguments = parser.parse_args()
    print(f"8 axes, 1 ms, a PLC task each cycle; {arguments.turns} turns of {arguments.cycles} cycles each")
    # The bench makes its pace itself; here it makes one that keeps what it measures.
    bench_module.RealPace = Noted  # type: ignore[misc]
    realtime = arguments.realtime
    measure("one process", paced(realtime=realtime, processes=False), arguments)
    measure("one process, with a trace", traced(realtime=realtime), arguments)
    measure("processes and Zenoh, as with serve", paced(realtime=realtime, processes=True), arguments)


if __name__ == "__main__":
    main()
