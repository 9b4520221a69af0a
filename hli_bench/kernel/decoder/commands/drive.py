"""#DRIVE WR [SYN] [AX=.. | AXNR=.. KEY=.. VAL=.. WAIT]: write a drive value through antr.function[]."""

import re
from typing import TYPE_CHECKING

from hli_bench.kernel.blocks import DriveWrite
from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.keywords import Kind, axis_of, keywords
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables

if TYPE_CHECKING:
    from hli_bench.kernel.decoder.configuration import DecoderAxis

_WORD = re.compile(r"[A-Z]+", re.IGNORECASE)
_SYN = re.compile(r"SYN\b", re.IGNORECASE)
_KEYS: dict[str, Kind] = {
    "AX": "word",
    "AXNR": "value",
    "KEY": "word",
    "VAL": "value",
    "WAIT": "flag",
    "MOTOR": "value",
    "PARAM_SET": "value",
}


def run(context: Context, memory: Variables, scanner: Scanner) -> Steps:
    """Yield the write; it keeps its place among the motion blocks when synchronous."""
    found = scanner.match(_WORD)
    word = found.group().upper() if found else ""
    if word in ("RD", "WAIT"):
        raise scanner.not_emulated(f"#DRIVE {word}: only #DRIVE WR is built")
    if word != "WR":
        raise scanner.error(f"expected WR after #DRIVE, found '{word}' {scanner.found()}")
    synchronous = scanner.match(_SYN) is not None
    axis: DecoderAxis | None = None
    key, value, wait = "", None, False
    start = scanner.pos
    for keyword in keywords(scanner, memory, _KEYS):
        match keyword.name:
            case "AX" | "AXNR":
                axis = axis_of(scanner, context, keyword)
            case "KEY":
                key = keyword.word.upper()
            case "VAL":
                value = keyword.value
            case "MOTOR" | "PARAM_SET":
                raise scanner.not_emulated(
                    f"#DRIVE {keyword.name}: several motors of a drive not built", keyword.at
                )
            case _:
                wait = True
    if axis is None or not key or value is None:
        raise scanner.error("expected AX= or AXNR=, KEY= and VAL= in #DRIVE WR [...]", start)
    source = scanner.block.source
    yield DriveWrite(source=source, axis=axis.index, key=key, value=value, synchronous=synchronous, wait=wait)
