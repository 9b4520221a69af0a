"""What stands in the layout is filled and true: states of axes and channel, error records, positions, drives."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from hli_bench import Bench
from hli_bench.manual.errors import by_number

READER = """
from hli_bench.plc import Plc

class Reader(Plc):
    period_us = 1000

    def start(self, hli, io):
        self.cycles = 0
        self.seen = {{}}
        hli.ch[1].head.plc_present_w = True
        for number in (1, 2, 3):
            hli.ax[number].head.plc_present_w = True

    def cycle(self, hli, io):
        cycles = self.cycles = self.cycles + 1
        control, errors, x, z = hli.ch[1].bahn_mc_control, hli.ch[1].mc_error, hli.ax[1], hli.ax[3]
{body}
        for name, value in {elements}.items():
            if self.seen.get(name) != value:
                self.seen[name] = value
                print(name, int(value))
"""
Watch = Callable[..., tuple[Bench, Callable[[], list[str]]]]


@pytest.fixture
def watch(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Watch:
    """Return what makes a bench whose PLC prints each change of elements; `body` runs before, in each cycle."""

    def make(
        elements: Sequence[str], body: str = "pass", settings: dict[str, object] | None = None
    ) -> tuple[Bench, Callable[[], list[str]]]:
        script = tmp_path / "reader.py"
        named = "{" + ", ".join(f"{one.split('.')[-1]!r}: {one}" for one in elements) + "}"
        lines = "\n".join(f"        {line}" for line in body.splitlines())
        script.write_text(READER.format(body=lines, elements=named))
        return Bench("demo", settings, plc=[script]), lambda: capfd.readouterr().out.splitlines()  # noqa: PLW0108

    return make


MODE = "hli.ch[1].channel_mc_control.mode_and_state.state_r"
STATE_X = "hli.ax[1].lr_state.axis_state_r"
HEAD = "hli.ch[1].mc_error.satz_r.kopf"


def test_an_axis_is_ready_active_and_on_hold(watch: Watch) -> None:
    body = "control.feedhold.enable_w = True\ncontrol.feedhold.command_w = 300 <= cycles < 500"
    bench, printed = watch([STATE_X], body)
    with bench:
        bench.advance(5)
        bench.run("N10 G01 X10 F600\nN20 M30")
        bench.advance(10)
    assert printed() == [
        "axis_state_r 1",
        "axis_state_r 3",
        "axis_state_r 5",
        "axis_state_r 3",
        "axis_state_r 1",
    ]


def test_homing_is_active_and_held_too(watch: Watch) -> None:
    body = "control.feedhold.enable_w = True\ncontrol.feedhold.command_w = 300 <= cycles < 500"
    bench, printed = watch([STATE_X], body)
    with bench:
        bench.advance(5)
        bench.run("N10 G74 X1\nN20 M30", limit_s=1.0)
    assert printed()[:4] == ["axis_state_r 1", "axis_state_r 3", "axis_state_r 5", "axis_state_r 3"]


def test_mode_and_state_of_the_channel(watch: Watch) -> None:
    body = "control.feedhold.enable_w = True\ncontrol.feedhold.command_w = 300 <= cycles < 500"
    bench, printed = watch([f"{MODE}.mode", f"{MODE}.state"], body)
    with bench:
        bench.advance(10)
        bench.run("N10 G01 X10 F600\nN20 M30")
        bench.advance(10)
        bench.run("N10 G01 X20 F600\nN20 G100 X500 F600\nN30 X\nN40 M30", limit_s=2.0)
        bench.advance(10)
    states = ["mode 2", "state 3", "state 4", "state 5", "state 4", "state 3"]
    assert printed()[: len(states)] == states


def test_the_block_in_execution(watch: Watch) -> None:
    bench, printed = watch(["hli.ch[1].bahn_state.block_nr_r"])
    with bench:
        bench.advance(5)
        bench.run("N10 G01 X2 F600\nN020 X4\nX5\nN30 G04 0.1\nN40 X0\nN50 M30")
        bench.advance(5)
    numbers = [int(line.split()[1]) for line in printed()]
    assert numbers == [0, 10, 20, 0, 30, 40, 0]


def test_errors_are_handed_over_one_by_one(watch: Watch) -> None:
    names = [f"{HEAD}.{name}" for name in ("error_id", "reaktions_klasse", "behebungs_klasse")]
    names += [f"hli.ch[1].mc_error.{name}" for name in ("axis_r", "block_r", "semaphor_rw")]
    body = "errors.enable_w = True\nif errors.semaphor_rw and cycles % 1000 == 0: errors.semaphor_rw = False"
    settings = {"axis.Z.kenngr.measure.signal": "DRIVE", "axis.Y.kenngr.measure.signal": "DRIVE"}
    bench, printed = watch(names, body, settings)
    with bench:
        result = bench.run("N05 #MEAS [ERR_NO_SIGNAL=1]\nN20 G100 G90 Y1 Z299 F6000\nN30 M30", limit_s=20.0)
        assert [error.id for error in result.errors] == [50057, 50057]
        bench.advance(2000)
    sheet, lines = by_number()[50057], printed()[len(names) :]
    assert sorted(lines[:6]) == sorted(
        [
            "error_id 50057",
            f"reaktions_klasse {sheet.reaction_class:d}",
            f"behebungs_klasse {sheet.remedy_class}",
            "axis_r 2",
            "block_r 20",
            "semaphor_rw 1",
        ]
    )
    assert lines[6:] == ["semaphor_rw 0", "axis_r 3", "semaphor_rw 1", "semaphor_rw 0"]


def test_a_plc_that_takes_no_records_finds_the_newest(watch: Watch) -> None:
    bench, _ = watch(
        [], settings={"axis.Z.kenngr.measure.signal": "DRIVE", "axis.Y.kenngr.measure.signal": "DRIVE"}
    )
    with bench:
        bench.run("N05 #MEAS [ERR_NO_SIGNAL=1]\nN20 G100 G90 Y1 Z299 F6000\nN30 M30", limit_s=20.0)
        image = bench.kernel.image
        shown = [
            image.get(image.layout.element(f"ch/1/mc_error/{name}").id) for name in ("axis_r", "semaphor_rw")
        ]
    assert shown == [3, 1]


def test_active_is_the_command_and_current_the_actual_position(watch: Watch) -> None:
    with Bench("demo", plc=[]) as bench:
        bench.start_up()
        bench.kernel.start(["%p\n", "N10 G01 X100 F6000\n", "N20 M30\n"], "p")
        bench.engine.wake()
        bench.advance(300)
        image, row = bench.kernel.image, bench.kernel.rows.axis[0]

        def shown(name: str) -> int:
            return int(image.get(image.layout.element(f"ax/1/lr_state/{name}").id))

        assert row["command"] - row["actual"] > 100
        assert shown("active_position_acs_r") == round(float(row["command"]))
        assert shown("current_position_acs_r") == round(float(row["actual"]))
        assert shown("following_error_r") == round(float(row["lag"]))
        assert shown("active_position_r") == shown("current_position_acs_r")
        assert shown("command_position_r") == shown("active_position_acs_r")
        assert shown("position_lag_r") == shown("following_error_r")


def test_a_drive_in_operation_shows_so(watch: Watch) -> None:
    with Bench("demo", plc=[]) as bench:
        image = bench.kernel.image
        ids = [
            image.layout.element(f"ax/1/lr_state/ready_for_{name}_r").id
            for name in ("power_on", "control_loop_on")
        ]
        assert [image.get(one) for one in ids] == [False, False]
        bench.start_up()
        assert [image.get(one) for one in ids] == [True, True]


def test_probing_position_is_the_measured_value(watch: Watch) -> None:
    body = (
        "z.lr_mc_control.probing_signal.enable_w = z.lr_mc_control.probing_position.enable_w = True\n"
        "z.lr_mc_control.probing_position.command_w = 1234567\n"
        "z.lr_mc_control.probing_signal.command_w = cycles > 500"
    )
    bench, _ = watch([], body, {"axis.Z.kenngr.measure.signal": "PLC"})
    with bench:
        result = bench.run("N10 G100 G90 Z90 F600\nN20 M30")
    assert result.measurements[0].acs_mm == 123.4567


@pytest.mark.parametrize(("direct", "homed"), [(0, True), (1, False)])
def test_cam_of_the_plc_counts_only_without_direct_access(watch: Watch, direct: int, homed: bool) -> None:
    settings = {"axis.X.lr_hw[0].cam_direct_access": direct, "axis.X.kenngr.homing_without_zero_pulse": 1}
    body = (
        "x.lr_mc_control.reference_cam.enable_w = True\n"
        "x.lr_mc_control.reference_cam.command_w = 500 < cycles < 1000 or cycles > 1500"
    )
    bench, _ = watch([], body, settings)
    with bench:
        result = bench.run("N10 G74 X1\nN20 M30", limit_s=5.0)
        image = bench.kernel.image
        state = image.get(image.layout.element("ax/1/lr_mc_control/reference_cam/state_r").id)
    assert (result.completed, state) == (homed, homed)
    assert any("reference_cam: P-AXIS-00036 is 1" in note for note in result.notes) is not homed
