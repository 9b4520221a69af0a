"""The sheet of an error message, and the short forms with which the tables are written."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum, StrEnum


class Severity(StrEnum):
    """What the result file prints."""

    WARNING = "warning"
    ERROR = "error"


class ReactionClass(IntEnum):
    """How the control reacts. Source: TF5200 diagnosis, infosys pages 402316811 and 402318347."""

    NONE = 1
    ABORT_PROGRAM = 2
    ABORT_JOB = 3
    FEEDHOLD_GROUP = 4
    STOP_AXIS = 5
    STOP_ALL = 6
    CONTROLLED_STOP = 7
    OPEN_LOOP_STOP = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorSheet:
    """One message of the control; the text is our own, `{0}`, `{1}` stand for the values."""

    number: int
    name: str
    """Constant name in small letters, for results and traces."""
    text: str
    severity: Severity
    reaction_class: ReactionClass
    remedy_class: int
    """2, 3, 5 correct the program or reset the channel, 6 restart of the channel, 7 restart."""
    values: tuple[str, ...] = ()
    """Meaning of each value."""
    source: str = ""

    def message(self, values: Sequence[object] = ()) -> str:
        """Return the text with its values; a value that was not handed over prints as `?`."""
        padded = [*values, *("?" for _ in range(len(self.values) - len(values)))]
        return self.text.format(*padded)

    def __str__(self) -> str:
        return f"P-ERR-{self.number}"


CATALOGUE = "message catalogue v300; classes as usual for the stage (decided here)"
"""Source of messages whose diagnosis page was not at hand."""


def diagnosis(number: int) -> str:
    """Return the source text of a message whose diagnosis page was read."""
    return f"TF5200 diagnosis, ID {number}"


def warning(name: str, number: int, text: str, *values: str, source: str = CATALOGUE) -> ErrorSheet:
    """Return a warning: no reaction, nothing to do (class 1)."""
    return ErrorSheet(
        number=number,
        name=name,
        text=text,
        severity=Severity.WARNING,
        reaction_class=ReactionClass.NONE,
        remedy_class=1,
        values=values,
        source=source,
    )


def program_error(name: str, number: int, text: str, *values: str, source: str = CATALOGUE) -> ErrorSheet:
    """Return an error of the program: abort it, correct it (classes 2 and 3)."""
    return ErrorSheet(
        number=number,
        name=name,
        text=text,
        severity=Severity.ERROR,
        reaction_class=ReactionClass.ABORT_PROGRAM,
        remedy_class=3,
        values=values,
        source=source,
    )


def motion_error(name: str, number: int, text: str, *values: str, source: str = CATALOGUE) -> ErrorSheet:
    """Return an error of the motion: feedhold for the group, restart of the channel (classes 4 and 6)."""
    return ErrorSheet(
        number=number,
        name=name,
        text=text,
        severity=Severity.ERROR,
        reaction_class=ReactionClass.FEEDHOLD_GROUP,
        remedy_class=6,
        values=values,
        source=source,
    )


def axis_error(
    name: str,
    number: int,
    text: str,
    *values: str,
    source: str = CATALOGUE,
    remedy: int = 6,
    reaction: ReactionClass = ReactionClass.CONTROLLED_STOP,
) -> ErrorSheet:
    """Return an error of the position control: controlled stop, restart of the channel (classes 7 and 6)."""
    return ErrorSheet(
        number=number,
        name=name,
        text=text,
        severity=Severity.ERROR,
        reaction_class=reaction,
        remedy_class=remedy,
        values=values,
        source=source,
    )
