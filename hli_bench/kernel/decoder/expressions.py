"""Expressions of the NC language, evaluated while they are read; angles in degrees."""

import math
import re
from collections.abc import Callable
from typing import Final, Protocol

from hli_bench.kernel.decoder.text import Scanner, short
from hli_bench.manual.dialect import FUNCTIONS as DIALECT
from hli_bench.manual.dialect import OPERATORS, SIGNS, missing

MAX_DEPTH: Final = 32
"""Nested brackets of one expression, decided here."""

_NUMBER = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]{1,3})?")
"""The exponent has a small letter: E is an address."""
_WORD = re.compile(r"[A-Z_][A-Z0-9_]*", re.IGNORECASE)
_OPERATOR = re.compile(
    r"(?P<compare>==|!=|<>|<=|>=|<|>|=)|(?P<add>[+-])|(?P<multiply>\*(?!\*)|/|MOD\b)"
    r"|(?P<either>\|\||OR\b)|(?P<both>&&|AND\b)",
    re.IGNORECASE,
)
_NOT_BUILT = re.compile(r"&|\^|\||XOR\b", re.IGNORECASE)
_SIGN = re.compile(r"[+-]")
_LITERAL = re.compile(
    r"[+-]?(?:[0-9]{1,20}\.?[0-9]{0,20}|\.[0-9]{1,20})(?=\s*(?:$|[\],]|(?!e[0-9+-])[A-Z](?![A-Z])))",
    re.IGNORECASE,
)
"""A number that no operator follows: by far the most frequent expression."""

_MEMORY = re.compile(r"V\.|PP[0-9\[]|P[0-9\[]|P{2,}[0-9]", re.IGNORECASE)
_CONSTANTS: Final = {"TRUE": 1.0, "FALSE": 0.0, "PI": math.pi}


class Memory(Protocol):
    """Reads the parameter or variable that stands at the scanner."""

    def read(self, scanner: Scanner) -> float:
        """Take the name at the scanner and return its value."""


def sine(degrees: float) -> float:
    """Return the sine, exact at multiples of 90 degrees."""
    quarter, rest = divmod(degrees, 90.0)
    if rest == 0.0:
        return (0.0, 1.0, 0.0, -1.0)[int(quarter) % 4]
    return math.sin(math.radians(degrees))


def cosine(degrees: float) -> float:
    """Return the cosine, exact at multiples of 90 degrees."""
    quarter, rest = divmod(degrees, 90.0)
    if rest == 0.0:
        return (1.0, 0.0, -1.0, 0.0)[int(quarter) % 4]
    return math.cos(math.radians(degrees))


def _round(value: float) -> float:
    return math.copysign(math.floor(abs(value) + 0.5), value)


FUNCTIONS: Final[dict[str, Callable[[float], float]]] = {
    "SIN": sine,
    "COS": cosine,
    "TAN": lambda x: sine(x) / cosine(x),
    "ASIN": lambda x: math.degrees(math.asin(x)),
    "ACOS": lambda x: math.degrees(math.acos(x)),
    "ATAN": lambda x: math.degrees(math.atan(x)),
    "SQRT": math.sqrt,
    "SQR": lambda x: x * x,
    "ABS": abs,
    "ROUND": _round,
    "FIX": math.floor,
    "FUP": math.ceil,
    "EXP": math.exp,
    "LN": math.log,
    "NOT": lambda x: float(not is_true(x)),
}
"""Functions of one argument in '[ ]'; ROUND takes halves away from zero (decided here)."""

_OPERATORS: Final[dict[str, Callable[[float, float], float]]] = {
    "||": lambda a, b: float(is_true(a) or is_true(b)),
    "&&": lambda a, b: float(is_true(a) and is_true(b)),
    "==": lambda a, b: float(a == b),
    "!=": lambda a, b: float(a != b),
    "<": lambda a, b: float(a < b),
    ">": lambda a, b: float(a > b),
    "<=": lambda a, b: float(a <= b),
    ">=": lambda a, b: float(a >= b),
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "MOD": math.fmod,
}
_SAME_AS: Final = {"OR": "||", "AND": "&&", "=": "==", "<>": "!="}
_BINDS: Final = {"either": 1, "both": 2, "compare": 3, "add": 4, "multiply": 5}


