"""Which axes must deliver a signal, and what happens when one does not (measurement manual 4, 5, 8.2)."""

import pytest

from hli_bench.base.errors import NotEmulated
from hli_bench.kernel.records import MeasuredValue

EACH_ITS_OWN = '''
from hli_bench.plc import Plc

class Signals(Plc):
    """Axis n gets its signal when its actual position has passed `at[n]` (0.1 um)."""
    at = {at}

    def start(self, hli, io):
        for n in (1, 2, 3):
            hli.ax[n].head.plc_present_w = True
            hli.ax[n].lr_mc_control.probing_signal.enable_w = True

    def cycle(self, hli, io):
        for n in (1, 2, 3):
            axis = hli.ax[n]
            limit = self.at.get(n)
            axis.lr_mc_control.probing_signal.command_w = (
                limit is not None and axis.lr_state.current_position_acs_r >= limit
            )
'''
BY_PLC = {f"axis.{axis}.kenngr.measure.signal": "PLC" for axis in "XYZ"} | {"axis.Z.start_mm": 0.0}
STANDARD = """\
%Measurement run standard
N10 G00 X0 Y1 Z0
N20 X5
N30 G100 X10 F500
N40 G01 Y3
N50 G100 Y10 F500
N60 G01 X10 Y5
N70 G100 X15 Y10 F500
N100 M30
"""


@pytest.fixture
def own_signals(script):
    """Return a maker of scripts with a signal for each axis."""
    return lambda at: script(EACH_ITS_OWN.replace("{at}", repr(at)), "own_signals")


def values(result) -> list[tuple[str, str, float]]:
    return [(one.block, one.axis, one.acs_mm) for one in result.measurements]


@pytest.mark.req("M-002", "M-040", "M-041", "M-042")
@pytest.mark.parametrize("only", [1, 2])
def test_run_of_two_axes_waits_for_both_signals(make, own_signals, errors, only):
    """One signal alone does not end it: the axes go on to the target."""
    both = {1: 70_000, 2: 60_000}
    program = "%p\nN10 G00 X5 Y5\nN70 G100 X15 Y10 F500\nN80 M30\n"
    result = make(BY_PLC, plc=[own_signals(both)]).run(program)
    alone = make(BY_PLC, plc=[own_signals({only: both[only]})])
    half = alone.run(program)

    assert result.completed
    assert [axis for _, axis, _ in values(result)] == ["X", "Y"] or [a for _, a, _ in values(result)] == [
        "Y",
        "X",
    ]
    assert result.variables["V.A.MERF.X"] == result.variables["V.A.MERF.Y"] == 1.0
    assert [axis for _, axis, _ in values(half)] == ["XY"[only - 1]]
    assert alone.position_mm("X") == pytest.approx(15.0, abs=1e-3)
    assert half.variables[f"V.A.MERF.{'XY'[only - 1]}"] == 1.0


@pytest.mark.req("M-002", "M-041", "M-042")
@pytest.mark.req("M-043", by="parsing")
def test_example_standard_waits_for_the_moved_axes_only(make, script):
    """The PLC gives a signal only while the run of the very axis is active: N30 X, N50 Y, N70 X and Y."""
    text = """
from hli_bench.plc import Plc

class Signals(Plc):
    def start(self, hli, io):
        self.since = {1: 0, 2: 0, 3: 0}
        for n in (1, 2, 3):
            hli.ax[n].head.plc_present_w = True
            hli.ax[n].lr_mc_control.probing_signal.enable_w = True

    def cycle(self, hli, io):
        for n in (1, 2, 3):
            axis = hli.ax[n]
            self.since[n] = self.since[n] + 1 if axis.lr_state.measurement_active_r else 0
            axis.lr_mc_control.probing_signal.command_w = self.since[n] > 100 * n
"""
    result = make(BY_PLC, plc=[script(text)]).run(STANDARD)

    assert result.completed, result.errors
    assert [(block, axis) for block, axis, _ in values(result)] == [
        ("N30", "X"),
        ("N50", "Y"),
        ("N70", "X"),
        ("N70", "Y"),
    ]


