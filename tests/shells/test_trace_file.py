"""The trace of a run: what is in it, that it repeats to the byte, that a torn one can be read."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from hli_bench.base.errors import InputError
from hli_bench.bench.bench import Bench
from hli_bench.laws.rows import LOG, LOG_CYCLES
from hli_bench.shells.trace_file import BLOCK_CYCLES, AxesBlock, TraceEvent, TraceFile, TraceReader, read
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.signals import Edge

SETTINGS = {
    "plant.probe.Z.face_mm": 299,
    "plant.probe.Z.material": "below",
    "axis.Z.kenngr.measure.signal": "DRIVE",
}
PROGRAM = 'N10 G01 G90 X5 F6000\nN20 G100 Z290 F500\nN30 #MSG SYN["Z=%f", V.A.MESS.Z]\nN40 G01 Z300\nN50 M30'


def record(path: Path, before: Callable[[Bench], None] = lambda _: None) -> Bench:
    with Bench("demo", SETTINGS, plc=[]) as bench:
        before(bench)
        with TraceFile(path, bench.kernel.setup, bench.kernel.rows.log, "demo", SETTINGS) as trace:
            bench.engine.observers.append(trace)
            assert bench.run(PROGRAM).completed
        trace.close()
    return bench


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Bench, Path]:
    path = tmp_path_factory.mktemp("trace") / "run.mcap"
    return record(path), path


def blocks(path: Path) -> list[AxesBlock]:
    return [entry for entry in read(path) if isinstance(entry, AxesBlock)]


def events(path: Path, topic: str) -> list[TraceEvent]:
    return [entry for entry in read(path) if isinstance(entry, TraceEvent) and entry.topic == topic]


def test_blocks_hold_every_cycle_and_begin_at_multiples_of_their_length(run: tuple[Bench, Path]) -> None:
    bench, path = run
    found = blocks(path)
    assert [block.first for block in found] == [1, *range(BLOCK_CYCLES, bench.engine.cycle + 1, BLOCK_CYCLES)]
    assert sum(len(block.rows) for block in found) == bench.engine.cycle
    slot = bench.engine.cycle % LOG_CYCLES
    assert found[-1].rows[-1].tobytes() == bench.kernel.rows.log[slot].tobytes()
    assert found[0].rows.dtype == LOG.newbyteorder("<")


def test_events_stand_with_their_instants(run: tuple[Bench, Path]) -> None:
    path = run[1]
    meta = events(path, "meta")[0].value
    assert (meta["machine"], meta["cycle_ns"], len(meta["axes"])) == ("demo", 1_000_000, 7)
    assert meta["overrides"]["plant.probe.Z.face_mm"] == "299"
    up, down = (edge for edge in events(path, "edges") if edge.value["signal"] == "probe")
    assert up.value["level"] is True
    assert down.value["level"] is False
    measured, message = events(path, "cnc")
    assert measured.value["kind"] == "MeasuredValue"
    assert measured.value["acs_tenth_um"] == pytest.approx(2_990_000, abs=1)
    assert 0 <= measured.at_ns - up.at_ns <= 2_000_000
    assert message.value["text"] == "Z=299.000000"
    first = [event.value for event in events(path, "can")[:7]]
    assert first == [CanFrame(0x700 + node, b"\0") for node in range(1, 8)]


def test_equal_runs_give_equal_bytes(run: tuple[Bench, Path], tmp_path: Path) -> None:
    again = tmp_path / "again.mcap"
    record(again)
    assert again.read_bytes() == run[1].read_bytes()


def test_the_bytes_do_not_depend_on_where_strides_end(run: tuple[Bench, Path], tmp_path: Path) -> None:
    def cycle_by_cycle(bench: Bench) -> None:
        step = bench.engine.step
        bench.engine.step = lambda _: step(bench.engine.cycle + 1)

    singly = tmp_path / "singly.mcap"
    record(singly, cycle_by_cycle)
    assert singly.read_bytes() == run[1].read_bytes()


def test_other_readers_find_index_and_schemas(run: tuple[Bench, Path]) -> None:
    with run[1].open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert summary is not None
        assert reader.get_header().library == "hli-bench"
        topics = {channel.topic: channel for channel in summary.channels.values()}
        assert set(topics) == {"meta", "axes", "can", "edges", "plc", "refused", "cnc"}
        assert all(channel.schema_id in summary.schemas for channel in topics.values())
        late = list(reader.iter_messages(["axes"], starting_at=250_000_000))
        assert late[0][2].log_time == 250_000_000


def made_up(path: Path, cycles: int) -> TraceFile:
    """A long trace without a bench: incompressible rows, so that chunks come often."""
    bench = Bench("demo", plc=[])
    ring: Any = np.zeros_like(bench.kernel.rows.log)
    trace = TraceFile(path, bench.kernel.setup, ring, "demo")
    generator = np.random.default_rng(3)
    for first in range(1, cycles, 100):
        for cycle in range(first, first + 100):
            ring[cycle % LOG_CYCLES]["target"] = generator.integers(-1000, 1000, ring.shape[1])
        trace.cycles(first, 100)
        trace.edges([Edge("probe", first * 1_000_000 + 17, first % 200 == 1)])
        trace.commands(Commands("plc", first + 99, (Write("ax/3/head/plc_present_w", True),)))
    return trace


def test_a_file_cut_off_anywhere_is_read_to_its_last_chunk(tmp_path: Path) -> None:
    whole = tmp_path / "whole.mcap"
    made_up(whole, 10_000).close()
    data = whole.read_bytes()
    complete = [(type(entry), getattr(entry, "first", None)) for entry in read(whole)]
    counts = []
    for size in (*np.linspace(8, len(data) - 100, 40, dtype=int), *range(len(data) - 50, len(data))):
        torn = tmp_path / "torn.mcap"
        torn.write_bytes(data[:size])
        try:
            reader = TraceReader(torn)
        except InputError:
            counts.append(0)
            continue
        entries = [(type(entry), getattr(entry, "first", None)) for entry in reader.entries()]
        assert entries == complete[: len(entries)]
        assert reader.torn or len(entries) == len(complete)
        counts.append(len(entries))
    assert counts == sorted(counts)
    assert counts[0] == 0 < counts[20] < len(complete)


def test_a_file_without_a_complete_chunk_says_so(tmp_path: Path) -> None:
    path = tmp_path / "short.mcap"
    made_up(path, 200).close()
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(InputError, match="cut off in front of its first complete chunk"):
        TraceReader(path)


def test_a_damaged_chunk_is_named(tmp_path: Path) -> None:
    path = tmp_path / "damaged.mcap"
    made_up(path, 10_000).close()
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0x40
    path.write_bytes(data)
    with pytest.raises(InputError, match=r"damaged\.mcap: damaged in front of byte [0-9]+"):
        list(read(path))


def test_stretches_are_blocks_with_what_happened_in_them(run: tuple[Bench, Path]) -> None:
    reader = TraceReader(run[1])
    assert [axis.name for axis in reader.meta.axes] == ["X", "Y", "Z", "X2", "A", "B", "S"]
    stretches = list(reader.stretches())
    assert not reader.torn
    assert sum(len(stretch.block.rows) for stretch in stretches) == run[0].engine.cycle
    for stretch in stretches:
        times = [event.at_ns for event in stretch.events]
        assert times == sorted(times)
    entries = [entry for entry in read(run[1]) if isinstance(entry, TraceEvent)]
    assert [event for stretch in stretches for event in stretch.events] == entries[1:]


def test_a_foreign_mcap_file_is_no_trace(tmp_path: Path) -> None:
    path = tmp_path / "foreign.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(library="something else")
        writer.finish()
    with pytest.raises(InputError, match="an MCAP file of 'something else'"):
        TraceReader(path)


def test_a_run_that_dies_leaves_its_chunks(tmp_path: Path) -> None:
    path = tmp_path / "dying.mcap"
    trace = made_up(path, 10_000)
    assert sum(len(block.rows) for block in blocks(path)) > 5_000
    trace.close()


def test_events_wait_for_the_block_they_belong_to(tmp_path: Path) -> None:
    path = tmp_path / "order.mcap"
    made_up(path, 1_000).close()
    order = [
        (entry.first, entry.first + len(entry.rows)) if isinstance(entry, AxesBlock) else entry.at_ns
        for entry in read(path)
    ]
    begin, end = 0, 0
    for entry in order[1:]:
        if isinstance(entry, tuple):
            begin, end = entry
        else:
            assert begin * 1_000_000 - 1_000_000 < entry < end * 1_000_000


def test_something_else_is_no_trace(tmp_path: Path) -> None:
    path = tmp_path / "text.mcap"
    for text in (b"N10 G01 X10\nN20 M30\n", b"N10", b""):
        path.write_bytes(text)
        with pytest.raises(InputError, match="no trace"):
            list(read(path))
