"""Results on disk: a manifest, part files as the runs end, one table when all are there."""

import fcntl
import json
import os
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final, Self

from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.base.loading import how_to_install
from hli_bench.sweep.campaign import Campaign, kind_of
from hli_bench.sweep.work import Row, code_digest

try:
    import pyarrow as pa
    import pyarrow.parquet as pq
except ModuleNotFoundError as error:
    raise EnvironmentLacks(f"a sweep needs pyarrow: {how_to_install('pyarrow')}") from error

MANIFEST: Final = "campaign.json"
TABLE: Final = "runs.parquet"
PARTS: Final = "parts"
TYPES: Final[Mapping[type, Any]] = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: pa.string()}


class Store:
    """The folder of a campaign. A part counts from the moment it has its name; only one process may write."""

    def __init__(self, folder: Path, campaign: Campaign) -> None:
        self.folder = folder
        self._campaign = campaign
        self._schema = schema(campaign)
        self._closing = ExitStack()

    def __enter__(self) -> Self:
        """Open or begin the folder. Raises InputError when it belongs to another campaign or is in use."""
        with ExitStack() as opened:
            self._open(opened)
            self._closing = opened.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.close()

    @property
    def table(self) -> Path:
        """The file with all runs."""
        return self.folder / TABLE

    def done(self) -> set[int]:
        """Return the numbers of the runs that are on disk."""
        return set(self._rows().column("run").to_pylist())

    def add(self, rows: Sequence[Row]) -> None:
        """Write runs that have ended; when this returns they are kept whatever happens."""
        rows = sorted(rows, key=lambda row: row.number)
        name = f"{rows[0].number:09d}-{rows[-1].number:09d}.parquet"
        self._write(self._table(rows), self.folder / PARTS / name)

    def finish(self) -> Any:
        """Write the one table, rows in the order of the runs, and return it; the parts go."""
        table = self._rows().sort_by("run").combine_chunks()
        self._write(table, self.table)
        for part in self._parts():
            part.unlink()
        (self.folder / PARTS).rmdir()
        return table

    def _open(self, opened: ExitStack) -> None:
        try:
            (self.folder / PARTS).mkdir(parents=True, exist_ok=True)
            lock = opened.enter_context((self.folder / "lock").open("w"))
        except OSError as error:
            raise InputError(f"--out: cannot be written: {error.strerror}", file=str(self.folder)) from error
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise InputError("a sweep is at work in this folder", file=str(self.folder)) from error
        self._check_manifest()
        for left in (self.folder / PARTS).glob("*.new"):
            left.unlink()

    def _check_manifest(self) -> None:
        manifest = {"code": code_digest(), **self._campaign.digests}
        path = self.folder / MANIFEST
        if not path.exists():
            if any(self._parts()) or self.table.exists():
                raise InputError(f"holds runs and no {MANIFEST}; choose another --out", file=str(self.folder))
            text = json.dumps({"campaign": Path(self._campaign.file).name, **manifest}, indent=2)
            replace_file(path, (text + "\n").encode())
            return
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
            changed = [name for name, value in manifest.items() if found.get(name) != value]
        except (ValueError, AttributeError) as error:
            raise InputError("is not the manifest of a sweep", file=str(path)) from error
        if changed:
            raise InputError(
                f"holds runs of another campaign (different: {', '.join(changed)}); "
                "choose another --out or delete the folder",
                file=str(self.folder),
            )

    def _parts(self) -> list[Path]:
        return sorted((self.folder / PARTS).glob("*.parquet"))

    def _rows(self) -> Any:
        """Return the runs on disk, each once."""
        files = self._parts()
        if self.table.exists():
            # The table may be there and its parts not yet gone.
            return self._read(self.table)
        tables = [self._read(file) for file in files]
        return pa.concat_tables(tables) if tables else self._schema.empty_table()

    def _read(self, file: Path) -> Any:
        try:
            return pq.read_table(file, schema=self._schema)
        except OSError as error:
            if error.errno is not None:
                raise EnvironmentLacks(f"{file}: cannot be read: {error.strerror}") from error
            raise _damaged(file) from error
        except pa.ArrowException as error:
            raise _damaged(file) from error

    def _table(self, rows: Sequence[Row]) -> Any:
        campaign = self._campaign
        drawn = [campaign.drawn(row.number) for row in rows]
        columns: dict[str, list[Any]] = {"run": [row.number for row in rows]}
        columns |= {key: [values[key] for values in drawn] for key in campaign.varied}
        columns |= {name: [row.metrics[at] for row in rows] for at, name in enumerate(campaign.metrics)}
        columns |= {name: [getattr(row, name) for row in rows] for name in ("status", "errors", "cycles")}
        return pa.table(columns, schema=self._schema)

    def _write(self, table: Any, path: Path) -> None:
        sink = pa.BufferOutputStream()
        pq.write_table(table, sink, compression="zstd")
        replace_file(path, sink.getvalue().to_pybytes())


def schema(campaign: Campaign) -> Any:
    """Return the columns of a campaign's table."""
    fields = [pa.field("run", pa.int64(), nullable=False)]
    fields += [pa.field(key, TYPES[kind_of(campaign, key)], nullable=False) for key in campaign.varied]
    fields += [pa.field(name, pa.float64()) for name in campaign.metrics]
    for name, kind in (("status", pa.string()), ("errors", pa.string()), ("cycles", pa.int64())):
        fields.append(pa.field(name, kind, nullable=False))
    return pa.schema(fields)


def _damaged(file: Path) -> InputError:
    return InputError("is damaged; delete it, and the same command does its runs anew", file=str(file))


def replace_file(path: Path, data: bytes) -> None:
    """Write a file so that it is there whole or not at all, also after a power failure. Raises EnvironmentLacks."""
    new = path.with_name(path.name + ".new")
    try:
        with new.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        new.replace(path)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        raise EnvironmentLacks(f"{path}: cannot be written: {error.strerror}") from error