@pytest.mark.req("M-044", "M-045", "M-046", "M-047", "M-048")
@pytest.mark.parametrize("angle", [45, 90])
@pytest.mark.parametrize("missing", [None, 1, 2, 3])
def test_coordinate_system_needs_the_signal_of_all_main_axes(make, own_signals, script, angle, missing):
    """%Measurement run CS: X, Y and Z must deliver, Z does not even move."""
    text = """
from hli_bench.plc import Plc

class Signals(Plc):
    def start(self, hli, io):
        self.since = 0
        for n in (1, 2, 3):
            hli.ax[n].head.plc_present_w = True
            hli.ax[n].lr_mc_control.probing_signal.enable_w = True

    def cycle(self, hli, io):
        self.since = self.since + 1 if hli.ax[1].lr_state.measurement_active_r else 0
        for n in (1, 2, 3):
            hli.ax[n].lr_mc_control.probing_signal.command_w = n != MISSING and self.since > 200
"""
    bench = make(BY_PLC, plc=[script(text.replace("MISSING", repr(missing)))])
    result = bench.run(
        f"%Measurement run CS\nN10 G00 X0 Y1 Z0\nN20 #CS ON[0,0,0,0,0,{angle}]\nN30 G100 X10 F500\n"
        "N40 #CS OFF\nN100 M30\n"
    )
    got = {axis for _, axis, _ in values(result)}

    assert result.completed, result.errors
    assert got == (set() if missing else {"X", "Y", "Z"})
    merf = [result.variables.get(f"V.A.MERF.{axis}", 0.0) for axis in "XYZ"]
    assert merf == [0.0 if missing else 1.0] * 3
    warned = [(one.id, one.severity, one.axis, one.block) for one in result.errors]
    assert warned == ([(22014, "warning", "XYZ"[missing - 1], "N30")] if missing else [])
    assert {one.axis for one in result.unmeasured} == (set("XYZ") if missing else set())
    assert not any(name.startswith("V.A.MESS") for name in result.variables) or not missing


def test_a_run_under_a_system_that_was_broken_off_is_not_remarked(make, own_signals):
    """X has latched, Y and Z have not when the program is aborted: no value, and no word about what is missing."""
    bench = make(BY_PLC, plc=[own_signals({1: 20_000})])
    program = "N10 G00 X0 Y0 Z0\nN20 #CS ON[0,0,0,0,0,0]\nN30 G100 X10 F60\nN40 M30\n"
    result = bench.run(program, limit_s=6.0)
    assert result.status == "aborted"
    assert bench.position_mm("X") > 2.5
    assert (list(result.errors), list(result.measurements), list(result.unmeasured)) == ([], [], [])
    assert result.variables["V.A.MERF.X"] == 0.0


@pytest.mark.req("M-046", "M-070", "M-072")
def test_values_of_all_axes_are_mapped_into_the_system(make, face):
    """Rotated by 90 degrees about X: the programmed Y is the machine's Z."""
    bench = make(face | {"axis.Z.start_mm": 120.0})
    result = bench.run(
        "%p\nN10 #CS ON[0,0,0,90,0,0]\nN20 G00 X0 Y120 Z0\nN30 G100 Y90 F600\nN40 #CS OFF\nN50 M30\n"
    )
    by_axis = {one.axis: one for one in result.measurements}

    assert result.completed, result.errors
    assert by_axis["Z"].acs_mm == pytest.approx(100.0, abs=1e-4)
    assert by_axis["Y"].pcs_mm == pytest.approx(100.0, abs=1e-4)
    assert by_axis["Y"].acs_mm == pytest.approx(0.0, abs=1e-4)
    assert result.variables["V.A.MESS.Y"] == pytest.approx(100.0, abs=1e-4)


@pytest.mark.req("M-040", "M-219")
def test_axis_that_is_no_measurement_axis_is_error_50059(make, errors):
    result = make({"axis.Y.kenngr.messachse": 0}).run("%p\nN10 G100 X1 Y1 F500\nN20 M30\n")

    assert errors(result) == [(50059, "Y", "N10")]
    assert result.errors[0].values == {"logical axis number": 2}
    assert result.status == "error"


