"""Processes that belong to a bench: PLC scripts, drives, terminals."""

import contextlib
import os
import socket
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from time import monotonic
from typing import Final, Self

from hli_bench.base.errors import BenchError, EnvironmentLacks
from hli_bench.base.loading import child_command
from hli_bench.base.plain import plain
from hli_bench.shells import plc_process
from hli_bench.shells.pipe import Gone, Pipe

END_S: Final = 5.0
"""Time that a process gets to end by itself."""
ANSWER_S: Final = 30.0
"""Time in which a worker must answer; a cycle takes a millisecond (decided here)."""
SLICE_S: Final = 0.25
"""A worker that has not answered for so long is spoken of, and again whenever so long has passed."""
START_S: Final = 180.0
"""The same for its first answer: it loads the machine and may compile the laws before (decided here)."""


class Deadline:
    """A moment `seconds` from now on."""

    __slots__ = ("_at",)

    def __init__(self, seconds: float) -> None:
        self._at = monotonic() + seconds

    @property
    def over(self) -> bool:
        """The moment has passed."""
        return monotonic() >= self._at


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
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(END_S)


class PlcProcess:
    """A PLC script running as a process of its own, attached to the bench over Zenoh."""

    def __init__(
        self,
        script: Path,
        endpoint: str,
        name: str,
        period_us: int | None = None,
        ends: Callable[[], bool] = lambda: False,
    ) -> None:
        """Start it; `period_us` None: the script's own. `ends` tells whether it is about to end by itself."""
        self._process = plc_process.start(script, endpoint, name, period_us)
        self._script = script
        self._ends = ends

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """End it; one that ends by itself may say why."""
        if self._ends():
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(END_S)
        _end(self._process)

    def check(self) -> None:
        """Raise BenchError when the process has ended."""
        status = self._process.poll()
        if status is not None:
            raise BenchError(f"the PLC process of {self._script} has ended with status {status}")


class Worker:
    """A Python module running as a process of its own, with a pipe to it. It ends with its pipe.

    It has a process group of its own: Ctrl-C is for the process that started it.
    """

    def __init__(self, module: str, arguments: Sequence[str], answer_s: float = ANSWER_S) -> None:
        """Start it; it must answer within `answer_s`, the first time within START_S."""
        ours, theirs = socket.socketpair()
        command = child_command(module, str(theirs.fileno()), *arguments)
        self._process = subprocess.Popen(
            command, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL, process_group=0
        )
        theirs.close()
        self.pipe = Pipe(ours)
        self.pipe.limit(START_S)
        self._name = module
        self._answer_s = answer_s
        self._started = False
        self._silent_s = 0.0
        self.on_silence: Callable[[], None] = lambda: None
        """Called again and again while an answer is waited for that does not come."""

    @property
    def condition(self) -> str:
        """What a look at the process shows: running, stopped, silent for some time, or ended."""
        status = self._process.poll()
        if status is not None:
            return f"ended with status {status}"
        if _stopped(self._process.pid):
            return "stopped"
        return f"silent for {self._silent_s:g} s" if self._silent_s else "running"

    def ask(self, message: bytes) -> bytes:
        """Send a message and wait for the answer. Raises BenchError when the process has ended or is stuck.

        What it ended of stands on standard error; when that was bad input the error says so by its exit status.
        """
        self.tell(message)
        return self.answer()

    def tell(self, message: bytes) -> None:
        """Send a message; `answer` takes the answer later. Raises as `ask` does."""
        try:
            self.pipe.send(message)
        except (Gone, TimeoutError) as error:
            raise self._failure(error) from error

    def answer(self) -> bytes:
        """Wait for the answer to what was told. Raises as `ask` does."""
        try:
            message = self.pipe.receive()
        except TimeoutError as error:
            message = self._late_answer(error)
        except EOFError as error:
            raise self._failure(error) from error
        if not self._started:
            self._started = True
            self.pipe.limit(min(self._answer_s, SLICE_S))
        return message

    def _late_answer(self, error: TimeoutError) -> bytes:
        """Wait on, with the bench being told of it; also `tell` waits as long as an answer may take."""
        slices = round(self._answer_s / SLICE_S) if self._started else 0
        self.pipe.limit(SLICE_S)
        try:
            for number in range(1, slices):
                self._silent_s = number * SLICE_S
                self.on_silence()
                try:
                    return self.pipe.receive()
                except TimeoutError:
                    continue
                except EOFError as gone:
                    raise self._failure(gone) from gone
            raise self._failure(error) from error
        finally:
            self._silent_s = 0.0

    def _failure(self, error: Exception) -> BenchError:
        """Return what has become of the process."""
        if isinstance(error, TimeoutError):
            return EnvironmentLacks(f"process {self._name} does not answer: it is stuck or stopped")
        try:
            status = self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            return EnvironmentLacks(f"process {self._name} has closed its pipe and does not end")
        kind = BenchError if status == BenchError.exit_status else EnvironmentLacks
        return kind(f"process {self._name} has ended with status {status}")

    def close(self) -> None:
        """End the process."""
        self.pipe.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(END_S)
        _end(self._process)


def _stopped(pid: int) -> bool:
    """Tell whether a process is stopped by a signal or a debugger; False where the system does not say so."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return stat.rpartition(") ")[2][:1] in ("T", "t")


def work(main: Callable[[Pipe, Sequence[str]], None], arguments: Sequence[str]) -> int:
    """Run the main function of a worker with its pipe and the rest of its arguments; return the exit status.

    When the bench closes the pipe while an answer is on its way, that is the regular end as well.
    """
    descriptor = int(arguments[0])
    os.set_inheritable(descriptor, False)
    try:
        with contextlib.closing(Pipe(socket.socket(fileno=descriptor))) as pipe:
            main(pipe, arguments[1:])
    except Gone:
        return 0
    except BenchError as error:
        sys.stderr.write(f"{plain(error)}\n")
        return error.exit_status
    return 0
