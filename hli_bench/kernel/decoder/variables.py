"""P parameters and V. variables: reading them in expressions, writing them in assignments."""

import re
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.decoder.context import Context
from hli_bench.kernel.decoder.coordinates import rounded
from hli_bench.kernel.decoder.expressions import evaluate
from hli_bench.kernel.decoder.faults import CncStop
from hli_bench.kernel.decoder.text import Scanner, short
from hli_bench.manual.dialect import AXIS_VARIABLES, GLOBAL_VARIABLES, VARIABLE_AREAS, missing
from hli_bench.manual.errors import decoder as errors
from hli_bench.manual.errors.record import ErrorSheet
from hli_bench.manual.nc_variables import emulated, own_areas

_PARAMETER = re.compile(r"(P+)([0-9]{1,9}|(?=\[))", re.IGNORECASE)
_VARIABLE = re.compile(r"V\.([A-Z_]+)\.([-+@]?[A-Z_][A-Z0-9_]*(?:\.[A-Z_][A-Z0-9_]*)*)", re.IGNORECASE)
MAX_VALUES: Final = 10_000
"""Parameters and own variables of a program (decided here): one that never ends must not fill the memory."""
_OWN: Final = own_areas()
"""Own variables. V.E. is kept by the program alone: the PLC does not see it yet."""
_OF_AXES: Final = {row.name: row for row in emulated("A")}
_OF_CHANNEL: Final = {row.name: row for row in emulated("G")}

_NEED_VALUE: Final = frozenset(("MESS", "MOFFS", "MEAS.ACS.VALUE", "MEAS.PCS.VALUE"))

_STRING = re.compile(r'"[^"]*"')
_FLUSHING: Final = "|".join(re.escape(name) for name, row in _OF_AXES.items() if row.flush)
_FROM_MACHINE = re.compile(rf"V\.A\.(?:{_FLUSHING})(?![A-Z_0-9])", re.IGNORECASE)
_POSITION = re.compile(r"V\.A\.(ABS|PROG|ACS\.ABS)(?:\.([A-Z_]\w*)|\[)", re.IGNORECASE)


def needs_flush(text: str, context: Context) -> bool:
    """Tell whether a block reads a variable that only the machine can fill."""
    if "." not in text:
        return False
    bare = _STRING.sub("", text)
    if _FROM_MACHINE.search(bare):
        return True
    void = context.coordinates.void
    return bool(void) and any(
        found.group(2) is None or not _is_known(context, found.group(2), found.group(1))
        for found in _POSITION.finditer(bare)
    )


def _is_known(context: Context, name: str, variable: str) -> bool:
    """Tell whether the position of an axis is known without asking; an unknown name is not the machine's."""
    axis, where = context.by_name.get(name.upper()), context.coordinates
    if axis is None:
        return True
    in_frame = variable.upper() == "ACS.ABS" and where.frame is not None
    needed = {axis.index, *where.main} if in_frame and where.main else {axis.index}
    return not needed & where.void


Slot = int | str
"""Where a value is kept: the number of a P parameter or the name of an own variable."""


