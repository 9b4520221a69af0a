"""The default drive: a CiA 402 servo with touch probe, cyclic synchronous position (figures decided here)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from hli_bench.base.loading import data_file
from hli_bench_drives.cia402 import drive


@dataclass(frozen=True, slots=True)
class DriveModel:
    """Name of a drive and of its EDS, among those of the project or a path."""

    name: str
    eds: str


MODEL: Final = DriveModel(name="servo402", eds="servo402.eds")


def create(name: str, node_id: int, row: Any, options: Mapping[str, object]) -> drive.Drive:
    """Build a drive of this model on its servo row, which holds the ratings of motor and encoder."""
    return drive.create(name, node_id, data_file("eds", MODEL.eds), row, options)
