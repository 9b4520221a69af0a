"""What a measuring run leaves behind and what does not get through it (measurement manual 2, 5, 8.2)."""

import numpy as np
import pytest

X, Y, Z = 0, 1, 2
SIGNAL = '''
from hli_bench.plc import Plc

class Signal(Plc):
    """The probing signal of X: a function of its actual position (mm)."""

    def start(self, hli, io):
        axis = hli.ax[1]
        axis.head.plc_present_w = True
        axis.lr_mc_control.probing_signal.enable_w = True

    def cycle(self, hli, io):
        x = hli.ax[1].lr_state.{position} / 10_000
        hli.ax[1].lr_mc_control.probing_signal.command_w = {level}
'''


@pytest.fixture
def signal(script, make):
    """Return a maker of PLC scripts with a signal of X; its position has one of the names of the layout."""
    paths = {path.rpartition("/")[2] for path in element_paths(make())}
    position = next(name for name in ("current_position_acs_r", "active_position_r") if name in paths)
    return lambda level: script(SIGNAL.format(position=position, level=level), "signal")


def element_paths(bench) -> list[str]:
    return [element.path for element in bench.kernel.image.layout.elements if "/lr_state/" in element.path]


@pytest.mark.req("M-011")
def test_no_set_point_jumps_at_the_end_of_a_run_and_behind_it(make, signal, recorder):
    """%Meas_run with X alone cut short: whatever the look-ahead had prepared is dropped, N40 begins where X stands."""
    bench = make({"axis.X.kenngr.measure.signal": "PLC"}, recorder=recorder, plc=[signal("x > 7.0")])
    result = bench.run("%Meas_run\nN10 G00 X0 Y0\nN20 X5\nN30 G100 X10 F500\nN40 G01 X12\nN50 X7\nN60 M30\n")
    x = recorder.column("command", X)[20:]
    a_cycle = 500 / 60 * 1e4 / 1e3  # F500 in 0.1 um a cycle of 1 ms

    assert result.completed, result.errors
    start = int(np.argmax(x > 60_000))
    assert np.abs(np.diff(x[start:])).max() <= a_cycle * 1.0001
    turn = int(np.argmax(x == x.max()))
    assert 120_000 - a_cycle < x.max() <= 120_000
    assert (np.diff(x[start:turn]) >= 0).all(), "never back to where a rest of the path might have begun"
    assert x[-1] == 70_000


@pytest.mark.req("M-061", "M-062", "M-063", "M-066")
def test_factors_of_several_axes_in_one_block(make, script):
    """G101 X0.5 Y-1: each axis its own offset with its own factor; G102 of one axis leaves the other's."""
    text = """
from hli_bench.plc import Plc

class Both(Plc):
    def start(self, hli, io):
        self.since = 0
        for n in (1, 2):
            hli.ax[n].head.plc_present_w = True
            hli.ax[n].lr_mc_control.probing_signal.enable_w = True

    def cycle(self, hli, io):
        self.since = self.since + 1 if hli.ax[1].lr_state.measurement_active_r else 0
        for n in (1, 2):
            hli.ax[n].lr_mc_control.probing_signal.command_w = self.since > 300
"""
    bench = make({f"axis.{axis}.kenngr.measure.signal": "PLC" for axis in "XY"}, plc=[script(text)])
    result = bench.run(
        "%p\nN10 G00 X0 Y0\nN20 G100 X10 Y20 F600\nN30 G101 X0.5 Y-1\nN40 G01 X3 Y4 F6000\n"
        'N50 #MSG SYN["%.4f %.4f %.4f %.4f", V.A.MEIN.X, V.A.MEIN.Y, V.A.ABS.X, V.A.ABS.Y]\n'
        'N60 G102 X7\nN70 #MSG SYN["%.4f %.4f", V.A.MEIN.X, V.A.MEIN.Y]\nN80 M30\n'
    )
    x, y = (next(one.acs_mm for one in result.measurements if one.axis == axis) for axis in "XY")
    first, second = ([float(word) for word in one.text.split()] for one in result.messages)

    assert result.completed, result.errors
    assert 0.5 < x < 5.0
    offsets = [0.5 * (x - 10.0), -1.0 * (y - 20.0)]
    assert first == pytest.approx([*offsets, 3.0 + offsets[0], 4.0 + offsets[1]], abs=2e-4)
    assert second == pytest.approx([0.0, offsets[1]], abs=2e-4)


