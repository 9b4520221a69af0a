"""`hli-bench sweep`: many runs over a grid of parameters and random draws."""

import argparse
import os
import sys
from pathlib import Path
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.cli.console import tell
from hli_bench.cli.options import Commands, supplied_file

MOST_WORKERS: Final = 256
"""More processes than this are a mistake (decided here)."""


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "sweep",
        help="many runs over a grid of parameters or random draws",
        description="Does the runs of a campaign and writes runs.parquet and report.html. The same command again "
        "goes on where a campaign was stopped. docs/sweeps.md says what may stand in a campaign.",
    )
    parser.add_argument(
        "campaign", metavar="CAMPAIGN.toml", help="a file, or the name of a supplied campaign"
    )
    parser.add_argument(
        "--engine",
        metavar="ENGINE",
        default="local",
        help="local: processes of this computer; dask://HOST:PORT; dask-local (default %(default)s)",
    )
    parser.add_argument(
        "--workers", metavar="N", type=int, help="worker processes of local engines (default: one a core)"
    )
    parser.add_argument(
        "--out", metavar="DIR", help="folder of the results (default out/NAME of the campaign)"
    )
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> int:
    """Do the campaign and return the exit status."""
    workers = (
        min(len(os.sched_getaffinity(0)), MOST_WORKERS) if arguments.workers is None else arguments.workers
    )
    if not 1 <= workers <= MOST_WORKERS:
        raise InputError(f"{workers} is not valid, expected 1 to {MOST_WORKERS}", file="--workers")
    file = supplied_file("campaigns", arguments.campaign, ".toml")
    from hli_bench.laws import native
    from hli_bench.shells.apart import apart
    from hli_bench.sweep import campaign, engines, sweep

    native.prepare(lambda: tell(native.COMPILING), apart)
    engine = engines.engine(arguments.engine, workers)
    taken = campaign.read(file)
    folder = Path("out", file.stem) if arguments.out is None else Path(arguments.out)
    done = sweep.run(taken, folder, engine, workers, sys.stderr)
    tell(f"{taken.runs} runs, {done} of them now: {folder / 'runs.parquet'}, {folder / sweep.REPORT}")
    return 0
