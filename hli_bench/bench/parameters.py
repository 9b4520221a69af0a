"""List files and the parameters built from them, each worked out once a process for the same text."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from hli_bench.bench.sources import Given
from hli_bench.manual.lists import Finding, build, check_values, parse_list, refusals
from hli_bench.manual.sheet import Value


class Tree(NamedTuple):
    """Parameters as built from their values, with what there is to say about them."""

    params: Any
    findings: Sequence[tuple[str, Finding]]
    refused: Sequence[tuple[str, str]]
    """What is not built: path of the value, and the text that says so."""


@lru_cache(maxsize=256)
def built(cls: Any, values: tuple[tuple[str, Value], ...], *exact: str) -> Tree:
    """Build and check parameters, once a process for the same values: benches of a sweep differ in few of them.

    `exact` are the texts they come from: they tell values apart that are equal and not the same (0.0 and -0.0).
    """
    params = build(cls, dict(values))
    return Tree(params, check_values(cls, dict(values)), refusals(cls, dict(values)))


class Listed(NamedTuple):
    """A list file: its values with their places, and findings beside those that checks of values repeat."""

    values: dict[str, Value]
    places: Mapping[str, Given]
    findings: Sequence[Finding]


@lru_cache(maxsize=256)
def listed(cls: Any, text: str, file: str, *, lenient: bool) -> Listed:
    """Parse a list, once a process for the same text."""
    parsed = parse_list(cls, text, file, lenient=lenient)
    about_values = {finding.message for _, finding in check_values(cls, parsed.values)}
    places = {key: Given(value, file, parsed.lines[key]) for key, value in parsed.values.items()}
    findings = [finding for finding in parsed.findings if finding.message not in about_values]
    return Listed(dict(parsed.values), places, findings)
