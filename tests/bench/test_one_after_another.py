"""Benches that live long: what one program, one abort, one failure leaves behind for the next."""

import pytest

from hli_bench import Bench
from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file

FACE = {"plant.probe.Z.face_mm": 100, "plant.probe.Z.material": "below"}
NEXT = "N100 G04 0.5\nN110 M30\n"


class Interrupts:
    """Observer that presses Ctrl-C once, when `when` holds."""

    def __init__(self, when) -> None:
        self.when = when
        self.pressed = False

    def cycles(self, first: int, count: int) -> None:
        if not self.pressed and self.when():
            self.pressed = True
            raise KeyboardInterrupt

    def frames(self, *_: object) -> None: ...

    edges = emitted = commands = refused = frames


def errors(result) -> list[tuple[int, str]]:
    return [(error.id, error.block) for error in result.errors]


@pytest.mark.parametrize(
    "program", ["N20 G90 G100 Z90 F6000\nN30 M30\n", "N10 #MEAS MODE[7]\nN20 G100 Z90 F600\nN30 M30\n"]
)
def test_an_interrupt_in_a_run_that_has_its_value_gives_a_result_and_a_bench_that_goes_on(
    program: str,
) -> None:
    settings = FACE | {"plant.stop.Z.at_mm": 100, "plant.stop.Z.side": "below"}
    with Bench("demo", settings) as bench:
        bench.run("N10 G90 G01 Z105 F6000\nN20 M30\n")
        image = bench.kernel.image
        shown = [
            image.layout.element(f"ax/3/lr_state/{name}_r").id
            for name in ("measure_value_ok", "measurement_active")
        ]
        bench.engine.observers.append(Interrupts(lambda: all(map(image.get, shown))))
        with pytest.raises(KeyboardInterrupt):
            bench.run(program)
        assert bench.interrupted is not None
        assert bench.interrupted.status == "aborted"
        assert [one.axis for one in bench.interrupted.measurements] == ["Z"]
        bench.reset()
        assert bench.run("N10 G90 G01 Z110 F6000\nN20 M30\n").completed


def test_an_interrupt_between_cycles_leaves_the_time_of_the_next_plc_task(tmp_path) -> None:
    (tmp_path / "slow.py").write_text(
        "class Slow:\n    period_us = 4000\n    def cycle(self, hli, io): ...\n"
    )
    with Bench("demo", plc=[tmp_path / "slow.py"]) as bench:
        bench.start_up()
        bench.engine.observers.append(Interrupts(lambda: bench.engine.cycle % 4 == 0))
        with pytest.raises(KeyboardInterrupt):
            bench.run(NEXT)
        assert bench.run(NEXT).completed


FAILS = """
class Fails:
    period_us = 1000
    def cycle(self, hli, io):
        before, self.before = self.before, io.probe.ch2.input
        if before and not self.before:
            raise {error}("once")
    before = False
"""


@pytest.mark.parametrize("error", ["ValueError", "KeyboardInterrupt"])
def test_what_other_plcs_wrote_in_a_cycle_in_which_one_failed_counts(tmp_path, error: str) -> None:
    (tmp_path / "fails.py").write_text(FAILS.format(error=error))
    with Bench("demo", FACE, plc=[data_file("plc_scripts", "demo.py"), tmp_path / "fails.py"]) as bench:
        assert bench.run("N10 G90 G01 Z105 F6000\nN20 G100 Z90 F6000\nN30 M30\n").measurements
        with pytest.raises((InputError, KeyboardInterrupt)):
            bench.run("N10 G90 G01 Z110 F6000\nN20 M30\n")
        bench.reset()
        again = bench.run("N10 G90 G01 Z110 F6000\nN20 G100 Z90 F6000\nN30 M30\n")
        assert (errors(again), len(again.measurements)) == ([], 1)


WRITES = """
class Writes:
    period_us = 1000
    pressed = False
    def cycle(self, hli, io):
        hli.ax[3].head.plc_present_w = True
        if not self.pressed:
            self.pressed = True
            raise KeyboardInterrupt
"""


def test_what_an_interrupted_script_had_written_comes_with_its_next_cycle(tmp_path) -> None:
    (tmp_path / "writes.py").write_text(WRITES)
    with Bench("demo", plc=[tmp_path / "writes.py"]) as bench:
        with pytest.raises(KeyboardInterrupt):
            bench.run(NEXT)
        bench.run(NEXT)
        image = bench.kernel.image
        assert image.get(image.layout.element("ax/3/head/plc_present_w").id) is True


