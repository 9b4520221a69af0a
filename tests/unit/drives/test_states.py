"""The 402 state walk: a rule machine whose model is the profile's diagram, not the project's table."""

from typing import Any

import numpy as np
import pytest
from canopen.profiles.p402 import State402
from hli_bench_drives.cia402.states import TRANSITIONS, State, next_transition, state_of
from hli_bench_drives.models import servo402
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from hli_bench.base.time import Ns
from hli_bench.laws.rows import SERVO

DISABLED, READY, ON, ENABLED = (
    State.SWITCH_ON_DISABLED,
    State.READY_TO_SWITCH_ON,
    State.SWITCHED_ON,
    State.OPERATION_ENABLED,
)
STOPPED, FAULT = State.QUICK_STOP_ACTIVE, State.FAULT

NAMES = {
    State.NOT_READY_TO_SWITCH_ON: "NOT READY TO SWITCH ON",
    DISABLED: "SWITCH ON DISABLED",
    READY: "READY TO SWITCH ON",
    ON: "SWITCHED ON",
    ENABLED: "OPERATION ENABLED",
    STOPPED: "QUICK STOP ACTIVE",
    State.FAULT_REACTION_ACTIVE: "FAULT REACTION ACTIVE",
    FAULT: "FAULT",
}

DIAGRAM = {
    DISABLED: {"shutdown": READY},
    READY: {"switch on": ON, "enable": ENABLED, "quick stop": DISABLED, "no voltage": DISABLED},
    ON: {"shutdown": READY, "enable": ENABLED, "quick stop": DISABLED, "no voltage": DISABLED},
    ENABLED: {"shutdown": READY, "switch on": ON, "quick stop": STOPPED, "no voltage": DISABLED},
    STOPPED: {"enable": ENABLED, "no voltage": DISABLED},
    FAULT: {},
}


def meaning(word: int) -> str:
    """Return the command of a controlword by its bits 0..3 and 7, written out."""
    if word & 0x80:
        return "none"
    switch_on, voltage, no_quick_stop, operation = (bool(word >> bit & 1) for bit in range(4))
    if not voltage:
        return "no voltage"
    if not no_quick_stop:
        return "quick stop"
    if not switch_on:
        return "shutdown"
    return "enable" if operation else "switch on"


class StateWalk(RuleBasedStateMachine):
    """Random controlwords and faults on a drive at standstill that stays in QUICK STOP ACTIVE (605A = 6)."""

    @initialize()
    def build(self) -> None:
        self.row = np.zeros(1, SERVO)[0]
        self.drive = servo402.create("Z", 1, self.row, {})
        self.drive.power_on()
        for index, option in ((0x605A, 6), (0x605C, 0), (0x605E, 0)):
            self.drive.device.values.put(index, 0, option)
        self.word = 0
        self.expected = DISABLED
        self.now = Ns(0)

    def cycle(self, word: int) -> None:
        self.now = Ns(self.now + 1_000_000)
        self.drive.exchange(word, 0, 0, self.now)
        if self.expected is FAULT:
            if word & 0x80 and not self.word & 0x80:
                self.expected = DISABLED
        else:
            self.expected = DIAGRAM[self.expected].get(meaning(word), self.expected)
        self.word = word

    @rule(word=st.sampled_from((0x00, 0x02, 0x06, 0x07, 0x0F, 0x80)))
    def usual_word(self, word: int) -> None:
        self.cycle(word)

    @rule(word=st.integers(0, 0xFFFF))
    def any_word(self, word: int) -> None:
        self.cycle(word)

    @rule()
    def same_word_again(self) -> None:
        self.cycle(self.word)

    @rule()
    def fault(self) -> None:
        self.drive.fault(0x8611)
        self.expected = FAULT

    @invariant()
    def shows_the_expected_state(self) -> None:
        if not hasattr(self, "drive"):
            return
        assert self.drive.state is self.expected
        assert state_of(self.drive.statusword) is self.expected
        assert self.row["enabled"] == (self.expected in {ENABLED, STOPPED})


StateWalk.TestCase.settings = settings(max_examples=80, stateful_step_count=40, deadline=None)
TestStateWalk = StateWalk.TestCase


@pytest.mark.parametrize("state", list(State))
@pytest.mark.parametrize("others", [0x0000, 0x0010, 0x3E10, 0xFFB0 & ~0x0020])
def test_statuswords_read_as_python_canopen_reads_them(state: State, others: int) -> None:
    word = state | others
    mask, bits = State402.SW_MASK[NAMES[state]]
    assert word & mask == bits
    assert state_of(word) is state


def test_table_covers_every_transition_of_the_profile_that_a_master_makes() -> None:
    assert {row.number for row in TRANSITIONS} == {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 15, 16}


@pytest.mark.parametrize("state", list(State))
def test_at_most_one_transition_fits_any_controlword(state: State) -> None:
    for word in range(256):
        fitting = [row for row in TRANSITIONS if row.source is state and word & row.mask == row.bits]
        assert len(fitting) <= 1
        assert next_transition(state, word, 0) is (fitting[0] if fitting else None)


def test_walk_by_python_canopens_transition_table() -> None:
    steps: list[Any] = []
    for (source, target), word in State402.TRANSITIONTABLE.items():
        by_name = {name: state for state, name in NAMES.items()}
        if source in by_name and target in by_name and source not in {"START", "NOT READY TO SWITCH ON"}:
            steps.append((by_name[source], by_name[target], word))
    manual = [step for step in steps if step[0] is not State.FAULT_REACTION_ACTIVE and step[1] is not FAULT]
    for source, target, word in manual:
        row = next_transition(source, word, 0)
        assert row is not None, (source, target, hex(word))
        reached = row.target
        assert reached is target or next_transition(reached, word, word) is not None
