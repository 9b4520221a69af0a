"""#CHANNEL INIT [CMDPOS | ACTPOS {AX=.. | AXNR=..}]: take positions of the machine into the program."""

import re

from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.keywords import Kind, axis_of, keywords
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables

_SET = re.compile(r"SET\b", re.IGNORECASE)
_INIT = re.compile(r"INIT\b", re.IGNORECASE)
_KEYS: dict[str, Kind] = {"CMDPOS": "flag", "ACTPOS": "flag", "AX": "word", "AXNR": "value"}


def run(context: Context, memory: Variables, scanner: Scanner) -> Steps:
    """Flush and take command or actual positions; with named axes the others take command positions."""
    if other := scanner.match(_SET):
        raise scanner.not_emulated("#CHANNEL SET: settings of functions not built", other.start())
    if not scanner.match(_INIT):
        raise scanner.error(f"expected INIT after #CHANNEL, found {scanner.found()}")
    actual = False
    named = set()
    if scanner.peek() == "[":
        for keyword in keywords(scanner, memory, _KEYS):
            if keyword.name in ("AX", "AXNR"):
                named.add(axis_of(scanner, context, keyword).index)
            else:
                actual = keyword.name == "ACTPOS"
    where = context.coordinates
    where.forget(list(context.axes), keep_programmed=False)
    yield from context.flush(scanner.block.source)
    state = context.measurements.state
    if actual and state is not None:
        where.forget(list(context.axes), keep_programmed=False)
        where.learn(
            {
                axis: state.actual[axis] if not named or axis in named else state.command[axis]
                for axis in context.axes
            }
        )
