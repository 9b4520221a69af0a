"""Trace files: spoilt bytes end in what could be read, or in an InputError; show, diff and export say so."""

from functools import partial
from pathlib import Path

from hli_bench import Bench
from hli_bench.shells.recorder import What, record
from hli_bench.shells.trace_file import TraceReader
from tests.fuzz.inputs import broken_bytes, seeds, tried

PROGRAM = 'N10 G90 G01 Z299 F2000\nN20 #MSG ["there"]\nN30 M30\n'


def recorded(path: Path) -> bytes:
    """Return a short trace."""
    with Bench("demo") as bench:
        what = What("trace", path, bench.kernel.setup, bench.config.name, {})
        recorder = record(what, bench.kernel.rows.log, paced=False)
        bench.engine.observers.append(recorder)
        bench.run(PROGRAM)
        recorder.close()
    return path.read_bytes()


def test_spoilt_traces(tmp_path: Path) -> None:
    path = tmp_path / "t.mcap"
    data = recorded(path)
    for seed in seeds():
        path.write_bytes(broken_bytes(data, seed))
        tried(partial(_read, path), seed)


def _read(path: Path) -> None:
    for _ in TraceReader(path).stretches():
        pass
