"""The example scripts on images: what they make of their inputs."""

import ast
import struct
from typing import Any

import pytest

from hli_bench.base import loading
from hli_bench.plc import Task, load
from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.images import TerminalLayout

AXES = [(number, name, "linear") for number, name in enumerate(("X", "Y", "Z", "X2", "A", "B", "S"), 1)]
LAYOUT = Layout(AXES)
PROBE = TerminalLayout(
    "probe", (("ch2/input", "BOOL", 0), ("ch2/latch_pos", "UNS64", 8), ("ch2/latch_neg", "UNS64", 16))
)
LATCH_NEG = 77
CAMS = TerminalLayout("cams", tuple((f"ch{number}/input", "BOOL", number - 1) for number in range(1, 9)))


def run(name: Any, *images: Any) -> Any:
    """Images of (probe level, latch, cams) -> the written values after each cycle, by path."""
    script = load(loading.data_file("plc_scripts", name))
    task, image = Task(name, script, 1000, LAYOUT, [PROBE, CAMS]), Image(LAYOUT)
    written: dict[str, Any] = {}
    seen = []
    for cycle, (level, latch, cams) in enumerate(images):
        io = {"probe": struct.pack("<?7xQQ", level, latch, LATCH_NEG), "cams": bytes(cams)}
        commands = task.step(cycle, cycle * 1_000_000, image.data, io)
        written.update({write.path: write.value for write in commands.writes})
        seen.append(dict(written))
    return seen


QUIET = (False, 5, [0] * 8)
TOUCHED = (True, 123_456_789, [0] * 8)
ON_CAM = (False, 5, [1, 0, 1, 0, 0, 0, 0, 0])


@pytest.mark.req("M-182", "M-239")
@pytest.mark.parametrize("name", ["probing.py", "demo.py"])
def test_probe_level_and_time_reach_every_measurement_axis_over_enabled_units(name: Any) -> None:
    before, after = run(name, QUIET, TOUCHED)
    for axis in range(1, 7):
        area = f"ax/{axis}/lr_mc_control"
        assert before[f"{area}/probing_signal/command_w"] is False
        assert after[f"{area}/probing_signal/command_w"] is True
        assert before[f"{area}/timestamp/command_w"] == LATCH_NEG
        assert after[f"{area}/timestamp/command_w"] == 123_456_789
        assert after[f"{area}/probing_signal/enable_w"] is True
        assert after[f"{area}/timestamp/enable_w"] is True


@pytest.mark.parametrize("name", ["homing_cam.py", "demo.py"])
def test_each_cam_reaches_its_axis(name: Any) -> None:
    before, after = run(name, QUIET, ON_CAM)
    assert [before[f"ax/{axis}/lr_mc_control/reference_cam/command_w"] for axis in range(1, 7)] == [False] * 6
    assert [after[f"ax/{axis}/lr_mc_control/reference_cam/command_w"] for axis in range(1, 7)] == [
        True, False, True, False, False, False,
    ]  # fmt: skip


@pytest.mark.parametrize(("name", "last"), [("probing.py", 6), ("homing_cam.py", 6), ("demo.py", 7)])
def test_every_script_announces_itself_and_releases_the_feed(name: Any, last: Any) -> None:
    (written,) = run(name, QUIET)
    for axis in range(1, last + 1):
        assert written[f"ax/{axis}/head/plc_present_w"] is True
        assert written[f"ax/{axis}/lr_mc_control/release_feedhold/enable_w"] is True
        assert written[f"ax/{axis}/lr_mc_control/release_feedhold/command_w"] is True


def test_the_scripts_import_nothing_but_the_plc_package() -> None:
    for path in loading.data_file("plc_scripts", "demo.py").parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            assert not isinstance(node, ast.Import), path
            assert not isinstance(node, ast.ImportFrom) or node.module == "hli_bench.plc", path
