"""How long a command takes that has nothing to do: an empty program against a Python that imports numba and Zenoh."""

import subprocess
import sys
import tempfile
from pathlib import Path

from _side_by_side import Work, in_turns, print_table, rate_ratio

BIN = Path(sys.executable).parent
TURNS = 15
IMPORTS = "import numpy, numba, zenoh"


def command(*words: str) -> Work:
    """Return what runs a command once."""

    def work() -> float:
        subprocess.run([BIN / words[0], *words[1:]], check=True, capture_output=True)
        return 1.0

    return work


def main() -> None:
    """Measure the empty program and what does not need a bench at all."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "empty.nc")
        program.write_text("%empty\nM30\n", encoding="utf-8")
        ways = {
            f'python -c "{IMPORTS}"': command("python", "-c", IMPORTS),
            "hli-bench run of an empty program": command("hli-bench", "run", str(program)),
            "hli-bench params show P-AXIS-00516": command("hli-bench", "params", "show", "P-AXIS-00516"),
            "hli-bench --help": command("hli-bench", "--help"),
        }
        timings = in_turns(ways, TURNS)
    reference, *_ = timings.values()
    rows = [
        (
            name,
            f"{1e3 / timing.rate:.0f} ms",
            f"{1e3 / timing.best:.0f} ms",
            f"{1 / rate_ratio(timing, reference):.2f}",
        )
        for name, timing in timings.items()
    ]
    print_table(
        f"cold commands, median of {TURNS} turns", ("command", "median", "best", "against imports"), rows
    )


if __name__ == "__main__":
    main()
