"""A campaign from its first open run to table and report."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final, TextIO

from hli_bench.base.errors import BenchError, InputError
from hli_bench.base.plain import plain
from hli_bench.sweep.campaign import Campaign
from hli_bench.sweep.engines import Chunk, Engine
from hli_bench.sweep.progress import Progress
from hli_bench.sweep.report import report_html
from hli_bench.sweep.store import Store, replace_file
from hli_bench.sweep.work import Failure, Row, Run

REPORT: Final = "report.html"
CHUNKS_A_WORKER: Final = 16
"""So many chunks at least, so that the workers end together and little is lost when the campaign is killed."""
LARGEST_CHUNK: Final = 50


def run(campaign: Campaign, folder: Path, engine: Engine, workers: int, stream: TextIO) -> int:
    """Do what is left of a campaign, write table and report, and return how many runs were done now.

    Raises InputError for a folder of another campaign and for runs that cannot be. Ctrl-C is told on `stream`, with
    what is kept.
    """
    with Store(folder, campaign) as store:
        try:
            return _run(campaign, store, engine, workers, stream)
        except KeyboardInterrupt:
            kept = f"{len(store.done())} of {campaign.runs} runs are kept in {folder}"
            print(f"stopped: {plain(kept)}; the same command goes on from there", file=stream, flush=True)
            raise


def _run(campaign: Campaign, store: Store, engine: Engine, workers: int, stream: TextIO) -> int:
    """Do what is left, write table and report, and return how many runs were done."""
    done = store.done()
    rest = [number for number in range(campaign.runs) if number not in done]
    if rest:
        progress = Progress(campaign.runs, len(done), stream)
        try:
            for chunk in engine.chunks(campaign.job, _chunks(campaign, rest, workers)):
                _keep(campaign, store, chunk)
                progress.add(len(chunk))
        finally:
            progress.end()
    table = store.finish()
    for name in campaign.metrics:
        if table.column(name).null_count == table.num_rows:
            print(f"warning: {name} is empty in all {table.num_rows} runs", file=stream)
    replace_file(store.folder / REPORT, report_html(campaign, table).encode())
    return len(rest)


def _chunks(campaign: Campaign, numbers: Sequence[int], workers: int) -> Iterator[Sequence[Run]]:
    """Yield runs in pieces, their settings made only now: a campaign may be large."""
    size = min(max(len(numbers) // (workers * CHUNKS_A_WORKER), 1), LARGEST_CHUNK)
    for first in range(0, len(numbers), size):
        yield [campaign.run(number) for number in numbers[first : first + size]]


def _keep(campaign: Campaign, store: Store, chunk: Chunk) -> None:
    """Write what has ended. Raises the usage error of a run that could not be."""
    rows = [row for row in chunk if isinstance(row, Row)]
    if rows:
        store.add(rows)
    for failure in failures(chunk):
        message = f"{campaign.describe(failure.number)}: {failure.text}"
        error: BenchError = InputError(message, file=campaign.file)
        error.exit_status = failure.exit_status
        raise error


def failures(chunk: Iterable[Row | Failure]) -> list[Failure]:
    """Return the runs of a chunk that could not be."""
    return [row for row in chunk if isinstance(row, Failure)]
