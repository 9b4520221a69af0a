"""`hli-bench run`: an NC program on a bench of its own, or on one that is up."""

import argparse
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from hli_bench.base import paths
from hli_bench.base.errors import BenchError, InputError
from hli_bench.cli.console import say_line, tell
from hli_bench.cli.options import (
    BenchOptions,
    Commands,
    add_bench,
    bench_options,
    endpoint,
    supplied_file,
)
from hli_bench.shells.whole_file import check_writable, write_whole

if TYPE_CHECKING:
    from hli_bench.bench.bench import Bench
    from hli_bench.bench.result import Result
    from hli_bench.kernel.records import Emitted
    from hli_bench.shells.recorder import Recorder

RESULT_KEYS: Final = (
    "program",
    "status",
    "messages",
    "errors",
    "variables",
    "measurements",
    "homing",
    "sim_s",
    "wall_s",
    "cycles",
)
"""What `--result` writes."""
REMARK_KEYS: Final = ("unmeasured", "notes")
"""What it also writes when there is anything to remark."""
PACED_KEYS: Final = ("late_cycles", "worst_lateness_us", "lateness_histogram", "plcs")
"""What it also writes of a bench in real pace."""
EXIT_STATUS: Final[Mapping[str, int]] = {"completed": 0, "error": 1, "aborted": 130}
OUTPUTS: Final = ("result", "trace", "report", "can_log")
RECORDED: Final = ("trace", "can_log")
"""Those that are written while the program runs."""
OF_A_MACHINE: Final = (".toml", ".lis", ".py", ".eds")
"""How files of a machine folder end that a bench may read."""
OF_AN_OWN_BENCH: Final = (
    "machine",
    "set",
    "lenient",
    "plc",
    "pace",
    "realtime",
    "can",
    "zenoh",
    "modbus",
    "trace",
    "report",
    "can_log",
    "limit",
)
"""Options that say nothing about a bench that is up already."""


def add(commands: Commands) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "run",
        help="run an NC program on a bench of its own",
        description="Runs an NC program and ends with it. Each #MSG text is a line on standard output; "
        "errors and warnings of the CNC go to standard error.",
    )
    parser.add_argument(
        "program", metavar="PROGRAM.nc", help="a file, or the name of a supplied program, with or without .nc"
    )
    add_bench(parser, pace="free", zenoh=None)
    parser.add_argument(
        "--connect", metavar="ENDPOINT", type=endpoint, help="use the bench that listens there"
    )
    parser.add_argument(
        "--limit",
        metavar="SECONDS",
        type=seconds,
        help="machine time after which a program that is not done is aborted (default: none)",
    )
    files = parser.add_argument_group("files to write")
    files.add_argument(
        "--result", metavar="FILE.json", help="messages, errors, measured values (mm, degrees)"
    )
    files.add_argument("--trace", metavar="FILE", help="the recorded run (MCAP)")
    files.add_argument("--report", metavar="FILE.html", help="one page with plots")
    files.add_argument("--can-log", metavar="FILE", help="the CAN frames as candump writes them")
    parser.set_defaults(execute=execute)


