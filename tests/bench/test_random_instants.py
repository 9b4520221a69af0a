"""Whatever breaks off at whatever instant: axes stand, a reset makes ready, the next program runs as ever."""

import random
import struct
from collections.abc import Callable
from typing import Any

import pytest

from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.wire.can import CanFrame

X, Y, Z = 0, 1, 2
SETTINGS = {f"axis.{name}.kenngr.abs_pos_gueltig": 0 for name in "XY"}
FACE = {"plant.probe.Z.face_mm": 100.0, "plant.probe.Z.material": "below", "axis.Z.start_mm": 130.0}
STOP = {"plant.stop.Z.at_mm": 80.0, "plant.stop.Z.side": "below", "axis.Z.start_mm": 90.0}
ACTIVITIES: dict[str, tuple[str, dict[str, Any]]] = {
    "homing": ("N10 G74 X1 Y1\nN20 M30\n", {"axis.X.start_mm": 5.0, "axis.Y.start_mm": -60.0}),
    "measuring": ("N10 G90 G100 Z90 F1000\nN20 M30\n", FACE),
    "fixed stop": ("N10 #MEAS MODE[7]\nN20 G90 G100 Z70 F1000\nN30 M30\n", STOP),
    "path": ("N10 G90 G01 X60 Y30 F4000\nN20 X0\nN30 M30\n", {}),
    "dwell": ("N10 G90 G01 X5 F4000\nN20 G04 1\nN30 X0\nN40 M30\n", {}),
}
COASTED = 4000
"""Cycles in which a drive without power runs out; its set point follows it."""
REFERENCE = "N10 G74 X1 Y1\nN20 G90 G01 X-5 Y-5 Z120 F4000\nN30 G91 X7 Y3\nN40 M30\n"


def interrupt(bench: Any, node: int) -> None:
    raise KeyboardInterrupt


def stop(bench: Any, node: int) -> None:
    bench.engine.put([nmt_frame(NmtCommand.STOP, node)])


def disable(bench: Any, node: int) -> None:
    bench.engine.put([CanFrame(0x600 + node, struct.pack("<BHBI", 0x2B, 0x6040, 0, 0))])


HAPPENINGS: dict[str, Callable[[Any, int], None] | None] = {
    "reset": None,
    "interrupt": interrupt,
    "node stopped": stop,
    "drive disabled": disable,
}


class At:
    """Observer that does something once, behind a cycle."""

    def __init__(self, cycle: int, what: Callable[[], None]) -> None:
        self.cycle = cycle
        self.what: Callable[[], None] | None = what

    def cycles(self, first: int, count: int) -> None:
        if self.what is not None and first + count > self.cycle:
            what, self.what = self.what, None
            what()

    def frames(self, *_: object) -> None: ...

    edges = emitted = commands = refused = overran = frames


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("happens", HAPPENINGS)
@pytest.mark.parametrize("activity", ACTIVITIES)
def test_what_breaks_off_at_any_instant_leaves_a_bench_as_good_as_new(make, activity, happens, seed):
    program, settings = ACTIVITIES[activity]
    rng = random.Random(f"{activity} {happens} {seed}")
    bench = make(SETTINGS | settings)
    bench.start_up()
    what, node = HAPPENINGS[happens], rng.choice([1, 2, 3])
    after = rng.randrange(1, 1000)
    if what is None:
        bench.kernel.start(program.splitlines(), "p")
        bench.engine.wake()
        bench.advance(after)
        bench.reset()
    else:
        bench.engine.observers.append(At(bench.engine.cycle + after, lambda: what(bench, node)))
        try:
            bench.run(program)
        except KeyboardInterrupt:
            assert happens == "interrupt"
    bench.advance(COASTED if happens == "drive disabled" else 600)
    core, axes = bench.kernel.core, bench.kernel.rows.axis
    before, places = axes["command"].copy(), [bench.position_mm(name) for name in "XYZ"]
    assert core.at_rest
    bench.advance(600)
    assert core.at_rest
    assert axes["command"] == pytest.approx(before, abs=20 if happens == "drive disabled" else 0)
    assert [bench.position_mm(name) for name in "XYZ"] == pytest.approx(places, abs=2e-3)

    bench.reset()
    bench.advance(500)
    assert bench.state()["state"] == "ready"
    assert not axes["probe_function"].any()
    again, fresh = bench.run(REFERENCE), make(SETTINGS | settings).run(REFERENCE)
    assert again.completed, again.errors
    assert fresh.completed, fresh.errors
    bench.advance(200)
    assert [bench.position_mm(name) for name in "XYZ"] == pytest.approx([2.0, -2.0, 120.0], abs=1e-3)
    assert again.variables == pytest.approx(fresh.variables, abs=1e-3)
