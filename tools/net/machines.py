"""Random machines: one of those supplied, with settings that change what it does."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

FACE_MM: Final = 40.0
STOP_MM: Final = 75.0
SOURCES: Final = ("PLC", "PLC_TIMESTAMP", "DRIVE", "FIXED_STOP")
LINEAR: Final = ("X", "Y", "Z")
FOLDERS: Final = {
    "demo": "demo",
    "three": "benchmarks/machines/three_axes",
    "eight": "benchmarks/machines/eight_axes",
}
AXES: Final = {
    "demo": ("X", "Y", "Z", "X2", "A", "B"),
    "three": LINEAR,
    "eight": ("X", "Y", "Z", "X2", "A", "B", "Y2"),
}

Random = np.random.Generator
Settings = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine folder, its settings, the axes a program may name, and where they start."""

    folder: str
    settings: Mapping[str, Any]
    axes: tuple[str, ...]
    starts: Mapping[str, float]

    @property
    def cycle_us(self) -> int:
        """Cycle of the kernel."""
        return int(self.settings.get("cycle_us", 1000))


def chance(random: Random, share: float) -> bool:
    """Return TRUE in that share of all calls."""
    return bool(random.random() < share)


def pick(random: Random, *choices: Any) -> Any:
    """Return one of the choices, as the plain Python value it is."""
    return choices[int(random.integers(len(choices)))]


def random_machine(random: Random) -> Machine:
    """Return a machine with random settings."""
    kind = pick(random, "demo", "demo", "demo", "three", "eight")
    starts = {"X": pick(random, 0.0, -20.0, 30.0), "Y": pick(random, 0.0, 12.5), "Z": 60.0}
    settings: Settings = {f"axis.{axis}.start_mm": start for axis, start in starts.items()}
    settings |= {"plant.probe.Z.face_mm": FACE_MM, "plant.probe.Z.material": "below"}
    if "A" in AXES[kind]:
        # without it a rotary axis looks for a cam that never comes for ever, as the parameter says
        settings["axis.A.kenngr.homing_max_movement_dist"] = 4_000_000
    for row in (_cycle, _probe, _sources, _homing, _stop, _limits, _channel, _dynamics, _faults):
        row(random, settings)
    return Machine(FOLDERS[kind], settings, AXES[kind], starts)


def _cycle(random: Random, settings: Settings) -> None:
    if chance(random, 0.3):
        settings["cycle_us"] = pick(random, 500, 500, 2000, 4000)


def _probe(random: Random, settings: Settings) -> None:
    for name, value in (("pretravel_um", 30.0), ("bounce_us", 1500.0), ("sigma_um", 0.7)):
        if chance(random, 0.15):
            settings[f"plant.probe.{name}"] = value
    if chance(random, 0.1):
        settings["terminal.probe.delay_ns"] = pick(random, 0, 500_000)


def _sources(random: Random, settings: Settings) -> None:
    for axis in LINEAR:
        if chance(random, 0.4):
            settings[f"axis.{axis}.kenngr.measure.signal"] = pick(random, *SOURCES)
    if chance(random, 0.1):
        settings["axis.Z.kenngr.measure.edge"] = "NEG"


def _homing(random: Random, settings: Settings) -> None:
    for axis in ("X", "Y"):
        settings |= {
            f"axis.{axis}.kenngr.abs_pos_gueltig": int(chance(random, 0.5)),
            f"axis.{axis}.getriebe[0].vb_refmax": pick(random, 83_333, 150_000),
            f"axis.{axis}.getriebe[0].vb_reflow": pick(random, 5_000, 20_000),
            f"axis.{axis}.getriebe[0].pos_refpkt": -550_000,
            f"plant.cam.{axis}.from_mm": -90.0,
            f"plant.cam.{axis}.to_mm": -50.0,
            f"plant.axis.{axis}.zero_pulse_offset_mm": 5.0,
        }
        for name in ("homing_without_zero_pulse", "fast_from_cam"):
            if chance(random, 0.2):
                settings[f"axis.{axis}.kenngr.{name}"] = 1
        if chance(random, 0.2):
            settings[f"axis.{axis}.antr.reference_cam_signal"] = "STATUS_DIG_INPUTS"
            settings[f"axis.{axis}.input.home"] = f"cam.{axis}"
        if chance(random, 0.1):
            settings[f"axis.{axis}.kenngr.homing.homing_type"] = "DISABLED"
        if chance(random, 0.3):
            settings[f"axis.{axis}.kenngr.swe_neg"] = -560_000
        if chance(random, 0.1):
            settings[f"plant.cam.{axis}.to_mm"] = -89.0


def _stop(random: Random, settings: Settings) -> None:
    if chance(random, 0.4):
        settings |= {"plant.stop.Z.at_mm": STOP_MM, "plant.stop.Z.side": "above"}
        if chance(random, 0.3):
            settings["plant.stop.Z.stiffness_n_per_um"] = pick(random, 5.0, 400.0)


def _limits(random: Random, settings: Settings) -> None:
    if chance(random, 0.4):
        settings[f"axis.{pick(random, *LINEAR)}.kenngr.swe_pos"] = 700_000
    if chance(random, 0.1):
        settings["axis.X.kenngr.prog_move_requires_homing"] = 1


def _channel(random: Random, settings: Settings) -> None:
    for name in ("meas_error_no_signal", "meas_use_std_dynamic", "meas_fixed_stop_no_error"):
        if chance(random, 0.2):
            settings[f"channel.{name}"] = 1
    if chance(random, 0.2):
        settings["channel.messtyp"] = pick(random, 2, 3, 4, 7)


def _dynamics(random: Random, settings: Settings) -> None:
    if chance(random, 0.3):
        axis = pick(random, *LINEAR)
        settings[f"axis.{axis}.getriebe[0].lslope_profil.a_stufe_1"] = pick(random, 200, 3000)
    if chance(random, 0.1):
        settings["axis.Y.getriebe[0].slep_max"] = 3000


def _faults(random: Random, settings: Settings) -> None:
    """A row for each kind of fault that is scheduled; those that are not built are refused at the start."""
    if chance(random, 0.1):
        settings |= {
            "fault.0.kind": "probe_stuck",
            "fault.0.value": pick(random, 0, 1),
            "fault.0.at_ms": float(random.integers(0, 3000)),
        }
        if chance(random, 0.5):
            settings["fault.0.for_ms"] = float(random.integers(1, 500))
