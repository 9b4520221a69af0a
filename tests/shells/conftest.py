"""Commands as a user runs them, each in a session of its own so that nothing it started can be overlooked."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event, Thread
from time import monotonic
from typing import IO, Any

import pytest

from hli_bench.shells.zenoh_client import HliClient

COMMAND = Path(sys.executable).with_name("hli-bench")
PATIENCE_S = 60.0
FACE = ("--set", "plant.probe.Z.face_mm=298", "--set", "plant.probe.Z.material=below")
PROBE = """%short
N10 G01 G90 Z299 F6000
N20 G100 Z290 F2000
N30 #MSG SYN["V.A.MESS.Z=%f", V.A.MESS.Z]
N40 M30
"""
LONG = "N10 G01 G90 Z0 F60\nN20 M30\n"
"""Five minutes of machine time."""


BUSY = "does not keep its period: "
"""In a line that a bench by the clock tells when the computer is busy with other things; test_overruns asks for it."""


class Command:
    """A running command: its lines of output as they come, its end, what is left of its session."""

    def __init__(
        self, arguments: Sequence[str | Path], on_interrupt: signal.Handlers = signal.SIG_DFL
    ) -> None:
        self.process = subprocess.Popen(
            [str(argument) for argument in arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            # A test run in the background would hand down that Ctrl-C is to be ignored.
            preexec_fn=lambda: signal.signal(signal.SIGINT, on_interrupt),  # noqa: PLW1509 - allocates nothing
        )
        self.out: list[str] = []
        self.err: list[str] = []
        self._lines: SimpleQueue[str] = SimpleQueue()
        self._readers = [
            Thread(target=self._read, args=(self.process.stdout, self.out), daemon=True),
            Thread(target=self._read, args=(self.process.stderr, self.err), daemon=True),
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, stream: IO[str], lines: list[str]) -> None:
        with stream:
            for line in stream:
                if lines is self.err and BUSY in line:
                    continue
                lines.append(line.rstrip("\n"))
                if lines is self.out:
                    self._lines.put(lines[-1])

    def line(self) -> str:
        """Return the next line of standard output."""
        try:
            return self._lines.get(timeout=PATIENCE_S)
        except Empty:
            pytest.fail(f"{self.process.args}: no line on standard output; {self.err}")

    def interrupt(self) -> None:
        """Press Ctrl-C: the signal goes to the foreground process group."""
        os.killpg(self.process.pid, signal.SIGINT)

    def end(self) -> int:
        """Wait for the end and return the exit status."""
        try:
            status = self.process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            pytest.fail(f"{self.process.args} does not end; {self.out} {self.err}")
        self._join()
        return status

    def _join(self) -> None:
        for reader in self._readers:
            reader.join(PATIENCE_S)

    def session(self) -> list[int]:
        """Return the processes of its session that live."""
        found = []
        for stat in Path("/proc").glob("[0-9]*/stat"):
            with suppress(OSError):
                state, _, _, session = stat.read_text().rpartition(") ")[2].split()[:4]
                if int(session) == self.process.pid and state != "Z":
                    found.append(int(stat.parent.name))
        return found

    def nothing_left(self) -> bool:
        """Tell whether all processes of its session have ended, in good time."""
        return until(lambda: not self.session())

    def kill(self) -> None:
        """End all of its session."""
        for pid in self.session():
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.process.wait()
        self._join()


def until(condition: Callable[[], Any]) -> bool:
    """Wait until a condition on other processes holds; False when it does not in good time."""
    deadline = monotonic() + PATIENCE_S
    pause = Event()
    while not condition():
        if monotonic() > deadline:
            return False
        pause.wait(0.05)
    return True


Start = Callable[..., Command]


@pytest.fixture(name="until")
def given_until() -> Callable[[Callable[[], Any]], bool]:
    """Return what waits until a condition on other processes holds."""
    return until


@contextmanager
def starter() -> Iterator[Start]:
    """Give what starts `hli-bench` (or another program); kill what of it is left over in the end."""
    commands: list[Command] = []

    def started(
        *arguments: str | Path, program: Sequence[str | Path] = (COMMAND,), background: bool = False
    ) -> Command:
        commands.append(Command([*program, *arguments], signal.SIG_IGN if background else signal.SIG_DFL))
        return commands[-1]

    yield started
    for command in commands:
        command.kill()


@pytest.fixture
def start() -> Iterator[Start]:
    """Return what starts a command of this test."""
    with starter() as started:
        yield started


@pytest.fixture
def do(start: Start) -> Callable[..., list[str]]:
    """Return what runs `hli-bench` to its end, which must be a good one, and gives its output."""

    def done(*arguments: str | Path, status: int = 0) -> list[str]:
        command = start(*arguments)
        assert command.end() == status, command.err
        return command.out if status == 0 else command.err

    return done


def free_endpoint() -> str:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return f"tcp/127.0.0.1:{listener.getsockname()[1]}"


@pytest.fixture
def endpoint() -> str:
    """A Zenoh endpoint on a free port of the loopback interface."""
    return free_endpoint()


class Served:
    """A bench that is up, with the face in reach."""

    def __init__(self, start: Start, endpoint: str, *options: str) -> None:
        self._start = start
        self.endpoint = endpoint
        self.command = start("serve", "--zenoh", endpoint, *FACE, *options)
        assert f"is up on {endpoint}" in self.command.line()

    def client(self) -> HliClient:
        return HliClient(self.endpoint)

    def state(self) -> dict[str, Any]:
        with self.client() as client:
            return client.state()

    def plcs(self) -> list[str]:
        return [plc["name"] for plc in self.state()["plcs"]]

    def plc(self, script: str | Path = "demo.py", *options: str) -> Command:
        """Attach a PLC and return when it takes part."""
        before = len(self.plcs())
        command = self._start("plc", script, "--connect", self.endpoint, *options)
        assert until(lambda: len(self.plcs()) > before or command.process.poll() is not None), command.err
        return command

    def run(self, program: Path, *options: str | Path) -> Command:
        return self._start("run", program, "--connect", self.endpoint, *options)

    def running(self) -> bool:
        """Wait until a program runs."""
        return until(lambda: self.state()["state"] == "active")

    def settled(self, condition: Callable[[dict[str, Any]], Any]) -> None:
        """Wait until the state is as it should be."""
        assert until(lambda: condition(self.state())), self.state()


@pytest.fixture
def serve(start: Start, endpoint: str) -> Callable[..., Served]:
    """Return what brings a bench up."""
    return lambda *options: Served(start, endpoint, *options)


@pytest.fixture(scope="module")
def bench() -> Iterator[Served]:
    """A bench in free pace and without a PLC for tests that leave it as it was."""
    with starter() as started:
        yield Served(started, free_endpoint(), "--plc", "none", "--pace", "free")


@pytest.fixture
def program(tmp_path: Path) -> Callable[[str], Path]:
    """Return what writes an NC program."""

    def written(text: str) -> Path:
        path = tmp_path / "short.nc"
        path.write_text(text)
        return path

    return written


@pytest.fixture
def probe(program: Callable[[str], Path]) -> Path:
    """A program that probes the face."""
    return program(PROBE)


@pytest.fixture
def endless(program: Callable[[str], Path]) -> Path:
    """A program that is still running whenever a test does something to it."""
    return program(LONG)


@pytest.fixture
def result(tmp_path: Path) -> Callable[[], dict[str, Any]]:
    """Return what reads the result file `result.json` of the test's folder."""
    return lambda: json.loads((tmp_path / "result.json").read_text())
