#!/usr/bin/env python3
"""Says which runs of a fixed set differ from those of a commit: where first, and by what.

`tools/compare_runs.py BASE` performs every run with this tree and with commit BASE (in a work tree of its own, by
this interpreter) and compares them to the bit: positions, edges, frames, HLI, CNC records, results. The set of
runs stands in tools/net/runs.py, so that it is the same for both. What a commit gave is kept below out/runs.
Ends with 1 when a run differs.
"""

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
KEPT = ROOT / "out" / "runs"


def git(*words: str) -> str:
    """Return what git says in this project."""
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout.strip()


def set_digest() -> str:
    """Return a digest of what decides what is performed and kept: the net itself, programs and golden cases."""
    places = sorted(
        [*ROOT.glob("tools/net/*.py"), *ROOT.glob("programs/*.nc"), *ROOT.glob("tests/nc/*/program.nc")]
    )
    return hashlib.sha256(b"".join(path.read_bytes() for path in places)).hexdigest()[:12]


def _places(tree: Path) -> str:
    """Return where the packages of a tree and the tools lie, as PYTHONPATH takes it."""
    return os.pathsep.join(map(str, (tree, tree / "drives", ROOT / "tools")))


def record(tree: Path, folder: Path, names: Sequence[str], jobs: int) -> None:
    """Perform the named runs with the packages of a tree, in so many processes, into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    environment = {**os.environ, "PYTHONPATH": _places(tree), "PYTHONHASHSEED": "0"}
    parts = [names[number::jobs] for number in range(jobs) if names[number::jobs]]
    words = [sys.executable, "-P", str(Path(__file__).resolve()), "--record", str(folder), "--only"]
    workers = [subprocess.Popen([*words, *part], env=environment, cwd=tree) for part in parts]
    codes = [worker.wait() for worker in workers]
    if any(codes):
        raise SystemExit(f"the runs could not be performed with {tree}")


def recorded(commit: str, names: Sequence[str], jobs: int) -> Path:
    """Return the folder of what a commit gives; performed in a work tree of its own where it is not kept."""
    full = git("rev-parse", "--verify", f"{commit}^{{commit}}")
    folder = KEPT / f"{full[:12]}-{set_digest()}"
    missing = [name for name in names if not (folder / f"{name}.run").is_file()]
    if missing:
        with tempfile.TemporaryDirectory(prefix="runs-") as place:
            tree = Path(place) / "tree"
            git("worktree", "add", "--quiet", "--detach", str(tree), full)
            try:
                record(tree, folder, missing, jobs)
            finally:
                git("worktree", "remove", "--force", str(tree))
    return folder


def report(base: Path, now: Path, names: Sequence[str], title: str) -> int:
    """Print what differs; return how many runs do."""
    from net.comparing import Shapes, compare
    from net.performing import Performed

    shapes, moved = Shapes(), 0
    for name in names:
        found = compare(*(Performed.load(folder / f"{name}.run") for folder in (base, now)), shapes)
        if found.first is not None:
            moved += 1
            print(f"{name}: {found.text()}")
    for side, only in ((title, shapes.base), ("this tree", shapes.now)):
        if only:
            print(f"told by {side} only: {', '.join(only)}")
    if moved:
        print(f"{moved} of {len(names)} runs differ from {title}")
    else:
        print(f"{len(names)} runs, none differs from {title}")
    return moved


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare; or with --record perform runs with the packages that are on the path."""
    from net.runs import all_runs

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("base", nargs="?", help="commit to compare with")
    parser.add_argument("--with", dest="other", metavar="COMMIT", help="compare BASE with this commit")
    parser.add_argument("--only", nargs="+", metavar="RUN", help="these runs only; a name may end in *")
    parser.add_argument(
        "--jobs", type=int, default=min(os.cpu_count() or 1, 4), help="processes (%(default)s)"
    )
    parser.add_argument("--list", action="store_true", help="print the names of the runs")
    parser.add_argument("--record", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    runs = {run.name: run for run in all_runs()}
    patterns = given.only or ["*"]
    names = [name for name in runs if any(Path(name).match(pattern) for pattern in patterns)]
    if not names:
        parser.error(f"no run is called {' or '.join(patterns)}")
    if given.list:
        print("\n".join(names))
        return 0
    if given.record is not None:
        from net.performing import perform_all

        perform_all([runs[name] for name in names], given.record)
        return 0
    if given.base is None:
        parser.error("a commit to compare with is needed, as HEAD or main")
    base = recorded(given.base, names, given.jobs)
    if given.other:
        return int(bool(report(base, recorded(given.other, names, given.jobs), names, given.base)))
    now = KEPT / "this"
    shutil.rmtree(now, ignore_errors=True)
    record(ROOT, now, names, given.jobs)
    return int(bool(report(base, now, names, given.base)))


if __name__ == "__main__":
    environment = ROOT / ".venv" / "bin" / "python"
    if sys.prefix == sys.base_prefix and environment.exists():
        os.execv(environment, [str(environment), *sys.argv])
    sys.exit(main())
