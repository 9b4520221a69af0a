"""Stops of a drive on its mechanics: where the axis is, along its ramps; what it does with and without power."""

import math
import struct
from typing import Any

import pytest
from hli_bench_drives.cia402.drive import Drive
from hli_bench_drives.cia402.states import State, state_of
from hli_bench_drives.models import servo402

from hli_bench.base.time import Ns
from hli_bench.laws.machine import advance_machine
from hli_bench.laws.native import bind
from hli_bench.plant.build import build
from hli_bench.plant.settings import AxisPlant, PlantAxis, PlantSettings, Probe, Stop
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort

TURN, PITCH_MM, CYCLE_NS, START_MM = 1_048_576, 10.0, 1_000_000, 300.0
PLAIN: dict[str, Any] = {
    "inertia_kg_m2": 3.3e-3,
    "mass_kg": 0.0,
    "pitch_mm": PITCH_MM,
    "viscous_nm_s": 0.002,
    "coulomb_nm": 0.05,
    "static_nm": 0.06,
    "rated_torque_nm": 15.0,
    "peak_permille": 3000.0,
    "increments_per_turn": TURN,
    "zero_pulse_increments": TURN // 2,
    "kv_per_s": 50.0,
    "speed_bandwidth_per_s": 300.0,
    "speed_reset_ms": 20.0,
}


class Axis:
    """A servo402 on its motor, commanded by numbers as a CNC does."""

    def __init__(self, *, stop: Stop | None = None, **plant: float) -> None:
        one = PlantAxis(
            name="Z",
            rotary=False,
            absolute=True,
            start_mm=START_MM,
            plant=AxisPlant(**PLAIN | plant),
            stop=stop,
        )
        built = build(PlantSettings(axes=[one], probe=Probe()))
        rows = built.rows
        self.row: Any = rows.servo[0]
        self.drive: Drive = servo402.create("Z", 3, self.row, {})
        self._advance = bind(
            advance_machine,
            *(rows.servo, rows.switch, rows.signal, rows.channel, rows.edge, rows.edges, built.pending),
            *(CYCLE_NS, 8, 0),
        )
        self.cycle = 0
        self.target_mm = START_MM
        self.power_on()

    def power_on(self) -> None:
        for word in (0x06, 0x07, 0x0F):
            self.step(word)

    def step(self, word: int = 0x0F, mm_per_s: float = 0.0) -> State | None:
        """One cycle: machine, then the telegram with the target that lies so much further."""
        self._advance(self.cycle * CYCLE_NS)
        self.cycle += 1
        self.target_mm += mm_per_s * 1e-3
        return state_of(self.drive.exchange(word, round(self.target_mm / PITCH_MM * TURN), 0, self.now))

    def run(self, cycles: int, word: int = 0x0F, mm_per_s: float = 0.0) -> list[float]:
        """Return the speed in mm/s at the end of each cycle."""
        found = []
        for _ in range(cycles):
            self.step(word, mm_per_s)
            found.append(self.speed)
        return found

    @property
    def now(self) -> Ns:
        return Ns(self.cycle * CYCLE_NS)

    @property
    def mm(self) -> float:
        return float(self.row["angle"]) * PITCH_MM / math.tau

    @property
    def speed(self) -> float:
        return float(self.row["speed"]) * PITCH_MM / math.tau

    def write(self, index: int, value: int, code: str = "<h") -> None:
        self.drive.device.values.download(index, 0, struct.pack(code, value))


def per_turn(mm_per_s2: float) -> int:
    return round(mm_per_s2 / PITCH_MM * TURN)


def test_a_following_error_stops_the_axis_where_it_is() -> None:
    """The target jumps by 100 mm, the window is 0.5 mm: fault 8611, and the axis does not go on to the target."""
    axis = Axis()
    axis.write(0x6065, round(0.5 / PITCH_MM * TURN), "<I")
    axis.write(0x6066, 0, "<H")
    axis.target_mm += 100.0
    where = None
    for _ in range(1000):
        state = axis.step()
        if where is None and state is State.FAULT_REACTION_ACTIVE:
            where, speed = axis.mm, axis.speed
    assert axis.drive.state is State.FAULT
    assert where is not None
    assert speed > 0.0
    # 6085 = 1048576000 increments/s2 are 10 m/s2
    assert axis.mm - where == pytest.approx(speed**2 / 2 / 10_000.0, rel=0.1, abs=0.05)
    assert axis.mm < START_MM + 5.0


