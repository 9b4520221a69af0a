"""The machine folder as frozen records: machine.toml, list files and overrides, checked key by key."""

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from datetime import date
from functools import lru_cache
from itertools import count, takewhile
from pathlib import Path
from typing import Any, Final, TypeVar, cast

from hli_bench.base.errors import BenchError, InputError, NotEmulated
from hli_bench.base.ids import AxisIndex, AxisNumber, NodeId
from hli_bench.base.loading import data_file
from hli_bench.base.time import NS_PER_MS, Ns, dc_ns
from hli_bench.bench.config import AxisConfig, FaultConfig, MachineConfig, PlcConfig
from hli_bench.bench.parameters import built, listed
from hli_bench.bench.schema import BITS, KEYS, Key, Plain, pattern
from hli_bench.bench.sources import Given, override, toml_text, toml_values
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.lists import Finding, Severity, converted
from hli_bench.manual.sheet import Value
from hli_bench.plant.build import signal_names
from hli_bench.plant.settings import PROBE, AxisPlant, Cam, Face, PlantAxis, PlantSettings, Probe, Stop
from hli_bench.shells.texts import text_of
from hli_bench.terminals.settings import TerminalSettings
from hli_bench.terminals.terminal import type_of

MACHINE_FILE: Final = "machine.toml"
LINEAR_PITCH_MM: Final = 10.0
ROTARY_PITCH_DEG: Final = 36.0
BUILT_FAULTS: Final = frozenset({"probe_stuck"})
PATTERNS: Final = tuple((pattern(key), key) for key in KEYS)
P = TypeVar("P")


def machine_folder(machine: str | Path) -> Path:
    """Return the folder of a machine given by name or path. Raises InputError when there is none."""
    folder = Path(machine)
    if (folder / MACHINE_FILE).is_file():
        return folder
    nothing_there = InputError(f"no {MACHINE_FILE} there", file=str(folder))
    if isinstance(machine, Path) or len(folder.parts) != 1:
        raise nothing_there
    try:
        shipped = data_file("machines", machine)
    except InputError:
        if folder.is_dir():
            raise nothing_there from None
        raise
    if not (shipped / MACHINE_FILE).is_file():
        raise nothing_there
    return shipped


def load(
    machine: str | Path, overrides: Mapping[str, object] | None = None, *, with_plcs: bool = True
) -> MachineConfig:
    """Return the machine of that name or folder with dotted-key overrides on top, its PLC tasks only `with_plcs`.

    Raises InputError naming file (or --set), line, key, value and what is permitted, with everything that is
    wrong in one text; NotEmulated for parameter values and faults that are not built.
    """
    folder = machine_folder(machine)
    file = folder / MACHINE_FILE
    text = toml_text(file)
    given = toml_values(text, str(file))
    texts = tuple(map(_list_text, _list_files(folder, text)))
    loader = _Loader(folder, given, override(given, overrides or {}), with_plcs=with_plcs)
    plain = _plain(folder, text, texts)
    if plain is not None:
        loader.begin_with(plain)
    return loader.load()


@lru_cache(maxsize=16)
def _plain(folder: Path, text: str, texts: tuple[str | None, ...]) -> "_Loader | None":
    """Return the loader of a folder without overrides, once a process for the same texts of its files.

    None when anything is to be said of it: then each load has to find it anew.
    """
    given = toml_values(text, str(folder / MACHINE_FILE))
    loader = _Loader(folder, given, given, dict(zip(_list_files(folder, text), texts, strict=True)))
    try:
        loader.load()
    except BenchError:
        return None
    return None if loader.notes else loader


@lru_cache(maxsize=16)
def _list_files(folder: Path, text: str) -> tuple[Path, ...]:
    """Return the list files that a machine.toml names."""
    given = toml_values(text, str(folder / MACHINE_FILE))
    return tuple(folder / str(one.value) for path, one in given.items() if path.endswith(".list"))


def _list_text(path: Path) -> str | None:
    """Return the text of a list file, None when it cannot be read."""
    try:
        return text_of(path)
    except (OSError, UnicodeDecodeError):
        return None


