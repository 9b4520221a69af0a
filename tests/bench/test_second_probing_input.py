"""P-AXIS-00517 = 2: the CNC configures the telegrams so that they carry the latches of the second input."""

import pytest

from hli_bench import Bench

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


def test_the_input_of_a_drive_cannot_be_changed_by_the_program() -> None:
    program = PROGRAM.replace("N20", "N15 #MEAS [AX=Z SIGNAL=DRIVE INPUT=2]\nN20")
    with Bench("demo", FACE) as bench:
        result = bench.run(program)
    assert [error.id for error in result.errors] == [70390]
