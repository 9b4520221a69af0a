#!/usr/bin/env python3
"""Random benches held against what must never happen, seed by seed.

A seed gives a machine with settings, PLC scripts, programs behind one another, and what comes from outside: resets,
Ctrl-C, puts of clients. What must hold behind each stands in tools/net/invariants.py and tools/net/sameness.py. A seed
that fails is a line to repeat it, and the smallest scenario found that fails in the same way. Ends with 1 then.
"""

import argparse
import os
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Go through seeds."""
    from net.swarming import found_in, report

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seeds", default="0:100", metavar="FROM:TO", help="seeds FROM up to TO - 1 (%(default)s)"
    )
    parser.add_argument("--minutes", type=float, help="end after so many minutes, wherever the seeds are")
    parser.add_argument("--brief", action="store_true", help="name what fails, do not make it small")
    given = parser.parse_args(arguments)
    try:
        first, last = (int(word) for word in given.seeds.split(":"))
    except ValueError:
        parser.error(f"--seeds {given.seeds}: FROM:TO expected, two numbers")
    end = time.monotonic() + given.minutes * 60 if given.minutes else float("inf")
    failed: Counter[str] = Counter()
    seeds = 0
    for seed in range(first, last):
        if time.monotonic() > end:
            break
        seeds += 1
        found = found_in(seed)
        failed.update(finding.check for finding in found)
        if found and given.brief:
            print(*(f"seed {seed}: {finding}" for finding in found), sep="\n", flush=True)
        elif found:
            print(*report(seed, found), "", sep="\n", flush=True)
    print(f"{seeds} seeds from {first} on, {failed.total()} findings")
    for check, count in failed.most_common():
        print(f"  {count} x {check}")
    return int(bool(failed))


if __name__ == "__main__":
    environment = ROOT / ".venv" / "bin" / "python"
    if sys.prefix == sys.base_prefix and environment.exists():
        os.execv(environment, [str(environment), *sys.argv])
    sys.exit(main())