def seconds(text: str) -> float:
    """Return the text of `--limit` as a time."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r}: expected seconds above 0")
    return value


def execute(arguments: argparse.Namespace) -> int:
    """Run the program and return the exit status."""
    program = supplied_file("programs", arguments.program, ".nc")
    if arguments.connect:
        return _run_connected(program, arguments)
    options = bench_options(arguments)
    prepare(arguments, [program, *_files_read(options)])
    failures: list[BenchError] = []
    result = _run(program, options, arguments, failures)
    with _collected(failures):
        finish(result.to_dict(), arguments.result)
    for failure in failures:
        tell(failure)
    if result.status == "aborted" and arguments.limit is not None and result.sim_s >= arguments.limit:
        tell(f"--limit: not done after {arguments.limit:g} s of machine time")
        return EXIT_STATUS["error"]
    if failures and result.status == "completed":
        return failures[0].exit_status
    return EXIT_STATUS[result.status]


def prepare(arguments: argparse.Namespace, read: Iterable[Path]) -> None:
    """Make sure that all files can be written. Raises InputError.

    What an earlier run left of those that are written while the program runs is emptied; result and report are
    replaced when the new ones are whole. None may be one that the run reads, or the same as another.
    """
    taken = {path.resolve(): "is read by this run" for path in read}
    given = [
        (Path(file), f"--{name.replace('_', '-')}") for name in OUTPUTS if (file := getattr(arguments, name))
    ]
    for path, option in given:
        place = _resolved(path, option)
        if place in taken and (paths.is_file(path) or not paths.exists(path)):
            raise InputError(f"{option}: {taken[place]}", file=str(path))
        taken[place] = f"is given to {option} too"
    for path, option in given:
        check_writable(path, option)
        if option.removeprefix("--").replace("-", "_") in RECORDED:
            _empty(path, option)


def _resolved(path: Path, option: str) -> Path:
    """Return the place of a file to write. Raises InputError for a name that no file can have."""
    try:
        return path.resolve()
    except ValueError as error:
        raise InputError(f"{option}: no file can have that name", file=repr(str(path))) from error


def _files_read(options: BenchOptions) -> Iterator[Path]:
    """Yield what a bench is made of: PLC scripts, what may belong to the machine folder, files that settings name."""
    from hli_bench.bench.folder import machine_folder

    folder = machine_folder(options.machine)
    yield from map(Path, options.plc or ())
    yield from (path for path in folder.iterdir() if path.suffix in OF_A_MACHINE)
    for value in options.settings.values():
        if isinstance(value, str):
            yield from filter(paths.is_file, (Path(value), folder / value))


def _empty(path: Path, option: str) -> None:
    existed = path.exists()
    try:
        path.open("wb").close()
        if not existed:
            path.unlink()
    except OSError as error:
        raise InputError(f"{option}: cannot be written: {error.strerror}", file=str(path)) from error


def finish(result: Mapping[str, Any], file: str | None) -> None:
    """Say on standard error how the run ended, and what the bench remarks; write the result file.

    Raises EnvironmentLacks when it cannot be written.
    """
    tell(
        f"{result['program']}: {result['status']}, {result['sim_s']:.3f} s of machine time "
        f"in {result['wall_s']:.1f} s, {result['cycles']} cycles",
    )
    if result.get("late_cycles"):
        tell(f"{result['late_cycles']} times of a cycle were missed in {result['cycles']} cycles")
    for note in result["notes"]:
        tell(f"note: {note}")
    if file is not None:
        remarked = (key for key in REMARK_KEYS if result.get(key))
        keys = (*RESULT_KEYS, *remarked, *(key for key in PACED_KEYS if key in result))
        text = json.dumps({key: result[key] for key in keys}, indent=2, ensure_ascii=False)
        write_whole(Path(file), text + "\n")


# -- a bench of its own -----------------------------------------------------------------------------------


def _run(
    program: Path, options: BenchOptions, arguments: argparse.Namespace, failures: list[BenchError]
) -> "Result":
    """Build the bench, run the program with its recorders; Ctrl-C gives an aborted result.

    What could not be written is added to `failures`: the result is there all the same.
    """
    from hli_bench.bench.bench import Bench

    with Bench(
        options.machine,
        options.settings,
        plc=options.plc,
        pace=options.pace,
        on_record=_print_record,
        on_note=tell,
        realtime=options.realtime,
        **_buses(options),
    ) as bench:
        report = None if arguments.report is None else _reporter(bench)
        with _recorders(bench, options, arguments, failures):
            bench.start_up()
            try:
                result = bench.run(program, arguments.program, limit_s=arguments.limit)
            except KeyboardInterrupt:
                if bench.interrupted is None:
                    raise
                result = bench.interrupted
        if report is not None:
            with _collected(failures):
                report(result, arguments.report)
        return result


def _buses(options: BenchOptions) -> dict[str, Any]:
    """Return the arguments of a bench that is not alone in this process."""
    given = {"can": options.can if options.can != "inproc" else None, "zenoh": options.zenoh}
    return {key: value for key, value in given.items() if value is not None}


def _print_record(record: "Emitted") -> None:
    """Print what the CNC says as it comes."""
    from hli_bench.bench.result import error_of
    from hli_bench.kernel.records import CncError, MessageText

    if isinstance(record, MessageText):
        say_line(record.text)
    elif isinstance(record, CncError):
        tell(error_of(record))


@contextmanager
def _recorders(
    bench: "Bench", options: BenchOptions, arguments: argparse.Namespace, failures: list[BenchError]
) -> Iterator[None]:
    """Attach what writes trace and CAN log while the program runs."""
    with ExitStack() as closing:
        for kind in RECORDED:
            file = getattr(arguments, kind)
            if file is None:
                continue
            from hli_bench.shells.recorder import What, record

            what = What(kind, Path(file), bench.kernel.setup, bench.config.name, options.settings)
            recorder = record(what, bench.kernel.rows.log, paced=options.pace == "real", on_note=tell)
            bench.engine.observers.append(recorder)
            closing.callback(_close, recorder, failures)
        yield


def _close(recorder: "Recorder", failures: list[BenchError]) -> None:
    with _collected(failures):
        recorder.close()


@contextmanager
def _collected(failures: list[BenchError]) -> Iterator[None]:
    """Add what goes wrong to `failures`."""
    try:
        yield
    except BenchError as error:
        failures.append(error)


def _reporter(bench: "Bench") -> Callable[["Result", str], None]:
    """Attach what the report is made of; return what writes it into a file."""
    from hli_bench.runtime.recording import Recording, input_taps
    from hli_bench.scope.report import report_html

    recording = Recording(bench.kernel, input_taps(bench.config.terminals))
    bench.engine.observers.append(recording)

    def write(result: "Result", file: str) -> None:
        recording.plcs = {plc.name: plc.period_cycles * bench.config.cycle_ns for plc in bench.engine.plcs}
        page = report_html(recording, result.to_dict(), bench.config.name)
        write_whole(Path(file), page)

    return write


# -- a bench that is up -----------------------------------------------------------------------------------


def _run_connected(program: Path, arguments: argparse.Namespace) -> int:
    """Let the bench at `--connect` run the program."""
    for name in OF_AN_OWN_BENCH:
        if getattr(arguments, name) is not None:
            option = f"--{name.replace('_', '-')}"
            raise InputError(f"{option} cannot be chosen for a bench that is up already", file="--connect")
    prepare(arguments, [program])
    from hli_bench.bench.result import Error
    from hli_bench.shells.zenoh_client import HliClient

    text = program.read_text(encoding="utf-8", errors="replace")
    with HliClient(arguments.connect) as client:
        try:
            result = client.run(text, arguments.program)
        except KeyboardInterrupt:
            if client.interrupted is None:
                raise
            result = client.interrupted
            if result["status"] == "aborted":
                tell(
                    f"stopped: the bench at {arguments.connect} has aborted {arguments.program} and stays up"
                )
    for message in result["messages"]:
        say_line(message["text"])
    for error in result["errors"]:
        tell(Error(**error))
    finish(result, arguments.result)
    return EXIT_STATUS[result["status"]]
