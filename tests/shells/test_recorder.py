"""Recording beside the kernel: the same bytes from another process, nothing waited for, no failure hidden."""

import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.bench.bench import Bench
from hli_bench.cli.main import main
from hli_bench.laws.rows import LOG_CYCLES
from hli_bench.runtime.engine import Observer
from hli_bench.shells.pipe import Pipe, framed
from hli_bench.shells.record_file import INTERRUPTS, RecordFile, uninterrupted
from hli_bench.shells.recorder import BATCH, Handover, Outbox, What, record
from hli_bench.shells.trace_file import BLOCK_CYCLES, AxesBlock, TraceEvent, TraceReader, read
from hli_bench.wire.can import CanFrame
from hli_bench.wire.signals import Edge

KINDS = ("trace", "can_log")
PROGRAM = 'N10 G01 G90 X5 F6000\nN20 #MSG SYN["there"]\nN30 G01 X0\nN40 M30\n'


class Steps:
    """Cycles without a bench: rows that do not compress, so that chunks come often."""

    def __init__(self, path: Path, kind: str = "trace") -> None:
        bench = Bench("demo", plc=[])
        self.ring: Any = np.zeros_like(bench.kernel.rows.log)
        self.what = What(kind, path, bench.kernel.setup, "demo", {"seed": 3})
        self._generator = np.random.default_rng(3)
        self.done = 0

    def go(self, observer: Observer, cycles: int) -> None:
        """Let cycles pass, each with a frame and an edge behind it now and then."""
        for cycle in range(self.done + 1, self.done + cycles + 1):
            row = self.ring[cycle % LOG_CYCLES]
            row["target"] = self._generator.integers(-(1 << 30), 1 << 30, self.ring.shape[1])
            if cycle % 7 == 0:
                observer.frames(cycle, [CanFrame(0x581, bytes(8))])
            observer.cycles(cycle, 1)
            if cycle % 10 == 0:
                observer.edges([Edge("probe", cycle * 1_000_000 - 17, cycle % 20 == 0)])
        self.done += cycles


def blocks(path: Path) -> list[AxesBlock]:
    return [entry for entry in read(path) if isinstance(entry, AxesBlock)]


# -- the process that writes ------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_another_process_writes_the_same_bytes(kind: str, tmp_path: Path) -> None:
    for name, paced in (("itself", False), ("process", True)):
        steps = Steps(tmp_path / name, kind)
        recorder = record(steps.what, steps.ring, paced=paced)
        steps.go(recorder, 3 * BLOCK_CYCLES + 17)
        recorder.close()
        recorder.close()
    assert (tmp_path / "itself").read_bytes() == (tmp_path / "process").read_bytes()


@pytest.mark.parametrize("kind", KINDS)
def test_a_paced_run_records_what_a_free_one_does(kind: str, tmp_path: Path) -> None:
    program = tmp_path / "short.nc"
    program.write_text(PROGRAM)
    for pace in ("free", "real"):
        option = f"--{kind.replace('_', '-')}"
        arguments = ["--plc", "none", "--pace", pace, option, str(tmp_path / pace)]
        assert main(["run", str(program), *arguments]) == 0
    assert (tmp_path / "free").read_bytes() == (tmp_path / "real").read_bytes()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("paced", [False, True])
def test_a_file_that_cannot_be_opened_is_bad_input(kind: str, paced: bool, tmp_path: Path) -> None:
    steps = Steps(tmp_path / "nowhere" / "run", kind)
    with pytest.raises(InputError, match="nowhere/run: cannot be written: No such file"):
        record(steps.what, steps.ring, paced=paced)


class StuckPipe:
    """Stands for the pipe to a process that takes nothing, until `open` is set."""

    def __init__(self, pipe: Pipe) -> None:
        self._pipe = pipe
        self.open = False
        self.limit = pipe.limit

    def send_part(self, part: memoryview) -> int:
        return self._pipe.send_part(part) if self.open else 0


def test_cycles_without_room_are_a_gap_of_whole_blocks(tmp_path: Path) -> None:
    path = tmp_path / "gap.mcap"
    steps = Steps(path)
    notes: list[str] = []
    recorder = Handover(steps.what, steps.ring, notes.append, room=7)
    stuck: Any = StuckPipe(recorder._outbox._pipe)
    recorder._outbox._pipe = stuck
    steps.go(recorder, 700)
    stuck.open = True
    steps.go(recorder, 400)
    recorder.close()
    kept = [(block.first, len(block.rows)) for block in blocks(path)]
    # seven batches were taken, the first of 49 cycles: the next ones were lost up to the begin of a block
    end = 7 * BATCH
    resumed = 3 * BLOCK_CYCLES
    assert kept == [(1, 249), (250, end - 250), (resumed, 250), (1000, 101)]
    gaps = [entry for entry in read(path) if isinstance(entry, TraceEvent) and entry.topic == "gaps"]
    assert [gap.value for gap in gaps] == [{"first": end, "count": resumed - end}]
    assert notes == [f"{path}: {resumed - end} cycles are missing, they came faster than they were written"]
    assert not TraceReader(path).torn