def is_true(value: float) -> bool:
    """Tell whether a condition holds: its amount is at least 0.5 (NC conditions)."""
    return abs(value) >= 0.5


def evaluate(scanner: Scanner, memory: Memory, *, condition: bool = False) -> float:
    """Take an expression and return its value; in a condition '=' compares."""
    start = scanner.pos
    if literal := scanner.match(_LITERAL):
        return float(literal.group())
    _deeper(scanner)
    try:
        value = float(_Evaluation(scanner, memory, condition=condition).binary(1))
    except (ZeroDivisionError, OverflowError, ValueError) as problem:
        raise scanner.error(f"expression cannot be computed: {problem}", start) from None
    scanner.depth -= 1
    if not math.isfinite(value):
        raise scanner.error("expression cannot be computed: the value is too large", start)
    return value


def _deeper(scanner: Scanner) -> None:
    scanner.depth += 1
    if scanner.depth > MAX_DEPTH:
        raise scanner.error(f"expected at most {MAX_DEPTH} nested brackets")


class _Evaluation:
    """One run over an expression."""

    __slots__ = ("_condition", "_memory", "_scanner")

    def __init__(self, scanner: Scanner, memory: Memory, *, condition: bool) -> None:
        self._scanner = scanner
        self._memory = memory
        self._condition = condition

    def binary(self, least: int) -> float:
        """Take operands joined by operators that bind at least so tightly."""
        scanner = self._scanner
        value = self._signed()
        while True:
            before = scanner.pos
            found = scanner.match(_OPERATOR)
            if found is None:
                if other := scanner.match(_NOT_BUILT):
                    raise scanner.not_emulated(
                        f"{other.group().upper()}: {OPERATORS[other.group().upper()]} not built",
                        other.start(),
                    )
                return value
            binds = _BINDS[found.lastgroup or ""]
            word = found.group().upper()
            if binds < least or (word == "=" and not self._condition):
                scanner.pos = before
                return value
            right = self.binary(binds + 1)
            value = _OPERATORS[_SAME_AS.get(word, word)](value, right)

    def _signed(self) -> float:
        negative = False
        while found := self._scanner.match(_SIGN):
            negative ^= found.group() == "-"
        value = self._power()
        return -value if negative else value

    def _power(self) -> float:
        value = self._operand()
        if not self._scanner.accept("**"):
            return value
        _deeper(self._scanner)
        exponent = self._signed()
        self._scanner.depth -= 1
        return math.pow(value, exponent)

    def _operand(self) -> float:
        scanner = self._scanner
        if number := scanner.match(_NUMBER):
            return float(number.group())
        if scanner.peek() == "[":
            return self._bracket()
        if scanner.accept("!"):
            _deeper(scanner)
            value = float(not is_true(self._operand()))
            scanner.depth -= 1
            return value
        if _MEMORY.match(scanner.text, scanner.pos):
            return self._memory.read(scanner)
        return self._function()

    def _bracket(self) -> float:
        _deeper(self._scanner)
        self._scanner.expect("[")
        value = self.binary(1)
        self._scanner.expect("]")
        self._scanner.depth -= 1
        return value

    def _function(self) -> float:
        scanner = self._scanner
        word = scanner.match(_WORD)
        if word is None and (what := missing(SIGNS, scanner.peek())):
            raise scanner.not_emulated(f"{scanner.found()}: {what} not built")
        if word is None:
            raise scanner.error(f"expected a number, a parameter or '[', found {scanner.found()}")
        name = word.group().upper()
        if name in _CONSTANTS:
            return _CONSTANTS[name]
        if name not in FUNCTIONS:
            if what := missing(DIALECT, name):
                raise scanner.not_emulated(f"{name}: {what} not built", word.start())
            known = ", ".join(FUNCTIONS)
            raise scanner.error(
                f"expected a number or a function ({known}), found '{short(name)}'", word.start()
            )
        return float(FUNCTIONS[name](self._bracket()))
