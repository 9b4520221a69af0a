"""What the units of channel and axes acknowledge is in effect: feedhold, override, delete distance to go."""

from collections.abc import Callable
from pathlib import Path

import pytest

from hli_bench import Bench
from hli_bench.bench.result import Result

SCRIPT = """
from hli_bench.plc import Plc

class Timed(Plc):
    period_us = 1000

    def start(self, hli, io):
        self.cycles = 0
        for axis in hli.ax.values():
            axis.head.plc_present_w = True
        hli.ch[1].head.plc_present_w = True
        self.seen = []

    def cycle(self, hli, io):
        self.cycles += 1
        self.act(self.cycles, hli)

    def act(self, cycles, hli):
{body}
"""
CHANNEL = "hli.ch[1].bahn_mc_control"
MakeBench = Callable[..., Bench]


@pytest.fixture
def timed(tmp_path: Path) -> Callable[..., Bench]:
    """Return what makes a bench whose PLC runs `body` with `cycles` since its start, in each cycle."""

    def make(body: str, settings: dict[str, object] | None = None) -> Bench:
        script = tmp_path / "timed.py"
        lines = body.strip("\n").splitlines()
        script.write_text(SCRIPT.replace("{body}", "\n".join(" " * 8 + line for line in lines)))
        return Bench("demo", settings, plc=[script])

    return make


def state(bench: Bench, path: str) -> int:
    image = bench.kernel.image
    return image.get(image.layout.element(path).id)


def pulse(begin: int, end: int | None = None, unit: str = f"{CHANNEL}.delete_distance_to_go") -> str:
    until = f" and cycles < {end}" if end else ""
    return f"{unit}.enable_w = True\n{unit}.command_w = cycles >= {begin}{until}"


DDG_STATE = "ch/1/bahn_mc_control/delete_distance_to_go/state_r"
HOMING = {"axis.X.start_mm": 300, "axis.X.kenngr.ref_richt": 0}


def run(bench: Bench, program: str) -> Result:
    with bench:
        return bench.run(program, limit_s=100.0)


def test_the_line_leads_from_the_stop_to_the_target_of_the_next_block(timed: MakeBench) -> None:
    program = "N05 G90 G01 X0 Y0 F6000\nN10 G01 X80 F600\nN20 G01 Y60\nN30 X60 Y80\nN40 M30"
    with timed(pulse(2000)) as bench:
        bench.start_up()
        columns: list[tuple[float, float]] = []
        plain = _Track(columns, bench)
        bench.engine.observers.append(plain)
        result = bench.run(program, limit_s=100.0)
        assert result.completed
        assert not result.errors
        assert (bench.position_mm("X"), bench.position_mm("Y")) == pytest.approx((60, 80), abs=0.05)
        assert state(bench, DDG_STATE) == 1
    # stopped at about 20 mm, from there straight to (80, 60)
    stop = max(x for x, y in columns if y < 1e-9)
    assert 19 < stop < 21
    for x, y in columns:
        if 1 < y < 59.9:
            assert x == pytest.approx(stop + y * (80 - stop) / 60, abs=0.05)


class _Track:
    """Keeps X and Y of every cycle (set points)."""

    def __init__(self, columns: list[tuple[float, float]], bench: Bench) -> None:
        self._columns, self._rows = columns, bench.kernel.rows

    def cycles(self, first: int, count: int) -> None:
        log = self._rows.log
        for cycle in range(first, first + count):
            row = log[cycle % log.shape[0]]["command"]
            self._columns.append((float(row[0]) / 1e4, float(row[1]) / 1e4))

    def frames(self, *_: object) -> None: ...

    edges = commands = emitted = refused = frames


def test_of_the_last_block_the_rest_is_dropped(timed: MakeBench) -> None:
    with timed(pulse(1000)) as bench:
        result = bench.run('N10 G01 X80 F600\nN20 #MSG SYN ["behind"]\nN30 M30')
        assert result.completed
        assert [error.id for error in result.errors] == [50810]
        assert result.errors[0].severity == "warning"
        assert [message.text for message in result.messages] == ["behind"]
        assert 8 < bench.position_mm("X") < 12


def test_taken_back_before_the_stop_the_contour_goes_on(timed: MakeBench) -> None:
    with timed(pulse(1000, 1003), {"axis.X.getriebe[0].slope_profil.a_feedh": 20}) as bench:
        result = bench.run("N10 G01 X80 F600\nN30 M30")
        assert (result.completed, result.errors) == (True, [])
        assert bench.position_mm("X") == pytest.approx(80, abs=0.05)
        assert state(bench, DDG_STATE) == 0


def test_without_motion_nothing_is_acknowledged(timed: MakeBench) -> None:
    with timed(pulse(100)) as bench:
        result = bench.run("N10 G04 1\nN20 G01 X10 F6000\nN30 M30")
        assert (result.completed, result.errors) == (True, [])
        assert bench.position_mm("X") == pytest.approx(10, abs=0.05)
        assert state(bench, DDG_STATE) == 0


