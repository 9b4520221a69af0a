"""A measuring run with nothing in its way: the CNC says what the manual says, the bench what the plant lacks."""

from pathlib import Path

import pytest

from hli_bench import Bench

DEMO = Path(__file__).parents[2] / "plc_scripts" / "demo.py"
MEASURES = "N10 G01 G90 Z299 F6000\nN20 G100 Z298 F2000\nN30 M30\n"
NO_FACE = "as the plant has no face: plant.probe.Z.face_mm and plant.probe.Z.material set one"
REMARK = (f"N20: axis Z measured nothing, {NO_FACE}",)

NO_SIGNAL = ("N20: axis Z measured nothing: no probing signal came on its way",)


@pytest.mark.parametrize(("settings", "errors"), [({}, []), ({"channel.meas_error_no_signal": 1}, [50057])])
def test_a_machine_without_a_face_is_remarked(settings: dict[str, object], errors: list[int]) -> None:
    with Bench("demo", settings) as bench:
        result = bench.run(MEASURES)
    assert [error.id for error in result.errors] == errors
    assert result.variables["V.A.MERF.Z"] == 0.0
    assert result.notes == REMARK


@pytest.mark.parametrize(
    ("signal", "units"),
    [("PLC", ["probing_signal"]), ("PLC_TIMESTAMP", ["probing_signal", "timestamp"])],
)
def test_a_signal_that_no_plc_serves_is_remarked(signal: str, units: list[str]) -> None:
    face = {"plant.probe.Z.face_mm": 297, "plant.probe.Z.material": "below"}
    with Bench("demo", face | {"axis.Z.kenngr.measure.signal": signal}, plc=[]) as bench:
        result = bench.run(MEASURES)
    assert result.completed
    silent = [f"ax/3/lr_mc_control/{unit}: ax/3/head/plc_present_w is FALSE" for unit in units]
    assert result.notes == (f"N20: axis Z measured nothing, as no PLC serves {' and '.join(silent)}",)


BRIEF = """
from hli_bench.plc import Plc

class Brief(Plc):
    cycles = 0

    def cycle(self, hli, io):
        self.cycles += 1
        axis = hli.ax[3]
        axis.head.plc_present_w = True
        axis.lr_mc_control.release_feedhold.enable_w = axis.lr_mc_control.release_feedhold.command_w = True
        axis.lr_mc_control.probing_signal.enable_w = axis.lr_mc_control.timestamp.enable_w = self.cycles < 400
"""


def test_a_unit_that_is_served_while_it_measures_is_not_remarked(tmp_path) -> None:
    (tmp_path / "brief.py").write_text(BRIEF)
    face = {"plant.probe.Z.face_mm": 200, "plant.probe.Z.material": "below"}
    with Bench("demo", face, plc=[tmp_path / "brief.py"]) as bench:
        result = bench.run("N20 G90 G100 Z298 F2000\nN30 G04 1\nN40 M30\n")
        assert result.notes == NO_SIGNAL


@pytest.mark.parametrize(
    "settings",
    [
        {"plant.probe.Z.face_mm": 0, "plant.probe.Z.material": "below"},
        {"plant.probe.X.face_mm": -900, "plant.probe.X.material": "below"},
        {"fault": [{"kind": "probe_stuck", "target": "probe", "at_ms": 10**6, "value": 1}]},
    ],
    ids=["not reached", "another axis", "fault"],
)
def test_a_signal_that_did_not_come_is_remarked_where_the_cnc_says_nothing(
    settings: dict[str, object],
) -> None:
    with Bench("demo", settings) as bench:
        assert bench.run(MEASURES).notes == NO_SIGNAL
    with Bench("demo", settings | {"channel.meas_error_no_signal": 1}) as bench:
        assert bench.run(MEASURES).notes == ()


@pytest.mark.parametrize(
    ("program", "settings"),
    [
        (MEASURES, {"plant.probe.Z.face_mm": 298.5, "plant.probe.Z.material": "below"}),
        (MEASURES, {"axis.Z.kenngr.measure.signal": "FIXED_STOP"}),
        ('N10 #MSG ["%f", V.A.MEIN.Z]\nN20 #MSG ["%f", V.A.MERF.Z]\nN30 M30\n', {}),
        (MEASURES.replace("N10", "N05 #MEAS MODE[7]\nN10"), {}),
        (MEASURES.replace("G100", "G01"), {}),
    ],
    ids=["met", "stop by signal", "variables only", "stop by type", "no measuring run"],
)
def test_where_nothing_is_amiss_nothing_is_remarked(program: str, settings: dict[str, object]) -> None:
    with Bench("demo", settings) as bench:
        assert bench.run(program).notes == ()


FACE = {"plant.probe.Z.face_mm": 100, "plant.probe.Z.material": "below"}
TWICE = """N10 G90 G00 Z200
N20 G100 Z90 F3000
N30 G00 Z200
N40 G100 Z150 F3000
N50 #MSG ["%f %f %d", V.A.MESS.Z, V.A.MOFFS.Z, V.A.MERF.Z]
N60 M30
"""


