"""CANopen on the in-process bus with every frame logged: probing with DRIVE latch, three drives, 1 ms cycle.

Reach: 20 times real time with the log. Beside it the same run without a log, with every frame made a message for
a listener, and with real frames through every drive in every cycle, as a bus between processes has it.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from _side_by_side import Timing, in_turns, print_table, rate_ratio

from hli_bench import Bench
from hli_bench.laws.rows import LOG_CYCLES
from hli_bench.runtime.frames import Beside, BusOrder, CycleBuffer
from hli_bench.shells.candump import CandumpLog
from hli_bench.wire.can import CanFrame

MACHINE = Path(__file__).parent / "machines" / "three_axes"
SETTINGS = {"axis.Z.kenngr.measure.signal": "DRIVE"}
PROBES = 10
PROGRAM = "\n".join(["G90 G01 Z110 F20000", *["G100 Z90 F300\nG01 Z110 F6000"] * PROBES, "M30"])
SHORT = "\n".join(["G90 G01 Z110 F20000", "G100 Z90 F300\nG01 Z110 F6000", "M30"])
TURNS = 5


def run(program: str, observer: Any = None, *, singly: bool = False) -> float:
    """Run on a new bench and return its machine time in s."""
    with Bench(MACHINE, SETTINGS, plc=[]) as bench:
        if singly:
            bench.engine.link.quiet = lambda _: 0
        attached = observer(bench) if observer is not None else None
        if attached is not None:
            bench.engine.observers.append(attached)
        result = bench.run(program)
        assert result.completed
        if attached is not None:
            attached.close()
    return result.sim_s


class Messages:
    """Observer that makes every frame of the bus a message."""

    def __init__(self, bench: Bench) -> None:
        self._order = BusOrder([axis.node for axis in bench.kernel.setup.axes])
        self._buffer = CycleBuffer(bench.kernel.rows.log)
        self._others: dict[int, list[CanFrame]] = {}
        self.count = 0

    def cycles(self, first: int, count: int) -> None:
        self._buffer.add(first, count)
        if self._buffer.count >= LOG_CYCLES:
            self.close()

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        self._others.setdefault(cycle, []).extend(frames)

    def edges(self, edges: object) -> None: ...

    def emitted(self, cycle: int, records: object) -> None: ...

    def commands(self, commands: object) -> None: ...

    def refused(self, cycle: int, refusals: object) -> None: ...

    def close(self) -> None:
        first, others = self._buffer.first, self._others
        self._others = {}
        for part in self._order.parts(first, self._buffer.take(self._buffer.count), others):
            if isinstance(part, Beside):
                self.count += len(part.frames)
                continue
            columns = [[CanFrame(0x80)] * len(part.rows)] if part.sync else []
            for telegram in part.telegrams:
                payload = telegram.payload(part.rows)
                data, length = payload.tobytes(), payload.shape[1]
                columns.append(
                    [CanFrame(telegram.cob_id, data[at : at + length]) for at in range(0, len(data), length)]
                )
            self.count += sum(1 for cycle in zip(*columns, strict=True) for _ in cycle)


def main() -> None:
    """Measure in turns and print the ratios."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "can.log"
        timings = in_turns(
            {
                "no log": lambda: run(PROGRAM),
                "every frame in a candump log": lambda: run(PROGRAM, lambda bench: _candump(bench, log)),
                "every frame a message to a listener": lambda: run(PROGRAM, Messages),
                "real frames through every drive, logged": lambda: run(
                    SHORT, lambda bench: _candump(bench, log), singly=True
                ),
            },
            TURNS,
        )
    plain = timings["no log"]
    print_table(
        f"CANopen, 3 drives, in-process bus, {plain.work:.0f} s of probing, median of {TURNS} turns",
        ("way", "x real time", "best", "against no log"),
        [(name, *_row(one, plain)) for name, one in timings.items()],
    )


def _candump(bench: Bench, path: Path) -> CandumpLog:
    return CandumpLog(path, bench.kernel.setup, bench.kernel.rows.log)


def _row(one: Timing, plain: Timing) -> tuple[str, str, str]:
    return f"{one.rate:.0f}", f"{one.best:.0f}", f"{rate_ratio(one, plain):.3f}"


if __name__ == "__main__":
    main()
