"""#MSG [SYN] ["text %f", value, ...]: texts to the operator."""

import re
from typing import Final

from hli_bench.kernel.blocks import Text
from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.expressions import evaluate
from hli_bench.kernel.decoder.faults import CncStop
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables
from hli_bench.manual.errors import decoder as errors

_WORD = re.compile(r"[A-Z_]+", re.IGNORECASE)
_STRING = re.compile(r'"([^"]*)"')
_CONVERSION = re.compile(r"%([-+ 0#]{0,5}[0-9]{0,3}(?:\.[0-9]{0,2})?)([A-Za-z%])")
_NOT_BUILT: Final = frozenset(("SYN_ACK", "ACK", "DIAG", "HMI", "PLC", "EVENT_LOGGER", "INFO", "SAVE"))

Value = float | str


def run(_context: Context, memory: Variables, scanner: Scanner) -> Steps:
    """Yield the text; its values are those of the moment the block is decoded, after the flush they need."""
    synchronous = _mode(scanner)
    scanner.expect("[")
    start = scanner.pos
    template = scanner.match(_STRING)
    if template is None:
        raise scanner.error(f'expected a text in "quotes", found {scanner.found()}')
    values: list[Value] = []
    while scanner.accept(","):
        string = scanner.match(_STRING)
        values.append(string.group(1) if string else evaluate(scanner, memory))
    scanner.expect("]")
    text = _fill(scanner, template.group(1), values, start)
    yield Text(source=scanner.block.source, text=text, synchronous=synchronous)


def _mode(scanner: Scanner) -> bool:
    synchronous = False
    while found := scanner.match(_WORD):
        word = found.group().upper()
        if word in _NOT_BUILT:
            raise scanner.not_emulated(f"#MSG {word}: acknowledged texts and receivers not built")
        if word not in ("SYN", "ISG_DIAG_BED"):
            raise scanner.error(f"expected SYN or '[' after #MSG, found '{word}'", found.start())
        synchronous |= word == "SYN"
    return synchronous


def _fill(scanner: Scanner, template: str, values: list[Value], at: int) -> str:
    """Return the text with its conversions filled in, as C prints them."""
    rest = list(values)
    wanted = sum(found.group(2) != "%" for found in _CONVERSION.finditer(template))
    if wanted != len(values):
        raise CncStop(errors.MESSAGE_VALUES, scanner.block.source, wanted)

    def put(found: re.Match[str]) -> str:
        flags, kind = found.groups()
        return "%" if kind == "%" else _convert(scanner, flags, kind, rest.pop(0), at)

    return _CONVERSION.sub(put, template)


def _convert(scanner: Scanner, flags: str, kind: str, value: Value, at: int) -> str:
    if kind == "s":
        return f"%{flags}s" % (value if isinstance(value, str) else f"{value:g}")
    if isinstance(value, str):
        raise scanner.error(f"expected a number for %{kind}, found a text", at)
    if kind in "diuxX":
        return f"%{flags}{kind}" % int(value)
    if kind in "feEgG":
        return f"%{flags}{kind}" % value
    raise scanner.error(f"expected %f, %e, %g, %d, %i, %u, %x or %s in the text, found %{kind}", at)
