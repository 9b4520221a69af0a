"""Campaign files: what is run, what varies, what is measured; every run follows from its number alone."""

import hashlib
import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, cast

from hli_bench.base import paths
from hli_bench.base.errors import BenchError, InputError
from hli_bench.base.loading import data_file
from hli_bench.bench.config import MachineConfig
from hli_bench.bench.drive_models import drive_model, eds_of
from hli_bench.bench.folder import load, machine_folder
from hli_bench.bench.sources import NUMBERED, SET, line_numbers, line_of, toml_tree
from hli_bench.sweep.draws import FORMS, RULES, Choice, Distribution, Integers, Plain, distribution, share
from hli_bench.sweep.expressions import metric
from hli_bench.sweep.work import PLACEHOLDER, PROGRAM, Job, Run

KEYS: Final = (
    "program",
    "machine",
    "plc",
    "seed",
    "repeats",
    "settings",
    "grid",
    "random",
    "metrics",
    "report.by",
)
COLUMNS: Final = ("run", "status", "errors", "cycles")
"""Columns of the table beside keys and metrics."""
NAME: Final = re.compile(r"[A-Za-z_]\w*")
MOST: Final = 10_000_000
"""Most runs of a campaign, decided here: more is a mistake in the grid."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Campaign:
    """A campaign that has been checked. Runs count through the grid, the last key fastest, repeats innermost."""

    file: str
    job: Job
    seed: int
    repeats: int
    fixed: Mapping[str, Plain]
    grid: Mapping[str, tuple[Plain, ...]]
    random: Mapping[str, Distribution]
    metrics: Mapping[str, str]
    by: str | None
    """The key by which the report is divided."""
    digests: Mapping[str, str]
    """What decides the results, part by part: two campaigns are the same when these are."""

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return math.prod(len(values) for values in self.grid.values()) * self.repeats

    @property
    def varied(self) -> tuple[str, ...]:
        """The keys that vary, in the order of the file."""
        return (*self.grid, *self.random)

    def drawn(self, number: int) -> dict[str, Plain]:
        """Return what varies, for one run."""
        at, values = number // self.repeats, {}
        for key, choices in reversed(tuple(self.grid.items())):
            at, index = divmod(at, len(choices))
            values[key] = choices[index]
        drawn = {key: values[key] for key in self.grid}
        return drawn | {key: of.draw(share(self.seed, number, key)) for key, of in self.random.items()}

    def run(self, number: int) -> Run:
        """Return a run with all its settings."""
        return Run(number, {**self.fixed, **self.drawn(number)})

    def describe(self, number: int) -> str:
        """Return what tells a run from the others, for messages."""
        values = ", ".join(f"{key} = {value}" for key, value in self.drawn(number).items())
        return f"run {number} ({values})" if values else f"run {number}"


def read(path: Path) -> Campaign:
    """Read and check a campaign. Raises InputError with file, line, key, value and what is allowed."""
    return _Reader(path, paths.text(path)).campaign()


class _Reader:
    """Takes a campaign file apart; knows the line of each key."""

    def __init__(self, path: Path, text: str) -> None:
        self._path = path
        self._lines = line_numbers(text)
        self._tree = toml_tree(text, str(path))
        self._places: dict[str, str] = {}
        self._scripts: set[Path] = set()

    def campaign(self) -> Campaign:
        """Return the campaign."""
        self._check_keys()
        fixed = {key: self._plain(key, value) for key, value in self._leaves("settings")}
        grid = {key: self._values(key, value) for key, value in self._leaves("grid")}
        random = {key: self._distribution(key, value) for key, value in self._leaves("random")}
        keys = frozenset((*fixed, *grid, *random))
        metrics = self._metrics(keys)
        name, text = self._program(keys)
        job = Job(
            machine=self._machine(),
            program_name=name,
            text=text,
            plc=self._plc(),
            metrics=tuple(metrics.values()),
            keys=keys,
        )
        campaign = Campaign(
            file=str(self._path),
            job=job,
            seed=self._whole("seed", 0, 0),
            repeats=self._whole("repeats", 1, 1),
            fixed=fixed,
            grid=grid,
            random=random,
            metrics=metrics,
            by=self._by((*grid, *random)),
            digests={},
        )
        if campaign.runs > MOST:
            raise self._error("grid", f"{campaign.runs} runs, allowed 1..{MOST}")
        self._try(campaign)
        digests = _digests(campaign, self._scripts)
        return Campaign(
            **{name: getattr(campaign, name) for name in Campaign.__slots__} | {"digests": digests}
        )

    # -- keys and values ----------------------------------------------------------------------------------

    def _error(self, path: str, message: str) -> InputError:
        return InputError(message, str(self._path), line_of(self._lines, path))

    def _error_of(self, key: str, message: str) -> InputError:
        """Return the error about a key of settings, grid or random."""
        return self._error(self._places.get(key, ""), message)

    def _check_keys(self) -> None:
        report = self._tree.get("report", {})
        given = [key for key in self._tree if key != "report"]
        given += [f"report.{key}" for key in report] if isinstance(report, Mapping) else ["report"]
        for key in given:
            if key not in KEYS:
                raise self._error(key, f"{key}: unknown key, expected {', '.join(KEYS)}")
        for needed in ("program", "metrics"):
            if needed not in self._tree:
                raise InputError(f"{needed}: is missing", str(self._path))

    def _leaves(self, table: str) -> Iterator[tuple[str, object]]:
        """Yield (key, value) of settings, grid or random; a key may stand in only one of them."""
        tree = self._tree.get(table, {})
        if not isinstance(tree, Mapping):
            raise self._error(table, f"{table}: expected a table [{table}]")
        for path, value in _flat(tree, "", inline=table == "random"):
            key = NUMBERED.sub(r"\1[\2]", path)
            if key in self._places:
                raise self._error(f"{table}.{path}", f"{key}: stands twice in this campaign")
            if key in COLUMNS:
                raise self._error(f"{table}.{path}", f"{key}: the table has a column of that name")
            self._places[key] = f"{table}.{path}"
            yield key, value

    def _plain(self, key: str, value: object) -> Plain:
        if isinstance(value, bool | int | float | str):
            return value
        raise self._error_of(key, f"{key}: {value!r} is not valid, expected true, false, a number or a text")

    def _values(self, key: str, value: object) -> tuple[Plain, ...]:
        if not isinstance(value, list) or not value:
            raise self._error_of(key, f"{key}: {value!r} is not valid, expected a list of values")
        values = tuple(self._plain(key, item) for item in value)
        if kind(values) is None:
            raise self._error_of(key, f"{key}: {value!r} is not valid, expected values of one kind")
        if len(set(values)) != len(values):
            raise self._error_of(key, f"{key}: {value!r} is not valid, a value stands twice; see repeats")
        return values

    def _distribution(self, key: str, value: object) -> Distribution:
        allowed = " or ".join(f"{{ {name} = {form} }}" for name, form in FORMS.items())
        if isinstance(value, Mapping) and len(value) == 1:
            (name, numbers), *_ = value.items()
            if name in FORMS and isinstance(numbers, list):
                try:
                    found = distribution(name, numbers)
                except ValueError as error:
                    message = (
                        f"{key}: {numbers!r} is not valid for {name}, expected {FORMS[name]}{RULES[name]}"
                    )
                    raise self._error_of(key, message) from error
                if isinstance(found, Choice):
                    self._values(key, numbers)
                return found
        raise self._error_of(key, f"{key}: {value!r} is not valid, expected {allowed}")

    def _whole(self, key: str, default: int, low: int) -> int:
        value = self._tree.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or value < low:
            raise self._error(key, f"{key}: {value!r} is not valid, expected a whole number from {low} on")
        return value

    def _metrics(self, keys: frozenset[str]) -> dict[str, str]:
        table = self._tree["metrics"]
        if not isinstance(table, Mapping) or not table:
            raise self._error("metrics", 'metrics: expected a table of name = "expression"')
        for name, text in table.items():
            here = f"metrics.{name}"
            if not NAME.fullmatch(name) or name in COLUMNS or name in keys:
                raise self._error(
                    here, f"{name!r} cannot name a metric: letters, digits, _; not {', '.join(COLUMNS)}"
                )
            if not isinstance(text, str):
                raise self._error(here, f"{here}: {text!r} is not valid, expected an expression as text")
            try:
                metric(text, keys)
            except ValueError as error:
                raise self._error(here, f"{here}: {error}") from error
        return cast("dict[str, str]", dict(table))

    def _by(self, varied: Sequence[str]) -> str | None:
        report = cast("Mapping[str, object]", self._tree.get("report", {}))
        given = report.get("by")
        if given is None:
            return None
        key = NUMBERED.sub(r"\1[\2]", str(given))
        if key not in varied:
            raise self._error("report.by", f"report.by: {given!r} is not one of {', '.join(varied)}")
        return key

    # -- files --------------------------------------------------------------------------------------------

    def _file(self, key: str, folder: str, name: object) -> Path:
        """Return a file beside the campaign, by its path, or among those supplied in `folder`."""
        if not isinstance(name, str):
            raise self._error(key, f"{key}: {name!r} is not valid, expected the name of a file")
        for candidate in (self._path.parent / name, Path(name)):
            if paths.is_file(candidate):
                return candidate.resolve()
        try:
            return data_file(folder, name)
        except InputError as error:
            message = f"{key}: {name!r} is neither beside the campaign nor a file nor in {folder}/"
            raise self._error(key, message) from error

    def _program(self, keys: Collection[str]) -> tuple[str, str]:
        """Return name and text of the program; its placeholders are the keys `program.*`."""
        path = self._file("program", "programs", self._tree["program"])
        text = path.read_text(encoding="utf-8-sig", errors="replace")
        given = {key.removeprefix(PROGRAM) for key in keys if key.startswith(PROGRAM)}
        wanted = set(PLACEHOLDER.findall(text))
        for name in sorted(given - wanted):
            message = f"{PROGRAM}{name}: {path.name} has no placeholder {{{name}}}"
            raise self._error_of(PROGRAM + name, f"{message} ({', '.join(sorted(wanted)) or 'none at all'})")
        if given and wanted - given:
            names = ", ".join(PROGRAM + name for name in sorted(wanted - given))
            raise self._error("program", f"{path.name}: no value for {names}")
        return str(self._tree["program"]), text

    def _machine(self) -> str:
        name = self._tree.get("machine", "demo")
        if not isinstance(name, str):
            raise self._error("machine", f"machine: {name!r} is not valid, expected a name or a folder")
        beside = self._path.parent / name
        if paths.is_file(beside / "machine.toml"):
            return str(beside.resolve())
        try:
            machine_folder(name)
        except InputError as error:
            message = f"machine: {name!r} is neither a machine of the package nor a folder with machine.toml"
            raise self._error("machine", message) from error
        return str(Path(name).resolve()) if paths.is_folder(Path(name)) else name

    def _plc(self) -> tuple[str, ...] | None:
        names = self._tree.get("plc")
        if names is None:
            return None
        if not isinstance(names, list):
            raise self._error(
                "plc", f"plc: {names!r} is not valid, expected a list of scripts, [] for no PLC"
            )
        for key in self._places:
            if key.startswith("plc["):
                raise self._error_of(
                    key, f"{key}: has no effect on scripts that `plc` names; set plc[0].script"
                )
        return tuple(str(self._file("plc", "plc_scripts", name)) for name in names)

    # -- trying out ---------------------------------------------------------------------------------------

    def _try(self, campaign: Campaign) -> None:
        """Load the machine once for each value, so that what cannot be is known before the first run."""
        self._load(campaign, campaign.run(0).settings, None)
        for key, values in campaign.grid.items():
            for value in values:
                self._load(campaign, {**campaign.run(0).settings, key: value}, key)
        for key, of in campaign.random.items():
            for value in _extremes(of):
                self._load(campaign, {**campaign.run(0).settings, key: value}, key)

    def _load(self, campaign: Campaign, settings: Mapping[str, Plain], varied: str | None) -> None:
        """Load the machine with these settings; an error about one of them stands at its line."""
        taken = {key: value for key, value in settings.items() if not key.startswith(PROGRAM)}
        try:
            config = load(campaign.job.machine, taken, with_plcs=campaign.job.plc is None)
            self._scripts |= {plc.script for plc in config.plcs}
        except InputError as error:
            if error.file and error.file != SET:
                if varied is None:
                    raise
                raise self._error_of(varied, f"{varied} = {settings[varied]}: {error}") from error
            key = varied or next((key for key in settings if error.message.startswith(key)), "")
            raise self._error_of(key, error.message) from error
        except BenchError as error:
            raise self._error_of(varied or "", str(error)) from error


def _flat(tree: Mapping[str, object], prefix: str, *, inline: bool) -> Iterator[tuple[str, object]]:
    """Yield the dotted keys of nested tables; `inline`: a table that names a distribution is a value."""
    for key, value in tree.items():
        named = isinstance(value, Mapping) and len(value) == 1 and next(iter(value)) in FORMS
        if isinstance(value, Mapping) and value and not (inline and named):
            yield from _flat(value, f"{prefix}{key}.", inline=inline)
        else:
            yield prefix + key, value


def kind(values: Sequence[Plain]) -> type[Plain] | None:
    """Return what these values are in a table: bool, int, float or str; None for a mixture."""
    found = {type(value) for value in values}
    if found == {int, float}:
        return float
    return found.pop() if len(found) == 1 else None


def kind_of(campaign: Campaign, key: str) -> type[Plain]:
    """Return what the column of a varied key holds."""
    of = campaign.random.get(key)
    if of is None or isinstance(of, Choice):
        found = kind(campaign.grid[key] if of is None else of.values)
        assert found is not None
        return found
    return int if isinstance(of, Integers) else float


def _extremes(of: Distribution) -> tuple[Plain, ...]:
    """Return values that a draw can come near to."""
    if isinstance(of, Choice):
        return of.values
    return of.draw(2.0**-20), of.draw(1 - 2.0**-20)


def _with_neighbours(scripts: Collection[Path]) -> set[Path]:
    """Return the scripts and the Python files beside them, which they may import."""
    return {*scripts, *(path for script in scripts for path in script.parent.glob("*.py") if path.is_file())}


def _drive_files(campaign: Campaign, machine: MachineConfig) -> set[Path]:
    """Return the files of the drive models that the runs of a campaign may name, and their EDS. Raises InputError."""
    users = {axis.drive: f"axis.{axis.name}.drive" for axis in machine.axes}
    chosen = {key: (value,) for key, value in campaign.fixed.items()}
    drawn = {key: of.values for key, of in campaign.random.items() if isinstance(of, Choice)}
    for key, values in {**chosen, **campaign.grid, **drawn}.items():
        if key.startswith("axis.") and key.endswith(".drive"):
            users |= dict.fromkeys(map(str, values), key)
    files: set[Path] = set()
    for name, key in users.items():
        try:
            model = drive_model(name)
            files |= {Path(model.__file__), *([eds] if (eds := eds_of(model)) else [])}
        except InputError as error:
            raise InputError(f"{key} = {name}: {error}", file=campaign.file) from error
    return files


def _digests(campaign: Campaign, scripts: Collection[Path]) -> dict[str, str]:
    """Return a digest of each part of a campaign and of the files that it names; `scripts` of the machine."""
    job = campaign.job
    machine = replace(load(job.machine, with_plcs=False), folder=Path(), notes=())
    used = scripts if job.plc is None else [Path(name) for name in job.plc]
    parts: dict[str, Any] = {
        "program": job.text,
        "machine": machine,
        "plc": sorted(path.read_bytes() for path in _with_neighbours(used)),
        "drives": sorted(path.read_bytes() for path in _with_neighbours(_drive_files(campaign, machine))),
        "settings": sorted(campaign.fixed.items()),
        "grid": list(campaign.grid.items()),
        "random": [(key, repr(of)) for key, of in campaign.random.items()],
        "seed": campaign.seed,
        "repeats": campaign.repeats,
        "metrics": list(campaign.metrics.items()),
    }
    return {name: hashlib.sha256(repr(part).encode()).hexdigest()[:16] for name, part in parts.items()}
