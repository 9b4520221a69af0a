"""Processes that belong to a bench: PLC scripts, drives, terminals; and the pipes between them."""

import contextlib
import os
import socket
import struct
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, Self

from hli_bench.base.errors import BenchError, EnvironmentLacks
from hli_bench.shells import plc_process

_LENGTH: Final = struct.Struct("<I")
END_S: Final = 5.0
"""Time that a process gets to end by itself."""


def free_endpoint() -> str:
    """Return a Zenoh endpoint on a loopback port that is free now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def _end(process: "subprocess.Popen[bytes]") -> None:
    """End a process: ask, then insist."""
    if process.poll() is None:
        process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(END_S)
            return
        process.kill()
    process.wait()


class PlcProcess:
    """A PLC script running as a process of its own, attached to the bench over Zenoh."""

    def __init__(self, script: Path, endpoint: str, name: str, period_us: int | None = None) -> None:
        """Start it; `period_us` None: the script's own."""
        self._process = plc_process.start(script, endpoint, name, period_us)
        self._script = script

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        _end(self._process)

    def check(self) -> None:
        """Raise BenchError when the process has ended."""
        status = self._process.poll()
        if status is not None:
            raise BenchError(f"the PLC process of {self._script} has ended with status {status}")


class Pipe:
    """Messages with a length in front, over one end of a socket pair."""

    def __init__(self, end: socket.socket) -> None:
        self._end = end
        self._file = end.makefile("rb")

    def send(self, message: bytes) -> None:
        """Send one message. Raises EnvironmentLacks when the other side has gone."""
        try:
            self._end.sendall(_LENGTH.pack(len(message)) + message)
        except OSError as error:
            raise EnvironmentLacks("a process of the bench has gone") from error

    def receive(self) -> bytes:
        """Wait for one message. Raises EOFError when the other side has gone."""
        try:
            head = self._file.read(_LENGTH.size)
        except ConnectionError:
            head = b""
        if len(head) < _LENGTH.size:
            raise EOFError
        return self._file.read(_LENGTH.unpack(head)[0])

    def close(self) -> None:
        """Close this end."""
        self._file.close()
        self._end.close()


class Worker:
    """A Python module running as a process of its own, with a pipe to it. It ends with its pipe.

    It has a process group of its own: Ctrl-C is for the process that started it.
    """

    def __init__(self, module: str, arguments: Sequence[str]) -> None:
        ours, theirs = socket.socketpair()
        command = [sys.executable, "-m", module, str(theirs.fileno()), *arguments]
        self._process = subprocess.Popen(
            command, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL, process_group=0
        )
        theirs.close()
        self.pipe = Pipe(ours)
        self._name = module

    def ask(self, message: bytes) -> bytes:
        """Send a message and wait for the answer. Raises BenchError when the process has ended.

        What it ended of stands on standard error; when that was bad input the error says so by its exit status.
        """
        try:
            self.pipe.send(message)
            return self.pipe.receive()
        except (EOFError, EnvironmentLacks) as error:
            status = self._process.wait()
            kind = BenchError if status == BenchError.exit_status else EnvironmentLacks
            raise kind(f"process {self._name} has ended with status {status}") from error

    def close(self) -> None:
        """End the process."""
        self.pipe.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(END_S)
        _end(self._process)


def work(main: Callable[[Pipe, Sequence[str]], None], arguments: Sequence[str]) -> int:
    """Run the main function of a worker with its pipe and the rest of its arguments; return the exit status."""
    descriptor = int(arguments[0])
    os.set_inheritable(descriptor, False)
    try:
        main(Pipe(socket.socket(fileno=descriptor)), arguments[1:])
    except BenchError as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_status
    return 0
