"""A PLC script as a process of its own, attached to a bench over Zenoh.

`python -m hli_bench.shells.plc_process SCRIPT ENDPOINT [NAME [PERIOD_US]]`; `start` runs that.
"""

import json
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Any, Final

import zenoh

from hli_bench.base import garbage
from hli_bench.base.endpoints import check_key
from hli_bench.base.errors import BenchError, InputError
from hli_bench.base.loading import child_command
from hli_bench.base.plain import plain
from hli_bench.plc import Task, load, period_of
from hli_bench.protocols.hli.packing import CommandsPacking, unpack_image
from hli_bench.shells.zenoh_client import HliClient, Terms
from hli_bench.shells.zenoh_session import PLC_LEASE_MS, on_network_thread, payload

RECONNECT_S: Final = 2.0
"""How long a PLC waits for a bench that vanished before it ends; a link comes back in 0.2 s."""
LOOK_S: Final = 0.02
WAITING: Final = 100_000
"""Messages that may wait for a script that dawdles in real pace; with more of them its link to the bench stands."""
MOST_LINES: Final = 1000
"""So many lines are told; whoever puts to the bench's keys could make ever new ones."""

DETACHED: Final = b"detached"
GONE: Final = b"gone"
HERE: Final = b"here"
"""News that the session puts to itself, so that they wait in one queue with the images that came before them."""


class _Turn:
    """A task's part of the exchange: the image of a cycle in, the commands that answer it out.

    Due are the images from cycle `first` on whose cycle `period` divides; the bench puts others too.
    """

    __slots__ = ("_first", "_pack", "_period", "_put", "_size", "_task")

    def __init__(
        self, task: Task, packing: CommandsPacking, put: Callable[[bytes], None], terms: Terms, size: int
    ) -> None:
        """`size` is that of the elements in an image."""
        self._size = size
        self._task = task
        self._pack = packing.pack
        self._put = put
        self._first = terms.cycle
        self._period = terms.period_us // terms.cycle_us

    def due(self, message: bytes) -> bool:
        """Tell whether the task runs on an image. Raises InputError for one of a wrong size."""
        cycle, _, _ = unpack_image(message, self._size)
        return cycle >= self._first and cycle % self._period == 0

    def answer(self, message: bytes, io: Mapping[str, bytes]) -> None:
        """Run the task on an image that is due, and put what it writes."""
        cycle, dc_ns, elements = unpack_image(message, self._size)
        self._put(self._pack(self._task.step(cycle, dc_ns, elements, io)))