@pytest.mark.parametrize(
    ("option", "mm_per_s2", "after"),
    [
        (1, 2000.0, State.SWITCH_ON_DISABLED),
        (2, 8000.0, State.SWITCH_ON_DISABLED),
        (5, 2000.0, State.QUICK_STOP_ACTIVE),
        (6, 8000.0, State.QUICK_STOP_ACTIVE),
    ],
)
def test_a_quick_stop_follows_its_ramp(option: int, mm_per_s2: float, after: State) -> None:
    axis = Axis()
    axis.write(0x6084, per_turn(2000.0), "<I")
    axis.write(0x6085, per_turn(8000.0), "<I")
    axis.write(0x605A, option)
    axis.run(1000, mm_per_s=200.0)
    assert axis.speed == pytest.approx(200.0, rel=0.01)
    where = axis.mm
    axis.target_mm += 100.0
    ramp = axis.run(round(200.0 / mm_per_s2 * 500.0), 0x02)
    assert 90.0 < ramp[-1] < 140.0, "halfway, a little later for the drive's own lag"
    axis.run(600, 0x02)
    assert axis.drive.state is after
    assert axis.mm - where == pytest.approx(200.0**2 / 2 / mm_per_s2, rel=0.15)
    assert axis.speed == pytest.approx(0.0, abs=1e-3)


def test_a_stop_by_the_torque_limit_brakes_with_it() -> None:
    axis = Axis()
    axis.write(0x605A, 3)
    axis.write(0x6072, 500, "<H")
    axis.run(1000, mm_per_s=200.0)
    where = axis.mm
    axis.run(500, 0x02)
    rate = 0.5 * 15.0 / 3.3e-3 * PITCH_MM / math.tau
    assert axis.mm - where == pytest.approx(200.0**2 / 2 / rate, rel=0.15)


def test_halt_follows_its_ramp_and_the_way_goes_on_from_there() -> None:
    axis = Axis()
    axis.write(0x6084, per_turn(2000.0), "<I")
    axis.run(1000, mm_per_s=200.0)
    where = axis.mm
    axis.run(500, 0x10F)
    assert axis.drive.state is State.OPERATION_ENABLED
    assert axis.mm - where == pytest.approx(200.0**2 / 2 / 2000.0, rel=0.1)
    assert not axis.drive.statusword & 0x1000, "it does not follow the target"
    axis.target_mm = axis.mm + 1.0
    axis.run(500)
    assert axis.drive.statusword & 0x1000
    assert axis.mm == pytest.approx(axis.target_mm, abs=1e-3)


@pytest.mark.parametrize(
    ("option", "state"),
    [
        (1, State.SWITCH_ON_DISABLED),
        (2, State.SWITCH_ON_DISABLED),
        (3, State.SWITCH_ON_DISABLED),
        (5, State.OPERATION_ENABLED),
        (6, State.OPERATION_ENABLED),
        (7, State.OPERATION_ENABLED),
    ],
)
def test_operation_is_resumed_in_a_quick_stop_only_where_the_drive_stays_in_it(
    option: int, state: State
) -> None:
    axis = Axis()
    axis.write(0x605A, option)
    axis.run(300, mm_per_s=200.0)
    axis.step(0x02)
    assert axis.drive.state is State.QUICK_STOP_ACTIVE
    moving = axis.step(0x0F)
    assert moving is (State.OPERATION_ENABLED if option >= 5 else State.QUICK_STOP_ACTIVE)
    axis.target_mm = axis.mm
    axis.run(1500, 0x0F)
    assert axis.drive.state is state


def test_operation_begins_where_the_axis_is() -> None:
    """Enabled without a telegram, as somebody with an SDO client does: the target is the actual position."""
    axis = Axis()
    axis.drive.on_reset()
    assert axis.drive.state is State.SWITCH_ON_DISABLED
    for word in (6, 7, 15):
        axis.write(0x6040, word, "<H")
    assert axis.drive.state is State.OPERATION_ENABLED
    assert axis.drive.device.values.number(0x607A) == round(START_MM / PITCH_MM * TURN)
    for _ in range(500):
        axis._advance(axis.cycle * CYCLE_NS)
        axis.cycle += 1
        axis.drive.on_sync(axis.now)
    assert axis.mm == pytest.approx(START_MM, abs=1e-4)
    axis.write(0x607A, round(301.0 / PITCH_MM * TURN), "<i")
    assert axis.row["target"] == round(301.0 / PITCH_MM * TURN)


