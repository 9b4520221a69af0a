"""Sweeps: runs a second and core, and Dask beside local processes for tasks of 50 ms.

Chunks of runs alternate with a reference (additions in a plain Python loop), because a virtual core that shares its
hardware with a neighbour is half as fast for a while and nothing else tells. Printed is the median of the chunks beside
which the reference was as fast as at its best (the core was ours), and the median of all. 300 runs a second and core
are to be reached. `--quick` takes a tenth of the runs.
"""

import argparse
import gc
import io
import os
import statistics
import tempfile
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from hli_bench.base import garbage
from hli_bench.sweep import campaign as campaigns
from hli_bench.sweep.engines import Dask, LocalProcesses
from hli_bench.sweep.sweep import run
from hli_bench.sweep.work import Job, Row, Run, run_chunk

RUNS: Final = 1000
CHUNK: Final = 10
ADDITIONS: Final = 100_000
OURS: Final = 0.8
"""A core on which the reference reaches this part of its best is not shared."""
TASKS: Final = 80
TASK_S: Final = 0.05
WARM: Final = 4
THREE_AXES: Final = Path(__file__).parent / "machines" / "three_axes"
PROGRAM: Final = "N10 #MEAS MODE[1]\nN20 G90 G01 Z290 F6000\nN30 G100 Z20 F6000\nN40 M30\n"
SECOND_MM: Final = 218.0
"""A face here makes a run take one second of machine time."""
CAMPAIGN: Final = """\
program = "p.nc"
machine = "{machine}"
{plc}
repeats = {runs}
[settings]
"plant.probe.Z.material" = "below"
"axis.Z.kenngr.measure.signal" = "{signal}"
{settings}
[random]
"plant.probe.Z.face_mm" = {{ uniform = [{low}, {high}] }}
[metrics]
error_um = "1000 * (measurements.0.acs_mm - settings['plant.probe.Z.face_mm'])"
sim_s = "sim_s"
"""


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    runs = RUNS // 10 if parser.parse_args().quick else RUNS
    gc.collect()
    gc.freeze()
    garbage.seldom()
    cores = len(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for title, machine, signal, plc, settings in (
            ("3 axes, DRIVE, no PLC", str(THREE_AXES), "DRIVE", "plc = []", ""),
            ("3 axes, PLC_TIMESTAMP, PLC every 10 ms", str(THREE_AXES), "PLC_TIMESTAMP", "", plc_of(10_000)),
            ("demo (7 axes), DRIVE, no PLC", "demo", "DRIVE", "plc = []", ""),
            ("demo (7 axes), PLC_TIMESTAMP, PLC every 10 ms", "demo", "PLC_TIMESTAMP", "", plc_of(10_000)),
        ):
            text = CAMPAIGN.format(
                machine=machine,
                plc=plc,
                runs=runs,
                signal=signal,
                settings=settings,
                low=SECOND_MM - 0.5,
                high=SECOND_MM + 0.5,
            )
            print_rate(folder, title, text, runs)
        print_campaign(folder, cores)
    print_engines()


def reference() -> float:
    """Return additions a second of a plain Python loop."""
    start, total = time.process_time(), 0
    for number in range(ADDITIONS):
        total += number
    return ADDITIONS / (time.process_time() - start)


def plc_of(period_us: int) -> str:
    """Return settings of one PLC task."""
    return f'"plc[0].script" = "probing.py"\n"plc[0].period_us" = {period_us}\n"plc[0].name" = "probing"'


def print_rate(folder: Path, title: str, text: str, runs: int) -> None:
    """Print runs a second of one core: what a worker does, by processor time, so that other load counts less."""
    (folder / "p.nc").write_text(PROGRAM)
    (folder / "c.toml").write_text(text)
    taken = campaigns.read(folder / "c.toml")
    rows = run_chunk(taken.job, [taken.run(number) for number in range(WARM)])
    references, rates = [reference()], []
    for first in range(0, runs, CHUNK):
        chunk = [taken.run(number) for number in range(first, min(first + CHUNK, runs))]
        begin = time.process_time()
        rows = run_chunk(taken.job, chunk)
        rates.append(len(chunk) / (time.process_time() - begin))
        references.append(reference())
    pace = [min(pair) for pair in pairwise(references)]
    ours = [rate for rate, beside in zip(rates, pace, strict=True) if beside >= OURS * max(references)]
    cycles = statistics.mean(row.cycles for row in rows if isinstance(row, Row))
    print(
        f"{title}: {statistics.median(ours or rates):.0f} runs a second and core, best {max(rates):.0f}, "
        f"all {statistics.median(rates):.0f} ({len(ours)} of {len(rates)} chunks on a core of our own, "
        f"{max(references) / 1e6:.0f} million additions a second; {cycles:.0f} cycles of 1 ms a run)"
    )


def print_campaign(folder: Path, cores: int) -> None:
    """Print how long the last campaign takes whole: workers, results on disk, table, report."""
    taken = campaigns.read(folder / "c.toml")
    begin = time.perf_counter()
    run(taken, folder / "out", LocalProcesses(cores), cores, io.StringIO())
    whole = time.perf_counter() - begin
    print(
        f"the last as a campaign of {taken.runs} runs with {cores} workers: {whole:.1f} s, their start included"
    )


def print_engines() -> None:
    """Print the pace of each engine with tasks that only wait, two workers, their start left out."""
    seconds: dict[str, list[float]] = {"local": [], "dask": []}
    for _ in range(3):
        seconds["local"].append(of_tasks(LocalProcesses(2, wait_50_ms)))
        seconds["dask"].append(of_tasks(Dask(None, 2, wait_50_ms)))
    local, dask = (statistics.median(turns) for turns in seconds.values())
    ratio = statistics.median(a / b for a, b in zip(seconds["dask"], seconds["local"], strict=True))
    print(
        f"{TASKS} tasks of {TASK_S * 1e3:.0f} ms, 2 workers (ideal {TASKS * TASK_S / 2:.2f} s): local {local:.2f} s, "
        f"dask {dask:.2f} s, dask against local {ratio:.3f} (reach 1.10)"
    )


def wait_50_ms(job: Job, runs: Sequence[Run]) -> list[Any]:
    """Wait for as long as a task takes."""
    time.sleep(TASK_S)
    return list(runs)


def of_tasks(engine: LocalProcesses | Dask) -> float:
    """Return the seconds that an engine takes for all tasks once its workers are up."""
    job = Job(machine="", program_name="", text="", plc=None, metrics=(), keys=frozenset())
    tasks = ([Run(number, {})] for number in range(TASKS + WARM))
    ends = [time.perf_counter() for _ in engine.chunks(job, tasks)]
    return ends[-1] - ends[WARM - 1]


if __name__ == "__main__":
    main()
