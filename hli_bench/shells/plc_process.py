"""A PLC script as a process of its own, attached to a bench over Zenoh.

`python -m hli_bench.shells.plc_process SCRIPT ENDPOINT [NAME [PERIOD_US]]`; `start` runs that.
"""

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any, Final

import zenoh

from hli_bench.base.errors import BenchError
from hli_bench.base.time import Ns
from hli_bench.plc import Task, load
from hli_bench.protocols.hli.packing import CommandsPacking, unpack_image
from hli_bench.shells.zenoh_client import HliClient
from hli_bench.shells.zenoh_session import payload, queued

RECONNECT_S: Final = 2.0
"""How long a PLC waits for a bench that vanished before it ends; a link comes back in 0.2 s."""


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

    def run(self) -> None:
        """Attach and run until the bench ends. Raises InputError when the script fails or is refused."""
        session, machine = self._client.session, self._client.machine
        token = session.liveliness().declare_token(f"{self._key}/alive")
        for key, kind in (
            (f"{machine}/io/*", "io"),
            (f"{machine}/hli/image", "image"),
            (f"{self._key}/detached", "detached"),
        ):
            session.declare_subscriber(key, queued(self._inbox.put, kind))
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
        first, period = terms["cycle"], terms["period_us"] // terms["cycle_us"]
        self._on_line(
            f"{self._name} is attached to {client.machine} at {client.endpoint}, every {terms['period_us']} us"
        )
        publisher = client.session.declare_publisher(f"{self._key}/commands", express=True)
        while True:
            image = self._next_image(first, period)
            if isinstance(image, bool):
                publisher.undeclare()
                return image
            cycle, dc_ns, elements, io = image
            commands = task.step(cycle, dc_ns, elements, io)
            publisher.put(self._packing.pack(commands))

    def _next_image(self, first: int, period: int) -> tuple[int, Ns, bytes, dict[str, bytes]] | bool:
        """Return the newest image that is due with the terminals as of then, or the answer of `_attached`.

        Due are the images from `first` on whose cycle `period` divides; the bench puts others too.
        """
        image: tuple[int, Ns, bytes, dict[str, bytes]] | None = None
        while image is None or not self._inbox.empty():
            kind, sample = self._inbox.get()
            if kind == "image":
                cycle, dc_ns, elements = unpack_image(payload(sample))
                if cycle >= first and cycle % period == 0:
                    image = cycle, dc_ns, elements, dict(self._io)
            elif kind == "io":
                self._io[str(sample.key_expr).rpartition("/")[2]] = payload(sample)
            elif kind == "detached":
                return True
            elif sample.kind == zenoh.SampleKind.DELETE:
                return self._bench_is_back()
        return image

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