@dataclass(slots=True)
class _Loader:
    """Turns given values into records and collects what is wrong with them.

    Of a loader that it began with it keeps what none of the `changed` values touches.
    """

    folder: Path
    file: Mapping[str, Given]
    """What machine.toml gives."""
    given: Mapping[str, Given]
    """The same with overrides on top."""
    texts: Mapping[Path, str | None] = field(default_factory=dict)
    """Texts of list files that have been read already."""
    with_plcs: bool = True
    """The machine's own PLC tasks are wanted."""
    base: MachineConfig | None = None
    changed: Sequence[str] = ()
    """Paths whose values differ from those of `base`."""
    accepted: Mapping[str, Plain] = field(default_factory=dict)
    """Values of the other paths, which have been checked."""
    machine: MachineConfig | None = None
    errors: list[InputError] = field(default_factory=list)
    notes: list[Finding] = field(default_factory=list)
    values: dict[str, Plain] = field(default_factory=dict)
    lists: dict[str, dict[str, Given]] = field(default_factory=dict)
    """List parameters that stand in machine.toml or an override, by owner (`channel`, `axis.Z`)."""
    places: dict[str, Mapping[str, Given]] = field(default_factory=dict)
    """Where the list parameters of each owner stand."""
    refused: list[str] = field(default_factory=list)
    """Parameter values that the bench cannot emulate."""

    def begin_with(self, plain: "_Loader") -> None:
        """Take over what the loader of the same folder without overrides has found."""
        self.texts = plain.texts
        self.places = dict(plain.places)
        self.base = plain.machine
        differ = [path for path, given in self.given.items() if plain.given.get(path) is not given]
        self.changed = [*differ, *(path for path in plain.given if path not in self.given)]
        gone = set(self.changed)
        self.accepted = {path: value for path, value in plain.values.items() if path not in gone}

    def load(self) -> MachineConfig:
        """Return the machine. Raises InputError for everything that is wrong, NotEmulated."""
        self.machine = self._config()
        self._finish()
        assert self.machine is not None
        faults = [f"fault {fault.kind}" for fault in self.machine.faults if fault.kind not in BUILT_FAULTS]
        not_built = [*self.refused, *faults]
        if not_built:
            raise NotEmulated("; ".join(not_built))
        return self.machine

    def _untouched(self, *below: str) -> MachineConfig | None:
        """Return the base if none of the values below these paths differs from it."""
        return None if any(path.startswith(below) for path in self.changed) else self.base

    def _config(self) -> MachineConfig | None:
        """Return the machine, or None when something is wrong."""
        base = self.base
        names = self._axis_names() if base is None else [axis.name for axis in base.axes]
        for path, given in self.given.items():
            if path in self.accepted:
                self.values[path] = self.accepted[path]
            else:
                self._take(path, given, names)
        kept = self._untouched("channel.")
        channel = kept.channel if kept else self._tree(ChannelParams, "channel")
        params = [self._params(number, name) for number, name in enumerate(names)]
        if self.errors:
            return None
        axes = tuple(self._axis(number, name, params[number]) for number, name in enumerate(names))
        plant = self._plant(axes)
        config = MachineConfig(
            name=self.folder.resolve().name,
            folder=self.folder,
            cycle_us=self._value("cycle_us"),
            dc_epoch_ns=dc_ns(self._value("dc_epoch")),
            seed=self._value("seed"),
            channel=channel,
            axes=axes,
            plant=plant,
            terminals=kept.terminals
            if (kept := self._untouched("terminal.", "cycle_us"))
            else self._terminals(),
            plcs=self._plcs() if self.with_plcs else (),
            faults=kept.faults if (kept := self._untouched("fault[")) else self._faults(),
            notes=tuple(self.notes),
        )
        if not self._untouched("axis.", "plant.axis."):
            self._check_axes(axes, plant)
        if not self._untouched("axis.", "terminal.", "fault["):
            self._check_signals(names)
        return config

    def _finish(self) -> None:
        """Raise one InputError for everything that was wrong."""
        if len(self.errors) == 1:
            raise self.errors[0]
        if self.errors:
            raise InputError("\n".join(str(error) for error in self.errors))

    # -- taking values ------------------------------------------------------------------------------------

    def _axis_names(self) -> list[str]:
        """Return the axes in the order of the file; an override cannot add one."""
        names: dict[str, None] = {}
        for path in self.file:
            if path.startswith("axis.") and path.count(".") >= 2:
                names[path.split(".")[1]] = None
        if not names:
            raise InputError("no axis: expected a table [axis.<NAME>]", file=str(self.folder / MACHINE_FILE))
        return list(names)

    def _take(self, path: str, given: Given, axes: Sequence[str]) -> None:
        """Check one value and keep it under its path."""
        found = _key(path)
        if found is not None:
            if self._names_hold(found[1], axes, path, given):
                self._keep(path, found[0], given)
            return
        owner, rest = _list_path(path)
        if owner == "channel" or (owner and owner.removeprefix("axis.") in axes):
            self.lists.setdefault(owner, {})[rest] = given
        elif owner:
            self._unknown_axis(path, owner.removeprefix("axis."), axes, given)
        else:
            self._fail(
                given, f"{path}: unknown key{_hint(path, axes)}; `hli-bench machine schema` lists them"
            )

    def _names_hold(self, names: Mapping[str, str], axes: Sequence[str], path: str, given: Given) -> bool:
        """Check the names within a path: axes, bits."""
        if names.get("AXIS", axes[0]) not in axes:
            self._unknown_axis(path, names["AXIS"], axes, given)
            return False
        if names.get("BIT", BITS[0]) not in BITS:
            self._fail(given, f"{path}: {names['BIT']!r} is not one of {', '.join(BITS)}")
            return False
        return True

    def _unknown_axis(self, path: str, name: str, axes: Sequence[str], given: Given) -> None:
        self._fail(given, f"{path}: {name!r} is not an axis of this machine ({', '.join(axes)})")

    def _keep(self, path: str, key: Key, given: Given) -> None:
        try:
            self.values[path] = key.accept(given.value)
        except (ValueError, OverflowError):
            value = str(given.value) if isinstance(given.value, date) else repr(given.value)
            self._fail(given, f"{path}: {value} is not valid, expected {key.expected()}")

    def _fail(self, given: Given | None, message: str) -> None:
        self.errors.append(given.error(message) if given else InputError(message, str(self._file())))

    def _file(self) -> Path:
        return self.folder / MACHINE_FILE

    def _value(self, path: str) -> Any:
        """Return a value, in the type of its key, or the default of its key."""
        if path in self.values:
            return self.values[path]
        found = _key(path)
        assert found is not None
        return found[0].default

    # -- list files ---------------------------------------------------------------------------------------

    def _tree(self, cls: type[P], owner: str) -> P:
        """Return the parameters of the channel or an axis: list file, then machine.toml, then overrides."""
        name = self._value(f"{owner}.list")
        text = self._list_file(owner, name) if name else ""
        found = listed(cast("Any", cls), text, str(self.folder / name))
        for finding in found.findings:
            self._found(finding.as_error(), finding.severity)
        places = dict(found.places)
        changes: dict[str, Value] = {}
        for path, given in self.lists.get(owner, {}).items():
            try:
                taken = converted(cls, {path: given.value})
            except InputError as error:
                self._fail(given, f"{owner}.{error.message}")
                continue
            changes.update(taken)
            places.update(dict.fromkeys(taken, given))
        self.places[owner] = places
        tree = built(cast("Any", cls), tuple((found.values | changes).items()), text, repr(changes))
        for path, finding in tree.findings:
            self._found(places[path].error(finding.message), finding.severity)
        self.refused += [f"{owner}: {text}" for text in tree.refused]
        return cast("P", tree.params)

    def _list_file(self, owner: str, name: str) -> str:
        """Return the text of a list file, of one that cannot be read an empty one."""
        path = self.folder / name
        text = self.texts[path] if path in self.texts else _list_text(path)
        if text is None:
            given = self.given.get(f"{owner}.list")
            self._fail(given, f"{owner}.list: {name!r} is not a readable file of {self.folder}")
        return text or ""

    def _found(self, error: InputError, severity: Severity) -> None:
        """Keep a remark about a list: an error stops, the rest is noted."""
        if severity is Severity.ERROR:
            self.errors.append(error)
        else:
            self.notes.append(Finding(severity, error.message, error.file, error.line, error.column))

    # -- axes and plant -----------------------------------------------------------------------------------

    def _params(self, index: int, name: str) -> AxisParams:
        kept = self._untouched(f"axis.{name}.")
        return kept.axes[index].params if kept else self._tree(AxisParams, f"axis.{name}")

    def _axis(self, index: int, name: str, params: AxisParams) -> AxisConfig:
        kept = self._untouched(f"axis.{name}.")
        if kept:
            return kept.axes[index]
        node = self._value(f"axis.{name}.node_id")
        return AxisConfig(
            index=AxisIndex(index),
            name=name,
            number=AxisNumber(params.kopf.achs_nr),
            node_id=NodeId(params.kopf.achs_nr if node is None else node),
            drive=self._value(f"axis.{name}.drive"),
            following_error=self._value(f"axis.{name}.following_error"),
            start_mm=self._value(f"axis.{name}.start_mm"),
            params=params,
        )

    def _check_axes(self, axes: Sequence[AxisConfig], plant: PlantSettings) -> None:
        """Axis numbers and node ids are unique, start positions fit into 32 bits."""
        for what, path in (("number", "kopf.achs_nr"), ("node_id", "node_id")):
            owners: dict[int, str] = {}
            for axis in axes:
                value = getattr(axis, what)
                if value in owners:
                    message = f"axis.{axis.name}.{path}: {value} is already that of axis {owners[value]}"
                    self._fail(self._place(axis.name, path), message)
                owners.setdefault(value, axis.name)
        for axis, drive_train in zip(axes, (one.plant for one in plant.axes), strict=True):
            limit = 2**31 / drive_train.increments_per_turn * drive_train.pitch_mm
            if abs(axis.start_mm) >= limit:
                message = f"axis.{axis.name}.start_mm: {axis.start_mm} is beyond the encoder's +-{limit:g}"
                self._fail(self.given.get(f"axis.{axis.name}.start_mm"), message)

    def _place(self, axis: str, path: str) -> Given | None:
        return self.places.get(f"axis.{axis}", {}).get(path) or self.given.get(f"axis.{axis}.{path}")

    def _plant(self, axes: Sequence[AxisConfig]) -> PlantSettings:
        kept = self._untouched("plant.probe.")
        probe = kept.plant.probe if kept else self._probe()
        plant = tuple(self._plant_axis(axis) for axis in axes)
        return PlantSettings(axes=plant, probe=probe, seed=self._value("seed"))

    def _probe(self) -> Probe:
        return Probe(**{item.name: self._value(f"plant.probe.{item.name}") for item in fields(Probe)})

    def _plant_axis(self, axis: AxisConfig) -> PlantAxis:
        name = axis.name
        kept = self._untouched(
            f"axis.{name}.", *(f"plant.{part}.{name}." for part in ("probe", "stop", "cam", "axis"))
        )
        if kept:
            return kept.plant.axes[axis.index]
        face = self._together(f"plant.probe.{name}", "face_mm", "material")
        stop = self._together(f"plant.stop.{name}", "at_mm", "side")
        cam = self._together(f"plant.cam.{name}", "from_mm", "to_mm")
        if cam and cam[0] >= cam[1]:
            given = self.given[f"plant.cam.{name}.to_mm"]
            self._fail(given, f"plant.cam.{name}.to_mm: {cam[1]} is not above from_mm = {cam[0]}")
        stiffness = self._value(f"plant.stop.{name}.stiffness_n_per_um")
        hysteresis = self._value(f"plant.cam.{name}.hysteresis_um")
        return PlantAxis(
            name=name,
            rotary=axis.kind != "T",
            absolute=axis.params.kenngr.abs_pos_gueltig,
            start_mm=axis.start_mm,
            plant=self._drive_train(name, rotary=axis.kind != "T"),
            face=Face(mm=face[0], material=face[1]) if face else None,
            stop=Stop(mm=stop[0], side=stop[1], stiffness_n_per_um=stiffness) if stop else None,
            cam=Cam(from_mm=cam[0], to_mm=cam[1], hysteresis_um=hysteresis) if cam else None,
            probe_inputs=tuple(self._value(f"axis.{name}.probe_input_{n}") for n in (1, 2)),
            inputs=tuple(self._value(f"axis.{name}.input.{bit}") for bit in BITS),
        )

    def _together(self, table: str, first: str, second: str) -> tuple[Any, Any] | None:
        """Return two values that only make sense together, or None when neither is given."""
        here = [self.values.get(f"{table}.{key}") for key in (first, second)]
        if None not in here:
            return here[0], here[1]
        for key, other in ((first, second), (second, first)):
            if f"{table}.{key}" in self.values:
                self._fail(self.given[f"{table}.{key}"], f"{table}.{key}: needs {table}.{other} as well")
        return None

    def _drive_train(self, name: str, *, rotary: bool) -> AxisPlant:
        table = f"plant.axis.{name}."
        pitch = self._value(table + "pitch_mm")
        pitch = (ROTARY_PITCH_DEG if rotary else LINEAR_PITCH_MM) if pitch is None else pitch
        turn = self._value(table + "increments_per_turn")
        zero = self._value(table + "zero_pulse_offset_increments")
        if zero is None:
            zero = round(self._value(table + "zero_pulse_offset_mm") / pitch * turn)
        computed: dict[str, Any] = {
            "pitch_mm": pitch,
            "zero_pulse_increments": zero,
            "increments_per_turn": turn,
        }
        rest = {
            item.name: self._value(table + item.name)
            for item in fields(AxisPlant)
            if item.name not in computed
        }
        return AxisPlant(**rest, **computed)

    # -- terminals, PLCs, faults --------------------------------------------------------------------------

    def _terminals(self) -> tuple[TerminalSettings, ...]:
        prefix = "terminal."
        names = dict.fromkeys(path.split(".")[1] for path in self.values if path.startswith(prefix))
        return tuple(one for name in names if (one := self._terminal(name)) is not None)

    def _terminal(self, name: str) -> TerminalSettings | None:
        table = f"terminal.{name}."
        wiring = {
            path.removeprefix(table + "wiring."): cast("str", signal)
            for path, signal in self.values.items()
            if path.startswith(table + "wiring.")
        }
        place = next(given for path, given in self.given.items() if path.startswith(table))
        cycle_us = self._value("cycle_us")
        period_us = self._value(table + "period_us")
        settings = TerminalSettings(
            name=name,
            model=self._value(table + "model") or "",
            period_us=cycle_us if period_us is None else period_us,
            wiring=wiring,
            mode=self._value(table + "mode"),
            delay_ns=self._value(table + "delay_ns"),
            clock_skew_ns=self._value(table + "clock_skew_ns"),
        )
        self._check_period(table + "period_us", settings.period_us)
        try:
            type_of(settings).channels(settings)
        except InputError as error:
            key = error.message.partition(":")[0]
            self._fail(self.given.get(key, place), error.message)
            return None
        return settings

    def _check_period(self, path: str, period_us: int) -> None:
        cycle_us = self._value("cycle_us")
        if period_us % cycle_us:
            self._fail(
                self.given.get(path), f"{path}: {period_us} is not a multiple of cycle_us = {cycle_us}"
            )

    def _numbered(self, table: str) -> list[str]:
        """Return the elements `plc[0]`, `plc[1]` ... in order; none may be missing."""
        found = {path.partition("]")[0] + "]" for path in self.values if path.startswith(f"{table}[")}
        names = list(takewhile(found.__contains__, (f"{table}[{number}]" for number in count())))
        beyond = found.difference(names)
        if beyond:
            self._beyond(table, len(names), beyond)
        return names

    def _beyond(self, table: str, count: int, beyond: set[str]) -> None:
        """Refuse entries whose number leaves a gap."""
        entries = f"1 {table} entry" if count == 1 else f"{count} {table} entries"
        there = f"the machine has {entries}, so {table}[{count}] is the highest, a new one"
        for path, given in self.given.items():
            name = path.partition("]")[0] + "]"
            if name in beyond:
                self._fail(given, f"{path} = {given.value!r}: there is no {name}; {there}")

    def _entry(self, name: str) -> Given:
        """Return the first value that was given for an entry."""
        return next(given for path, given in self.given.items() if path.startswith(f"{name}."))

    def _plcs(self) -> tuple[PlcConfig, ...]:
        plcs: list[PlcConfig] = []
        for table in self._numbered("plc"):
            script = self._value(f"{table}.script")
            if script is None:
                self._fail(self._entry(table), f"{table}.script: is missing")
                continue
            path = self._script(table, script)
            period_us = self._value(f"{table}.period_us")
            if period_us is not None:
                self._check_period(f"{table}.period_us", period_us)
            name = self._value(f"{table}.name") or path.stem
            if name in [plc.name for plc in plcs]:
                self._fail(self._entry(table), f"{table}.name: {name!r} is already that of another task")
            process = self._value(f"{table}.process")
            plcs.append(PlcConfig(name=name, script=path, period_us=period_us, process=process))
        return tuple(plcs)

    def _script(self, table: str, script: str) -> Path:
        """Return the file of a PLC script: of the machine folder, among those supplied, or a path."""
        for candidate in (self.folder / script, Path(script)):
            if candidate.is_file():
                return candidate
        try:
            return data_file("plc_scripts", script)
        except InputError:
            message = f"{table}.script: {script!r} is neither in {self.folder} nor in plc_scripts/ nor a file"
            self._fail(self.given[f"{table}.script"], message)
            return Path(script)

    def _faults(self) -> tuple[FaultConfig, ...]:
        faults = []
        for table in self._numbered("fault"):
            kind = self._value(f"{table}.kind")
            if kind is None:
                self._fail(self._entry(table), f"{table}.kind: is missing")
                continue
            if self._value(f"{table}.when"):
                self.refused.append(f"{table}.when: faults at a condition")
            value = self._value(f"{table}.value")
            if kind == "probe_stuck" and value not in (0.0, 1.0):
                given = self.given[f"{table}.value"]
                self._fail(given, f"{table}.value: {value:g} is no level of a stuck probe, 0 or 1 expected")
            at_ns = Ns(round(self._value(f"{table}.at_ms") * NS_PER_MS))
            for_ms = self._value(f"{table}.for_ms")
            faults.append(
                FaultConfig(
                    kind=kind,
                    target=self._value(f"{table}.target") or (PROBE if kind == "probe_stuck" else ""),
                    at_ns=at_ns,
                    until_ns=None if for_ms is None else Ns(at_ns + round(for_ms * NS_PER_MS)),
                    value=value,
                )
            )
        return tuple(faults)

    def _check_signals(self, axes: Sequence[str]) -> None:
        """Every wire must lead to a signal of this machine."""
        known = signal_names(axes)
        for path, value in self.values.items():
            wire = (
                ".wiring." in path
                or ".probe_input_" in path
                or (path.startswith("axis.") and ".input." in path)
            )
            stuck = path.startswith("fault[") and path.endswith(".target")
            stuck = stuck and self.values.get(path.removesuffix("target") + "kind") == "probe_stuck"
            if (wire or stuck) and value and value not in known:
                self._fail(self.given[path], f"{path}: {value!r} is not a signal ({', '.join(known)})")


@lru_cache(maxsize=4096)
def _key(path: str) -> tuple[Key, Mapping[str, str]] | None:
    """Return the key of machine.toml that a path is, with the names within it."""
    for expression, key in PATTERNS:
        match = expression.fullmatch(path)
        if match is not None:
            return key, match.groupdict()
    return None


def _list_path(path: str) -> tuple[str, str]:
    """Return (owner, list path) of a path that may be a parameter's, or empty texts."""
    parts = path.split(".", 2)
    if parts[0] == "channel" and len(parts) > 1:
        return "channel", path.removeprefix("channel.")
    if parts[0] == "axis" and len(parts) > 2:
        return f"axis.{parts[1]}", parts[2]
    return "", ""


def _hint(path: str, axes: Sequence[str]) -> str:
    """Return ' (did you mean ...?)' for the nearest keys."""
    known = [
        key.path.replace("<AXIS>", axis).replace("<N>", "0").replace("<BIT>", "home")
        for key in KEYS
        for axis in (axes if "<AXIS>" in key.path else axes[:1])
    ]
    near = difflib.get_close_matches(path, known, n=2, cutoff=0.7)
    return f" (did you mean {' or '.join(near)}?)" if near else ""
