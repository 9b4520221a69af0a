"""Cost of a cycle with 32 axes against 8, all of them moving. Reach: at most 4.4.

The machines are made in a temporary folder: linear axes X1, X2, ... with the parameters of axis X of demo.
"""

import re
import tempfile
from pathlib import Path

from _side_by_side import in_turns, print_table, rate_ratio

from hli_bench import Bench

DEMO = Path(__file__).parent.parent / "hli_bench" / "machines" / "demo"
AXES = (3, 8, 32)
MOVES = 20
TURNS = 7


def machine(folder: Path, axes: int) -> Path:
    """Write a machine folder and return it."""
    folder = folder / f"axes{axes}"
    folder.mkdir()
    lines = ["cycle_us = 1000"]
    parameters = (DEMO / "x.lis").read_text()
    for number in range(1, axes + 1):
        text = re.sub(r"(?m)^(kopf\.achs_nr\s+)\d+", rf"\g<1>{number}", parameters)
        (folder / f"x{number}.lis").write_text(text)
        lines += [
            f"[axis.X{number}]",
            f'list = "x{number}.lis"',
            'drive = "drives.models.servo402"',
            f"node_id = {number}",
            f"[plant.axis.X{number}]",
            "pitch_mm = 10.0",
        ]
    (folder / "machine.toml").write_text("\n".join(lines) + "\n")
    return folder


def program(axes: int) -> str:
    """Move all axes to and fro, without a pause."""
    to, fro = (" ".join(f"X{number}={value + number}" for number in range(1, axes + 1)) for value in (300, 0))
    return "\n".join(["G90 G01 F60000", *[f"{to}\n{fro}"] * (MOVES // 2), "M30"])


def main() -> None:
    """Measure in turns and print the ratio."""
    with tempfile.TemporaryDirectory() as name:
        benches = {axes: Bench(machine(Path(name), axes), plc=[]) for axes in AXES}

        def cycles(axes: int) -> float:
            result = benches[axes].run(program(axes))
            assert result.completed, result.errors
            return result.cycles

        timings = in_turns({str(axes): lambda axes=axes: cycles(axes) for axes in AXES}, TURNS)
        for bench in benches.values():
            bench.close()
    few = timings["8"]
    print_table(
        f"all axes moving, cycle 1 ms, {few.work:.0f} cycles a turn, median of {TURNS} turns",
        ("axes", "a cycle", "x real time", "cost against 8"),
        [
            (axes, f"{1e6 / one.rate:.2f} us", f"{one.rate / 1000:.0f}", f"{rate_ratio(few, one):.2f}")
            for axes, one in timings.items()
        ],
    )


if __name__ == "__main__":
    main()