@pytest.mark.parametrize("signal", ["PLC", "PLC_TIMESTAMP", "DRIVE"])
def test_each_block_that_measured_nothing_is_told(signal: str) -> None:
    """V.A.MESS keeps the value of the run before, V.A.MERF says that the last run had none."""
    with Bench("demo", FACE | {"axis.Z.kenngr.measure.signal": signal}) as bench:
        result = bench.run(TWICE)
    assert result.completed
    assert [one.block for one in result.measurements] == ["N20"]
    assert [(one.axis, one.block) for one in result.unmeasured] == [("Z", "N40")]
    assert result.notes == (NO_SIGNAL[0].replace("N20", "N40"),)
    mess, offset, merf = result.messages[0].text.split()
    assert float(mess) == pytest.approx(100.0, abs=0.1)
    assert float(offset) == pytest.approx(10.0, abs=0.1), "against the target of the run that has the value"
    assert merf == "0"


def test_blocks_of_a_loop_are_told_once_with_their_number() -> None:
    program = "N10 G90 G00 Z200\n$FOR P1 = 1, 3, 1\nN20 G100 Z190 F3000\nN30 G00 Z200\n$ENDFOR\nN40 M30\n"
    with Bench("demo", FACE) as bench:
        result = bench.run(program)
    assert len(result.unmeasured) == 3
    assert result.notes == (f"{NO_SIGNAL[0]} (3 times)",)


def test_a_run_that_was_broken_off_is_not_remarked() -> None:
    with Bench("demo", FACE) as bench:
        result = bench.run("N10 G90 G100 Z110 F60\nN20 M30\n", limit_s=0.5)
    assert result.status == "aborted"
    assert result.notes == ()
    assert not result.unmeasured


@pytest.mark.parametrize("signal", ["PLC", "PLC_TIMESTAMP"])
@pytest.mark.parametrize("period_us", [1000, 10_000])
def test_a_probe_that_is_operated_from_the_start_is_told_at_the_start(
    script, signal: str, period_us: int
) -> None:
    """The first block of all: the PLC has not yet spoken when it begins."""
    text = DEMO.read_text().replace("period_us = 1000", f"period_us = {period_us}")
    settings = FACE | {"axis.Z.start_mm": 95.0, "axis.Z.kenngr.measure.signal": signal}
    with Bench("demo", settings, plc=[script(text)]) as bench:
        result = bench.run("N10 G100 Z90 F500\nN20 M30\n")
        assert [(one.id, one.axis, one.block) for one in result.errors] == [(50052, "Z", "N10")]
        bench.advance(300)
        assert bench.position_mm("Z") > 94.0
    with Bench("demo", settings | {"channel.meas_allow_actuated_probe": 1}) as bench:
        result = bench.run("N10 G100 Z90 F500\nN20 M30\n")
        assert result.completed
        assert [(one.axis, one.block) for one in result.unmeasured] == [("Z", "N10")]


def test_the_level_that_is_wrong_for_the_edge_is_named() -> None:
    settings = FACE | {"axis.Z.kenngr.measure.signal": "PLC", "axis.Z.kenngr.measure.edge": "NEG"}
    with Bench("demo", settings) as bench:
        (error,) = bench.run("N05 G04 0.1\nN10 G100 Z90 F500\nN20 M30\n").errors
    assert error.id == 50052
    assert "already is FALSE, the level behind its edge NEG" in error.text


@pytest.mark.parametrize(("param", "numbers"), [({}, [50067]), ({"channel.meas_error_no_move_path": 0}, [])])
def test_a_measuring_run_without_motion(param: dict[str, object], numbers: list[int]) -> None:
    with Bench("demo", FACE | param) as bench:
        result = bench.run("N10 G90 G01 Z200 F6000\nN20 G100 Z200 F500\nN30 M30\n")
    assert [error.id for error in result.errors] == numbers
    assert result.completed is (not numbers)


def test_an_axis_that_is_no_main_axis_is_named_in_type_4() -> None:
    with Bench("demo", FACE) as bench:
        (error,) = bench.run("#MEAS MODE[4]\nN10 G100 X2=5 F500\nN20 M30\n").errors
    assert (error.id, error.axis) == (50061, "X2")
    assert "X2 is not a main axis" in error.text


def test_a_later_value_of_another_axis_does_not_change_one_under_a_system() -> None:
    program = """N05 G90 G00 X0 Y0 Z200
N10 #CS ON[0,0,0,0,20,0]
N20 G01 G90 X0 Z190 F3000
N30 G100 Z80 F3000
P1 = V.A.MESS.Z
#CS OFF
N40 G01 Z200 F6000
N50 G100 Z90 F3000
P2 = V.A.MESS.X
N60 M30
"""
    with Bench("demo", FACE) as bench:
        result = bench.run(program)
    assert result.completed, result.errors
    assert len(result.measurements) == 4
    assert result.variables["P2"] == result.variables["V.A.MESS.X"]
    first = {one.axis: one for one in result.measurements[:3]}
    assert result.variables["V.A.MEAS.ACS.VALUE.X"] == first["X"].acs_mm
    assert result.variables["V.A.MEAS.PCS.VALUE.X"] == first["X"].pcs_mm