@pytest.mark.req("M-044", "M-051")
@pytest.mark.parametrize("axis", ["X", "Y", "Z"])
def test_coordinate_system_with_an_axis_that_may_not_measure_is_error_50059(make, errors, axis):
    """Only X is programmed; all three must be measurement axes."""
    bench = make({f"axis.{axis}.kenngr.messachse": 0})
    result = bench.run("%p\nN10 #CS ON[0,0,0,0,0,45]\nN20 G100 X1 F500\nN30 M30\n")

    assert errors(result) == [(50059, axis, "N20")]


@pytest.mark.req("M-002")
@pytest.mark.parametrize("signal", ["PLC", "PLC_TIMESTAMP"])
def test_operated_probe_is_error_50052_and_no_axis_moves(make, face, errors, signal):
    bench = make(face | {"axis.Z.start_mm": 99.0, "axis.Z.kenngr.measure.signal": signal})
    bench.advance(5)
    result = bench.run("%p\nN10 G100 Z50 F500\nN20 M30\n")

    assert errors(result) == [(50052, "Z", "N10")]
    assert bench.position_mm("Z") == pytest.approx(99.0, abs=1e-3)
    active = [
        bench.kernel.image.get(bench.kernel.image.layout.element(f"ax/{n}/lr_state/measurement_active_r").id)
        for n in range(1, 7)
    ]
    assert not any(active)


@pytest.mark.req("M-053", "M-192")
def test_no_signal_is_no_error_by_default(make):
    bench = make({"axis.Z.start_mm": 20.0})
    result = bench.run('%p\nN10 G100 Z10 F600\nN20 #MSG SYN["%d", V.A.MERF.Z]\nN30 G01 Z12\nN40 M30\n')

    assert result.completed
    assert [one.text for one in result.messages] == ["0"]
    assert not result.measurements
    bench.advance(200)
    assert bench.position_mm("Z") == pytest.approx(12.0, abs=1e-3)


@pytest.mark.req("M-192")
def test_no_signal_is_error_50057_when_the_channel_says_so(make, errors):
    bench = make({"axis.Z.start_mm": 20.0, "channel.meas_error_no_signal": 1})
    result = bench.run("%p\nN10 G100 Z10 F600\nN20 G01 Z12\nN30 M30\n")

    assert errors(result) == [(50057, "Z", "N10")]
    assert bench.position_mm("Z") == pytest.approx(10.0, abs=1e-3), "the next block is not executed"


@pytest.mark.req("M-192", "E-006")
@pytest.mark.parametrize(("word", "failed"), [("ERR_NO_SIGNAL=1", True), ("ERR_NO_SIGNAL=0", False)])
def test_program_overrides_the_channel(make, word, failed):
    bench = make({"axis.Z.start_mm": 20.0, "channel.meas_error_no_signal": not failed})
    result = bench.run(f"%p\nN10 #MEAS [{word}]\nN20 G100 Z10 F600\nN30 M30\n")

    assert [one.id for one in result.errors] == ([50057] if failed else [])


@pytest.mark.req("M-053", "M-217")
@pytest.mark.parametrize(
    ("offset", "face_mm", "found", "in_time"),
    [
        (0, 9.5, False, False),
        (20_000, 9.5, True, False),
        (20_000, 10.5, True, True),
        (20_000, 7.5, False, False),
    ],
)
def test_probing_offset_lets_the_axis_go_past_the_target(make, offset, face_mm, found, in_time):
    """Target 10, offset 2 mm: a face behind the target is still measured, but not before the target."""
    settings = {
        "plant.probe.Z.face_mm": face_mm,
        "plant.probe.Z.material": "below",
        "axis.Z.start_mm": 20.0,
        "axis.Z.kenngr.probing_offset": offset,
    }
    bench = make(settings)
    result = bench.run("%p\nN10 G100 Z10 F600\nN20 M30\n")

    assert [one.acs_mm for one in result.measurements] == ([face_mm] if found else [])
    assert result.variables.get("V.A.MERF.Z", 0.0) == float(in_time)
    if not found:
        assert bench.position_mm("Z") == pytest.approx(10.0 - offset / 1e4, abs=1e-3)


