"""One seed after another: perform, check, make small what fails."""

from collections.abc import Iterator

from net.invariants import Finding, findings
from net.sameness import performed, same_behind, same_steps
from net.scenario import Scenario, scenario
from net.shrinking import shrunk
from net.trial import trial

SINGLE = 5
"""Every so many seeds are performed cycle by cycle as well."""
PROCESSES = 100
"""Every so many seeds are performed by processes as well: they take seconds to start."""


def found_by(one: Scenario, *, single: bool = False, processes: bool = False) -> list[Finding]:
    """Return what does not hold of a scenario."""
    with trial(one) as seen:
        found = findings(seen)
        if seen.bench is None or not seen.spans:
            return found
        strides = performed(seen) if single or processes else None
        if not found:
            found += same_behind(seen)
    if strides is not None:
        if single:
            found += same_steps(one, strides)
        if processes:
            found += same_steps(one, strides, processes=True)
    return found


def found_in(seed: int) -> list[Finding]:
    """Return what does not hold of the scenario of a seed."""
    return found_by(scenario(seed), single=seed % SINGLE == 0, processes=seed % PROCESSES == PROCESSES - 1)


def smallest(seed: int, finding: Finding) -> Scenario:
    """Return the smallest scenario found that fails as this one."""
    single, processes = "single cycles" in finding.check, "processes" in finding.check

    def fails(one: Scenario) -> bool:
        return any(
            other.check == finding.check for other in found_by(one, single=single, processes=processes)
        )

    return shrunk(scenario(seed), fails)


def report(seed: int, found: list[Finding]) -> Iterator[str]:
    """Yield what is printed of a seed that fails: its lines, and the smallest program."""
    for finding in found:
        yield f"seed {seed}: {finding}"
    yield f"again: .venv/bin/python tools/swarm.py --seeds {seed}:{seed + 1}"
    yield from smallest(seed, found[0]).text().splitlines()
