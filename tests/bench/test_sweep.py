"""Campaigns run whole: same table with every engine, after a kill, and what ends one."""

import importlib
import os
import shlex
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.sweep import engines, store

CAMPAIGN = """\
program = "p.nc"
seed = 3
repeats = 4
[settings]
"plant.probe.Z.material" = "below"
"channel.meas_error_no_signal" = 1
"plc[0].script" = "probing.py"
[grid]
"axis.Z.kenngr.measure.signal" = ["PLC", "PLC_TIMESTAMP", "DRIVE"]
program.feed = [1500, 6000]
program.depth = [280, 294]
[random]
"plant.probe.Z.face_mm" = { uniform = [291, 292] }
[metrics]
error_um = "1000 * (measurements.0.acs_mm - settings['plant.probe.Z.face_mm'])"
"""
PROGRAM = "N05 #MEAS MODE[1]\nN10 G90 G01 Z295 F6000\nN20 G100 Z{depth} F{feed}\nN30 M30\n"


def command(folder: Path, out: str, *options: str) -> list[str]:
    arguments = ["sweep", str(folder / "c.toml"), "--out", str(folder / out), *options]
    return [sys.executable, "-m", "hli_bench.cli.main", *arguments]


def sweep(folder: Path, out: str, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(folder, out, *options), capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("sweep")
    (made / "p.nc").write_text(PROGRAM)
    (made / "c.toml").write_text(CAMPAIGN)
    return made


@pytest.fixture(scope="module")
def done(folder):
    """The campaign by one process, without a break."""
    ended = sweep(folder, "one", "--workers", "1")
    assert ended.returncode == 0, ended.stderr
    assert "100 %, 48 of 48 runs" in ended.stderr
    return (folder / "one" / "runs.parquet").read_bytes()


@pytest.mark.parametrize("options", [("--workers", "3"), ("--engine", "dask-local", "--workers", "2")])
def test_every_engine_gives_the_same_bytes(folder, done, options):
    ended = sweep(folder, "-".join(options), *options)
    assert ended.returncode == 0, ended.stderr
    assert (folder / "-".join(options) / "runs.parquet").read_bytes() == done


def test_a_killed_campaign_goes_on_where_it_stopped(folder, done):
    first = subprocess.Popen(command(folder, "killed", "--workers", "2"), stderr=subprocess.PIPE, text=True)
    assert first.stderr is not None
    assert first.stderr.readline() == "0 %, 0 of 48 runs\n"
    line = first.stderr.readline()
    first.kill()
    # The end of the stream is there only when the workers have ended too: none is left behind.
    first.communicate()
    assert line.endswith("left\n"), line
    kept = sum(pq.read_metadata(part).num_rows for part in (folder / "killed" / "parts").glob("*.parquet"))
    assert 0 < kept < 48
    ended = sweep(folder, "killed", "--workers", "2")
    assert f"48 runs, {48 - kept} of them now" in ended.stderr
    assert (folder / "killed" / "runs.parquet").read_bytes() == done
    assert (folder / "killed" / "report.html").stat().st_size > 10_000


@pytest.mark.parametrize("lines", [1, 2])
def test_ctrl_c_tells_what_is_kept(folder, done, lines):
    out = folder / f"stopped after {lines}"
    campaign = subprocess.Popen(
        command(folder, out.name, "--workers", "2"), stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert campaign.stderr is not None
    for _ in range(lines):
        campaign.stderr.readline()
    os.killpg(campaign.pid, signal.SIGINT)
    *_, last = said = campaign.communicate()[1].splitlines()
    assert campaign.returncode == 130
    kept = sum(pq.read_metadata(part).num_rows for part in (out / "parts").glob("*.parquet"))
    assert last == f"stopped: {kept} of 48 runs are kept in {out}; the same command goes on from there"
    assert all(" of 48 runs, " in line for line in said[:-1])


def test_ctrl_c_is_not_for_the_workers():
    """Not even while they start: each would end with a traceback."""
    (masks,) = engines.LocalProcesses(1, _held).chunks(None, iter([[None]]))
    assert signal.SIGINT in masks
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_ctrl_c_while_a_worker_starts_comes_when_it_has_started():
    """Another thread takes the signal; a worker left half started would end with a traceback."""
    over, reached = threading.Event(), []

    def start() -> None:
        with engines._interrupts_held():
            os.kill(os.getpid(), signal.SIGINT)
            over.wait(0.05)
            reached.append(True)

    other = threading.Thread(target=over.wait)
    other.start()
    with pytest.raises(KeyboardInterrupt):
        start()
    over.set()
    other.join()

    assert reached


def _held(job, runs):
    """A worker's signals that are held back."""
    return list(signal.pthread_sigmask(signal.SIG_BLOCK, ()))


def test_a_campaign_that_is_done_does_nothing_again(folder, done):
    ended = sweep(folder, "one")
    assert (ended.returncode, ended.stderr.split(":")[0]) == (0, "48 runs, 0 of them now")
    assert (folder / "one" / "runs.parquet").read_bytes() == done


def test_errors_of_the_cnc_are_rows(folder, done):
    rows = pq.read_table(folder / "one" / "runs.parquet").to_pylist()
    failed = [row for row in rows if row["program.depth"] == 294]
    assert len(failed) == 24
    for row in failed:
        assert row["status"] == "error"
        assert row["error_um"] is None
        assert "P-ERR-" in row["errors"]
    assert all(row["status"] == "completed" and row["errors"] == "" for row in rows if row not in failed)


@pytest.mark.req("M-137")
def test_the_error_of_a_source_is_what_its_way_takes(folder, done):
    rows = [
        row for row in pq.read_table(folder / "one" / "runs.parquet").to_pylist() if row["status"] != "error"
    ]
    for row in rows:
        travel_um = row["program.feed"] / 60.0
        if row["axis.Z.kenngr.measure.signal"] == "PLC":
            # One cycle to the kernel and up to one PLC period before it, here 1 ms both.
            assert -2 * travel_um - 0.1 <= row["error_um"] <= -travel_um + 0.1
        else:
            assert abs(row["error_um"]) <= 0.1


def test_a_changed_campaign_is_refused(folder, done):
    other = folder / "other"
    other.mkdir()
    (other / "p.nc").write_text(PROGRAM)
    (other / "c.toml").write_text(CAMPAIGN.replace("repeats = 4", "repeats = 5"))
    ended = subprocess.run(
        [*command(other, "x")[:-1], str(folder / "one")], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 2
    assert "holds runs of another campaign (different: repeats)" in ended.stderr


def test_a_damaged_result_file_is_named_and_its_runs_are_done_anew_without_it(tmp_path):
    (tmp_path / "p.nc").write_text("N20 M30\n")
    (tmp_path / "c.toml").write_text(
        'program = "p.nc"\nrepeats = 2\n[metrics]\ntime_s = "sim_s"\nnothing = "measurements[5].acs_mm"\n'
    )
    ended = sweep(tmp_path, "out", "--workers", "1")
    assert "warning: nothing is empty in all 2 runs" in ended.stderr.splitlines()
    table = tmp_path / "out" / "runs.parquet"
    whole = table.read_bytes()
    table.write_bytes(whole[:100])
    ended = sweep(tmp_path, "out", "--workers", "1")
    assert (ended.returncode, ended.stderr.startswith(f"{table}: is damaged; delete it")) == (2, True)
    table.unlink()
    assert sweep(tmp_path, "out", "--workers", "1").returncode == 0
    assert table.read_bytes() == whole


def test_no_more_workers_are_started_than_there_are_chunks(monkeypatch):
    started = []

    class Counted(engines._Worker):
        def __init__(self, *arguments):
            started.append(self)
            super().__init__(*arguments)

    monkeypatch.setattr(engines, "_Worker", Counted)
    assert len(list(engines.LocalProcesses(9, _held).chunks(None, iter([[None], [None]])))) == 2
    assert len(started) == 2


def test_a_run_that_cannot_be_ends_the_campaign_and_is_named(tmp_path):
    (tmp_path / "p.nc").write_text("N10 G01 Z299 F{feed}\nN20 M30\n")
    text = 'program = "p.nc"\n[grid]\nprogram.feed = ["500", "QQ"]\n[metrics]\ntime_s = "sim_s"\n'
    (tmp_path / "c.toml").write_text(text)
    ended = sweep(tmp_path, "out", "--workers", "1")
    assert ended.returncode == 2
    assert f"{tmp_path / 'c.toml'}: run 1 (program.feed = QQ): p.nc:1:" in ended.stderr


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--engine", "ray"), "--engine: 'ray' is not valid, expected local, dask://HOST:PORT or dask-local"),
        (("--workers", "0"), "--workers: 0 is not valid, expected 1 to 256"),
    ],
)
def test_options_that_are_wrong(folder, options, named):
    ended = sweep(folder, "wrong", *options)
    assert (ended.returncode, ended.stderr) == (2, named + "\n")


def test_without_pyarrow_or_dask_the_command_that_installs_it_is_told(monkeypatch):
    install = f"{shlex.quote(sys.executable)} -m pip install"
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "pyarrow", None)
        without.delitem(sys.modules, store.__name__)
        with pytest.raises(EnvironmentLacks) as caught:
            importlib.import_module(store.__name__)
    assert str(caught.value) == f"a sweep needs pyarrow: {install} pyarrow"
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(EnvironmentLacks) as caught:
        engines.engine("dask-local", 1)
    assert str(caught.value) == f"this engine needs Dask: {install} distributed"


def test_a_scheduler_that_is_not_there(folder):
    ended = sweep(folder, "nobody", "--engine", "dask://127.0.0.1:1")
    assert ended.returncode == 3
    assert "no Dask scheduler at 127.0.0.1:1" in ended.stderr
