"""A PLC script as a process of its own, attached to a bench over Zenoh.

`python -m hli_bench.shells.plc_process SCRIPT ENDPOINT [NAME [PERIOD_US]]`; `start` runs that.
"""

import json
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Lock
from time import monotonic
from typing import Any, Final

import zenoh

from hli_bench.base import garbage
from hli_bench.base.errors import BenchError
from hli_bench.plc import Task, load
from hli_bench.protocols.hli.packing import CommandsPacking, unpack_image
from hli_bench.shells.zenoh_client import HliClient
from hli_bench.shells.zenoh_session import on_network_thread, payload, queued

RECONNECT_S: Final = 2.0
"""How long a PLC waits for a bench that vanished before it ends; a link comes back in 0.2 s."""


class _Turn:
    """A task's part of the exchange: the image of a cycle in, the commands that answer it out.

    Due are the images from cycle `first` on whose cycle `period` divides; the bench puts others too.
    """

    __slots__ = ("_first", "_pack", "_period", "_put", "_task")

    def __init__(
        self, task: Task, packing: CommandsPacking, put: Callable[[bytes], None], first: int, period: int
    ) -> None:
        self._task = task
        self._pack = packing.pack
        self._put = put
        self._first = first
        self._period = period

    def due(self, cycle: int) -> bool:
        """Tell whether the task runs on the image of a cycle."""
        return cycle >= self._first and cycle % self._period == 0

    def answer(self, message: bytes, io: Mapping[str, bytes]) -> None:
        """Run the task on an image if it is due, and put what it writes."""
        cycle, dc_ns, elements = unpack_image(message)
        if self.due(cycle):
            self._put(self._pack(self._task.step(cycle, dc_ns, elements, io)))


class ScriptClient:
    """A task with its session: takes images off the net, puts commands. `period_us` None: the script's own.

    `on_line` gets a line for people whenever the script takes part, and when the bench has ended.
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
        self._packing = CommandsPacking(client.layout)
        self._inbox: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        self._io: dict[str, bytes] = {}
        self._lock = Lock()
        self._turn: _Turn | None = None
        """In lock-step: what answers an image on the network thread, without waking this one."""

    def run(self) -> None:
        """Attach and run until the bench ends. Raises InputError when the script fails or is refused."""
        session, machine = self._client.session, self._client.machine
        token = session.liveliness().declare_token(f"{self._key}/alive")
        for key, kind in ((f"{machine}/io/*", "io"), (f"{machine}/hli/image", "image")):
            session.declare_subscriber(key, on_network_thread(partial(self._arrived, kind)))
        session.declare_subscriber(f"{self._key}/detached", queued(self._inbox.put, "detached"))
        session.liveliness().declare_subscriber(
            f"{machine}/bench/alive", queued(self._inbox.put, "alive"), history=True
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
        period_us = script.period_us if self._period_us is None else self._period_us
        task = Task(self._name, script, period_us, client.layout, client.terminals)
        for terminal in client.terminals:
            self._io[terminal.name] = client.ask_packed(f"io/{terminal.name}")
        terms = json.loads(
            client.ask_packed(f"plc/{self._name}/attach", json.dumps({"period_us": period_us}))
        )
        self._on_line(
            f"{self._name} is attached to {client.machine} at {client.endpoint}, every {terms['period_us']} us"
        )
        publisher = client.session.declare_publisher(f"{self._key}/commands", express=True)
        period = terms["period_us"] // terms["cycle_us"]
        turn = _Turn(task, self._packing, publisher.put, terms["cycle"], period)
        try:
            return self._in_lock_step(turn) if terms["lockstep"] else self._as_images_come(turn)
        finally:
            publisher.undeclare()

    def _arrived(self, kind: str, sample: zenoh.Sample) -> None:
        """Take an image or a terminal on the network thread: act in lock-step, else leave it to `run`."""
        with self._lock:
            if self._turn is None:
                self._inbox.put((kind, sample))
                return
            try:
                self._take(self._turn, kind, sample)
            except BaseException as error:
                self._turn = None
                self._inbox.put(("failed", error))

    def _take(self, turn: "_Turn", kind: str, sample: zenoh.Sample) -> None:
        """Keep a terminal, answer an image."""
        if kind == "image":
            turn.answer(payload(sample), self._io)
        else:
            self._keep(sample)

    def _keep(self, sample: zenoh.Sample) -> None:
        self._io[str(sample.key_expr).rpartition("/")[2]] = payload(sample)

    def _in_lock_step(self, turn: "_Turn") -> bool:
        """Let every image be answered as it comes; wait for what ends that."""
        ended: bool | None = None
        with self._lock:
            while not self._inbox.empty():
                kind, message = self._inbox.get()
                if kind in ("image", "io"):
                    self._take(turn, kind, message)
                else:
                    ended = self._end(kind, message) if ended is None else ended
            self._turn = turn if ended is None else None
        while ended is None:
            ended = self._end(*self._inbox.get())
        with self._lock:
            self._turn = None
        return ended

    def _as_images_come(self, turn: "_Turn") -> bool:
        """Answer the newest image each time, with the terminals as of then; the others are left out."""
        newest: tuple[bytes, dict[str, bytes]] | None = None
        while True:
            if newest is not None and self._inbox.empty():
                turn.answer(*newest)
                newest = None
            kind, message = self._inbox.get()
            if kind == "io":
                self._keep(message)
            elif kind == "image":
                image = payload(message)
                newest = (image, dict(self._io)) if turn.due(unpack_image(image)[0]) else newest
            elif (ended := self._end(kind, message)) is not None:
                return ended

    def _end(self, kind: str, message: Any) -> bool | None:
        """Return whether to attach anew when a message ends this, None for one that does not."""
        if kind == "failed":
            raise message
        if kind == "detached":
            return True
        if message.kind == zenoh.SampleKind.DELETE:
            return self._bench_is_back()
        return None

    def _bench_is_back(self) -> bool:
        """Tell whether a bench that went away shows up again: then only the link broke, e.g. of a frozen PLC."""
        deadline = monotonic() + RECONNECT_S
        while (remaining := deadline - monotonic()) > 0:
            try:
                kind, sample = self._inbox.get(timeout=remaining)
            except Empty:
                break
            if kind == "alive" and sample.kind == zenoh.SampleKind.PUT:
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
    load(script)
    with HliClient(endpoint, machine) as client:
        ScriptClient(client, script, name or script.stem, period_us, on_line).run()


def start(
    script: Path, endpoint: str, name: str = "", period_us: int | None = None
) -> "subprocess.Popen[bytes]":
    """Start `attach` as a process; errors go to its standard error, exit status as of the command line.

    It has a process group of its own: Ctrl-C is for the process that starts it and ends it.
    """
    arguments = [str(script), endpoint, name, *([] if period_us is None else [str(period_us)])]
    command = [sys.executable, "-m", "hli_bench.shells.plc_process", *arguments]
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
        sys.stderr.write(f"{error}\n")
        return error.exit_status
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