@pytest.mark.req("M-053")
@pytest.mark.parametrize("depth_um", [0.2, 2.0, 20.0])
@pytest.mark.parametrize("source", ["PLC_TIMESTAMP", "DRIVE", "PLC"])
def test_face_just_before_the_target_is_not_missed(make, source, depth_um):
    """The interpolation is at the target before the axis and the signal are."""
    settings = {
        "plant.probe.Z.face_mm": 10.0 + depth_um / 1000.0,
        "plant.probe.Z.material": "below",
        "axis.Z.start_mm": 20.0,
        "axis.Z.kenngr.measure.signal": source,
    }
    result = make(settings).run("%p\nN10 G100 Z10 F6000\nN20 M30\n")

    assert result.completed
    assert [one.axis for one in result.measurements] == ["Z"]
    assert result.variables["V.A.MERF.Z"] == 1.0


@pytest.mark.req("M-067")
def test_axis_that_is_not_programmed_keeps_its_value(make, own_signals):
    result = make(BY_PLC, plc=[own_signals({1: 20_000})]).run(
        "%p\nN10 G100 X5 F600\nN20 G100 Y5 F600\n"
        'N30 #MSG SYN["%d %d %f", V.A.MERF.X, V.A.MERF.Y, V.A.MESS.X]\nN40 M30\n'
    )

    merf_x, merf_y, mess_x = result.messages[0].text.split()
    assert (merf_x, merf_y) == ("1", "0")
    assert float(mess_x) == pytest.approx(2.0, abs=0.05)


@pytest.mark.req("M-064")
def test_offset_without_a_value_is_an_error(make, errors):
    """G101 behind a run without a signal: there is nothing to include."""
    result = make({"axis.Z.start_mm": 20.0}).run("%p\nN10 G100 Z10 F600\nN20 G101 Z1\nN30 M30\n")

    assert [one[0] for one in errors(result)] == [20024]
    assert result.status == "error"


@pytest.mark.req("M-130", "M-236")
@pytest.mark.parametrize("source", ["PLC", "PLC_TIMESTAMP", "DRIVE"])
def test_negative_edge(make, probing, source):
    """The probe starts inside the material and leaves it upwards."""
    settings = {
        "plant.probe.Z.face_mm": 100.0,
        "plant.probe.Z.material": "below",
        "plant.probe.pretravel_um": 0.0,
        "axis.Z.start_mm": 95.0,
        "axis.Z.kenngr.measure.signal": source,
        "axis.Z.kenngr.measure.edge": "NEG",
    }
    bench = make(settings, plc=[probing((3,), latch="latch_neg")])
    bench.advance(5)
    result = bench.run("%p\nN10 G100 Z105 F600\nN20 M30\n")

    (value,) = result.measurements
    assert value.edge == "NEG"
    late = 0.02 if source == "PLC" else 0.0
    assert 100.0 - 2e-4 <= value.acs_mm <= 100.0 + late + 2e-4


@pytest.mark.req("M-130")
@pytest.mark.parametrize("edge", ["POS", "NEG"])
def test_drive_ignores_the_other_edge(make, edge):
    """Into the material only a positive edge comes, out of it only a negative one."""
    settings = {
        "plant.probe.Z.face_mm": 100.0,
        "plant.probe.Z.material": "below",
        "axis.Z.start_mm": 105.0,
        "axis.Z.kenngr.measure.signal": "DRIVE",
        "axis.Z.kenngr.measure.edge": edge,
    }
    bench = make(settings)
    into = bench.run("%p\nN10 G100 Z95 F600\nN20 G01 Z95 F600\nN30 M30\n")
    out = bench.run("%p\nN10 G100 Z105 F600\nN30 M30\n")

    assert len(into.measurements) == (edge == "POS")
    assert len(out.measurements) == (edge == "NEG")