def test_the_line_leads_to_the_place_of_a_measuring_run(timed: MakeBench) -> None:
    settings = {"plant.probe.Z.face_mm": 100, "plant.probe.Z.material": "below"}
    with timed(pulse(1000), {**settings, "axis.Z.kenngr.measure.signal": "DRIVE"}) as bench:
        result = bench.run("N10 G01 G90 X50 F1000\nN20 G100 Z90 F3000\nN30 M30")
        assert [error.id for error in result.errors] == [51036]
        assert bench.position_mm("X") == pytest.approx(50, abs=0.05)
        assert result.measurements[0].acs_mm == pytest.approx(100, abs=0.05)


@pytest.mark.parametrize("meas", ["", "N05 #MEAS [ERR_NO_SIGNAL=1]\n"])
def test_a_measuring_run_is_dropped_without_an_error(timed: MakeBench, meas: str) -> None:
    with timed(pulse(1000), {"axis.Z.kenngr.measure.signal": "DRIVE"}) as bench:
        result = bench.run(meas + "N10 G100 G90 Z90 F600\nN20 G91 G01 X5 F6000\nN30 M30")
        assert result.completed
        assert [error.id for error in result.errors] == ([51058] if meas else [])
        assert result.measurements == []
        assert 285 < bench.position_mm("Z") < 295
        assert bench.position_mm("X") == pytest.approx(5, abs=0.05)


def test_a_second_pulse_cuts_the_short_cut(timed: MakeBench) -> None:
    unit = f"{CHANNEL}.delete_distance_to_go"
    body = f"{unit}.enable_w = True\n{unit}.command_w = 1000 <= cycles < 1500 or cycles >= 2000"
    with timed(body) as bench:
        result = bench.run("N10 G01 X80 F600\nN20 X80 Y60\nN30 X0 Y0\nN40 M30")
        assert (result.completed, result.errors) == (True, [])
        assert result.sim_s < 6


def test_texts_of_the_dropped_way_come_at_the_stop(timed: MakeBench) -> None:
    with timed(pulse(1000)) as bench:
        result = bench.run(
            'N10 G01 X80 F600\nN20 #MSG SYN ["at the stop"]\nN30 Y60\nN40 #MSG SYN ["later"]\nN50 X0\nN60 M30'
        )
        assert [message.text for message in result.messages] == ["at the stop", "later"]


def test_feedhold_of_the_channel_holds_homing(timed: MakeBench) -> None:
    with timed(pulse(200, 1200, f"{CHANNEL}.feedhold")) as bench:
        bench.start_up()
        held = bench.run("N10 G74 X1\nN20 M30", limit_s=60.0)
    with timed("pass") as bench:
        bench.start_up()
        free = bench.run("N10 G74 X1\nN20 M30", limit_s=60.0)
    assert held.status == free.status
    assert held.sim_s == pytest.approx(free.sim_s + 1.0, abs=0.2)


def test_override_of_the_channel_scales_homing(timed: MakeBench) -> None:
    unit = f"{CHANNEL}.override_feedrate"
    body = f"{unit}.enable_w = True\n{unit}.command_w = 500"
    times = []
    for text in ("pass", body):
        with timed(text) as bench:
            times.append(bench.run("N10 G74 X1\nN20 M30", limit_s=200.0).sim_s)
    assert times[1] > 1.7 * times[0]


@pytest.mark.parametrize(("command", "in_effect"), [(100, 100), (0, 0), (5000, 1000)])
def test_override_of_the_channel_is_acknowledged_as_it_acts(
    timed: MakeBench, command: int, in_effect: int
) -> None:
    unit = f"{CHANNEL}.override_feedrate"
    with timed(f"{unit}.enable_w = True\n{unit}.command_w = {command} if cycles < 2000 else 1000") as bench:
        bench.start_up()
        assert state(bench, "ch/1/bahn_mc_control/override_feedrate/state_r") == 1000
        bench.run("N10 G01 X5 F600\nN20 M30", limit_s=1.0)
        assert state(bench, "ch/1/bahn_mc_control/override_feedrate/state_r") == in_effect
        assert bench.position_mm("X") == pytest.approx(min(in_effect / 100, 5), rel=0.1, abs=0.02)


def test_override_of_an_axis_is_not_acknowledged_where_it_does_not_act(timed: MakeBench) -> None:
    unit = "hli.ax[1].ipo_mc_control.override"
    with timed(
        f"{unit}.enable_w = True\n{unit}.command_w = 100\n{unit}_valid.enable_w = {unit}_valid.command_w = True"
    ) as bench:
        result = bench.run("N10 G01 X10 F600\nN20 M30")
        assert result.sim_s < 1.5
        assert state(bench, "ax/1/ipo_mc_control/override/state_r") == 1000
        assert state(bench, "ax/1/ipo_mc_control/override_valid/state_r") == 0
        assert any(
            "ax/1/ipo_mc_control/override: it acts on independent axes" in note for note in result.notes
        )


def test_what_holds_from_the_start_is_acknowledged(timed: MakeBench) -> None:
    with timed("pass") as bench:
        bench.start_up()
        assert state(bench, "ax/1/lr_mc_control/release_feedhold/state_r") == 1
