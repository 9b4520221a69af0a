"""Processes that belong to a bench: PLC scripts, drives, terminals; and the pipes between them."""

import contextlib
import os
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final, Self

from hli_bench.base.errors import BenchError
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

    def __init__(self, script: Path, endpoint: str, name: str) -> None:
        self._process = plc_process.start(script, endpoint, name)
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
        """Send one message. Raises BenchError when the other side has gone."""
        try:
            self._end.sendall(_LENGTH.pack(len(message)) + message)
        except OSError as error:
            raise BenchError("a process of the bench has gone") from error

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
    """A Python module running as a process of its own, with a pipe to it. It ends with its pipe."""

    def __init__(self, module: str, arguments: Sequence[str]) -> None:
        ours, theirs = socket.socketpair()
        command = [sys.executable, "-m", module, str(theirs.fileno()), *arguments]
        self._process = subprocess.Popen(command, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL)
        theirs.close()
        self.pipe = Pipe(ours)
        self._name = module

    def ask(self, message: bytes) -> bytes:
        """Send a message and wait for the answer. Raises BenchError when the process has died."""
        self.pipe.send(message)
        return self.answer()

    def answer(self) -> bytes:
        """Wait for an answer. Raises BenchError when the process has died."""
        try:
            return self.pipe.receive()
        except EOFError as error:
            raise BenchError(f"process {self._name} has ended with status {self._process.wait()}") from error

    def close(self) -> None:
        """End the process."""
        self.pipe.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(END_S)
        _end(self._process)


def worker_pipe(argument: str) -> Pipe:
    """Return the pipe that this process was started with; Ctrl-C is left to the process at the other end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    descriptor = int(argument)
    os.set_inheritable(descriptor, False)
    return Pipe(socket.socket(fileno=descriptor))
