"""A scenario: a machine, its PLCs, and programs behind one another with what comes from outside meanwhile."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from net.grammar import Block, program_text, random_program
from net.machines import Machine, Random, chance, pick, random_machine
from net.outside import Act
from net.plcs import SERVING, script

LIMIT_S: Final = 60.0
"""Machine time that no random program needs."""
UNITS: Final = (
    ("ch/1/bahn_mc_control/feedhold", (0, 1)),
    ("ch/1/bahn_mc_control/override", (1000, 500, 0, 100, 1300)),
    ("ch/1/bahn_mc_control/override_feedrate", (1000, 500, 0, 100, 1300)),
    ("ch/1/bahn_mc_control/override_valid", (0, 1)),
    ("ch/1/bahn_mc_control/delete_distance_to_go", (0, 1)),
    ("ax/1/ipo_mc_control/feedhold", (0, 1)),
    ("ax/3/ipo_mc_control/feedhold", (0, 1)),
    ("ax/2/ipo_mc_control/override", (1000, 300)),
    ("ax/2/ipo_mc_control/override_valid", (0, 1)),
    ("ax/2/lr_mc_control/release_feedhold", (0, 1)),
    ("ax/3/lr_mc_control/release_feedhold", (0, 1)),
    ("ax/3/lr_mc_control/probing_signal", (0, 1)),
    ("ax/3/lr_mc_control/probing_position", (400_000, -5)),
    ("ax/1/lr_mc_control/reference_cam", (0, 1)),
)
"""Units that clients put; those that a commit does not have are left out when their time comes."""


@dataclass(frozen=True, slots=True)
class Step:
    """A program, and what comes from outside while it runs."""

    blocks: tuple[Block, ...]
    acts: tuple[Act, ...] = ()


@dataclass(frozen=True, slots=True)
class Scenario:
    """`plcs` None: the machine's own; else names of scripts of the net with their periods."""

    seed: int
    machine: Machine
    plcs: tuple[tuple[str, int], ...] | None
    steps: tuple[Step, ...]

    def scripts(self) -> Mapping[str, str] | None:
        """Return the texts of the PLC scripts by name."""
        if self.plcs is None:
            return None
        return {
            f"{name}_{n}": script(name, period_us=us, seed=self.seed)
            for n, (name, us) in enumerate(self.plcs)
        }

    def text(self) -> str:
        """Return it for people."""
        lines = [
            f"machine {self.machine.folder}, PLC {'its own' if self.plcs is None else self.plcs or 'none'}"
        ]
        lines += [f"  --set {key}={json.dumps(value)}" for key, value in self.machine.settings.items()]
        for number, step in enumerate(self.steps, 1):
            acts = f" ({', '.join(map(str, step.acts))})" if step.acts else ""
            lines += [f"program {number}{acts}:"]
            lines += [f"  {line}" for line in program_text(step.blocks).splitlines()]
        return "\n".join(lines)

    def with_settings(self, settings: Mapping[str, object]) -> "Scenario":
        """Return the same on a machine with other settings."""
        return replace(self, machine=replace(self.machine, settings=settings))


def scenario(seed: int) -> Scenario:
    """Return the scenario of a seed."""
    random = np.random.default_rng(seed)
    machine = random_machine(random)
    steps = tuple(_step(random, machine) for _ in range(int(random.integers(1, 5))))
    return Scenario(seed, machine, _plcs(random, machine), steps)


def _step(random: Random, machine: Machine) -> Step:
    blocks = tuple(random_program(random, machine))
    count = int(random.integers(1, 4)) if chance(random, 0.4) else 0
    return Step(blocks, tuple(act for _ in range(count) for act in _acts(random)))


def _acts(random: Random) -> Sequence[Act]:
    """Return what a moment brings: something that ends the program, or puts of a client."""
    at_ms = round(float(random.uniform(1, 4000)), 1)
    what = pick(random, "interrupt", "reset", "reset", "put", "put", "put", "put")
    if what != "put":
        return [Act(what, at_ms)]
    unit, values = pick(random, *UNITS)
    head = "/".join([*unit.split("/")[:2], "head/plc_present_w"])
    acts = [Act("put", at_ms, head, 1), Act("put", at_ms, f"{unit}/enable_w", 1)]
    acts.append(Act("put", at_ms + 1.0, f"{unit}/command_w", pick(random, *values)))
    if chance(random, 0.7):
        acts.append(Act("put", at_ms + float(random.integers(2, 1500)), f"{unit}/enable_w", 0))
    return acts


def _plcs(random: Random, machine: Machine) -> tuple[tuple[str, int], ...] | None:
    """Return PLCs: mostly one that serves all, seldom none, several, or others."""
    if machine.folder == "demo" and machine.cycle_us in (500, 1000) and chance(random, 0.3):
        return None
    if chance(random, 0.1):
        return ()
    name = pick(random, "good", "good", "restless", *SERVING)
    cycles = pick(random, 1, 4, 4, 7, 20)
    plcs = [(name, cycles * max(machine.cycle_us, 1000))]
    if chance(random, 0.1):
        plcs.append(("looker", 5 * max(machine.cycle_us, 1000)))
    return tuple(plcs)
