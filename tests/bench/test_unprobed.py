"""A measuring run with nothing in its way: the CNC says what the manual says, the bench what the plant lacks."""

import pytest

from hli_bench import Bench

MEASURES = "N10 G01 G90 Z299 F6000\nN20 G100 Z298 F2000\nN30 M30\n"
REMARK = (
    "axis Z measured nothing, as the plant has no face: plant.probe.Z.face_mm and plant.probe.Z.material set one",
)

NO_SIGNAL = ("axis Z measured nothing: no probing signal came on its way",)


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
    assert result.notes == tuple(
        f"axis Z measured nothing, as no PLC serves ax/3/lr_mc_control/{unit}: ax/3/head/plc_present_w is FALSE"
        for unit in units
    )


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
        (MEASURES.replace("N10", "N05 #MEAS MODE[7]\nN10"), {}),
        (MEASURES.replace("G100", "G01"), {}),
    ],
    ids=["met", "stop by signal", "stop by type", "no measuring run"],
)
def test_where_nothing_is_amiss_nothing_is_remarked(program: str, settings: dict[str, object]) -> None:
    with Bench("demo", settings) as bench:
        assert bench.run(program).notes == ()
