"""Lock-step with a PLC process over Zenoh against a bare ping-pong of two processes over Zenoh.

The bench: free pace, 3 axes, probing, a PLC task in every cycle of 1 ms in a process of its own. The reference passes
messages of the same sizes, image there and eight bytes back, between the same kinds of sessions opened and received
from as the bench receives, and does nothing with them. Ratio of round trips a second, in alternating turns of one run.
"""

import argparse
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import zenoh
from _side_by_side import Work, in_turns, print_table, rate_ratio

from hli_bench import Bench
from hli_bench.base import garbage
from hli_bench.protocols.hli.packing import IMAGE_HEADER
from hli_bench.shells.processes import free_endpoint
from hli_bench.shells.zenoh_session import connect, listen, payload, queued

MACHINE = Path(__file__).parent / "machines" / "three_axes"
SETTINGS = {
    "plant.probe.Z.face_mm": 250.0,
    "plant.probe.Z.material": "below",
    "terminal.probe.model": "EL1252",
    "terminal.probe.wiring.ch2": "probe",
    "plc": [{"script": "probing.py", "period_us": 1000, "process": True}],
}
PROBES = 3
ROUND_TRIPS = 5000
UNWRITTEN = bytes(8)
"""A commands message in which nothing is written: what a PLC answers in nearly all cycles."""


def program() -> str:
    """Probe the same face again and again, moving in between."""
    lines = ["%lockstep", "N10 G90 G01 Z300 F6000"]
    for _ in range(PROBES):
        lines += ["G100 Z240 F2000", "G01 Z300 F6000", "G01 X10 Y5 F6000", "G01 X0 Y0 F6000"]
    return "\n".join([*lines, "M30"])


def lockstep(bench: Bench) -> float:
    """Run the program; return its cycles."""
    result = bench.run(program())
    assert result.completed, result.errors
    assert len(result.measurements) == PROBES
    return result.cycles


def exchange(session: Any, there: str, back: str) -> tuple[Callable[[bytes], None], Callable[[], bytes]]:
    """Return what puts a message in `there`, and what waits for one in `back`."""
    inbox: SimpleQueue[tuple[str, Any]] = SimpleQueue()
    session.declare_subscriber(back, queued(inbox.put, back))
    publisher = session.declare_publisher(
        there, express=True, congestion_control=zenoh.CongestionControl.DROP
    )
    return publisher.put, lambda: payload(inbox.get()[1])


def echo(endpoint: str) -> None:
    """Answer every image, until an empty one comes."""
    with connect(endpoint) as session:
        put, receive = exchange(session, "bare/commands", "bare/image")
        put(UNWRITTEN)
        while receive():
            put(UNWRITTEN)


@contextmanager
def ping_pong(image: bytes) -> Iterator[Work]:
    """Two processes that do nothing but exchange messages."""
    endpoint = free_endpoint()
    with listen(endpoint) as session:
        put, receive = exchange(session, "bare/image", "bare/commands")
        with subprocess.Popen([sys.executable, __file__, "--echo", endpoint]):
            receive()

            def work() -> float:
                for _ in range(ROUND_TRIPS):
                    put(image)
                    receive()
                return ROUND_TRIPS

            yield work
            put(b"")


def main() -> None:
    """Measure both in turns."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--turns", type=int, default=9)
    parser.add_argument("--echo", metavar="ENDPOINT", help="be the other process of the ping-pong")
    arguments = parser.parse_args()
    if arguments.echo:
        echo(arguments.echo)
        return
    garbage.seldom()  # as the command line does
    with Bench(MACHINE, SETTINGS) as bench:
        bench.start_up()
        image = bytes(IMAGE_HEADER.size + bench.kernel.image.layout.size)
        with ping_pong(image) as bare:
            ways = in_turns({"lock-step": lambda: lockstep(bench), "ping-pong": bare}, arguments.turns)
    reference = ways["ping-pong"]
    rows = [
        (name, f"{one.rate:.0f}", f"{one.best:.0f}", f"{rate_ratio(one, reference):.2f}")
        for name, one in ways.items()
    ]
    title = f"lock-step over Zenoh, image of {len(image)} bytes; {arguments.turns} turns"
    print_table(title, ("", "cycles/s", "best turn", "against ping-pong"), rows)


if __name__ == "__main__":
    main()