def test_an_axis_without_power_coasts_against_its_friction() -> None:
    axis = Axis(viscous_nm_s=0.0, coulomb_nm=1.0, static_nm=1.2)
    axis.run(1000, mm_per_s=500.0)
    speed, where = axis.speed, axis.mm
    axis.step(0x00)
    assert axis.drive.state is State.SWITCH_ON_DISABLED
    axis.run(100, 0x00)
    assert 0.0 < axis.speed < speed
    axis.run(2000, 0x00)
    rate = 1.0 / 3.3e-3 * PITCH_MM / math.tau
    assert axis.mm - where == pytest.approx(speed**2 / 2 / rate, rel=0.02)
    assert axis.speed == 0.0
    assert axis.row["following_error"] == 0


def test_a_brake_falls_in_without_power() -> None:
    axis = Axis(brake_nm=20.0)
    axis.run(1000, mm_per_s=500.0)
    speed, where = axis.speed, axis.mm
    axis.run(500, 0x00)
    rate = 20.0 / 3.3e-3 * PITCH_MM / math.tau
    assert axis.mm - where == pytest.approx(speed**2 / 2 / rate, rel=0.1, abs=0.6)
    assert axis.speed == 0.0


def test_an_axis_without_power_is_pushed_out_of_a_stop() -> None:
    axis = Axis(stop=Stop(mm=301.0, side="above", stiffness_n_per_um=100.0))
    axis.write(0x6072, 300, "<H")
    axis.target_mm += 2.0
    axis.run(2000)
    assert axis.mm > 301.0
    inside = axis.mm
    axis.run(2000, 0x00)
    assert axis.mm < inside
    assert axis.speed == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("limit", "sign"), [(0x60E0, 1.0), (0x60E1, -1.0)])
def test_each_torque_limit_holds_for_its_direction(limit: int, sign: float) -> None:
    axis = Axis()
    axis.write(limit, 100, "<H")
    for way, expected in ((sign, 100), (-sign, 3000)):
        axis.target_mm = axis.mm + way * 50.0
        torques = []
        for _ in range(20):
            axis.step()
            torques.append(int(axis.row["torque_permille"]) * way)
        assert max(torques) == expected
        axis.target_mm = axis.mm
        axis.drive.fault(0x8611)
        axis.run(1500, 0x00)
        axis.run(3, 0x80)
        axis.target_mm = axis.mm
        axis.power_on()


def test_mode_0_changes_nothing_and_a_drive_without_a_mode_does_not_move() -> None:
    axis = Axis()
    axis.write(0x6060, 0, "<b")
    assert axis.drive.device.values.number(0x6061) == 8
    axis.target_mm += 1.0
    axis.run(500)
    assert axis.mm == pytest.approx(START_MM + 1.0, abs=1e-3)


@pytest.mark.parametrize(
    ("index", "good", "bad"),
    [
        (0x6007, range(4), (-1, 4)),
        (0x605A, (0, 1, 2, 3, 5, 6, 7), (-1, 4, 8, 9)),
        (0x605B, (0, 1), (-1, 2)),
        (0x605C, (0, 1), (-1, 2)),
        (0x605D, (1, 2, 3), (-1, 0, 4)),
        (0x605E, (0, 1, 2, 3), (-1, 4)),
    ],
)
def test_option_codes_that_are_not_built_are_refused(index: int, good: Any, bad: Any) -> None:
    axis = Axis()
    for value in good:
        axis.write(index, value)
    for value in bad:
        with pytest.raises(SdoAbort) as refused:
            axis.write(index, value)
        assert refused.value.code in {AbortCode.RANGE, AbortCode.TOO_HIGH, AbortCode.TOO_LOW}
    assert axis.drive.device.values.number(index) == list(good)[-1]


def test_a_deceleration_of_0_is_refused() -> None:
    for index in (0x6084, 0x6085):
        with pytest.raises(SdoAbort) as refused:
            Axis().write(index, 0, "<I")
        assert refused.value.code == AbortCode.TOO_LOW
