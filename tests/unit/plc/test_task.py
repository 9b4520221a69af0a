import inspect
from typing import Any

import pytest

from hli_bench.base.errors import InputError
from hli_bench.plc import TON, Plc, Task
from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.images import TerminalLayout

LAYOUT = Layout([(1, "X", "linear")])
CAMS = TerminalLayout("cams", (("ch1/input", "BOOL", 0),))
CAM = "ax/1/lr_mc_control/reference_cam"


class Cam(Plc):
    def __init__(self) -> None:
        self.delay = TON()

    def start(self, hli: Any, io: Any) -> None:
        hli.ax[1].lr_mc_control.reference_cam.enable_w = True

    def cycle(self, hli: Any, io: Any) -> None:
        hli.ax[1].lr_mc_control.reference_cam.command_w = self.delay(IN=io.cams.ch1.input, PT=2)


def test_the_first_cycle_writes_everything_and_later_ones_what_changed() -> None:
    image, task = Image(LAYOUT), Task("cam", Cam(), 1000, LAYOUT, [CAMS])
    first = Commands("cam", 1, (Write(f"{CAM}/enable_w", True), Write(f"{CAM}/command_w", False)))
    assert task.step(1, 1_000_000, image.data, {"cams": b"\x00"}) == first
    assert task.step(2, 2_000_000, image.data, {"cams": b"\x01"}) == Commands("cam", 2, ())
    assert task.step(3, 3_000_000, image.data, {}) == Commands("cam", 3, ())
    assert task.step(4, 4_000_000, image.data, {}) == Commands("cam", 4, (Write(f"{CAM}/command_w", True),))


def test_two_tasks_of_one_process_have_their_own_time() -> None:
    image, tasks = Image(LAYOUT), [Task(name, Cam(), 1000, LAYOUT, [CAMS]) for name in "ab"]
    for task, start in zip(tasks, (0, 10**12), strict=True):
        task.step(1, start, image.data, {"cams": b"\x01"})
    assert len(tasks[0].step(2, 2_000_000, image.data, {}).writes) == 1
    assert len(tasks[1].step(2, 10**12 + 1_000_000, image.data, {}).writes) == 0


class Broken(Plc):
    def cycle(self, hli: Any, io: Any) -> None:
        hli.ax[1].lr_mc_control.reference_cam.comand_w = True


def test_an_error_of_the_script_names_its_file_and_line() -> None:
    task = Task("broken", Broken(), 1000, LAYOUT, [CAMS])
    with pytest.raises(
        InputError, match="no 'comand_w' in ax/1/lr_mc_control/reference_cam; near names"
    ) as error:
        task.step(1, 0, Image(LAYOUT).data, {})
    assert error.value.file == __file__
    assert error.value.line == inspect.getsourcelines(Broken)[1] + 2
