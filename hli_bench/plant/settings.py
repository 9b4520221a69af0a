"""What the machine folder says about the plant: mm (degrees for rotary axes), torques motor side."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

PROBE: Final = "probe"
"""The one signal that every workpiece face feeds."""
ABOVE: Final = "above"
BELOW: Final = "below"


def cam(axis: str) -> str:
    """Return the name of the signal of an axis' reference cam switch."""
    return f"cam.{axis}"


class Channel(Protocol):
    """What a terminal tells about one of its inputs: its signal (empty: none), delay, clock and latch mode."""

    @property
    def signal(self) -> str:
        """Name of the signal, or empty."""

    @property
    def delay_ns(self) -> int:
        """Input delay."""

    @property
    def clock_skew_ns(self) -> int:
        """How far the clock of its latches is ahead of DC time."""

    @property
    def single_event(self) -> bool:
        """Whether the latches keep the first edge until they are read."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """A workpiece face across an axis; `material` is the solid side (above or below)."""

    mm: float
    material: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """A mechanical fixed stop; `side` is the solid side."""

    mm: float
    side: str
    stiffness_n_per_um: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Cam:
    """Where a reference cam switch is operated, and how far beyond it is released."""

    from_mm: float
    to_mm: float
    hysteresis_um: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """The touch probe: way into the material until it switches, bounce, spread of the trigger point."""

    pretravel_um: float = 0.0
    bounce_us: float = 0.0
    sigma_um: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisPlant:
    """Drive train, motor, encoder and loops of one axis."""

    inertia_kg_m2: float
    mass_kg: float
    """Moved mass, added to the inertia over the pitch (linear axes)."""
    pitch_mm: float
    viscous_nm_s: float
    coulomb_nm: float
    static_nm: float
    rated_torque_nm: float
    peak_permille: float
    increments_per_turn: int
    zero_pulse_increments: int
    """Count of the zero pulse within a turn, from machine position 0."""
    kv_per_s: float
    speed_bandwidth_per_s: float
    speed_reset_ms: float
    brake_nm: float = 0.0
    """Of a brake that falls in when the drive has no power; 0: there is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlantAxis:
    """One axis of the plant. `absolute`: the encoder shows the machine position, else 0 at power-on."""

    name: str
    rotary: bool
    absolute: bool
    start_mm: float
    plant: AxisPlant
    face: Face | None = None
    stop: Stop | None = None
    cam: Cam | None = None
    probe_inputs: tuple[str, ...] = ("", "")
    inputs: tuple[str, ...] = ("",) * 8
    """Signals at bits 0..7 of the drive's digital inputs (60FD)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlantSettings:
    """The whole plant; `seed` is the seed of everything random."""

    axes: Sequence[PlantAxis]
    probe: Probe = Probe()
    seed: int = 0
