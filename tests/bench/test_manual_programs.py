"""The four measuring examples of the manual, unchanged, over EL1252, PLC script and HLI (measurement manual 5)."""

import re
from pathlib import Path

import pytest

PROGRAMS = Path(__file__).resolve().parents[2] / "programs"

FACE_MM = {"meas1": 100.0, "meas2": 100.0, "meas3": 100.0, "meas4": 55.5}
RESULT = re.compile(r"->\s*(?P<name>V\.A\.[A-Z.]+) = (?P<value>[0-9.]+)")
EXACT_MM = 1e-4
MEAS4_MM = 0.0046
"""20.0 is printed for 20.0045."""

MEAS1 = """\
%meas1
N05 #MEAS MODE[1]
N10 G01 G90 Z200 F2000
N20 G100 Z20 F2000
N30 #MSG SYN["V.A.MESS.Z=%f", V.A.MESS.Z]
      -> V.A.MESS.Z = 100.0
N31 #MSG SYN["V.A.MEAS.ACS.VALUE.Z=%f",
      V.A.MEAS.ACS.VALUE.Z]
      -> V.A.MEAS.ACS.VALUE.Z = 100.0
N32 #MSG SYN["V.A.MEAS.PCS.VALUE.Z=%f",
      V.A.MEAS.PCS.VALUE.Z]
      -> V.A.MEAS.PCS.VALUE.Z = 100.0
N40 #MSG SYN["V.A.MOFFS.Z=%f", V.A.MOFFS.Z]
      -> V.A.MOFFS.Z = 80.0
N50 #MSG SYN["V.A.MEIN.Z=%f", V.A.MEIN.Z]
      -> V.A.MEIN.Z = 0.0
N60 G101 Z1
N70 #MSG SYN["V.A.MEIN.Z=%f", V.A.MEIN.Z]
      -> V.A.MEIN.Z = 80.0
N80 G01 Z100 F1000
N90 #MSG SYN["V.A.ABS.Z=%f", V.A.ABS.Z]
      -> V.A.ABS.Z = 180.0
N100 G102 Z1
N110 #MSG SYN["V.A.MEIN.Z=%f", V.A.MEIN.Z]
      -> V.A.MEIN.Z = 0.0
N120 G01 Z100 F1000
N130 #MSG SYN["V.A.ABS.Z=%f", V.A.ABS.Z]
      -> V.A.ABS.Z = 100.0
N140 M30
"""


def printed(text: str) -> list[tuple[str, float]]:
    """Return what the result lines of an example say."""
    return [(found["name"], float(found["value"])) for found in RESULT.finditer(text)]


def messages(result) -> list[tuple[str, float]]:
    pairs = [message.text.split("=") for message in result.messages]
    return [(name, float(value)) for name, value in pairs]


def compare(result, expected, tolerance: float) -> None:
    assert result.completed, result.errors
    assert [name for name, _ in messages(result)] == [name for name, _ in expected]
    for (name, value), (_, wanted) in zip(messages(result), expected, strict=True):
        assert value == pytest.approx(wanted, abs=tolerance), name


@pytest.mark.parametrize("source", ["PLC_TIMESTAMP", "DRIVE"])
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(
            "meas1",
            marks=pytest.mark.req(
                "M-075", "M-076", "M-077", "M-078", "M-079", "M-080", "M-081", "M-082", "M-083"
            ),
        ),
        pytest.param(
            "meas2", marks=pytest.mark.req("M-084", "M-085", "M-086", "M-087", "M-088", "M-089", "M-090")
        ),
        pytest.param(
            "meas3", marks=pytest.mark.req("M-091", "M-092", "M-093", "M-094", "M-095", "M-096", "M-097")
        ),
        pytest.param(
            "meas4",
            marks=pytest.mark.req("M-098", "M-099", "M-100", "M-101", "M-102", "M-103", "M-104", "M-105"),
        ),
    ],
)
@pytest.mark.req("M-001", "M-005", "M-007", "M-057", "M-106", "M-181", "M-182", "M-183")
def test_example_prints_the_numbers_of_the_manual(make, name, source):
    program = PROGRAMS / f"{name}.nc"
    settings = {"plant.probe.Z.face_mm": FACE_MM[name], "plant.probe.Z.material": "below"}
    settings |= {f"axis.{axis}.kenngr.measure.signal": source for axis in "XYZ"}
    result = make(settings).run(program)

    compare(result, printed(program.read_text()), MEAS4_MM if name == "meas4" else EXACT_MM)
    assert {one.source for one in result.measurements} == {source}


@pytest.mark.req("M-098", "M-099", "M-105")
@pytest.mark.parametrize("source", ["PLC_TIMESTAMP", "DRIVE"])
def test_meas4_measures_the_exact_value_behind_the_printed_one(make, source):
    settings = {"plant.probe.Z.face_mm": 55.5, "plant.probe.Z.material": "below"}
    settings |= {f"axis.{axis}.kenngr.measure.signal": source for axis in "XYZ"}
    result = make(settings).run(PROGRAMS / "meas4.nc")

    values = dict(messages(result))
    assert values["V.A.MESS.Z"] == pytest.approx(20.0045, abs=1e-3)
    assert values["V.A.MEAS.ACS.VALUE.Z"] == pytest.approx(55.5, abs=1e-4)


@pytest.mark.req("M-075", "M-083")
def test_text_as_the_manual_prints_it_runs_with_its_result_lines(make, face):
    """The arrows with the results are no NC text; the manual's page runs all the same."""
    result = make(face).run(MEAS1, name="meas1")

    compare(result, printed(MEAS1), EXACT_MM)


@pytest.mark.req("M-134", "M-182", "M-184", "M-235", "M-238", "M-239")
def test_signal_goes_the_whole_way_from_the_edge_to_the_value(make, face, recorder):
    """Plant edge, EL1252 time latch, PLC write on the HLI, kernel: the same instant all the way."""
    bench = make(face | {"terminal.probe.delay_ns": 0}, recorder=recorder)
    result = bench.run("%p\nN10 G01 Z101 F6000\nN20 G100 Z99 F600\nN30 M30\n")

    (edge,) = [one for one in recorder.signals if one.signal == "probe" and one.level]
    stamp = bench.kernel.setup.dc_epoch_ns + edge.at_ns
    writes = [
        (commands.cycle, write.path, write.value)
        for commands in recorder.writes
        for write in commands.writes
        if write.path.startswith("ax/3/lr_mc_control/")
    ]
    stamped = [w for w in writes if w[1].endswith("timestamp/command_w") and w[2] == stamp]
    levelled = [w for w in writes if w[1].endswith("probing_signal/command_w") and w[2]]
    assert len(stamped) == len(levelled) == 1
    assert stamped[0][0] == levelled[0][0] == -(-edge.at_ns // 1_000_000)
    assert result.measurements[0].dc_ns == stamp
    assert result.measurements[0].acs_mm == pytest.approx(100.0, abs=1e-4)
