"""The default drive: a CiA 402 servo with touch probe, cyclic synchronous position (figures decided here)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from drives.cia402 import drive
from hli_bench.base.loading import data_file


@dataclass(frozen=True, slots=True)
class DriveModel:
    """Name, object dictionary and ratings of a drive with its motor."""

    name: str
    eds: str
    rated_torque_mnm: int
    rated_current_ma: int
    peak_torque_permille: int
    encoder_increments: int


MODEL: Final = DriveModel(
    name="servo402",
    eds="servo402.eds",
    rated_torque_mnm=15_000,
    rated_current_ma=10_000,
    peak_torque_permille=3_000,
    encoder_increments=1_048_576,
)


def create(name: str, node_id: int, row: Any, options: Mapping[str, object]) -> drive.Drive:
    """Build a drive of this model on its servo row; ratings that the row lacks (0) are the model's."""
    ratings = {
        "rated_torque": MODEL.rated_torque_mnm / 1000.0,
        "peak_permille": MODEL.peak_torque_permille,
        "increments_per_turn": MODEL.encoder_increments,
    }
    for field, rating in ratings.items():
        if not row[field]:
            row[field] = rating
    return drive.create(name, node_id, data_file("eds", MODEL.eds), row, options)
