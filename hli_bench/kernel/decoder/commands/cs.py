"""#CS ON[v1,v2,v3,phi1,phi2,phi3], #CS OFF, #CS OFF ALL: machining coordinate systems, stacked."""

import re

from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.coordinates import MAX_FRAMES, frame
from hli_bench.kernel.decoder.expressions import evaluate
from hli_bench.kernel.decoder.faults import CncStop, cnc_error
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables
from hli_bench.manual.errors import decoder as errors

_WORD = re.compile(r"[A-Z]+", re.IGNORECASE)
_ALL = re.compile(r"ALL\b", re.IGNORECASE)


def run(context: Context, memory: Variables, scanner: Scanner) -> Steps:
    """Change the stack of systems."""
    found = scanner.match(_WORD)
    word = found.group().upper() if found else ""
    if word in ("DEF", "ADD", "MODE", "SELECT"):
        raise scanner.not_emulated(f"#CS {word}: only #CS ON and #CS OFF are built")
    if word not in ("ON", "OFF"):
        raise scanner.error(f"expected ON or OFF after #CS, found '{word}' {scanner.found()}")
    where = context.coordinates
    if where.main is None:
        raise scanner.error("#CS: expected a channel with the three main axes X, Y and Z")
    if word == "OFF":
        if not where.depth:
            yield cnc_error(errors.CS_OFF_WITHOUT_ON, scanner.block.source)
        where.pop(everything=scanner.match(_ALL) is not None)
        return
    if where.depth == MAX_FRAMES:
        raise CncStop(errors.CS_STACK, scanner.block.source, MAX_FRAMES)
    where.push(frame(_values(memory, scanner)))


def _values(memory: Variables, scanner: Scanner) -> list[float]:
    if scanner.peek() != "[":
        raise scanner.not_emulated("#CS ON without [v1,v2,v3,phi1,phi2,phi3]: stored systems not built")
    scanner.expect("[")
    values: list[float] = []
    while True:
        values.append(0.0 if scanner.peek() in (",", "]") else evaluate(scanner, memory))
        if not scanner.accept(","):
            break
    scanner.expect("]")
    if len(values) > 6:
        raise scanner.error(f"expected at most 6 values in #CS ON[...], found {len(values)}")
    if scanner.peek() == "[":
        raise scanner.not_emulated("#CS ON[id][...]: stored systems not built")
    return values + [0.0] * (6 - len(values))