def test_the_last_cycles_wait_for_room(tmp_path: Path) -> None:
    path = tmp_path / "late.mcap"
    steps = Steps(path)
    notes: list[str] = []
    recorder = Handover(steps.what, steps.ring, notes.append, room=7)
    stuck: Any = StuckPipe(recorder._outbox._pipe)
    recorder._outbox._pipe = stuck
    cycles = 7 * BATCH + 20
    steps.go(recorder, cycles)
    assert recorder._outbox.full
    stuck.open = True
    recorder.close()
    assert sum(len(block.rows) for block in blocks(path)) == cycles
    assert notes == []


def test_a_gap_is_shown_and_counts_as_a_difference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [tmp_path / name for name in ("whole.mcap", "gap.mcap")]
    for path in paths:
        steps = Steps(path)
        recorder: Any = record(steps.what, steps.ring, paced=False)
        steps.go(recorder, 600)
        if path.stem == "gap":
            recorder.gap(601, 149)
            steps.done = 749
        else:
            steps.go(recorder, 149)
        steps.go(recorder, 100)
        recorder.close()
    assert main(["trace", "show", "--channel", "gaps", str(paths[1])]) == 0
    assert "gaps    149 cycles are missing, from 601 on" in capsys.readouterr().out
    assert main(["trace", "diff", *map(str, paths)]) == 1
    assert "1 in gaps" in capsys.readouterr().out


def test_a_gap_at_the_end_is_told(tmp_path: Path) -> None:
    path = tmp_path / "gap.mcap"
    steps = Steps(path)
    recorder = Handover(steps.what, steps.ring, lambda _: None, room=2)
    stuck: Any = StuckPipe(recorder._outbox._pipe)
    recorder._outbox._pipe = stuck
    steps.go(recorder, 220)
    stuck.open = True
    recorder.close()
    last = list(read(path))[-1]
    assert isinstance(last, TraceEvent)
    assert (last.topic, last.value) == ("gaps", {"first": 100, "count": 121})


def test_a_process_that_dies_is_told_and_leaves_what_it_wrote(tmp_path: Path) -> None:
    path = tmp_path / "dying.mcap"
    steps = Steps(path)
    notes: list[str] = []
    recorder = Handover(steps.what, steps.ring, notes.append)
    assert recorder._worker is not None
    process = recorder._worker._process
    process.kill()
    process.wait()
    steps.go(recorder, 1000)
    with pytest.raises(EnvironmentLacks, match=r"dying\.mcap: recording has failed"):
        recorder.close()
    assert (
        notes[0]
        == f"{path}: recording has failed: a process of the bench has gone; the run goes on without it"
    )


def test_messages_pass_a_narrow_pipe_in_pieces() -> None:
    class Narrow:
        taken = b""

        def send_part(self, part: memoryview) -> int:
            self.taken += part[:3]
            return len(part[:3])

    narrow: Any = Narrow()
    outbox = Outbox(narrow, 2)
    outbox.put(b"first message")
    outbox.put(b"second")
    assert outbox.full
    outbox.send()
    assert narrow.taken == framed(b"first message")[:3]
    outbox.send_all()
    assert narrow.taken == framed(b"first message") + framed(b"second")
    assert not outbox.full


