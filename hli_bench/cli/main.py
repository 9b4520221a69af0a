"""The command `hli-bench`: parser, dispatch, and how every command ends.

Each command is a module with `add`, which declares it, and `execute`, which returns the exit status. What is heavy
(the compiler, zenoh, CAN) is imported by `execute`, so that help and checks answer at once.
"""

import argparse
import errno
import io
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, NoReturn

from hli_bench.base import garbage
from hli_bench.base.errors import BenchError, EnvironmentLacks
from hli_bench.base.loading import version
from hli_bench.cli import (
    doctor,
    drive,
    errors,
    hli,
    machine,
    params,
    plc,
    reset,
    run,
    serve,
    state,
    sweep,
    trace,
    unbuilt,
)
from hli_bench.cli.console import say, tell

INTERRUPTED: Final = 130
"""Exit status after Ctrl-C, as a shell reports it."""
PIPE_CLOSED: Final = 141
"""Exit status when nobody reads standard output any more."""
FAULT_OF_OURS: Final = 70
"""Exit status after an error that nobody has foreseen (EX_SOFTWARE)."""
EPILOG: Final = (
    "exit status: 0 done (run: M02 or M30), 1 stopped by an error of the CNC, 2 bad input, "
    "3 this computer cannot serve it, 70 a fault of the bench itself, 130 Ctrl-C"
)


class _Version(argparse.Action):
    """Prints the version; looked for when asked, because that takes longer than the rest of a start."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> NoReturn:
        say(f"hli-bench {version()}")
        parser.exit()


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = argparse.ArgumentParser(
        prog="hli-bench",
        description="An emulated CNC with emulated drives and terminals, open to PLC logic over the HLI.",
        epilog=EPILOG,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = top.add_subparsers(dest="command", required=True, title="commands")
    for module in (
        run,
        serve,
        plc,
        hli,
        state,
        reset,
        params,
        errors,
        drive,
        machine,
        trace,
        sweep,
        unbuilt,
        doctor,
    ):
        module.add(commands)
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line (default: this process's) and return the exit status."""
    _open_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    garbage.seldom()
    try:
        try:
            return _execute(argv)
        finally:
            sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception as error:
        return _failed(error)


def _execute(argv: Sequence[str] | None) -> int:
    arguments = parser().parse_args(argv)
    _take_signals()
    try:
        status: int = arguments.execute(arguments)
    except BenchError as error:
        tell(error)
        return error.exit_status
    return status


def _open_streams() -> None:
    """Give standard streams that are closed to nobody, before a file or socket gets their numbers."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            stream = Path(os.devnull).open(mode, encoding="utf-8")  # noqa: SIM115 - open as long as the process
            os.set_inheritable(stream.fileno(), True)
            setattr(sys, name, stream)


def _failed(error: Exception) -> int:
    """Say what went wrong when no command has foreseen it; return the exit status, which is none of the CNC's."""
    number = error.errno if isinstance(error, OSError) else None
    if number not in (errno.EPIPE, errno.ENOSPC):
        traceback.print_exception(error)
        return FAULT_OF_OURS
    # Who writes a file says which one it was; here it was a standard stream.
    if number == errno.ENOSPC:
        with suppress(OSError):
            tell(f"standard output: cannot be written: {os.strerror(number)}")
    # What is still buffered must not fail again when the interpreter flushes it.
    for stream in (sys.stdout, sys.stderr):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    return PIPE_CLOSED if number == errno.EPIPE else EnvironmentLacks.exit_status


def _take_signals() -> None:
    """Let SIGINT and SIGTERM interrupt the command as Ctrl-C does, so that what it began is ended and written.

    Said explicitly, because a shell without job control starts a command with `&` so that it ignores SIGINT.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)


if __name__ == "__main__":
    sys.exit(main())
