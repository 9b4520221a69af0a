"""Traces as other programs read them, and two traces compared."""

import csv
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.bench.bench import Bench
from hli_bench.laws.rows import LOG_CYCLES
from hli_bench.shells.candump import CandumpLog
from hli_bench.shells.pcap import Pcap
from hli_bench.shells.trace_diff import Comparison, compare
from hli_bench.shells.trace_export import export
from hli_bench.shells.trace_file import AxesBlock, TraceFile, TraceReader, read
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.signals import Edge

SETTINGS = {
    "plant.probe.Z.face_mm": 299,
    "plant.probe.Z.material": "below",
    "axis.Z.kenngr.measure.signal": "DRIVE",
}
PROGRAM = "N10 G01 G90 X5 F6000\nN20 G100 Z290 F500\nN40 G01 Z300\nN50 M30"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with `run.mcap` and `run.log` of one run."""
    folder = tmp_path_factory.mktemp("export")
    with Bench("demo", SETTINGS, plc=[]) as bench:
        setup, log = bench.kernel.setup, bench.kernel.rows.log
        trace = TraceFile(folder / "run.mcap", setup, log, "demo", SETTINGS)
        candump = CandumpLog(folder / "run.log", setup, log)
        bench.engine.observers += [trace, candump]
        assert bench.run(PROGRAM).completed
        trace.close()
        candump.close()
    return folder


def recorded(path: Path) -> Any:
    return np.concatenate([entry.rows for entry in read(path) if isinstance(entry, AxesBlock)])


def test_candump_is_what_the_can_log_of_the_run_holds(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.log"
    export(TraceReader(run / "run.mcap"), "candump", out)
    assert out.read_bytes() == (run / "run.log").read_bytes()


def test_csv_and_parquet_hold_every_cycle_of_every_axis(run: Path, tmp_path: Path) -> None:
    rows = recorded(run / "run.mcap")
    for form in ("csv", "parquet"):
        export(TraceReader(run / "run.mcap"), form, tmp_path / f"run.{form}")
    with (tmp_path / "run.csv").open(newline="") as file:
        lines = list(csv.DictReader(file))
    table = pyarrow.parquet.read_table(tmp_path / "run.parquet").to_pydict()
    assert list(lines[0]) == list(table)
    assert len(lines) == len(table["cycle"]) == rows.size
    for at in (0, rows.size // 2, rows.size - 1):
        cycle, axis = divmod(at, rows.shape[1])
        line, row = lines[at], rows[cycle, axis]
        assert (line["cycle"], line["time_ns"]) == (str(cycle + 1), str((cycle + 1) * 1_000_000))
        assert line["axis"] == table["axis"][at] == ["X", "Y", "Z", "X2", "A", "B", "S"][axis]
        for name in ("command", "actual", "lag"):
            assert float(line[name]) == table[name][at] == row[name] / 10_000
        assert int(line["target"]) == table["target"][at] == row["target"]
        assert [int(line[f"latch_{n}"]) for n in (0, 1)] == row["latch"].tolist()


def test_parquet_without_pyarrow_says_what_is_missing(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr(sys, "executable", "/my clone/.venv/bin/python")
    with pytest.raises(EnvironmentLacks) as caught:
        export(TraceReader(run / "run.mcap"), "parquet", tmp_path / "run.parquet")
    command = "'/my clone/.venv/bin/python' -m pip install pyarrow"
    assert str(caught.value) == f"Parquet needs pyarrow: {command}; or export as csv"
    assert not (tmp_path / "run.parquet").exists()


def test_a_capture_record() -> None:
    record = Pcap().frame(CanFrame(0x583, b"\x01\x02"), 1_767_225_600_000_000_007)
    assert record.hex() == "00b95569" + "07000000" + "0a000000" * 2 + "00000583" + "02000000" + "0102"
    assert Pcap().frame(CanFrame(0x701, remote=True), 0)[16:20].hex() == "40000701"


@pytest.mark.skipif(shutil.which("tshark") is None, reason="tshark is not installed")
def test_tshark_opens_the_capture_as_canopen(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "run.pcap"
    export(TraceReader(run / "run.mcap"), "pcap", out)
    decode = ["-d", "can.subdissector,canopen"]
    fields = ["-T", "fields", "-e", "frame.time_epoch", "-e", "can.id", "-e", "frame.protocols"]
    shown = subprocess.run(
        ["tshark", "-r", str(out), *decode, *fields], capture_output=True, text=True, check=True
    )
    lines = [line.split("\t") for line in shown.stdout.splitlines()]
    log = (run / "run.log").read_text().splitlines()
    assert len(lines) == len(log)
    for (time, identifier, protocols), line in zip(lines, log, strict=True):
        stamp, _, frame = line.split()
        assert protocols == "can:canopen" or frame.endswith("#"), line
        assert time[:17] == stamp[1:-1]
        assert int(identifier) == int(frame.split("#")[0], 16)


def made_up(
    path: Path, change: Callable[[int, Any], None] = lambda *_: None, cycles: int = 900
) -> TraceReader:
    """A trace without a bench: `change(cycle, row)` may alter a cycle's row."""
    bench = Bench("demo", plc=[])
    ring: Any = np.zeros_like(bench.kernel.rows.log)
    with TraceFile(path, bench.kernel.setup, ring, "demo") as trace:
        for cycle in range(1, cycles + 1):
            row = ring[cycle % LOG_CYCLES]
            row["target"] = cycle
            change(cycle, row)
            trace.cycles(cycle, 1)
            if cycle % 100 == 0:
                trace.edges([Edge("probe", cycle * 1_000_000 - 17, cycle % 200 == 0)])
    return TraceReader(path)


