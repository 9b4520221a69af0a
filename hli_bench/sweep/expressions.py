"""Metrics: small expressions over the result and the settings of a run.

Numbers, `+ - * /`, brackets, `abs min max len`, and paths: `measurements.0.acs_mm`, `measurements[-1].dc_ns`,
`variables['V.A.MESS.Z']`, `settings['plant.probe.Z.face_mm']`. What a run does not have makes the metric empty.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import lru_cache
from types import UnionType
from typing import Any, Final, NamedTuple, get_args, get_origin

from hli_bench.bench.result import Result


class Ended(NamedTuple):
    """A run that has ended, as expressions see it."""

    result: Result
    settings: Mapping[str, Any]


Evaluate = Callable[[Ended], Any]
"""Gives the value of a part of an expression, or raises what `ABSENT` names."""
Metric = Callable[[Result, Mapping[str, Any]], float | None]

OF_THE_CLOCK: Final = frozenset({"wall_s", "late_cycles", "lateness"})
"""Parts of a result that differ from one execution to the next, so that no metric may take them."""
ROOTS: Final[Mapping[str, Any]] = {
    item.name: item.type for item in fields(Result) if item.name not in OF_THE_CLOCK
}
SETTINGS: Final = "settings"
OPERATORS: Final[Mapping[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
FUNCTIONS: Final[Mapping[str, Callable[..., Any]]] = {"abs": abs, "min": min, "max": max, "len": len}
ABSENT: Final = (LookupError, ZeroDivisionError, OverflowError, TypeError)
INDEX: Final = re.compile(r"""'[^']*'|"[^"]*"|(?<=[A-Za-z_\]])\.(\d+)\b|(?<=[A-Za-z_]\d)\.(\d+)\b""")
LENGTH: Final = 1000
"""Longest expression, decided here: what is longer is a mistake."""


@lru_cache(maxsize=256)
def metric(text: str, keys: Collection[str]) -> Metric:
    """Return the metric that `text` describes; `keys` are the settings there are. Raises ValueError."""
    if len(text) > LENGTH:
        raise ValueError(f"longer than {LENGTH} characters")
    try:
        tree = ast.parse(_indexed(text), mode="eval")
    except (SyntaxError, RecursionError) as error:
        raise ValueError(f"{text!r} is no expression") from error
    kind, evaluate = _part(tree.body, keys)
    if not _numeric(kind):
        raise ValueError(f"{text!r} is no number")

    def value(result: Result, settings: Mapping[str, Any]) -> float | None:
        try:
            found = float(evaluate(Ended(result, settings)))
        except (*ABSENT, ValueError):
            return None
        return found if math.isfinite(found) else None

    return value


def _indexed(text: str) -> str:
    """Return the text with `.0` after a name as `[0]`; quoted keys stay as they are."""
    before = None
    while before != text:
        before = text
        text = INDEX.sub(
            lambda match: f"[{match[1] or match[2]}]" if match[1] or match[2] else match[0], text
        )
    return text


def _numeric(kind: Any) -> bool:
    return kind in {int, float, bool} or (isinstance(kind, UnionType) and any(map(_numeric, get_args(kind))))


def _part(node: ast.expr, keys: Collection[str]) -> tuple[Any, Evaluate]:
    """Return type and evaluation of a part. Raises ValueError for what an expression may not have."""
    match node:
        case ast.Constant(value=bool() | int() | float() as number):
            return type(number), lambda _: number
        case ast.BinOp(left, of, right) if type(of) in OPERATORS:
            apply, first, second = OPERATORS[type(of)], _number(left, keys), _number(right, keys)
            return float, lambda run: apply(first(run), second(run))
        case ast.UnaryOp(ast.USub(), operand):
            inner = _number(operand, keys)
            return float, lambda run: -inner(run)
        case ast.Call(ast.Name(name), arguments, []) if name in FUNCTIONS and arguments:
            return _call(name, arguments, keys)
        case ast.Name(name):
            return _root(name)
        case ast.Attribute(owner, name):
            return _attribute(owner, name, keys)
        case ast.Subscript(owner, key):
            return _element(owner, key, keys)
        case _:
            pass
    raise ValueError(
        f"{ast.unparse(node)}: expected numbers, + - * /, brackets, {' '.join(FUNCTIONS)}, and paths into the result"
    )


def _number(node: ast.expr, keys: Collection[str]) -> Evaluate:
    kind, evaluate = _part(node, keys)
    if not _numeric(kind):
        raise ValueError(f"{ast.unparse(node)} is no number")
    return evaluate


def _call(name: str, arguments: Sequence[ast.expr], keys: Collection[str]) -> tuple[Any, Evaluate]:
    function = FUNCTIONS[name]
    if name == "len":
        kind, of = _part(arguments[0], keys)
        if len(arguments) > 1 or get_origin(kind) is None:
            raise ValueError("len: expected one list, such as len(measurements)")
        return int, lambda run: len(of(run))
    if (name == "abs") != (len(arguments) == 1):
        raise ValueError(f"{name}: expected {'one number' if name == 'abs' else 'several numbers'}")
    parts = [_number(argument, keys) for argument in arguments]
    return float, lambda run: function(*(part(run) for part in parts))


def _root(name: str) -> tuple[Any, Evaluate]:
    if name == SETTINGS:
        return SETTINGS, lambda run: run.settings
    if name in OF_THE_CLOCK:
        raise ValueError(f"{name} differs from one execution to the next")
    if name not in ROOTS:
        raise ValueError(f"{name!r} is not one of {', '.join((*ROOTS, SETTINGS))}")
    return ROOTS[name], lambda run: getattr(run.result, name)


def _attribute(owner: ast.expr, name: str, keys: Collection[str]) -> tuple[Any, Evaluate]:
    kind, of = _part(owner, keys)
    text = ast.unparse(owner)
    if not is_dataclass(kind):
        hint = "a number in brackets" if get_origin(kind) in {list, Sequence} else "a quoted name in brackets"
        raise ValueError(f"{text} has no {name!r}: expected {hint}")
    known = {item.name: item.type for item in fields(kind)}
    if name not in known:
        raise ValueError(f"{text}.{name}: {name!r} is not one of {', '.join(known)}")
    return known[name], lambda run: getattr(of(run), name)


def _element(owner: ast.expr, key: ast.expr, keys: Collection[str]) -> tuple[Any, Evaluate]:
    kind, of = _part(owner, keys)
    text = ast.unparse(owner)
    try:
        at = ast.literal_eval(key)
    except (ValueError, TypeError):
        at = None
    if kind == SETTINGS:
        if not isinstance(at, str) or at not in keys:
            raise ValueError(f"settings[{at!r}] is not a key of this campaign ({', '.join(sorted(keys))})")
        return float | int | str, lambda run: run.settings[at]
    origin = get_origin(kind)
    wanted = int if origin is Sequence else str if origin is Mapping else None
    if wanted is None or type(at) is not wanted:
        expected = "nothing" if wanted is None else "a whole number" if wanted is int else "a quoted name"
        raise ValueError(f"{ast.unparse(key)} in the brackets of {text}: expected {expected}")
    return get_args(kind)[-1], lambda run: of(run)[at]