# -- failures ---------------------------------------------------------------------------------------------


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """No file of this process and its children grows beyond `size`: as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("paced", [False, True])
def test_what_stands_in_front_of_a_full_disk_can_be_read(paced: bool, tmp_path: Path) -> None:
    path = tmp_path / "full.mcap"
    steps = Steps(path)
    with largest_file(300_000):
        recorder = record(steps.what, steps.ring, paced=paced)
        steps.go(recorder, 40 * BLOCK_CYCLES)
        with pytest.raises(EnvironmentLacks, match=r"full\.mcap: recording has failed: File too large"):
            recorder.close()
    assert path.stat().st_size == 300_000
    reader = TraceReader(path)
    cycles = sum(len(stretch.block.rows) for stretch in reader.stretches())
    assert 0 < cycles < 40 * BLOCK_CYCLES
    assert reader.torn


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_run_that_cannot_be_recorded_gives_its_result(
    pace: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    program, result = tmp_path / "short.nc", tmp_path / "result.json"
    program.write_text(PROGRAM)
    arguments = ["--plc", "none", "--pace", pace, "--trace", "/dev/full", "--result", str(result)]
    assert main(["run", str(program), *arguments]) == 3
    assert json.loads(result.read_text())["status"] == "completed"
    told = capfd.readouterr().err
    assert "/dev/full: recording has failed: No space left on device\n" in told


def test_a_result_that_cannot_be_written_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "short.nc"
    program.write_text(PROGRAM)
    assert main(["run", str(program), "--plc", "none", "--result", "/dev/full"]) == 3
    told = capsys.readouterr().err
    assert "short.nc: completed" in told
    assert "/dev/full: cannot be written: No space left on device" in told


def test_a_file_that_was_taken_away_is_told(tmp_path: Path) -> None:
    file = RecordFile(tmp_path / "run", lambda _: None)
    file.write(np.zeros((3, 7), np.uint8).data)
    assert file.tell() == 21
    (tmp_path / "run").unlink()
    file.write(b"end")
    with pytest.raises(EnvironmentLacks, match="run: recording has failed: No such file"):
        file.close()
    file = RecordFile(tmp_path / "run", lambda _: None)
    (tmp_path / "other").write_bytes(b"")
    (tmp_path / "other").rename(tmp_path / "run")
    with pytest.raises(EnvironmentLacks, match="another file has taken its place"):
        file.close()


# -- interrupts -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_waits_until_a_piece_is_written(number: int) -> None:
    before = signal.signal(number, signal.default_int_handler)
    done = []

    def piece() -> None:
        with uninterrupted():
            signal.raise_signal(number)
            done.append(number)

    try:
        with pytest.raises(KeyboardInterrupt):
            piece()
    finally:
        signal.signal(number, before)
    assert done == [number]


@pytest.fixture
def delivered() -> Iterator[list[int]]:
    """Handlers that tell which signals they got, and raise."""
    got: list[int] = []

    def handler(number: int, _: object) -> None:
        got.append(number)
        raise KeyboardInterrupt

    before = {number: signal.signal(number, handler) for number in INTERRUPTS}
    yield got
    for number, one in before.items():
        signal.signal(number, one)


def test_of_several_signals_none_is_lost(delivered: list[int]) -> None:
    def piece() -> None:
        with uninterrupted():
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGINT):
                signal.raise_signal(number)
            assert not delivered

    with pytest.raises(KeyboardInterrupt):
        piece()
    assert delivered == [signal.SIGINT, signal.SIGTERM, signal.SIGINT]


def test_a_signal_before_both_handlers_stand_leaves_neither(
    delivered: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    install, before = signal.signal, [signal.getsignal(number) for number in INTERRUPTS]

    def interrupted(number: int, handler: Any) -> Any:
        monkeypatch.undo()
        install(number, handler)
        signal.raise_signal(signal.SIGTERM)

    def piece() -> None:
        with uninterrupted():
            pytest.fail("begun")

    monkeypatch.setattr(signal, "signal", interrupted)
    with pytest.raises(KeyboardInterrupt):
        piece()
    assert [signal.getsignal(number) for number in INTERRUPTS] == before


def started(folder: Path, pace: str) -> "subprocess.Popen[str]":
    """Start a run that does not end by itself, and wait until it has moved for a while."""
    program = folder / "endless.nc"
    program.write_text(
        'N10 G01 G90 X50 Y20 F20000\nN20 X0 Y0\nN30 X50\n#MSG SYN["going"]\n'
        "$WHILE 1 > 0\nN40 G01 X0 Y20 F20000\nN50 X50 Y0\n$ENDWHILE\nM30\n"
    )
    command = [sys.executable, "-m", "hli_bench.cli.main", "run", str(program), "--plc", "none"]
    command += ["--pace", pace, "--trace", str(folder / "run.mcap"), "--can-log", str(folder / "run.log")]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "going\n"
    return process


def ended(process: "subprocess.Popen[str]", number: int) -> str:
    """Send a signal; return what was said when the run and the processes that write for it have ended."""
    process.send_signal(number)
    return process.communicate()[1]


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_killed_run_leaves_a_trace_that_says_it_was_cut_off(
    pace: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    process = started(tmp_path, pace)
    if pace == "free":
        while not has_a_chunk(tmp_path / "run.mcap"):
            pass
    ended(process, signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    trace = str(tmp_path / "run.mcap")
    assert main(["trace", "show", "--every", "0", "--channel", "axes", "--axis", "X", trace]) == 0
    told = capsys.readouterr()
    assert "cut off: the recording was not ended" in told.err
    assert len(told.out.splitlines()) > 2 * BLOCK_CYCLES


def has_a_chunk(path: Path) -> bool:
    try:
        TraceReader(path)
    except InputError:
        return False
    return True


@pytest.mark.parametrize("pace", ["free", "real"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_ends_its_files(pace: str, number: int, tmp_path: Path) -> None:
    process = started(tmp_path, pace)
    told = ended(process, number)
    assert process.returncode == 130
    assert "endless.nc: aborted" in told
    reader = TraceReader(tmp_path / "run.mcap")
    assert sum(len(stretch.block.rows) for stretch in reader.stretches()) > 2 * BLOCK_CYCLES
    assert not reader.torn
    assert (tmp_path / "run.log").read_bytes().endswith(b"\n")
