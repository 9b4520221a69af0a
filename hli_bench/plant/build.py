"""The plant's settings become rows: mechanics and drives' loops, switches, signals, terminal channels."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hli_bench.laws.rows import NOISE, MachineRows, Rows
from hli_bench.plant.settings import ABOVE, PROBE, Channel, PlantAxis, PlantSettings, Probe, cam

ZETA: Final = 0.5
"""Damping ratio of the contact at a fixed stop, decided here."""
NOISE_LIMIT: Final = 4.0
"""The spread of the probe is cut at so many sigma."""
PENDING_PER_SWITCH: Final = 16
"""Coming changes (contact bounce) that one switch may have at a time."""
MAIN_AXES: Final = ("X", "Y", "Z")
"""Axes whose faces are the sides of one body; a face of another axis stands alone."""
OPERATION_OFF: Final = 0xFFFFFFFF
"""6065: following error is not watched."""


@dataclass(frozen=True, slots=True)
class SignalNames:
    """Signals by index: `probe` first, then a cam signal an axis."""

    names: tuple[str, ...]

    def index(self, name: str) -> int:
        """Return the index of a signal; an empty name is 'not connected', -1."""
        return self.names.index(name) if name else -1


@dataclass(frozen=True, slots=True)
class Plant:
    """Rows for the laws and what their indices mean. `pending`: instant, signal or -1, change."""

    rows: MachineRows
    signals: SignalNames
    pending: NDArray[np.int64]

    def force(self, signal: str, level: int | None) -> None:
        """Hold a signal at level 0 or 1 whatever its switches do (a stuck probe); None lets it go."""
        self.rows.signal[self.signals.index(signal)]["forced"] = -1 if level is None else level


def signal_names(axes: Sequence[str]) -> tuple[str, ...]:
    """Return the names of all signals of a machine with these axes."""
    return (PROBE, *(cam(axis) for axis in axes))


def build(settings: PlantSettings, channels: Sequence[Channel] = ()) -> Plant:
    """Return the rows of a machine at its start; `channels` are the inputs of all terminals in order."""
    axes = settings.axes
    signals = SignalNames(signal_names([axis.name for axis in axes]))
    switches = sum((axis.face is not None) + (axis.cam is not None) for axis in axes)
    rows = MachineRows.allocate(len(axes), switches, len(signals.names), len(channels))
    for number, axis in enumerate(axes):
        _servo(rows.servo, number, axis, signals)
    _switches(rows.switch, settings)
    rows.signal[0]["needed"] = _sides(settings)
    for number, channel in enumerate(channels):
        row = rows.channel[number]
        row["signal"] = signals.index(channel.signal)
        row["delay_ns"] = channel.delay_ns
        row["skew_ns"] = channel.clock_skew_ns
        row["single_event"] = channel.single_event
    _settle(rows)
    pending = np.full((max(PENDING_PER_SWITCH * switches, 1), 3), -1, np.int64)
    return Plant(rows, signals, pending)


def _servo(rows: Rows, number: int, axis: PlantAxis, signals: SignalNames) -> None:
    """Fill the row of one axis."""
    plant, row = axis.plant, rows[number]
    per_rad = plant.pitch_mm / math.tau
    inertia = plant.inertia_kg_m2 + (0.0 if axis.rotary else plant.mass_kg * (per_rad * 1e-3) ** 2)
    gain = inertia * plant.speed_bandwidth_per_s
    shown = round(axis.start_mm / plant.pitch_mm * plant.increments_per_turn)
    offset = 0 if axis.absolute else -shown
    position = shown + offset
    values: Mapping[str, float] = {
        "kv": plant.kv_per_s,
        "speed_gain": gain,
        "speed_integral_gain": gain / (plant.speed_reset_ms * 1e-3),
        "rated_torque": plant.rated_torque_nm,
        "peak_permille": plant.peak_permille,
        "torque_limit_permille": plant.peak_permille,
        "following_window": OPERATION_OFF,
        "angle": axis.start_mm / per_rad,
        "inertia": inertia,
        "viscous": plant.viscous_nm_s,
        "coulomb": plant.coulomb_nm,
        "static": plant.static_nm,
        "brake": plant.brake_nm,
        "increments_per_rad": plant.increments_per_turn / math.tau,
        "increments_per_turn": plant.increments_per_turn,
        "zero_pulse": plant.zero_pulse_increments % plant.increments_per_turn,
        "encoder_offset": offset,
        "position": position,
        "target": position,
        "demand": position,
        "demand_from": position,
    }
    rows[[*values]][number] = tuple(values.values())
    if axis.stop is not None:
        stiffness = _motor_stiffness(axis, axis.stop.stiffness_n_per_um)
        row["stop_side"] = 1 if axis.stop.side == ABOVE else -1
        row["stop_angle"] = axis.stop.mm / per_rad
        row["stop_stiffness"] = stiffness
        row["stop_damping"] = 2.0 * ZETA * math.sqrt(stiffness * inertia)
    row["probe_signal"] = [signals.index(name) for name in axis.probe_inputs]
    row["input_signal"] = [signals.index(name) for name in axis.inputs]


def _motor_stiffness(axis: PlantAxis, stiffness: float) -> float:
    """Return a stop's stiffness at the motor, Nm/rad.

    Given in N/um; for a rotary axis the number counts as Nm per 0.001 degree (decided here).
    """
    if axis.rotary:
        return stiffness * 1000.0 * math.degrees(1.0) * (axis.plant.pitch_mm / 360.0) ** 2
    return stiffness * 1e6 * (axis.plant.pitch_mm * 1e-3 / math.tau) ** 2


def _switches(rows: Rows, settings: PlantSettings) -> None:
    """Fill the rows of faces and cams."""
    used = 0
    for number, axis in enumerate(settings.axes):
        per_rad = axis.plant.pitch_mm / math.tau
        if axis.face is not None:
            row = rows[used]
            used += 1
            _face(row, axis, settings.probe, _spread(settings.seed, axis.name))
            row["signal"] = 0
            row["axis"] = number
            row["weight"] = 1 if axis.name in MAIN_AXES else _sides(settings)
        if axis.cam is not None:
            row = rows[used]
            used += 1
            row["signal"] = 1 + number
            row["axis"] = number
            row["low"] = axis.cam.from_mm / per_rad
            row["high"] = axis.cam.to_mm / per_rad
            row["hysteresis"] = axis.cam.hysteresis_um * 1e-3 / per_rad


def _sides(settings: PlantSettings) -> int:
    """Return the weight at which the probe is operated: faces of the main axes are the sides of one body."""
    return max(sum(axis.face is not None and axis.name in MAIN_AXES for axis in settings.axes), 1)


def _face(row: Rows, axis: PlantAxis, probe: Probe, spread: NDArray[np.float64]) -> None:
    """Fill the switch of a face: on behind the pretravel, off when the tip is out again.

    With a spread the release keeps four sigma from every trigger point, so that leaving does not chatter.
    """
    assert axis.face is not None
    um = 1e-3 * math.tau / axis.plant.pitch_mm
    into = axis.face.mm * 1e3 * um
    row["hysteresis"] = max(probe.pretravel_um, NOISE_LIMIT * probe.sigma_um) * um
    row["bounce_ns"] = round(probe.bounce_us * 1e3)
    row["noise"] = spread * probe.sigma_um * um
    if axis.face.material == ABOVE:
        row["low"] = into + probe.pretravel_um * um
        row["high"] = math.inf
    else:
        row["low"] = -math.inf
        row["high"] = into - probe.pretravel_um * um


@lru_cache(maxsize=64)
def _spread(seed: int, axis: str) -> NDArray[np.float64]:
    """Return the trigger offsets of an axis' probe contact in sigma, drawn by the bench's seed and the node's name."""
    generator = np.random.default_rng([seed, *f"probe.{axis}".encode()])
    spread = np.clip(generator.standard_normal(NOISE), -NOISE_LIMIT, NOISE_LIMIT)
    spread.flags.writeable = False
    return spread


def _settle(rows: MachineRows) -> None:
    """Set switches, signals and inputs to what the axes' start positions give."""
    for row in rows.switch:
        shift = row["noise"][row["noise_index"]]
        angle = rows.servo[row["axis"]]["angle"]
        row["state"] = row["low"] + shift <= angle <= row["high"] - shift
        rows.signal[row["signal"]]["operated"] += row["state"] * row["weight"]
    rows.signal["level"] = rows.signal["operated"] >= rows.signal["needed"]
    for channel in rows.channel:
        if channel["signal"] >= 0:
            level = rows.signal[channel["signal"]]["level"]
            channel["level"] = channel["level_next"] = channel["input"] = level
    levels = rows.signal["level"].tolist()
    for servo, inputs in zip(rows.servo, rows.servo["input_signal"].tolist(), strict=True):
        servo["digital_inputs"] = sum(
            1 << bit for bit, signal in enumerate(inputs) if signal >= 0 and levels[signal]
        )