@pytest.mark.parametrize("limit_s", [1.5, 1.512, 1.53, 1.56])
def test_a_drive_that_comes_back_while_the_path_brakes_stands_still(limit_s: float) -> None:
    stop = {"plant.stop.X.at_mm": 400, "plant.stop.X.side": "above", "plant.axis.X.brake_nm": 60}
    with Bench("demo", stop, plc=[]) as bench:
        bench.run("N10 G90 G01 X380 F30000\nN777 X600 F30000\nN40 M30\n", limit_s=limit_s)
        assert errors(bench.run(NEXT)) == []
        assert bench.position_mm("X") == pytest.approx(400.28, abs=0.01)
        bench.reset()
        assert bench.run("N10 G01 X300 F6000\nN20 M30\n").completed


@pytest.mark.parametrize("limit_s", [1.512, 1.513, 1.514])
def test_a_drive_that_trips_while_a_reset_takes_it_back_is_reset_as_well(limit_s: float) -> None:
    with Bench("demo", {"plant.stop.X.at_mm": 400, "plant.stop.X.side": "above"}, plc=[]) as bench:
        bench.run("N10 G90 G01 X380 F30000\nN20 X600 Y100 F30000\nN40 M30\n", limit_s=limit_s)
        assert errors(bench.run(NEXT)) == []


@pytest.mark.parametrize("between", ["", "N15 G01 Z120\n"])
def test_a_drive_probes_again_at_once(between: str) -> None:
    program = f"N05 G90 G01 Z120 F9000\nN10 G100 Z90 F1000\n{between}N20 G100 Z80\nN30 M30\n"
    with Bench("demo", FACE | {"axis.Z.kenngr.measure.signal": "DRIVE"}) as bench:
        result = bench.run(program)
        assert errors(result) == []
        assert [one.block for one in result.measurements] == (["N10", "N20"] if between else ["N10"])
        assert errors(bench.run("N10 G01 Z120 F9000\nN20 G100 Z90 F1000\nN30 M30\n")) == []


def test_a_drive_probes_there_back_and_there_again() -> None:
    edges = [
        f"N{number}0 #MEAS [AX=Z EDGE={edge}]\nN{number}5 G100 Z{target}\n"
        for number, edge, target in ((1, "POS", 90), (2, "NEG", 150), (3, "POS", 90))
    ]
    with Bench("demo", FACE | {"axis.Z.kenngr.measure.signal": "DRIVE"}) as bench:
        result = bench.run(f"N05 G90 G01 Z120 F6000\n{''.join(edges)}N40 M30\n")
    assert errors(result) == []
    assert [(one.block, one.edge) for one in result.measurements] == [
        ("N15", "POS"),
        ("N25", "NEG"),
        ("N35", "POS"),
    ]


@pytest.mark.parametrize("cycles", [1, 500, 540, 600])
def test_a_program_waits_for_drives_that_a_reset_brings_back(cycles: int) -> None:
    trips = "N10 G90 G01 X300 F20000\nN20 #DRIVE WR SYN [AX=X KEY=MON_WINDOW VAL=100 WAIT]\nN30 X0\nN40 M30\n"
    with Bench("demo", plc=[]) as bench:
        assert [number for number, _ in errors(bench.run(trips))] == [70222]
        bench.advance(cycles)
        bench.reset()
        assert errors(bench.run(NEXT)) == []


def test_a_reset_ends_what_is_on_its_way_to_a_drive() -> None:
    with Bench("demo", {"axis.X.antr.function[0].wr_ident[0]": "5FFF_00"}, plc=[]) as bench:
        assert bench.run("N77 #DRIVE WR [AX=X KEY=MON_WINDOW VAL=5]\nN80 M30\n").completed
        bench.reset()
        assert errors(bench.run(NEXT)) == []


def test_an_error_before_the_first_block_names_none() -> None:
    with Bench("demo", {"plant.stop.X.at_mm": 400, "plant.stop.X.side": "above"}, plc=[]) as bench:
        bench.run("N10 G90 G01 X380 F30000\nN777 X600 F30000\nN40 M30\n", limit_s=1.45)
        assert "N777" not in [block for _, block in errors(bench.run(NEXT))]
