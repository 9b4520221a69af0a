"""How many times faster than the machine: probing in free pace, without a PLC and with PLC tasks of 10 ms and 1 ms.

Three axes, 1 ms cycle, about 60 s of machine time; everything is included (bench, drives, plant, decoder, results)
but the first compilation. The reference is the machine's own time: a ratio of 1 is real time.
"""

import statistics
import time
from pathlib import Path

from hli_bench import Bench
from hli_bench.base import garbage

MACHINE = Path(__file__).parent / "machines" / "three_axes"
FACE = {"plant.probe.Z.face_mm": 250.0, "plant.probe.Z.material": "below"}
TERMINAL = {"terminal.probe.model": "EL1252", "terminal.probe.wiring.ch2": "probe"}
PROBES = 20
TURNS = 7


def program() -> str:
    """Probe the same face again and again."""
    lines = ["%free_pace", "N10 G90 G01 Z300 F6000"]
    for _ in range(PROBES):
        lines += ["G100 Z240 F2000", "G01 Z300 F6000", "G01 X10 Y5 F6000", "G01 X0 Y0 F6000"]
    return "\n".join([*lines, "M30"])


def measure(name: str, settings: dict[str, object], plc: list[str] | None) -> None:
    """Print the ratio of one kind of bench."""
    ratios, text = [], program()
    for _ in range(TURNS + 1):
        start = time.perf_counter()
        with Bench(MACHINE, {**FACE, **settings}, plc=plc) as bench:
            result = bench.run(text)
        assert result.completed, result.errors
        assert len(result.measurements) == PROBES
        ratios.append(result.sim_s / (time.perf_counter() - start))
    best, median = max(ratios[1:]), statistics.median(ratios[1:])
    print(f"{name:<42} {result.sim_s:6.1f} s   median {median:7.0f}x   best {best:7.0f}x")


def main() -> None:
    """Measure all kinds in turn."""
    garbage.seldom()  # as the command line does
    print(f"probing in free pace, 3 axes, cycle 1 ms, {TURNS} turns")
    measure("DRIVE latch, no PLC", {"axis.Z.kenngr.measure.signal": "DRIVE"}, [])
    for period_ms in (10, 1):
        tasks = [{"script": "probing.py", "period_us": period_ms * 1000}]
        measure(f"EL1252, PLC_TIMESTAMP, PLC task {period_ms} ms", {**TERMINAL, "plc": tasks}, None)


if __name__ == "__main__":
    main()
