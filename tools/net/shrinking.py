"""Makes a scenario that fails as small as it can: programs, blocks, acts, PLCs and settings go, one after another."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

from net.scenario import Scenario

TRIES: Final = 150
"""Scenarios that are tried at the most."""


def shrunk(scenario: Scenario, fails: Callable[[Scenario], bool], tries: int = TRIES) -> Scenario:
    """Return the smallest scenario found that still fails."""
    smaller = True
    while smaller and tries > 0:
        smaller = False
        for candidate in _smaller(scenario):
            tries -= 1
            if fails(candidate):
                scenario, smaller = candidate, True
                break
            if tries <= 0:
                break
    return scenario


def _smaller(scenario: Scenario) -> Iterator[Scenario]:
    """Yield scenarios with a piece less, large pieces first."""
    steps = scenario.steps
    for number in range(len(steps) if len(steps) > 1 else 0):
        yield replace(scenario, steps=steps[:number] + steps[number + 1 :])
    for number, step in enumerate(steps):
        size = len(step.blocks)
        while size > 1:
            size //= 2
            for first in range(0, len(step.blocks), size):
                blocks = step.blocks[:first] + step.blocks[first + size :]
                yield _with(scenario, number, replace(step, blocks=blocks))
        for act in step.acts:
            yield _with(scenario, number, replace(step, acts=tuple(one for one in step.acts if one != act)))
        for at, block in enumerate(step.blocks):
            lines = block.text.split("\n")
            for line in range(len(lines) if len(lines) > 1 else 0):
                less = replace(block, text="\n".join(lines[:line] + lines[line + 1 :]))
                yield _with(
                    scenario, number, replace(step, blocks=(*step.blocks[:at], less, *step.blocks[at + 1 :]))
                )
    if scenario.plcs:
        yield replace(scenario, plcs=())
    elif scenario.plcs is None:
        yield replace(scenario, plcs=(("good", max(scenario.machine.cycle_us, 1000)),))
    for key in scenario.machine.settings:
        left = {name: value for name, value in scenario.machine.settings.items() if name != key}
        yield scenario.with_settings(left)


def _with(scenario: Scenario, number: int, step: object) -> Scenario:
    return replace(scenario, steps=(*scenario.steps[:number], step, *scenario.steps[number + 1 :]))  # type: ignore[arg-type]