@pytest.mark.req("M-130")
@pytest.mark.req("M-209", by="parsing")
@pytest.mark.parametrize("number", [1, 2])
def test_drive_latches_at_the_configured_input(make, recorder, number):
    settings = {
        "plant.probe.Z.face_mm": 100.0,
        "plant.probe.Z.material": "below",
        "axis.Z.start_mm": 105.0,
        "axis.Z.kenngr.measure.signal": "DRIVE",
        "axis.Z.kenngr.measure.input": number,
        "axis.Z.probe_input_1": "probe" if number == 1 else "",
        "axis.Z.probe_input_2": "probe" if number == 2 else "",
    }
    bench = make(settings, recorder=recorder)
    result = bench.run("%p\nN10 G100 Z95 F600\nN30 M30\n")

    assert set(recorder.column("probe_function", 2)) == {0, 0x11 << 8 * (number - 1)}
    assert [one.acs_mm for one in result.measurements] == [100.0]


@pytest.mark.req("M-033", "M-179", "M-183", "E-018", "E-019", "E-024")
def test_program_switches_the_signal_and_back(make, face):
    """#MEAS [AXNR=3 SIGNAL=..] acts until #MEAS DEFAULT takes it back to the list."""
    bench = make(face | {"axis.Z.start_mm": 110.0, "axis.Z.kenngr.measure.signal": "PLC"})
    block = "G100 Z95 F600\nG01 Z110 F6000\n"
    result = bench.run(
        f"%p\n{block}#MEAS [AXNR=3 SIGNAL=PLC_TIMESTAMP]\n{block}#MEAS [AX=Z SIGNAL=DRIVE]\n{block}"
        f"#MEAS DEFAULT\n{block}M30\n"
    )

    assert [one.source for one in result.measurements] == ["PLC", "PLC_TIMESTAMP", "DRIVE", "PLC"]
    assert [one.acs_mm for one in result.measurements[1:3]] == [100.0, 100.0]
    assert all(
        0.01 <= 100.0 - one.acs_mm <= 0.0202 for one in (result.measurements[0], result.measurements[3])
    )


@pytest.mark.req("M-024", "M-032", "M-033", "M-056")
def test_measuring_type_of_the_program_and_back_to_that_of_the_channel(make, errors):
    bench = make({"axis.Z.start_mm": 20.0, "channel.messtyp": 7})
    result = bench.run(
        '%p\nN10 #MSG ["%d", V.G.MEAS_TYPE]\nN20 #MEAS MODE[1]\nN30 #MSG ["%d", V.G.MEAS_TYPE]\n'
        'N35 G100 Z19 F600\nN40 #MEAS MODE\nN50 #MSG ["%d", V.G.MEAS_TYPE]\nN60 G100 Z18 F600\nN70 M30\n'
    )

    assert [one.text for one in result.messages] == ["7", "1", "7"]
    assert errors(result) == [(50886, "Z", "N60")], "N35 ran as type 1, N60 as type 7"


@pytest.mark.req("M-024", "M-145")
def test_channel_list_sets_the_type_that_a_run_uses(make, errors):
    result = make({"axis.Z.start_mm": 20.0, "channel.messtyp": 7}).run("%p\nN10 G100 Z19 F600\nN20 M30\n")

    assert errors(result) == [(50886, "Z", "N10")]


@pytest.mark.req("M-237", "M-239")
@pytest.mark.parametrize("given", [{"signal": False}, {"present": False}])
def test_unit_that_is_not_enabled_is_not_used(make, face, probing, given):
    """The level comes, but enable_w or plc_present_w is FALSE: no event."""
    bench = make(face | {"axis.Z.start_mm": 110.0}, plc=[probing((3,), **given)])
    result = bench.run("%p\nN10 G100 Z95 F6000\nN20 M30\n")

    assert result.completed
    assert not result.measurements


@pytest.mark.req("M-239")
def test_timestamp_unit_that_is_not_enabled_is_error_70689(make, face, probing, errors):
    bench = make(face | {"axis.Z.start_mm": 110.0}, plc=[probing((3,), stamp=False)])
    result = bench.run("%p\nN10 G100 Z95 F6000\nN20 M30\n")

    assert errors(result) == [(70689, "Z", "N10")]
    assert bench.kernel.core.at_rest


