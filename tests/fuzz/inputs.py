"""Seeded wrong inputs: good texts with pieces cut, doubled, swapped or replaced by what parsers stumble over.

`HLI_BENCH_FUZZ` is the number of inputs of each kind (fewer of those that take long), `HLI_BENCH_FUZZ_SEED` the first
seed; a failing input is made again from the seed that the test names.
"""

import os
import time
from collections.abc import Callable

import numpy as np

from hli_bench.base.errors import BenchError

COUNT = int(os.environ.get("HLI_BENCH_FUZZ", "300"))
FIRST = int(os.environ.get("HLI_BENCH_FUZZ_SEED", "0"))
LONGEST_S = 20.0
"""An input that takes longer hangs; far above what a loaded computer needs for the slowest of them."""
ODD = (
    "",
    "\0",
    "\x1b[2J",
    "\ufeff",
    "ä",
    "\U0001f600",
    "-",
    "0x",
    "0xFFFFFFFFFFFFFFFFFFFF",
    "1e308",
    "1e-320",
    "-1",
    "nan",
    "inf",
    "99999999999999999999",
    "9" * 5000,
    "[" * 2000,
    "(" * 2000,
    "{" * 2000,
    '"' * 3,
    "'",
    "[]",
    "[0][0]",
    "[" + "9" * 5000 + "]",
    "[-1]",
    ".",
    "..",
    "=",
    "#",
    "\n",
    "\r",
    "\t",
    "%",
    "\\",
    "a" * 300,
    "true",
    "1979-05-27",
    "settings[[]]",
    "\ud800".encode("utf-8", "surrogatepass").decode("latin-1"),
)


def seeds(share: int = 1) -> range:
    """Return the seeds of the inputs to try, one `share`-th of them for a kind that takes longer."""
    return range(FIRST, FIRST + max(COUNT // share, 1))


def broken(text: str, seed: int, *more: str) -> str:
    """Return the text with one to four places spoilt; `more` are odd pieces of its own language."""
    draw = np.random.default_rng(seed)
    pieces = ODD + more
    for _ in range(int(draw.integers(1, 5))):
        at, to = sorted(int(place) for place in draw.integers(0, len(text) + 1, 2))
        to = min(to, at + int(draw.integers(1, 60)))
        match int(draw.integers(0, 5)):
            case 0:
                text = text[:at] + text[to:]
            case 1:
                text = text[:to] + text[at:]
            case 2:
                text = text[:at] + pieces[int(draw.integers(len(pieces)))] + text[at:]
            case 3:
                text = text[:at] + pieces[int(draw.integers(len(pieces)))] + text[to:]
            case _:
                text = text[:at] + chr(int(draw.integers(1, 256))) + text[at + 1 :]
    return text


def broken_bytes(data: bytes, seed: int) -> bytes:
    """Return the bytes with one to four places spoilt, or cut off."""
    draw = np.random.default_rng(seed)
    spoilt = bytearray(data)
    for _ in range(int(draw.integers(1, 5))):
        at = int(draw.integers(0, len(spoilt) + 1))
        match int(draw.integers(0, 4)):
            case 0:
                del spoilt[at : at + int(draw.integers(1, 50))]
            case 1:
                spoilt[at:at] = draw.bytes(int(draw.integers(1, 20)))
            case 2:
                spoilt[at : at + 4] = draw.bytes(min(4, len(spoilt) - at))
            case _:
                del spoilt[at:]
        if not spoilt:
            break
    return bytes(spoilt)


def tried(call: Callable[[], object], seed: int, given: object = "") -> None:
    """Call with one input: it may be refused with a text that says why, in time, and nothing else may come out."""
    begin = time.process_time()
    said = "-"
    try:
        call()
    except BenchError as error:
        said = str(error)
    except Exception as error:
        raise AssertionError(f"seed {seed}: {given!r}") from error
    assert said, f"seed {seed}: refused without a word"
    took = time.process_time() - begin
    assert took < LONGEST_S, f"seed {seed} took {took:.1f} s"