class ScriptClient:
    """A task with its session: takes images off the net, puts commands. `period_us` None: the script's own.

    `on_line` gets a line for people whenever the script takes part, when the bench refuses what it writes (once for
    each reason), and when the bench has ended.
    """

    def __init__(
        self,
        client: HliClient,
        script: Path,
        name: str,
        period_us: int | None = None,
        on_line: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._client = client
        self._script = script
        self._name = name
        self._period_us = period_us
        self._on_line = on_line
        self._key = f"{client.machine}/plc/{name}"
        self._image_key = f"{client.machine}/hli/image"
        self._terminal_keys = f"{client.machine}/io/"
        self._errors_key = f"{client.machine}/hli/errors"
        self._told: set[str] = set()
        """Reasons for refusals, and other lines, that people know."""
        self._packing = CommandsPacking(client.layout)
        self._io: dict[str, bytes] = {}
        self._sizes = {terminal.name: terminal.size for terminal in client.terminals}
        # One queue that Zenoh fills without Python's lock, so that the script has the thread that Ctrl-C interrupts to
        # itself. A Python queue that a callback fills would take a quarter of the lock-step cycles.
        self._inbox: Any = client.session.declare_subscriber(
            f"{client.machine}/*/*", zenoh.handlers.FifoChannel(WAITING)
        )

    def run(self) -> None:
        """Attach and run until the bench ends. Raises InputError when the script fails or is refused."""
        session = self._client.session
        token = session.liveliness().declare_token(f"{self._key}/alive")
        news = session.declare_publisher(self._key, allowed_destination=zenoh.Locality.SESSION_LOCAL)
        session.declare_subscriber(f"{self._key}/detached", on_network_thread(lambda _: news.put(DETACHED)))
        session.liveliness().declare_subscriber(
            f"{self._client.machine}/bench/alive",
            on_network_thread(
                lambda sample: news.put(GONE if sample.kind == zenoh.SampleKind.DELETE else HERE)
            ),
            history=True,
        )
        try:
            while self._attached():
                pass
            self._on_line(f"the bench at {self._client.endpoint} has ended")
        finally:
            token.undeclare()

    def _attached(self) -> bool:
        """Take part with a fresh task until the bench lets go of it (True) or ends (False)."""
        client = self._client
        script = load(self._script)
        period_us = self._period_us or period_of(script, self._script)
        task = Task(self._name, script, period_us, client.layout, client.terminals)
        for terminal in client.terminals:
            self._keep(terminal.name, client.ask_packed(f"io/{terminal.name}"))
        terms = client.attach(self._name, period_us)
        self._on_line(
            f"{self._name} is attached to {client.machine} at {client.endpoint}, every {terms.period_us} us"
        )
        publisher = client.session.declare_publisher(f"{self._key}/commands", express=True)
        turn = _Turn(task, self._packing, publisher.put, terms, client.layout.size)
        try:
            return self._in_lock_step(turn) if terms.lockstep else self._as_images_come(turn)
        finally:
            publisher.undeclare()

    def _in_lock_step(self, turn: _Turn) -> bool:
        """Answer every image as it comes."""
        while True:
            sample = self._inbox.recv()
            key = str(sample.key_expr)
            if key == self._image_key:
                if self._due(turn, image := payload(sample)):
                    turn.answer(image, self._io)
            elif (ended := self._end(key, sample)) is not None:
                return ended

    def _as_images_come(self, turn: _Turn) -> bool:
        """Answer the newest image each time, with the terminals as of then; the others are left out."""
        newest: tuple[bytes, dict[str, bytes]] | None = None
        while True:
            sample = self._inbox.recv() if newest is None else self._inbox.try_recv()
            if sample is None and newest is not None:
                turn.answer(*newest)
                newest = None
                continue
            key = str(sample.key_expr)
            if key == self._image_key:
                image = payload(sample)
                newest = (image, dict(self._io)) if self._due(turn, image) else newest
            elif (ended := self._end(key, sample)) is not None:
                return ended

    def _end(self, key: str, sample: zenoh.Sample) -> bool | None:
        """Keep a terminal; return whether to attach anew when a sample ends this, None for one that does not."""
        if key.startswith(self._terminal_keys):
            self._keep(key.removeprefix(self._terminal_keys), payload(sample))
        elif key == self._errors_key:
            self._tell(payload(sample))
        elif key == self._key:
            news = payload(sample)
            if news == DETACHED:
                return True
            if news == GONE:
                return self._bench_is_back()
        return None

    def _due(self, turn: _Turn, image: bytes) -> bool:
        """Tell whether the task runs on an image; one of a wrong size comes from somebody else and is left out."""
        try:
            return turn.due(image)
        except InputError as error:
            self._say(f"left out: hli/image: {error.message}")
            return False

    def _keep(self, terminal: str, data: bytes) -> None:
        """Keep a terminal's image, unless somebody else has put something of a wrong size there."""
        size = self._sizes.get(terminal)
        if len(data) == size:
            self._io[terminal] = data
        elif size is not None:
            self._say(f"left out: io/{terminal}: {len(data)} bytes, {size} expected")

    def _tell(self, record: bytes) -> None:
        """Tell people why a write of this PLC counts for nothing."""
        with suppress(ValueError, RecursionError):
            match json.loads(record):
                case {"writer": self._name, "path": str(path), "reason": str(reason)}:
                    self._say(f"refused: {path}: {reason}", reason)
                case _:
                    pass

    def _say(self, line: str, once: str = "") -> None:
        """Tell people something, once."""
        if (once or line) not in self._told and len(self._told) < MOST_LINES:
            self._told.add(once or line)
            self._on_line(line)

    def _bench_is_back(self) -> bool:
        """Tell whether a bench that went away shows up again: then only the link broke, e.g. of a frozen PLC."""
        deadline = monotonic() + RECONNECT_S
        while monotonic() < deadline:
            sample = self._inbox.try_recv()
            if sample is None:
                sleep(LOOK_S)
            elif str(sample.key_expr) == self._key and payload(sample) == HERE:
                return True
        return False


def attach(
    script: Path,
    endpoint: str,
    machine: str = "",
    name: str = "",
    period_us: int | None = None,
    on_line: Callable[[str], None] = lambda _: None,
) -> None:
    """Attach a script to the bench at `endpoint` and run it until the bench ends.

    `name` is by default the file's, `period_us` the script's own; `on_line` gets lines for people.

    Raises EnvironmentLacks when no bench is there, InputError when the script fails or the bench refuses it.
    """
    name = name or script.stem
    check_key(name, "a PLC", str(script))
    load(script)
    with HliClient(endpoint, machine, PLC_LEASE_MS) as client:
        ScriptClient(client, script, name, period_us, on_line).run()


def start(
    script: Path, endpoint: str, name: str = "", period_us: int | None = None
) -> "subprocess.Popen[bytes]":
    """Start `attach` as a process; errors go to its standard error, exit status as of the command line.

    It has a process group of its own: Ctrl-C is for the process that starts it and ends it.
    """
    arguments = [str(script), endpoint, name, *([] if period_us is None else [str(period_us)])]
    command = child_command("hli_bench.shells.plc_process", *arguments)
    return subprocess.Popen(command, process_group=0)


def main(arguments: Sequence[str]) -> int:
    """Run `attach` from the command line; return the exit status."""
    try:
        script, endpoint, name, period = (*arguments, *("", "")[: 4 - len(arguments)])
        period_us = int(period) if period else None
    except ValueError:
        sys.stderr.write("SCRIPT ENDPOINT [NAME [PERIOD_US]] expected, the period a whole number\n")
        return 2
    garbage.seldom()
    try:
        attach(Path(script), endpoint, name=name, period_us=period_us)
    except KeyboardInterrupt:
        return 0
    except BenchError as error:
        sys.stderr.write(f"{plain(error)}\n")
        return error.exit_status
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
