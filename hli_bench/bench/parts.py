"""The parts of a machine beside its axes: plant, terminals, PLC tasks, faults, each a record made of values."""

from collections.abc import Sequence
from dataclasses import fields
from itertools import count, takewhile
from pathlib import Path
from typing import Any, Final, cast

from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file
from hli_bench.base.paths import is_file
from hli_bench.base.time import NS_PER_MS, Ns
from hli_bench.bench.config import AxisConfig, FaultConfig, PlcConfig
from hli_bench.bench.schema import BITS
from hli_bench.bench.sources import Given
from hli_bench.bench.values import Values
from hli_bench.plant.settings import PROBE, AxisPlant, Cam, Face, PlantAxis, PlantSettings, Probe, Stop
from hli_bench.terminals.settings import TerminalSettings
from hli_bench.terminals.terminal import type_of

LINEAR_PITCH_MM: Final = 10.0
ROTARY_PITCH_DEG: Final = 36.0
BUILT_FAULTS: Final = frozenset({"probe_stuck"})


def plant_of(values: Values, axes: Sequence[AxisConfig]) -> PlantSettings:
    """Return what the axes move and meet."""
    kept = values.untouched("plant.probe.")
    probe = kept.plant.probe if kept else _probe(values)
    plant = tuple(_plant_axis(values, axis) for axis in axes)
    return PlantSettings(axes=plant, probe=probe, seed=values.value("seed"))


def _probe(values: Values) -> Probe:
    return Probe(**{item.name: values.value(f"plant.probe.{item.name}") for item in fields(Probe)})


def _plant_axis(values: Values, axis: AxisConfig) -> PlantAxis:
    name = axis.name
    kept = values.untouched(
        f"axis.{name}.", *(f"plant.{part}.{name}." for part in ("probe", "stop", "cam", "axis"))
    )
    if kept:
        return kept.plant.axes[axis.index]
    face = _together(values, f"plant.probe.{name}", "face_mm", "material")
    stop = _together(values, f"plant.stop.{name}", "at_mm", "side")
    cam = _together(values, f"plant.cam.{name}", "from_mm", "to_mm")
    if cam and cam[0] >= cam[1]:
        given = values.given[f"plant.cam.{name}.to_mm"]
        values.fail(given, f"plant.cam.{name}.to_mm: {cam[1]} is not above from_mm = {cam[0]}")
    stiffness = values.value(f"plant.stop.{name}.stiffness_n_per_um")
    hysteresis = values.value(f"plant.cam.{name}.hysteresis_um")
    return PlantAxis(
        name=name,
        rotary=axis.kind != "T",
        absolute=axis.params.kenngr.abs_pos_gueltig,
        start_mm=axis.start_mm,
        plant=_drive_train(values, name, rotary=axis.kind != "T"),
        face=Face(mm=face[0], material=face[1]) if face else None,
        stop=Stop(mm=stop[0], side=stop[1], stiffness_n_per_um=stiffness) if stop else None,
        cam=Cam(from_mm=cam[0], to_mm=cam[1], hysteresis_um=hysteresis) if cam else None,
        probe_inputs=tuple(values.value(f"axis.{name}.probe_input_{n}") for n in (1, 2)),
        inputs=tuple(values.value(f"axis.{name}.input.{bit}") for bit in BITS),
    )


def _together(values: Values, table: str, first: str, second: str) -> tuple[Any, Any] | None:
    """Return two values that only make sense together, or None when neither is given."""
    here = [values.checked.get(f"{table}.{key}") for key in (first, second)]
    if None not in here:
        return here[0], here[1]
    for key, other in ((first, second), (second, first)):
        if f"{table}.{key}" in values.checked:
            values.fail(values.given[f"{table}.{key}"], f"{table}.{key}: needs {table}.{other} as well")
    return None


def _drive_train(values: Values, name: str, *, rotary: bool) -> AxisPlant:
    table = f"plant.axis.{name}."
    pitch = values.value(table + "pitch_mm")
    pitch = (ROTARY_PITCH_DEG if rotary else LINEAR_PITCH_MM) if pitch is None else pitch
    turn = values.value(table + "increments_per_turn")
    zero = values.value(table + "zero_pulse_offset_increments")
    if zero is None:
        zero = _zero_pulse(values, table + "zero_pulse_offset_mm", turn / pitch)
    computed: dict[str, Any] = {
        "pitch_mm": pitch,
        "zero_pulse_increments": zero,
        "increments_per_turn": turn,
    }
    rest = {
        item.name: values.value(table + item.name) for item in fields(AxisPlant) if item.name not in computed
    }
    return AxisPlant(**rest, **computed)


def _zero_pulse(values: Values, path: str, increments_per_mm: float) -> int:
    """Return the place of the zero pulse in increments; one that no encoder of 32 bits counts to is refused."""
    zero: int = round(values.value(path) * increments_per_mm)
    if abs(zero) >= 2**31:
        limit = 2**31 / increments_per_mm
        message = f"{path}: {values.value(path)} is beyond the encoder's +-{limit:g}"
        values.fail(values.given.get(path), message)
        return 0
    return zero


