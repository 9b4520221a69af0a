"""Binary signals of the machine (touch probe, cam switches): their exact edges."""

from dataclasses import dataclass

from hli_bench.base.time import Ns


@dataclass(frozen=True, slots=True)
class Edge:
    """A signal changed its level at `at_ns` (bench time), between two cycles."""

    signal: str
    at_ns: Ns
    level: bool
