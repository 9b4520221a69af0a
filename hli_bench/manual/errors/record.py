"""The sheet of an error message, and the short forms with which the tables are written."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from typing import Final

AXIS_NUMBER: Final = "logical axis number"
DRIVE_TYPE: Final = "drive type"
DRIVE_STATUS: Final = "drive status"
BLOCK_NUMBER: Final = "block number"
"""Values that many messages hand over; whoever reports for an axis and a block knows them."""


class Severity(StrEnum):
    """What the result file prints."""

    WARNING = "warning"
    ERROR = "error"


class ReactionClass(IntEnum):
    """How the control reacts. Source: TF5200 diagnosis 1.2."""

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
    """One message of the control; the text is our own, `{0}`, `{1}` stand for values and details."""

    number: int
    name: str
    """Constant name in small letters, for results and traces."""
    text: str
    reaction_class: ReactionClass
    remedy_class: int
    """2, 3, 5 correct the program or reset the channel, 6 restart of the channel, 7 and 8 restart."""
    values: tuple[str, ...] = ()
    """Meaning of each value that the control hands over."""
    details: tuple[str, ...] = ()
    """Meaning of what the bench adds, behind the values: a name that a text is clearer with."""
    source: str = ""

    @property
    def severity(self) -> Severity:
        """A message without reaction is a warning, any other an error."""
        return Severity.WARNING if self.reaction_class is ReactionClass.NONE else Severity.ERROR

    @property
    def names(self) -> tuple[str, ...]:
        """What the values and details of a report are called, in order."""
        return self.values + self.details

    def named(
        self, given: Sequence[float | str], known: Mapping[str, float | str] | None = None
    ) -> dict[str, float | str]:
        """Return what is handed over by name, in the order of the sheet.

        `given` are all values and details, or those that are not `known` where the report is made. Fewer leave the
        last ones out.
        """
        known = {} if len(given) == len(self.names) else known or {}
        rest = iter(given)
        values: dict[str, float | str] = {}
        for name in self.names:
            value = known[name] if name in known else next(rest, None)
            if value is not None:
                values[name] = value
        return values

    def message(self, values: Sequence[object] = ()) -> str:
        """Return the text with its values; a value that was not handed over prints as `?`."""
        padded = [*values, *("?" for _ in range(len(self.names) - len(values)))]
        return self.text.format(*padded)

    def message_of(self, named: Mapping[str, object]) -> str:
        """Return the text with values by name."""
        return self.message([named.get(name, "?") for name in self.names])

    def __str__(self) -> str:
        return f"P-ERR-{self.number}"


NOT_IN_BOOK: Final = "not in the public diagnosis book; classes as usual for the stage (decided here)"
SYSTEM: Final = "a system error without a text in the diagnosis book; text and values decided here"


def message(
    name: str,
    number: int,
    text: str,
    *values: str,
    classes: tuple[int, int],
    details: tuple[str, ...] = (),
    source: str = "",
) -> ErrorSheet:
    """Return a message with its classes of reaction and remedy."""
    return ErrorSheet(
        number=number,
        name=name,
        text=text,
        reaction_class=ReactionClass(classes[0]),
        remedy_class=classes[1],
        values=values,
        details=details,
        source=source or f"TF5200 diagnosis, ID {number}",
    )


def warning(
    name: str, number: int, text: str, *values: str, details: tuple[str, ...] = (), source: str = ""
) -> ErrorSheet:
    """Return a warning: no reaction, nothing to do (class 1)."""
    return message(name, number, text, *values, classes=(1, 1), details=details, source=source)


def program_error(
    name: str, number: int, text: str, *values: str, details: tuple[str, ...] = (), source: str = ""
) -> ErrorSheet:
    """Return an error of the program: abort it, correct it (classes 2 and 3)."""
    return message(name, number, text, *values, classes=(2, 3), details=details, source=source)


def motion_error(
    name: str, number: int, text: str, *values: str, details: tuple[str, ...] = (), source: str = ""
) -> ErrorSheet:
    """Return an error of the motion: feedhold for the group, reset (classes 4 and 6)."""
    return message(name, number, text, *values, classes=(4, 6), details=details, source=source)


def axis_error(
    name: str, number: int, text: str, *values: str, details: tuple[str, ...] = (), source: str = ""
) -> ErrorSheet:
    """Return an error of the position control: controlled stop, reset (classes 7 and 6)."""
    return message(name, number, text, *values, classes=(7, 6), details=details, source=source)
