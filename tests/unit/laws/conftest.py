"""A machine without kernel: targets go straight into the servo rows, cycle by cycle."""

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from hli_bench.laws.machine import advance_machine
from hli_bench.laws.native import bind
from hli_bench.plant.build import Plant, build
from hli_bench.plant.settings import AxisPlant, PlantAxis, PlantSettings, Probe
from hli_bench.terminals.settings import Channel

EPOCH_NS = 820_540_800_000_000_000
CYCLE_NS = 1_000_000
TURN = 1_048_576
PITCH_MM = 10.0
PLAIN = {
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


IDEAL = Probe()


class Rig:
    """One or more axes under law control; positions in mm, times in ns since start."""

    def __init__(
        self,
        axes: Sequence[PlantAxis],
        channels: Sequence[Channel] = (),
        probe: Probe = IDEAL,
        cycle_ns: int = CYCLE_NS,
        seed: int = 0,
    ) -> None:
        self.plant: Plant = build(PlantSettings(axes=axes, probe=probe, seed=seed), channels)
        self.rows = self.plant.rows
        self.cycle_ns = cycle_ns
        self.cycle = 0
        self.faults = 0
        self.rows.servo["enabled"] = 1
        r = self.rows
        self._advance = bind(
            advance_machine,
            r.servo,
            r.switch,
            r.signal,
            r.channel,
            r.edge,
            r.edges,
            self.plant.pending,
            cycle_ns,
            cycle_ns // 125_000,
            EPOCH_NS,
        )

    @property
    def now_ns(self) -> int:
        return self.cycle * self.cycle_ns

    def step(self) -> None:
        self.faults += self._advance(self.now_ns)
        self.cycle += 1

    def wait(self, cycles: int) -> None:
        for _ in range(cycles):
            self.step()

    def move(self, mm_per_s: float, cycles: int, axis: int = 0) -> None:
        """Command a constant velocity for some cycles."""
        servo = self.rows.servo
        start = int(servo[axis]["target"])
        for k in range(1, cycles + 1):
            servo[axis]["target"] = start + round(mm_per_s * k * self.cycle_ns * 1e-9 / PITCH_MM * TURN)
            self.step()

    def mm(self, axis: int = 0) -> float:
        return float(self.rows.servo[axis]["angle"]) * PITCH_MM / 6.283185307179586

    def edges(self) -> list[tuple[int, int, int]]:
        """Return (instant, signal, level) of everything reported so far."""
        count = int(self.rows.edges[0])
        return [(int(e["at_ns"]), int(e["signal"]), int(e["level"])) for e in self.rows.edge[:count]]


@pytest.fixture
def axis() -> Callable[..., PlantAxis]:
    """Make a linear axis; plant values by name, the rest as PlantAxis."""

    def make(name: str = "Z", **given: Any) -> PlantAxis:
        values = {key: given.pop(key, value) for key, value in PLAIN.items()}
        plant = AxisPlant(**values)
        return PlantAxis(
            **{"name": name, "rotary": False, "absolute": True, "start_mm": 0.0, "plant": plant, **given}
        )

    return make


@pytest.fixture
def rig() -> type[Rig]:
    return Rig
