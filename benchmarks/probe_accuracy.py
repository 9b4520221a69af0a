"""How far the measured value of a face is off, by probing source and feed: the table of docs/performance.md.

    .venv/bin/python benchmarks/probe_accuracy.py [FACES]

Each row measures FACES (default 50) random faces over the whole way: plant edge, EL1252 or drive, PLC script,
HLI, kernel. The last column is what a controller without any latch must show that samples probe and position
once in its cycle of 1 ms: uniform from 0 to feed x 1 ms. All times are virtual, so the numbers repeat to the bit.
"""

import math
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hli_bench import Bench

FEEDS = (100, 500, 2000, 6000)
PITCH_MM = 10.0
CYCLE_MS = 1.0
Z = 2
APPROACH_MM = {100: 0.3, 500: 0.5, 2000: 2.0, 6000: 6.0}
SCRIPT = '''
from hli_bench.plc import Plc


class Forward(Plc):
    """EL1252 channel 2 to axis 3."""

    period_us = {period_us}

    def start(self, hli, io):
        axis = hli.ax[3]
        axis.head.plc_present_w = True
        axis.lr_mc_control.probing_signal.enable_w = True
        axis.lr_mc_control.timestamp.enable_w = True

    def cycle(self, hli, io):
        axis = hli.ax[3].lr_mc_control
        axis.probing_signal.command_w = io.probe.ch2.input
        axis.timestamp.command_w = io.probe.ch2.latch_pos
'''


@dataclass(frozen=True)
class Row:
    """One way of measuring."""

    name: str
    signal: str
    plc_ms: int


ROWS = (
    Row("PLC_TIMESTAMP, PLC every 1 ms", "PLC_TIMESTAMP", 1),
    Row("PLC_TIMESTAMP, PLC every 4 ms", "PLC_TIMESTAMP", 4),
    Row("DRIVE", "DRIVE", 1),
    Row("PLC, PLC every 1 ms", "PLC", 1),
    Row("PLC, PLC every 4 ms", "PLC", 4),
)


def faces(bench: Bench, count: int, seed: int) -> Iterator[float]:
    """Put the workpiece to random places over 0.1 mm more than a cycle's way, one after the other."""
    (face,) = [row for row in bench.engine.link.rows.switch if row["axis"] == Z and row["signal"] == 0]
    for place in np.random.default_rng(seed).uniform(12.2, 12.8, count):
        face["high"] = place / (PITCH_MM / math.tau)
        yield float(place)


def deviations(row: Row, feed: int, count: int) -> list[float]:
    """Return face minus measured value in um, in the direction of travel."""
    settings = {
        "plant.probe.Z.face_mm": 12.5,
        "plant.probe.Z.material": "below",
        "axis.Z.start_mm": 20.0,
        "axis.Z.kenngr.measure.signal": row.signal,
    }
    way = APPROACH_MM[feed]
    program = f"%p\nG00 Z{12.8 + way}\nG100 Z{12.2 - way} F{feed}\nG00 Z{12.8 + way}\nM30\n"
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "forward.py"
        script.write_text(SCRIPT.format(period_us=1000 * row.plc_ms))
        with Bench("demo", settings, plc=[script]) as bench:
            bench.start_up()
            return [
                (place - bench.run(program).measurements[0].acs_mm) * 1000.0
                for place in faces(bench, count, seed=feed)
            ]


def cell(values: Sequence[float]) -> str:
    """Return mean and range in um."""
    if max(abs(value) for value in values) < 1.0:
        return f"at most {max(abs(value) for value in values):.2f}"
    return f"{np.mean(values):.1f} ({min(values):.1f} to {max(values):.1f})"


def main() -> None:
    """Print the table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    print("| source | " + " | ".join(f"F{feed}" for feed in FEEDS) + " |")
    print("|---|" + "---|" * len(FEEDS))
    for row in ROWS:
        cells = [cell(deviations(row, feed, count)) for feed in FEEDS]
        print(f"| {row.name} | " + " | ".join(cells) + " |", flush=True)
    print("| *(cycle, cycle + 1 ms] x feed* | " + " | ".join(_span(feed, 1.0, 2.0) for feed in FEEDS) + " |")
    print("| *(cycle, cycle + 4 ms] x feed* | " + " | ".join(_span(feed, 1.0, 5.0) for feed in FEEDS) + " |")
    print("| *sampling once in 1 ms* | " + " | ".join(_span(feed, 0.0, 1.0) for feed in FEEDS) + " |")


def _span(feed: int, low_ms: float, high_ms: float) -> str:
    """Return mean and range of what is spread evenly between two delays, um."""
    per_ms = feed / 60.0
    middle = (low_ms + high_ms) / 2.0
    return f"*{per_ms * middle:.1f} ({per_ms * low_ms:.1f} to {per_ms * high_ms:.1f})*"


if __name__ == "__main__":
    main()
