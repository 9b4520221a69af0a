"""The machine folder as frozen records: machine.toml, list files and overrides, checked key by key.

`values.py` takes what is given, `axes.py` and `parts.py` make the records; here they become one machine.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path

from hli_bench.base.errors import BenchError, InputError, NotEmulated
from hli_bench.base.loading import data_file
from hli_bench.base.paths import is_file, is_folder
from hli_bench.base.time import dc_ns
from hli_bench.bench.axes import axis_of, channel_of, check_axes, list_text, params_of
from hli_bench.bench.config import MachineConfig
from hli_bench.bench.parts import faults_of, plant_of, plcs_of, terminals_of
from hli_bench.bench.sources import Given, override, toml_text, toml_values
from hli_bench.bench.values import MACHINE_FILE, Values
from hli_bench.plant.build import signal_names


def machine_folder(machine: str | Path) -> Path:
    """Return the folder of a machine given by name or path. Raises InputError when there is none."""
    folder = Path(machine)
    if is_file(folder / MACHINE_FILE):
        return folder
    nothing_there = InputError(f"no {MACHINE_FILE} there", file=str(folder))
    if isinstance(machine, Path) or len(folder.parts) != 1:
        raise nothing_there
    try:
        shipped = data_file("machines", machine)
    except InputError:
        if is_folder(folder):
            raise nothing_there from None
        raise
    if not is_file(shipped / MACHINE_FILE):
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
    texts = tuple(map(list_text, _list_files(folder, text)))
    values = Values(folder, override(given, overrides or {}))
    plain = _plain(folder, text, texts)
    if plain is not None:
        values.begin_with(plain)
    return _machine(values, given, with_plcs=with_plcs)


@lru_cache(maxsize=16)
def _plain(folder: Path, text: str, texts: tuple[str | None, ...]) -> Values | None:
    """Return the values of a folder without overrides, once a process for the same texts of its files.

    None when anything is to be said of them: then each load has to find it anew.
    """
    given = toml_values(text, str(folder / MACHINE_FILE))
    values = Values(folder, given, dict(zip(_list_files(folder, text), texts, strict=True)))
    try:
        _machine(values, given, with_plcs=True)
    except BenchError:
        return None
    return None if values.notes else values


@lru_cache(maxsize=16)
def _list_files(folder: Path, text: str) -> tuple[Path, ...]:
    """Return the list files that a machine.toml names."""
    given = toml_values(text, str(folder / MACHINE_FILE))
    return tuple(folder / str(one.value) for path, one in given.items() if path.endswith(".list"))


def _machine(values: Values, file: Mapping[str, Given], *, with_plcs: bool) -> MachineConfig:
    """Return the machine of these values; `file` is what stands in machine.toml.

    Raises InputError for everything that is wrong, NotEmulated.
    """
    values.machine = _config(values, file, with_plcs=with_plcs)
    _finish(values)
    assert values.machine is not None
    if values.refused:
        raise NotEmulated("\nNotEmulated: ".join(map(str, values.refused)))
    return values.machine


def _config(values: Values, file: Mapping[str, Given], *, with_plcs: bool) -> MachineConfig | None:
    """Return the machine, or None when something is wrong."""
    names = (
        _axis_names(file, values.folder) if values.base is None else [axis.name for axis in values.base.axes]
    )
    for path, given in values.given.items():
        if path in values.accepted:
            values.checked[path] = values.accepted[path]
        else:
            values.take(path, given, names)
    channel = channel_of(values)
    params = [params_of(values, number, name) for number, name in enumerate(names)]
    if values.errors:
        return None
    axes = tuple(axis_of(values, number, name, params[number]) for number, name in enumerate(names))
    plant = plant_of(values, axes)
    config = MachineConfig(
        name=values.folder.resolve().name,
        folder=values.folder,
        cycle_us=values.value("cycle_us"),
        dc_epoch_ns=dc_ns(values.value("dc_epoch")),
        seed=values.value("seed"),
        channel=channel,
        axes=axes,
        plant=plant,
        terminals=terminals_of(values),
        plcs=plcs_of(values) if with_plcs else (),
        faults=faults_of(values),
        notes=tuple(values.notes),
    )
    if not values.untouched("axis.", "plant.axis."):
        check_axes(values, axes, plant)
    if not values.untouched("axis.", "terminal.", "fault["):
        _check_signals(values, names)
    return config


def _finish(values: Values) -> None:
    """Raise one InputError for everything that was wrong."""
    if len(values.errors) == 1:
        raise values.errors[0]
    if values.errors:
        raise InputError("\n".join(str(error) for error in values.errors))


def _axis_names(file: Mapping[str, Given], folder: Path) -> list[str]:
    """Return the axes in the order of the file; an override cannot add one."""
    names: dict[str, None] = {}
    for path in file:
        if path.startswith("axis.") and path.count(".") >= 2:
            names[path.split(".")[1]] = None
    if not names:
        raise InputError("no axis: expected a table [axis.<NAME>]", file=str(folder / MACHINE_FILE))
    return list(names)


def _check_signals(values: Values, axes: Sequence[str]) -> None:
    """Every wire must lead to a signal of this machine."""
    known = signal_names(axes)
    for path, value in values.checked.items():
        wire = (
            ".wiring." in path or ".probe_input_" in path or (path.startswith("axis.") and ".input." in path)
        )
        stuck = path.startswith("fault[") and path.endswith(".target")
        stuck = stuck and values.checked.get(path.removesuffix("target") + "kind") == "probe_stuck"
        if (wire or stuck) and value and value not in known:
            values.fail(values.given[path], f"{path}: {value!r} is not a signal ({', '.join(known)})")