def terminals_of(values: Values) -> tuple[TerminalSettings, ...]:
    """Return the terminals."""
    if kept := values.untouched("terminal.", "cycle_us"):
        return kept.terminals
    prefix = "terminal."
    names = dict.fromkeys(path.split(".")[1] for path in values.checked if path.startswith(prefix))
    return tuple(one for name in names if (one := _terminal(values, name)) is not None)


def _terminal(values: Values, name: str) -> TerminalSettings | None:
    table = f"terminal.{name}."
    wiring = {
        path.removeprefix(table + "wiring."): cast("str", signal)
        for path, signal in values.checked.items()
        if path.startswith(table + "wiring.")
    }
    place = next(given for path, given in values.given.items() if path.startswith(table))
    cycle_us = values.value("cycle_us")
    period_us = values.value(table + "period_us")
    settings = TerminalSettings(
        name=name,
        model=values.value(table + "model") or "",
        period_us=cycle_us if period_us is None else period_us,
        wiring=wiring,
        mode=values.value(table + "mode"),
        delay_ns=values.value(table + "delay_ns"),
        clock_skew_ns=values.value(table + "clock_skew_ns"),
    )
    _check_period(values, table + "period_us", settings.period_us)
    try:
        type_of(settings).channels(settings)
    except InputError as error:
        key = error.message.partition(":")[0]
        values.fail(values.given.get(key, place), error.message)
        return None
    return settings


def plcs_of(values: Values) -> tuple[PlcConfig, ...]:
    """Return the PLC tasks."""
    plcs: list[PlcConfig] = []
    for table in _numbered(values, "plc"):
        script = values.value(f"{table}.script")
        if script is None:
            values.fail(_entry(values, table), f"{table}.script: is missing")
            continue
        path = _script(values, table, script)
        period_us = values.value(f"{table}.period_us")
        if period_us is not None:
            _check_period(values, f"{table}.period_us", period_us)
        name = values.value(f"{table}.name") or path.stem
        if name in [plc.name for plc in plcs]:
            values.fail(_entry(values, table), f"{table}.name: {name!r} is already that of another task")
        process = values.value(f"{table}.process")
        plcs.append(PlcConfig(name=name, script=path, period_us=period_us, process=process))
    return tuple(plcs)


def _script(values: Values, table: str, script: str) -> Path:
    """Return the file of a PLC script: of the machine folder, among those supplied, or a path."""
    for candidate in (values.folder / script, Path(script)):
        if is_file(candidate):
            return candidate
    try:
        return data_file("plc_scripts", script)
    except InputError:
        message = f"{table}.script: {script!r} is neither in {values.folder} nor in plc_scripts/ nor a file"
        values.fail(values.given[f"{table}.script"], message)
        return Path(script)


def faults_of(values: Values) -> tuple[FaultConfig, ...]:
    """Return the scheduled faults."""
    if kept := values.untouched("fault["):
        return kept.faults
    faults = []
    for table in _numbered(values, "fault"):
        kind = values.value(f"{table}.kind")
        if kind is None:
            values.fail(_entry(values, table), f"{table}.kind: is missing")
            continue
        if values.value(f"{table}.when"):
            values.refuse(values.given[f"{table}.when"], f"{table}.when: faults at a condition")
        if kind not in BUILT_FAULTS:
            values.refuse(values.given[f"{table}.kind"], f"{table}.kind: fault {kind}")
        value = values.value(f"{table}.value")
        if kind == "probe_stuck" and value not in (0.0, 1.0):
            given = values.given[f"{table}.value"]
            values.fail(given, f"{table}.value: {value:g} is no level of a stuck probe, 0 or 1 expected")
        at_ns = Ns(round(values.value(f"{table}.at_ms") * NS_PER_MS))
        for_ms = values.value(f"{table}.for_ms")
        faults.append(
            FaultConfig(
                kind=kind,
                target=values.value(f"{table}.target") or (PROBE if kind == "probe_stuck" else ""),
                at_ns=at_ns,
                until_ns=None if for_ms is None else Ns(at_ns + round(for_ms * NS_PER_MS)),
                value=value,
            )
        )
    return tuple(faults)


def _check_period(values: Values, path: str, period_us: int) -> None:
    cycle_us = values.value("cycle_us")
    if period_us % cycle_us:
        values.fail(values.given.get(path), f"{path}: {period_us} is not a multiple of cycle_us = {cycle_us}")


def _numbered(values: Values, table: str) -> list[str]:
    """Return the elements `plc[0]`, `plc[1]` ... in order; none may be missing."""
    found = {path.partition("]")[0] + "]" for path in values.checked if path.startswith(f"{table}[")}
    names = list(takewhile(found.__contains__, (f"{table}[{number}]" for number in count())))
    beyond = found.difference(names)
    if beyond:
        _beyond(values, table, len(names), beyond)
    return names


def _beyond(values: Values, table: str, count: int, beyond: set[str]) -> None:
    """Refuse entries whose number leaves a gap."""
    entries = f"1 {table} entry" if count == 1 else f"{count} {table} entries"
    there = f"the machine has {entries}, so {table}[{count}] is the highest, a new one"
    for path, given in values.given.items():
        name = path.partition("]")[0] + "]"
        if name in beyond:
            values.fail(given, f"{path} = {given.value!r}: there is no {name}; {there}")


def _entry(values: Values, name: str) -> Given:
    """Return the first value that was given for an entry."""
    return next(given for path, given in values.given.items() if path.startswith(f"{name}."))
