"""The CiA 402 power state machine: states as statusword bits, commands as controlword patterns, one table."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import Final


class State(IntEnum):
    """Power states; the value is what the statusword shows under mask 0x6F."""

    NOT_READY_TO_SWITCH_ON = 0x00
    SWITCH_ON_DISABLED = 0x40
    READY_TO_SWITCH_ON = 0x21
    SWITCHED_ON = 0x23
    OPERATION_ENABLED = 0x27
    QUICK_STOP_ACTIVE = 0x07
    FAULT_REACTION_ACTIVE = 0x0F
    FAULT = 0x08


_LOOSE_MASK: Final = 0x4F
_MASK: Final = 0x6F
_LOOSE: Final = (
    State.NOT_READY_TO_SWITCH_ON,
    State.SWITCH_ON_DISABLED,
    State.FAULT_REACTION_ACTIVE,
    State.FAULT,
)


def state_of(statusword: int) -> State | None:
    """Return the state that a statusword shows, None for a pattern of no state (bit 5 is free in some)."""
    for state in State:
        mask = _LOOSE_MASK if state in _LOOSE else _MASK
        if statusword & mask == state:
            return state
    return None


class StatusBit(IntFlag):
    """Statusword bits beside the state; 12 and 13 have their meaning in cyclic synchronous position mode."""

    VOLTAGE_ENABLED = 0x0010
    WARNING = 0x0080
    REMOTE = 0x0200
    TARGET_REACHED = 0x0400
    INTERNAL_LIMIT = 0x0800
    DRIVE_FOLLOWS = 0x1000
    FOLLOWING_ERROR = 0x2000


class ControlBit(IntFlag):
    """Controlword bits."""

    SWITCH_ON = 0x0001
    ENABLE_VOLTAGE = 0x0002
    NO_QUICK_STOP = 0x0004
    ENABLE_OPERATION = 0x0008
    FAULT_RESET = 0x0080
    HALT = 0x0100


SHUTDOWN: Final = 0x06
SWITCH_ON: Final = 0x07
ENABLE_OPERATION: Final = 0x0F
QUICK_STOP: Final = 0x02
DISABLE_VOLTAGE: Final = 0x00
FAULT_RESET: Final = 0x80


@dataclass(frozen=True, slots=True)
class Transition:
    """Row of the table: CiA 402 number, from, controlword pattern (`word & mask == bits`), to.

    `edge` marks a pattern that counts only when it was not there before.
    """

    number: int
    source: State
    mask: int
    bits: int
    target: State
    edge: bool = False


_SO, _EV, _QS, _EO, _RESET = 0x01, 0x02, 0x04, 0x08, 0x80
_NO_VOLTAGE: Final = (_RESET | _EV, 0)
_QUICK: Final = (_RESET | _EV | _QS, _EV)
_SHUTDOWN: Final = (_RESET | _SO | _EV | _QS, _EV | _QS)
_ON: Final = (_RESET | _SO | _EV | _QS | _EO, _SO | _EV | _QS)
_ENABLE: Final = (_RESET | _SO | _EV | _QS | _EO, _SO | _EV | _QS | _EO)

TRANSITIONS: Final = (
    Transition(2, State.SWITCH_ON_DISABLED, *_SHUTDOWN, State.READY_TO_SWITCH_ON),
    Transition(7, State.READY_TO_SWITCH_ON, *_NO_VOLTAGE, State.SWITCH_ON_DISABLED),
    Transition(7, State.READY_TO_SWITCH_ON, *_QUICK, State.SWITCH_ON_DISABLED),
    Transition(3, State.READY_TO_SWITCH_ON, *_ON, State.SWITCHED_ON),
    Transition(3, State.READY_TO_SWITCH_ON, *_ENABLE, State.SWITCHED_ON),
    Transition(10, State.SWITCHED_ON, *_NO_VOLTAGE, State.SWITCH_ON_DISABLED),
    Transition(10, State.SWITCHED_ON, *_QUICK, State.SWITCH_ON_DISABLED),
    Transition(6, State.SWITCHED_ON, *_SHUTDOWN, State.READY_TO_SWITCH_ON),
    Transition(4, State.SWITCHED_ON, *_ENABLE, State.OPERATION_ENABLED),
    Transition(9, State.OPERATION_ENABLED, *_NO_VOLTAGE, State.SWITCH_ON_DISABLED),
    Transition(11, State.OPERATION_ENABLED, *_QUICK, State.QUICK_STOP_ACTIVE),
    Transition(8, State.OPERATION_ENABLED, *_SHUTDOWN, State.READY_TO_SWITCH_ON),
    Transition(5, State.OPERATION_ENABLED, *_ON, State.SWITCHED_ON),
    Transition(12, State.QUICK_STOP_ACTIVE, *_NO_VOLTAGE, State.SWITCH_ON_DISABLED),
    Transition(16, State.QUICK_STOP_ACTIVE, *_ENABLE, State.OPERATION_ENABLED),
    Transition(15, State.FAULT, _RESET, _RESET, State.SWITCH_ON_DISABLED, edge=True),
)
"""What the controlword does. Transitions 0, 1, 13 and 14 are automatic and not in the table.

`enable operation` in READY runs transition 3 and, with the same word, 4.
"""


_COMMAND_BITS: Final = _RESET | _EO | _QS | _EV | _SO
_BY_COMMAND: Final = {
    (row.source, word): row
    for word in range(_COMMAND_BITS + 1)
    for row in TRANSITIONS
    if word & ~_COMMAND_BITS == 0 and word & row.mask == row.bits
}
"""The table by state and command bits, because it is asked at every SYNC."""


def next_transition(state: State, word: int, before: int) -> Transition | None:
    """Return the transition that controlword `word`, after `before`, makes in `state`."""
    row = _BY_COMMAND.get((state, word & _COMMAND_BITS))
    return None if row is not None and row.edge and before & row.mask == row.bits else row


def walk(state: State, word: int, before: int) -> Iterator[Transition]:
    """Yield every transition that a newly received controlword makes, one after another."""
    row = next_transition(state, word, before)
    while row is not None:
        yield row
        row = next_transition(row.target, word, word)
