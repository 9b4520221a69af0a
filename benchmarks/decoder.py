"""Decoding 100,000 plain motion blocks, beside LinuxCNC's stand-alone interpreter. Reach: a third of its speed.

`rs274` comes with the Debian package linuxcnc-uspace; RS274 names it where it is not on the path, and
LD_LIBRARY_PATH its libraries where they are not installed. Without it the decoder is measured alone. The
interpreter is a program of its own, so its start (measured with an empty program) is taken off.
"""

import os
import random
import shutil
import subprocess
import tempfile
from pathlib import Path

from _side_by_side import Timing, in_turns, print_table, rate_ratio

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Line
from hli_bench.kernel.decoder import Decoder, DecoderAxis, DecoderDefaults

BLOCKS = 100_000
TURNS = 7
AXES = [DecoderAxis(AxisIndex(at), name, at + 1, "T", True) for at, name in enumerate("XYZ")]
RS274 = os.environ.get("RS274") or shutil.which("rs274")


def part_program() -> list[str]:
    """Return plain motion blocks as a CAM system writes them: modal G01, three axes, now and then a feed."""
    draw = random.Random(274)
    lines = ["G90 F2000", "G01 X0 Y0 Z0"]
    for _ in range(BLOCKS - 1):
        words = [f"{name}{draw.uniform(-100, 100):.3f}" for name in "XYZ"]
        feed = f" F{draw.randrange(500, 6000)}" if draw.random() < 0.05 else ""
        lines.append(f"{' '.join(words)}{feed}")
    return lines


def decode(file: Path) -> float:
    """Decode a file block by block and return how many motion blocks there were."""
    with file.open(encoding="utf-8") as lines:
        items = Decoder(lines, file.name, AXES, DecoderDefaults()).blocks()
        return sum(isinstance(item, Line) for item in items)


def interpret(program: str, folder: Path, name: str, out: Path = Path(os.devnull)) -> float:
    """Let rs274 write its canonical calls for a program."""
    tools, parameters = folder / "tool.tbl", folder / "rs274.var"
    tools.write_text("T1 P1 D0.1\n")
    parameters.write_text("")
    command = [program, "-t", str(tools), "-v", str(parameters), "-g", str(folder / name), str(out)]
    subprocess.run(command, check=True, capture_output=True)
    return BLOCKS


def check(program: str, folder: Path) -> None:
    """Make sure that rs274 finds as many motions as our decoder."""
    out = folder / "canonical.txt"
    interpret(program, folder, "part.ngc", out)
    assert out.read_text().count("STRAIGHT_FEED") == decode(folder / "part.nc")


def main() -> None:
    """Measure in turns and print the ratio."""
    lines = part_program()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, end in (("part.nc", "M30"), ("part.ngc", "M2")):
            (folder / file).write_text("\n".join([*lines, end, ""]))
        (folder / "empty.ngc").write_text("M2\n")
        ways = {"decoder": lambda: decode(folder / "part.nc")}
        if RS274:
            check(RS274, folder)
            ways["rs274"] = lambda: interpret(RS274, folder, "part.ngc")
            ways["start"] = lambda: interpret(RS274, folder, "empty.ngc")
        timings = in_turns(ways, TURNS)
    ours = timings["decoder"]
    rows = [("decoder", f"{ours.rate:,.0f}", f"{ours.best:,.0f}", "1.00")]
    if RS274:
        spans = zip(timings["rs274"].seconds, timings["start"].seconds, strict=True)
        theirs = Timing(timings["rs274"].work, tuple(whole - start for whole, start in spans))
        ratio = rate_ratio(ours, theirs)
        rows = [
            ("decoder", f"{ours.rate:,.0f}", f"{ours.best:,.0f}", f"{ratio:.2f}"),
            ("rs274", f"{theirs.rate:,.0f}", f"{theirs.best:,.0f}", "1.00"),
        ]
    else:
        print("rs274 is not here (Debian package linuxcnc-uspace): the decoder alone")
    title = f"{ours.work:,.0f} plain motion blocks, three axes, median of {TURNS} turns"
    print_table(title, ("", "blocks/s", "best", "against rs274"), rows)


if __name__ == "__main__":
    main()
