"""A trace in forms that other programs read: tables (CSV, Parquet) and the bus (candump, pcap), block by block.

A table has one row a cycle and axis; `command`, `actual`, `lag` in mm or degrees, all else as on the bus.
"""

from collections.abc import Callable, Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.base.loading import how_to_install
from hli_bench.base.units import TENTH_UM_PER_MM
from hli_bench.shells.bus_file import BusFile, Form
from hli_bench.shells.candump import Candump
from hli_bench.shells.pcap import Pcap
from hli_bench.shells.trace_file import Stretch, TraceReader
from hli_bench.wire.can import CanFrame

_LENGTHS: Final = ("command", "actual", "lag")
_ROWS: Final = 100_000
"""Rows of a Parquet row group, at least."""

Columns = dict[str, NDArray[Any]]
"""A piece of the table: arrays of equal length."""


def csv(reader: TraceReader, out: BinaryIO) -> None:
    """Write the axes as CSV with a line of names."""
    heads: list[str] = []
    for columns in _tables(reader):
        if not heads:
            heads = list(columns)
            out.write((",".join(heads) + "\n").encode())
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        out.write("".join(",".join(map(str, row)) + "\n" for row in rows).encode())


def parquet(reader: TraceReader, out: BinaryIO) -> None:
    """Write the axes as Parquet."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    writer: Any = None
    waiting: list[Any] = []
    try:
        for columns in _tables(reader):
            waiting.append(pa.table(columns))
            writer = writer or pq.ParquetWriter(out, waiting[0].schema, compression="zstd")
            if sum(len(table) for table in waiting) >= _ROWS:
                writer.write_table(pa.concat_tables(waiting))
                waiting.clear()
        if waiting:
            writer.write_table(pa.concat_tables(waiting))
    finally:
        if writer is not None:
            writer.close()


def candump(reader: TraceReader, out: BinaryIO) -> None:
    """Write all frames of the bus as `--can-log` does."""
    _bus(reader, out, Candump())


def pcap(reader: TraceReader, out: BinaryIO) -> None:
    """Write all frames of the bus as a capture file."""
    _bus(reader, out, Pcap())


FORMATS: Final[Mapping[str, Callable[[TraceReader, BinaryIO], None]]] = {
    "csv": csv,
    "parquet": parquet,
    "candump": candump,
    "pcap": pcap,
}


def export(reader: TraceReader, form: str, out: Path) -> None:
    """Write a trace as one of `FORMATS`.

    Raises OSError when the file cannot be written, EnvironmentLacks without pyarrow for Parquet, before it is touched.
    """
    if form == "parquet" and find_spec("pyarrow") is None:
        raise EnvironmentLacks(f"Parquet needs pyarrow: {how_to_install('pyarrow')}; or export as csv")
    with out.open("wb") as file:
        FORMATS[form](reader, file)


def _tables(reader: TraceReader) -> Iterator[Columns]:
    """Yield the table of axes block by block."""
    meta = reader.meta
    names = np.array([axis.name for axis in meta.axes])
    for stretch in reader.stretches():
        block = stretch.block
        count = len(block.rows)
        if not count:
            continue
        cycles = np.repeat(np.arange(block.first, block.first + count, dtype=np.int64), len(names))
        columns: Columns = {
            "cycle": cycles,
            "time_ns": cycles * meta.cycle_ns,
            "axis": np.tile(names, count),
        }
        rows = block.rows.reshape(-1)
        for name in rows.dtype.names or ():
            columns |= _columns(name, rows[name])
        yield columns


def _columns(name: str, values: NDArray[Any]) -> Columns:
    """Return a field of the log as columns: an array field as one column an element."""
    if values.ndim > 1:
        return {f"{name}_{at}": np.ascontiguousarray(values[:, at]) for at in range(values.shape[1])}
    return {name: values / TENTH_UM_PER_MM if name in _LENGTHS else np.ascontiguousarray(values)}


def _bus(reader: TraceReader, out: BinaryIO, form: Form) -> None:
    meta = reader.meta
    nodes = [axis.node for axis in meta.axes]
    bus = BusFile(out, form, nodes, meta.cycle_ns, meta.dc_epoch_ns)
    for stretch in reader.stretches():
        bus.write(stretch.block.first, stretch.block.rows, _frames(stretch, meta.cycle_ns))


def _frames(stretch: Stretch, cycle_ns: int) -> dict[int, list[CanFrame]]:
    """Return the frames beside the telegrams by cycle."""
    frames: dict[int, list[CanFrame]] = {}
    for event in stretch.events:
        if event.topic == "can":
            frames.setdefault(event.at_ns // cycle_ns, []).append(event.value)
    return frames