@pytest.mark.req("M-236", "M-134", "M-200")
@pytest.mark.parametrize(
    ("edge", "level"),
    [("POS", "x > 7.0 and not 8.0 < x < 9.0"), ("NEG", "not (x > 7.0 and not 8.0 < x < 9.0)")],
)
def test_edge_of_the_unit_that_counts(make, signal, edge, level):
    """Both edges come, twice each; the first of the kind that P-AXIS-00518 names ends the run."""
    settings = {"axis.X.kenngr.measure.signal": "PLC", "axis.X.kenngr.measure.edge": edge}
    bench = make(settings, plc=[signal(level)])
    bench.advance(5)
    result = bench.run("%p\nN10 G100 X15 F600\nN20 M30\n")

    (value,) = result.measurements
    assert value.edge == edge
    assert 7.0 <= value.acs_mm <= 7.03


@pytest.mark.req("M-236")
@pytest.mark.parametrize(("edge", "ends_at"), [("POS", 8.0), ("NEG", 7.0)])
def test_the_other_edge_of_the_unit_passes(make, signal, edge, ends_at):
    """The level is TRUE up to 7 and from 8 on: the falling edge is at 7, the rising one at 8."""
    settings = {"axis.X.kenngr.measure.signal": "PLC", "axis.X.kenngr.measure.edge": edge}
    settings["axis.X.start_mm"] = 6.0 if edge == "NEG" else 7.5
    bench = make(settings, plc=[signal("x < 7.0 or x > 8.0")])
    bench.advance(5)
    result = bench.run("%p\nN10 G100 X15 F600\nN20 M30\n")

    assert [one.acs_mm for one in result.measurements] == [pytest.approx(ends_at + 0.02, abs=0.021)]


@pytest.mark.req("M-236")
def test_the_unit_does_not_act_on_a_run_of_the_drive(make, signal):
    bench = make({"axis.X.kenngr.measure.signal": "DRIVE"}, plc=[signal("x > 7.0")])
    result = bench.run("%p\nN10 G100 X15 F600\nN20 M30\n")
    bench.advance(100)

    assert result.completed, result.errors
    assert not result.measurements
    assert bench.position_mm("X") == pytest.approx(15.0, abs=1e-3)


@pytest.mark.req("M-025", "M-028")
@pytest.mark.parametrize("kind", [1, 4])
@pytest.mark.parametrize("feed", [300, 900])
def test_run_takes_the_f_word(make, recorder, kind, feed):
    make(recorder=recorder).run(f"%p\nN10 #MEAS MODE[{kind}]\nN20 G100 X5 F{feed}\nN30 M30\n")

    assert recorder.velocity(X).max() == pytest.approx(feed / 60.0, abs=1e-6)


@pytest.mark.req("M-211")
def test_source_plc_ignores_the_number_of_the_input(make, signal):
    settings = {"axis.X.kenngr.measure.signal": "PLC", "axis.X.kenngr.measure.input": 2}
    result = make(settings, plc=[signal("x > 7.0")]).run("%p\nN10 G100 X15 F600\nN20 M30\n")

    assert [one.acs_mm for one in result.measurements] == [pytest.approx(7.015, abs=0.015)]


@pytest.mark.req("M-229")
@pytest.mark.parametrize(
    "given",
    [
        {"kenngr.measure.fixed_stop_detect.start_distance_per_mille": 1001},
        {
            "kenngr.measure.fixed_stop_detect.start_distance_per_mille": -1,
            "antr.fixed_stop.detect.start_distance_per_mille": 1001,
        },
    ],
)
def test_program_does_not_go_on_behind_error_51026(make, errors, given):
    bench = make({"axis.Z.start_mm": 90.0} | {f"axis.Z.{key}": value for key, value in given.items()})
    result = bench.run("%p\n#MEAS MODE[7]\nN50 G100 Z110 F600\nN60 G01 X20 F6000\nN70 M30\n")
    bench.advance(100)

    assert errors(result) == [(51026, "Z", "N50")]
    assert result.status == "error"
    assert bench.position_mm("Z") == pytest.approx(90.0, abs=1e-3)
    assert bench.position_mm("X") == pytest.approx(0.0, abs=1e-3)