class Variables:
    """Memory of the program, and its view on axes and channel."""

    __slots__ = ("_context", "_read", "_values")

    def __init__(self, context: Context) -> None:
        self._context = context
        self._values: dict[Slot, float] = {}
        self._read: dict[str, float] = {}

    def at_name(self, scanner: Scanner) -> bool:
        """Tell whether a parameter or variable stands at the scanner."""
        scanner.skip()
        text, pos = scanner.text, scanner.pos
        return _PARAMETER.match(text, pos) is not None or text[pos : pos + 2].upper() == "V."

    def read(self, scanner: Scanner) -> float:
        """Take a name and return its value."""
        start = scanner.pos
        if (number := self._parameter(scanner)) is not None:
            return self._parameter_value(scanner, number, start)
        area, name = self._variable(scanner)
        if area == "A":
            return self._axis_value(scanner, name, start)
        if area == "G" and name in _OF_CHANNEL:
            value = self._context.measuring_type if name == "MEAS_TYPE" else self._context.feed
            self._read[f"V.G.{name}"] = float(value)
            return float(value)
        if area in _OWN:
            key = self._own_key(scanner, area, name)
            if key not in self._values:
                raise scanner.error(f"variable {key} has no value yet", start)
            return self._values[key]
        raise self._unknown(scanner, area, name, start)

    def assign(self, scanner: Scanner) -> Slot:
        """Take `name = expression`, keep the value and return where."""
        start = scanner.pos
        slot = self._slot(scanner)
        if len(self._values) >= MAX_VALUES and slot not in self._values:
            raise scanner.error(f"expected at most {MAX_VALUES} parameters and variables in a program", start)
        scanner.expect("=")
        self._values[slot] = evaluate(scanner, self)
        return slot

    def get(self, slot: Slot) -> float:
        """Return a value that was assigned before."""
        return self._values[slot]

    def put(self, slot: Slot, value: float) -> None:
        """Keep a value."""
        self._values[slot] = value

    def result(self) -> dict[str, float]:
        """Return what the program set or read, the variables of every axis it has measured among them."""
        values = self._context.measurements
        for axis in sorted(self._context.axes):
            if values.has_run(axis):
                self._note("MERF", axis)
                self._note("MEIN", axis)
            if values.has_value(axis):
                for name in sorted(_NEED_VALUE):
                    self._note(name, axis)
        own = {str(slot): value for slot, value in self._values.items() if isinstance(slot, str)}
        parameters = {f"P{slot}": value for slot, value in self._values.items() if isinstance(slot, int)}
        return dict(sorted((self._read | own | parameters).items()))

    def _slot(self, scanner: Scanner) -> Slot:
        start = scanner.pos
        if (number := self._parameter(scanner)) is not None:
            return number
        area, name = self._variable(scanner)
        if area in _OWN:
            return self._own_key(scanner, area, name)
        if area == "A" or (area == "G" and name in _OF_CHANNEL):
            raise self._stop(scanner, errors.VARIABLE_WRITE_DENIED, f"V.{area}.{name}")
        raise self._unknown(scanner, area, name, start)

    def _parameter(self, scanner: Scanner) -> int | None:
        """Take P10, P[...] or the indirect PP10 and return the number it stands for."""
        found = scanner.match(_PARAMETER)
        if found is None:
            return None
        if found.group(2):
            number = int(found.group(2))
        else:
            scanner.expect("[")
            number = self._whole(scanner, evaluate(scanner, self), "parameter number")
            scanner.expect("]")
        for _ in found.group(1)[1:]:
            value = self._parameter_value(scanner, number, found.start())
            number = self._whole(scanner, value, "parameter number")
        return number

    def _parameter_value(self, scanner: Scanner, number: int, at: int) -> float:
        if number not in self._values:
            raise scanner.error(f"parameter P{number} has no value yet", at)
        return self._values[number]

    def _whole(self, scanner: Scanner, value: float, what: str) -> int:
        if value < 0 or abs(value - round(value)) > 1e-6:
            raise scanner.error(f"expected a {what} (whole, not negative), found {value:g}")
        return round(value)

    def _variable(self, scanner: Scanner) -> tuple[str, str]:
        found = scanner.match(_VARIABLE)
        if found is None:
            raise scanner.error("expected a variable such as V.A.ABS.X or V.P.NAME")
        return found.group(1).upper(), found.group(2).upper()

    def _index(self, scanner: Scanner) -> int:
        scanner.expect("[")
        index = self._whole(scanner, evaluate(scanner, self), "index")
        scanner.expect("]")
        return index

    def _own_key(self, scanner: Scanner, area: str, name: str) -> str:
        key = f"V.{area}.{name}"
        while scanner.text[scanner.pos : scanner.pos + 1] == "[":
            key += f"[{self._index(scanner)}]"
        return key

    def _axis_value(self, scanner: Scanner, name: str, start: int) -> float:
        if scanner.text[scanner.pos : scanner.pos + 1] == "[":
            index = AxisIndex(self._index(scanner))
            if index not in self._context.axes:
                highest = max(self._context.axes)
                raise self._stop(scanner, errors.VARIABLE_INDEX, index, 0, highest, f"V.A.{name}[{index}]")
        else:
            name, _, axis_name = name.rpartition(".")
            axis = self._context.by_name.get(axis_name)
            if axis is None:
                raise self._stop(scanner, errors.VARIABLE_UNKNOWN_AXIS, f"V.A.{name}.{axis_name}")
            index = axis.index
        if what := missing(AXIS_VARIABLES, name):
            raise scanner.not_emulated(f"V.A.{name}: {what} not built", start)
        if name not in _OF_AXES or not self._context.path_axis(index):
            raise self._stop(scanner, errors.UNKNOWN_VARIABLE, f"V.A.{name}")
        return self._note(name, index)

    def _note(self, name: str, axis: AxisIndex) -> float:
        """Return the value of an axis variable and remember it for the result."""
        value = self._measured(name, axis) if name in _NEED_VALUE else self._position(name, axis)
        self._read[f"V.A.{name}.{self._context.axes[axis].name}"] = value
        return value

    def _measured(self, variable: str, axis: AxisIndex) -> float:
        """Return a measured value; 0 for an axis that has none yet (decided here: V.A.MERF tells)."""
        values = self._context.measurements
        if not values.has_value(axis):
            return 0.0
        match variable:
            case "MESS":
                return values.with_offsets(axis)
            case "MOFFS":
                return values.distance(axis)
            case "MEAS.ACS.VALUE":
                return values.in_axes(axis)
            case _:
                return values.without_offsets(axis)

    def _position(self, name: str, axis: AxisIndex) -> float:
        where, values = self._context.coordinates, self._context.measurements
        match name:
            case "ABS":
                return where.absolute[axis]
            case "PROG":
                return where.programmed[axis]
            case "ACS.ABS":
                return where.acs(axis)
            case "MEIN":
                return where.included[axis]
            case "BZP":
                return where.shift[axis]
            case "MERF":
                return float(values.completed(axis))
            case _:
                pass
        assert values.state is not None
        if name == "RERF":
            return float(values.state.referenced.get(axis, False))
        return rounded(where.from_acs(values.state.actual)[axis] - where.applied[axis])

    def _unknown(self, scanner: Scanner, area: str, name: str, at: int) -> Exception:
        what = missing(VARIABLE_AREAS, area)
        if area == "G":
            what = missing(GLOBAL_VARIABLES, name) or missing(GLOBAL_VARIABLES, name.partition(".")[0])
        if what:
            return scanner.not_emulated(f"V.{area}.{short(name)}: {what} not built", at)
        return self._stop(scanner, errors.UNKNOWN_VARIABLE, f"V.{area}.{name}")

    def _stop(self, scanner: Scanner, sheet: ErrorSheet, *values: float | str) -> CncStop:
        return CncStop(sheet, scanner.block.source, *values)
