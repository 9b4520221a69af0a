"""A whole session as one cold command: start, three homings with cam and zero pulse, 40 probes, stop.

The command is run again and again as a user would run it; its results have to be identical every time.
"""

import hashlib
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent
SETTINGS = [
    "axis.Z.kenngr.measure.signal=DRIVE",
    *(
        f"axis.{axis}.{setting}"
        for axis in "XYZ"
        for setting in (
            "kenngr.abs_pos_gueltig=0",
            "antr.reference_cam_signal=STATUS_DIG_INPUTS",
            f"input.home=cam.{axis}",
        )
    ),
]


def program() -> str:
    """Home Z, then X and Y, then probe the face 40 times at different places."""
    lines = ["%session", "N10 G74 Z1 X2 Y2", "N20 G90 G01 X0 Y0 Z120 F20000"]
    for probe in range(40):
        lines += [f"G01 X{probe % 8 * 5} Y{probe // 8 * 5} F20000", "G100 Z90 F2000", "G01 Z120 F20000"]
    return "\n".join([*lines, "M30", ""])


def main() -> None:
    """Run the session many times (100, or the number given) and compare the results."""
    turns = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    with tempfile.TemporaryDirectory() as folder:
        source, result = Path(folder, "session.nc"), Path(folder, "result.json")
        source.write_text(program(), encoding="utf-8")
        command = [str(Path(sys.executable).with_name("hli-bench")), "run", str(source), "--result", str(result),
                   "--machine", str(HERE / "machines" / "three_axes"), "--plc", "none",
                   *(part for setting in SETTINGS for part in ("--set", setting))]  # fmt: skip
        times, digests = [], set()
        for _ in range(turns + 1):
            start = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True)
            times.append(time.perf_counter() - start)
            found = json.loads(result.read_text(encoding="utf-8"))
            assert len(found["measurements"]) == 40
            assert len(found["homing"]) == 3
            del found["wall_s"], found["program"]
            digests.add(hashlib.sha256(json.dumps(found, sort_keys=True).encode()).hexdigest())
    sim_s = found["sim_s"]
    same = "all results identical" if len(digests) == 1 else "RESULTS DIFFER"
    median, best = statistics.median(times[1:]), min(times[1:])
    print(
        f"session of {sim_s:.1f} s machine time, {turns} cold commands: median {median:.2f} s, best {best:.2f} s"
    )
    print(same)


if __name__ == "__main__":
    main()
