"""Folder test: every EDS parses here and in python-canopen, every model builds, walks and sends its telegram."""

import logging
import pkgutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import canopen
import hli_bench_drives.models
import numpy as np
import pytest
from hli_bench_drives.cia402.states import State

from hli_bench.base import loading
from hli_bench.base.time import Ns
from hli_bench.bench.schema import DRIVE_TRAIN
from hli_bench.laws.rows import SERVO
from hli_bench.protocols.canopen.device import Device
from hli_bench.protocols.canopen.eds import load
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame

EDS_FILES = sorted(loading.data_file("eds", ".").glob("*.eds"))
MODELS = [
    loading.module(f"hli_bench_drives.models.{info.name}")
    for info in pkgutil.iter_modules(hli_bench_drives.models.__path__)
]


def test_folders_are_not_empty() -> None:
    assert EDS_FILES
    assert MODELS


@pytest.mark.parametrize("path", EDS_FILES, ids=lambda path: path.stem)
def test_eds_parses_here_and_in_python_canopen_without_warnings(
    path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    oracle = canopen.import_od(str(path), 7)
    description = load(path)
    assert not caplog.records
    assert {entry.index for entry in description} == {index for index in oracle if index >= 0x1000}
    for entry in description:
        variable = oracle.get_variable(entry.index, entry.subindex)
        assert variable is not None
        if variable.default is not None:
            assert entry.default_for(7) == variable.default
    Device(description, 7)
    assert int(description.device_info["NROFRXPDO"], 0) == len(Device(description, 7).pdos.rpdos)
    assert int(description.device_info["NROFTXPDO"], 0) == len(Device(description, 7).pdos.tpdos)


@pytest.mark.parametrize("path", EDS_FILES, ids=lambda path: path.stem)
def test_identity_in_file_and_object_agree(path: Path) -> None:
    description = load(path)
    for key, sub in (("VENDORNUMBER", 1), ("PRODUCTNUMBER", 2), ("REVISIONNUMBER", 3)):
        assert int(description.device_info[key], 0) == description[0x1018, sub].default


@pytest.mark.parametrize("model", MODELS, ids=lambda module: module.__name__.rpartition(".")[2])
class TestModel:
    """What every drive model must do."""

    def build(self, model: ModuleType) -> tuple[Any, Any]:
        row = np.zeros(1, SERVO)[0]
        return model.create("X", 1, row, {}), row

    def test_its_eds_says_what_a_machine_folder_says_by_default(self, model: ModuleType) -> None:
        description = load(loading.data_file("eds", model.MODEL.eds))
        defaults: dict[str, Any] = {key.path.rpartition(".")[2]: key.default for key in DRIVE_TRAIN}
        assert description[0x6076, 0].default == 1000 * defaults["rated_torque_nm"]
        assert description[0x6072, 0].default == defaults["peak_permille"]
        assert description[0x608F, 1].default == defaults["increments_per_turn"]
        assert description[0x1008, 0].default == model.MODEL.name

    def test_state_walk_and_telegram(self, model: ModuleType) -> None:
        drive, row = self.build(model)
        assert [frame.cob_id for frame in drive.power_on()] == [0x701]
        drive.on_frame(nmt_frame(NmtCommand.START), Ns(0))
        assert drive.cyclic_signature()
        for word in (0x06, 0x07, 0x0F):
            drive.exchange(word, 0, 0, Ns(0))
        assert drive.state is State.OPERATION_ENABLED
        assert row["enabled"] == 1
        sent = drive.device.on_sync(Ns(0))
        assert [frame.cob_id for frame in sent] == [0x181, 0x281, 0x381, 0x481]
        assert [frame.cob_id for frame in drive.device.on_sync(Ns(1))] == [0x181, 0x281, 0x381, 0x481]

    def test_every_readable_object_can_be_uploaded(self, model: ModuleType) -> None:
        drive, _ = self.build(model)
        values = drive.device.values
        for entry in values.description:
            if entry.access.readable:
                data = values.upload(entry.index, entry.subindex)
                assert isinstance(data, bytes)

    def test_every_writable_object_takes_its_own_value_back(self, model: ModuleType) -> None:
        drive, _ = self.build(model)
        values = drive.device.values
        special = {0x1010, 0x1011, *range(0x1600, 0x1604), *range(0x1A00, 0x1A04)}
        for entry in values.description:
            if entry.access.writable and entry.index not in special:
                values.download(entry.index, entry.subindex, values.upload(entry.index, entry.subindex))


@pytest.mark.parametrize("package", [True, False], ids=["with __init__", "without"])
def test_a_folder_called_drives_of_the_user_hides_nothing_and_is_found(tmp_path: Path, package: bool) -> None:
    folder = tmp_path / "drives"
    (folder / "mine").mkdir(parents=True)
    if package:
        (folder / "__init__.py").touch()
        (folder / "mine" / "__init__.py").touch()
    (folder / "mine" / "motor.py").write_text(
        "from hli_bench_drives.models.servo402 import MODEL, create\n", encoding="utf-8"
    )
    code = "from hli_bench import Bench\n" + "\n".join(
        f"Bench('demo', {{'axis.Z.drive': {name!r}}}).close()"
        for name in ("drives.models.servo402", "drives.mine.motor", "hli_bench_drives.models.servo402")
    )
    ended = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stderr) == (0, "")
