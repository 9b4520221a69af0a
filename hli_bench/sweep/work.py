"""What a worker does: runs of a campaign, each on a bench of its own."""

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from hli_bench.base import garbage
from hli_bench.base.errors import BenchError
from hli_bench.base.loading import SUPPLIED, installed
from hli_bench.bench.bench import Bench
from hli_bench.sweep.draws import Plain
from hli_bench.sweep.expressions import metric


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """What all runs of a campaign have in common; `plc` None: the machine's own scripts.

    `text` is the NC text with its placeholders, `metrics` are expressions, `keys` the settings they may name.
    """

    machine: str
    program_name: str
    text: str
    plc: tuple[str, ...] | None
    metrics: tuple[str, ...]
    keys: frozenset[str]


@dataclass(frozen=True, slots=True)
class Run:
    """One run: its number and all its settings, those of the program too."""

    number: int
    settings: Mapping[str, Plain]


@dataclass(frozen=True, slots=True)
class Row:
    """What a run came to; metrics in the order of the campaign, None for what the run does not have."""

    number: int
    metrics: tuple[float | None, ...]
    status: str
    errors: str
    cycles: int


@dataclass(frozen=True, slots=True)
class Failure:
    """A run that could not be: a usage error. It ends the campaign."""

    number: int
    text: str
    exit_status: int


PROGRAM: Final = "program."
"""Keys that go into the NC text, not to the machine."""
PLACEHOLDER: Final = re.compile(r"\{(\w+)\}")


def nc_text(text: str, settings: Mapping[str, Plain]) -> str:
    """Return the NC text with `{feed}` replaced by the value of `program.feed`; without such keys as it is."""
    if not any(key.startswith(PROGRAM) for key in settings):
        return text
    return PLACEHOLDER.sub(lambda match: str(settings[PROGRAM + match[1]]), text)


def run_chunk(job: Job, runs: Sequence[Run]) -> list[Row | Failure]:
    """Do some runs, up to the first that cannot be; called in a worker process."""
    rows: list[Row | Failure] = []
    machine = Path(job.machine) if Path(job.machine).is_absolute() else job.machine
    for run in runs:
        try:
            rows.append(_row(job, machine, run))
            garbage.of_one_run()
        except BenchError as error:
            rows.append(Failure(run.number, str(error), error.exit_status))
            break
    return rows


def _row(job: Job, machine: Path | str, run: Run) -> Row:
    settings = {key: value for key, value in run.settings.items() if not key.startswith(PROGRAM)}
    with Bench(machine, settings, plc=job.plc) as bench:
        result = bench.run(nc_text(job.text, run.settings).splitlines(), job.program_name)
    return Row(
        run.number,
        tuple(metric(text, job.keys)(result, run.settings) for text in job.metrics),
        result.status,
        "; ".join(str(error) for error in result.errors),
        result.cycles,
    )


def code_digest() -> str:
    """Return a digest of the bench's code and drive models: the same code gives the same results."""
    package = Path(__file__).resolve().parent.parent
    digest = hashlib.sha256()
    for folder in (package, installed(SUPPLIED).parent, package.parent / "eds"):
        for path in sorted((*folder.rglob("*.py"), *folder.rglob("*.eds"))):
            digest.update(path.relative_to(folder.parent).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()[:16]
