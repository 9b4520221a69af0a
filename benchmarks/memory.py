"""Memory of a long run with a trace against a short one: 1 h of machine time against 1 min. Reach: at most 1.1.

Each run is a command of its own; its peak is what the operating system counted for it.
"""

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from _side_by_side import print_table

MACHINE = Path(__file__).parent / "machines" / "three_axes"
TURNS = 3
MINUTE = "G01 X40 Y20 F2000\nG04 50\nG01 X0 Y0 F2000\nG04 7\n"
"""About a minute of motion and dwell."""


def measure(folder: Path, minutes: int) -> tuple[float, float, float]:
    """Run so many minutes with a trace; return peak memory in MB, size of the trace in MB, seconds."""
    program, trace = folder / f"run{minutes}.nc", folder / "run.mcap"
    program.write_text("G90\n" + MINUTE * minutes + "M30\n")
    command = [sys.executable, "-m", "hli_bench.cli.main", "run", str(program)]
    command += ["--machine", str(MACHINE), "--plc", "none", "--trace", str(trace)]
    begin = time.perf_counter()
    with (folder / "said.txt").open("wb") as said:
        process = os.posix_spawn(
            sys.executable,
            command,
            os.environ,
            file_actions=[(os.POSIX_SPAWN_DUP2, said.fileno(), 2)],
        )
        _, status, usage = os.wait4(process, 0)
    assert status == 0, (folder / "said.txt").read_text()
    print((folder / "said.txt").read_text().strip())
    return usage.ru_maxrss / 1024, trace.stat().st_size / 1e6, time.perf_counter() - begin


def main() -> None:
    """Measure both in turns and print the ratio."""
    turns: dict[int, list[tuple[float, float, float]]] = {1: [], 60: []}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(TURNS):
            for minutes, found in turns.items():
                found.append(measure(Path(folder), minutes))
    medians = {
        minutes: [statistics.median(column) for column in zip(*found, strict=True)]
        for minutes, found in turns.items()
    }
    print_table(
        f"run --trace, 3 axes, cycle 1 ms, median of {TURNS} turns",
        ("machine time", "peak memory", "trace", "wall"),
        [
            (f"{minutes} min", f"{peak:.1f} MB", f"{size:.1f} MB", f"{seconds:.1f} s")
            for minutes, (peak, size, seconds) in medians.items()
        ],
    )
    print(f"memory of 1 h against 1 min: {medians[60][0] / medians[1][0]:.3f}")


if __name__ == "__main__":
    main()
