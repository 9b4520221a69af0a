"""P-AXIS-00517 = 2: the CNC configures the telegrams so that they carry the latches of the second input."""

import pytest

from hli_bench import Bench
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort

PROGRAM = "%second\nN10 G01 G90 Z290 F6000\nN20 G100 Z270 F2000\nN30 M30\n"
FACE = {"plant.probe.Z.face_mm": 280.1234, "plant.probe.Z.material": "below"}
WIRED_TO_INPUT_2 = {"axis.Z.probe_input_1": "", "axis.Z.probe_input_2": "probe"}


@pytest.mark.req("M-129", "M-130")
def test_the_drive_latches_at_the_input_that_the_list_chooses() -> None:
    settings = {**FACE, **WIRED_TO_INPUT_2, "axis.Z.kenngr.measure.signal": "DRIVE"}
    with Bench("demo", {**settings, "axis.Z.kenngr.measure.input": 2}) as bench:
        assert bench.run(PROGRAM).variables["V.A.MESS.Z"] == 280.1234
        assert bench.engine.link.quiet(bench.engine.cycle + 1) > 0
    with Bench("demo", {**settings, "axis.Z.kenngr.measure.input": 1}) as bench:
        assert not bench.run(PROGRAM).measurements


BOTH = """%both
N10 G01 G90 Z290 F6000
N15 #MEAS [AX=Z SIGNAL=DRIVE INPUT=2]
N20 G100 Z270 F2000
N30 G01 Z290 F6000
N35 #MEAS [AX=Z INPUT=1]
N40 G100 Z270 F2000
N45 #MEAS [AX=Z INPUT=2 EDGE=NEG]
N50 G100 Z290 F2000
N60 M30
"""


@pytest.mark.req("M-129", "M-130", "E-019", "E-026")
@pytest.mark.parametrize("processes", [False, True])
@pytest.mark.parametrize(("first", "blocks"), [("", ["N20", "N50"]), ("probe", ["N20", "N40", "N50"])])
def test_the_program_changes_the_input_of_a_canopen_drive(
    processes: bool, first: str, blocks: list[str]
) -> None:
    """The telegrams are changed to carry the latches of the input, before the run begins."""
    settings = {**FACE, "axis.Z.probe_input_1": first, "axis.Z.probe_input_2": "probe"}
    with Bench("demo", settings, processes=processes) as bench:
        result = bench.run(BOTH)
        again = bench.run(PROGRAM.replace("N20", "N15 #MEAS [AX=Z SIGNAL=DRIVE]\nN20"))
    assert result.completed, result.errors
    assert [one.block for one in result.measurements] == blocks
    assert {one.acs_mm for one in result.measurements} == {280.1234}
    assert bool(again.measurements) is bool(first), "the next program measures by the list again"


def refuse(_: object) -> None:
    raise SdoAbort(AbortCode.NOT_MAPPABLE)


def test_a_drive_that_refuses_another_telegram_is_an_error() -> None:
    program = PROGRAM.replace("N20", "N15 #MEAS [AX=Z SIGNAL=DRIVE INPUT=2]\nN20")
    with Bench("demo", FACE) as bench:
        bench.start_up()
        (drive,) = [one for one in bench.engine.link.drives if one.node_id == 3]
        drive.device.values.on_write(0x1A01, 0, refuse)
        result = bench.run(program)
    assert [error.id for error in result.errors] == [70278]


@pytest.mark.parametrize("words", ["INPUT=3", "INPUT=0", "INPUT=300", ""])
def test_an_input_that_the_source_has_not_is_error_50639(words: str) -> None:
    settings = {**FACE, "axis.Z.kenngr.measure.input": 4}
    program = PROGRAM.replace("N20", f"N15 #MEAS [AX=Z SIGNAL=DRIVE {words}]\nN20")
    with Bench("demo", settings) as bench:
        result = bench.run(program)
    assert [(one.id, one.axis, one.block) for one in result.errors] == [(50639, "Z", "N15")]


def test_an_input_of_the_list_that_the_source_has_not_is_corrected() -> None:
    settings = {**FACE, "axis.Z.kenngr.measure.signal": "DRIVE", "axis.Z.kenngr.measure.input": 4}
    with Bench("demo", settings) as bench:
        notes = [note.message for note in bench.config.notes if "110587" in note.message]
        result = bench.run(PROGRAM)
    assert len(notes) == 1
    assert "kenngr.measure.input: 4 is not one of 1..2" in notes[0]
    assert result.variables["V.A.MESS.Z"] == 280.1234


def test_a_default_of_the_drive_type_may_be_named() -> None:
    program = PROGRAM.replace("N20", "N15 #MEAS [AX=Z SIGNAL=DRIVE_TYPE_DEFAULT]\nN20")
    with Bench("demo", FACE) as bench:
        (value,) = bench.run(program).measurements
    assert value.source == "DRIVE"


@pytest.mark.req("E-006", "E-007")
@pytest.mark.parametrize("kind", [1, 2, 3, 4])
@pytest.mark.parametrize("word", [0, 1])
def test_the_word_of_the_program_decides_whether_a_missing_signal_is_an_error(kind: int, word: int) -> None:
    program = PROGRAM.replace("N20", f"N15 #MEAS [TYPE={kind} ERR_NO_SIGNAL={word}]\nN20")
    settings = {"channel.meas_error_no_signal": 1 - word}
    with Bench("demo", {**FACE, **settings, "plant.probe.Z.face_mm": 100}) as bench:
        result = bench.run(program)
    assert [error.id for error in result.errors] == ([50057] if word else [])
    assert [(one.axis, one.block) for one in result.unmeasured] == [("Z", "N20")]