@pytest.mark.req("M-181")
@pytest.mark.parametrize(
    ("latch", "number"),
    [
        ("latch_pos - 300_000_000", 50053),  # the axis has a history there, and no run
        ("latch_pos - 60_000_000_000", 70689),  # beyond the history
        ("latch_neg", 70689),  # never latched: 0
    ],
)
def test_timestamp_from_before_the_run_is_an_error(make, face, probing, errors, latch, number):
    """The PLC forwards a time that its terminal did not latch in this run."""
    bench = make(face | {"axis.Z.start_mm": 110.0}, plc=[probing((3,), latch=latch)])
    bench.advance(1_000)
    result = bench.run("%p\nN10 G100 Z95 F6000\nN20 M30\n")

    assert errors(result) == [(number, "Z", "N10")]
    assert not result.measurements


@pytest.mark.req("M-005", "M-011")
def test_run_is_cut_at_the_event_and_the_next_block_starts_there(make, own_signals, recorder):
    """%Meas_run: X and Y of N30 end on the way, N40 goes on from the stopped point."""
    bench = make(BY_PLC, recorder=recorder, plc=[own_signals({1: 70_000, 2: 40_000})])
    result = bench.run("%Meas_run\nN10 G00 X0 Y0 Z0\nN20 X5\nN30 G100 X10 Y10 F500\nN40 G01 X7\nN50 M30\n")
    x, y = recorder.column("command", 0), recorder.column("command", 1)

    assert result.completed, result.errors
    assert {one.axis for one in result.measurements} == {"X", "Y"}
    assert y.max() < 60_000, "the rest of the path is dropped"
    assert y[-1] == y.max()
    assert x[-1] == 70_000


@pytest.mark.req("M-026", "M-220")
def test_type_2_takes_its_feed_from_the_axis_and_wants_a_signal(make, recorder, errors):
    bench = make({"axis.Z.start_mm": 20.0, "axis.Z.kenngr.vb_messen": 12_000}, recorder=recorder)
    result = bench.run("%p\nN10 #MEAS MODE[2]\nN20 G100 Z10 F60\nN30 M30\n")

    assert errors(result) == [(50057, "Z", "N20")]
    assert abs(recorder.velocity(2)).max() == pytest.approx(12.0, abs=1e-6)


@pytest.mark.req("M-026", "M-028")
@pytest.mark.parametrize(("kind", "words", "most"), [(2, "X1 Y1", 1), (4, "X1 Y1 Z19 A1", 3)])
def test_too_many_axes_for_the_type_is_error_50061(make, kind, words, most):
    result = make({"axis.Z.start_mm": 20.0}).run(
        f"%p\nN10 #MEAS MODE[{kind}]\nN20 G100 {words} F60\nN30 M30\n"
    )

    (error,) = result.errors
    assert error.id == 50061
    assert list(error.values.values())[1:] == [most, kind]


@pytest.mark.req("M-214", "M-215")
@pytest.mark.parametrize("kind", [1, 4])
def test_stroke_of_the_probe_limits_the_feed(make, recorder, kind):
    """Stroke 1 mm, deceleration 2000 mm/s2: 63 mm/s at most, with type 4 and not with type 1."""
    settings = {"axis.Z.start_mm": 20.0, "axis.Z.kenngr.hub_messtaster": 10_000}
    settings |= {f"axis.Z.getriebe[0].lslope_profil.a_grenz_stufe_{n}": 2000 for n in (1, 2)}
    bench = make(settings, recorder=recorder)
    result = bench.run(f"%p\nN10 #MEAS MODE[{kind}]\nN20 G100 Z0 F6000\nN30 M30\n")

    fastest = abs(recorder.velocity(2)).max()
    assert fastest == pytest.approx(100.0 if kind == 1 else (2 * 2000 * 1.0) ** 0.5, abs=1e-3)
    assert [(one.id, one.severity) for one in result.errors] == ([] if kind == 1 else [(120213, "warning")])