def compared(tmp_path: Path, change: Callable[[int, Any], None], cycles: int = 900) -> Comparison:
    return compare(made_up(tmp_path / "a.mcap"), made_up(tmp_path / "b.mcap", change, cycles))


def test_equal_traces_differ_in_nothing(tmp_path: Path) -> None:
    found = compared(tmp_path, lambda *_: None)
    assert found.first is None
    assert not found.counts


def test_a_value_that_differs_is_named_with_its_place(tmp_path: Path) -> None:
    def change(cycle: int, row: Any) -> None:
        if cycle in (613, 700):
            row[2]["target"] += 1
            row[4]["latch"][1] = 7

    found = compared(tmp_path, change)
    first = found.first
    assert first is not None
    assert (first.channel, first.cycle, first.at_ns, first.axis) == ("axes", 613, 613_000_000, "Z")
    # The ring keeps latches until the cycle that overwrites them.
    assert (first.field, first.left, first.right) == ("target", 613, 614)
    assert found.counts["axes"] == 4


def test_zero_and_minus_zero_differ(tmp_path: Path) -> None:
    def change(cycle: int, row: Any) -> None:
        row["lag"] = -0.0

    assert compared(tmp_path, change).counts["axes"] == 900 * 7


def test_cycles_that_only_one_trace_has_are_counted(tmp_path: Path) -> None:
    found = compared(tmp_path, lambda *_: None, cycles=600)
    assert found.counts == {"axes": 300, "edges": 3}
    assert found.first is not None
    assert (found.first.cycle, found.first.left, found.first.right) == (601, "cycle 601", "nothing")


def with_events(path: Path, events: Sequence[tuple[int, str]]) -> TraceReader:
    bench = Bench("demo", plc=[])
    ring: Any = np.zeros_like(bench.kernel.rows.log)
    with TraceFile(path, bench.kernel.setup, ring, "demo") as trace:
        trace.cycles(1, 500)
        for cycle, element in events:
            trace.commands(Commands("plc", cycle, (Write(element, True),)))
    return TraceReader(path)


def test_one_event_more_is_one_difference(tmp_path: Path) -> None:
    left = with_events(tmp_path / "a.mcap", [(cycle, "x") for cycle in range(1, 300)])
    right = with_events(tmp_path / "b.mcap", [(cycle, "x") for cycle in range(1, 300) if cycle != 40])
    found = compare(left, right)
    assert found.counts == {"plc": 1}
    assert found.first is not None
    assert (found.first.cycle, found.first.right) == (40, "nothing")


def test_an_event_with_another_value_names_the_field(tmp_path: Path) -> None:
    left = with_events(tmp_path / "a.mcap", [(3, "x"), (4, "x")])
    right = with_events(tmp_path / "b.mcap", [(3, "x"), (4, "y")])
    first = compare(left, right).first
    assert first is not None
    assert (first.field, first.left, first.right) == ("writes", [["x", True]], [["y", True]])


def test_other_settings_and_other_machines_are_named(tmp_path: Path, run: Path) -> None:
    with Bench("demo", plc=[], settings={"cycle_us": 500}) as bench:
        TraceFile(tmp_path / "slow.mcap", bench.kernel.setup, bench.kernel.rows.log, "demo").close()
    found = compare(TraceReader(run / "run.mcap"), TraceReader(tmp_path / "slow.mcap"))
    assert [one.field for one in found.meta] == ["cycle_ns", *(f"set {key}" for key in sorted(SETTINGS))]
    assert found.first is None