@pytest.mark.parametrize("signal", ["PLC_EXT_LATCH_CONTROL", "PLC_FIRST_EVENT", "EXT_PROBE_WITH_DRIVE"])
def test_source_that_is_not_built_says_so(make, signal):
    with pytest.raises(NotEmulated, match=signal):
        make({"axis.Z.start_mm": 20.0, "axis.Z.kenngr.measure.signal": signal}).run(
            "%p\nN10 G100 Z10 F60\nN30 M30\n"
        )


@pytest.mark.req("M-052", "M-068", "M-070")
def test_measured_value_is_a_record_with_its_instant(make, face, recorder):
    bench = make(face | {"axis.Z.start_mm": 110.0}, recorder=recorder)
    result = bench.run("%p\nN10 G100 Z95 F600\nN20 M30\n")
    (edge,) = [one for one in recorder.signals if one.level]
    (record,) = [one for _, one in recorder.records if isinstance(one, MeasuredValue)]

    assert record.dc_ns - bench.kernel.setup.dc_epoch_ns == edge.at_ns
    assert record.acs_tenth_um == 1_000_000
    assert result.variables["V.A.MESS.Z"] == result.variables["V.A.MEAS.ACS.VALUE.Z"] == 100.0


@pytest.mark.req("M-004", "M-006", "M-199")
def test_default_place_of_the_latch_is_the_drive(make, face):
    """DRIVE_TYPE_DEFAULT with a CANopen drive: the drive measures, whatever the PLC does."""
    settings = face | {"axis.Z.start_mm": 110.0, "axis.Z.kenngr.measure.signal": "DRIVE_TYPE_DEFAULT"}
    result = make(settings, plc=[]).run("%p\nN10 G100 Z95 F6000\nN20 M30\n")

    assert [(one.source, one.acs_mm) for one in result.measurements] == [("DRIVE", 100.0)]


@pytest.mark.req("M-180", "M-181", "M-184")
def test_timestamp_needs_no_input_at_the_drive(make, face):
    """Nothing is wired to the drive: EL1252 channel 2 and the HLI alone deliver the position."""
    settings = face | {"axis.Z.start_mm": 110.0, "axis.Z.probe_input_1": "", "axis.Z.probe_input_2": ""}
    result = make(settings).run("%p\nN10 G100 Z95 F6000\nN20 M30\n")

    assert [(one.source, one.acs_mm) for one in result.measurements] == [("PLC_TIMESTAMP", 100.0)]


@pytest.mark.req("M-184")
def test_signal_on_the_other_channel_of_the_terminal_does_not_count(make, face):
    settings = face | {
        "axis.Z.start_mm": 110.0,
        "terminal.probe.wiring.ch1": "probe",
        "terminal.probe.wiring.ch2": "",
    }
    assert not make(settings).run("%p\nN10 G100 Z95 F6000\nN20 M30\n").measurements


@pytest.mark.req("M-055", "M-063", "M-065")
def test_factor_of_the_offset(make, face):
    """G101 Z0.5 includes half of it, until G102."""
    bench = make(face | {"axis.Z.start_mm": 110.0})
    result = bench.run(
        "%p\nN10 G100 Z90 F6000\nN20 G101 Z0.5\nN30 G01 Z50 F6000\n"
        'N40 #MSG SYN["%.3f %.3f", V.A.MEIN.Z, V.A.ABS.Z]\nN50 G102 Z0\nN60 G01 Z50\n'
        'N70 #MSG SYN["%.3f %.3f", V.A.MEIN.Z, V.A.ABS.Z]\nN80 M30\n'
    )

    assert [one.text for one in result.messages] == ["5.000 55.000", "0.000 50.000"]


@pytest.mark.req("M-002")
def test_drives_of_other_axes_are_not_armed(make, recorder):
    settings = {f"axis.{axis}.kenngr.measure.signal": "DRIVE" for axis in "XYZ"} | {"axis.Z.start_mm": 20.0}
    bench = make(settings, recorder=recorder)
    bench.run("%p\nN10 G100 Z10 F6000\nN20 M30\n")

    assert [bool(recorder.column("probe_function", axis).any()) for axis in range(3)] == [False, False, True]
    assert recorder.column("probe_function", 2)[-1] == 0, "and switched off behind the run"
