"""Usage errors: the bench was used wrongly. What the emulated CNC reports is a record, never one of these."""

from dataclasses import dataclass
from typing import Final


class BenchError(Exception):
    """Base of every usage error; `exit_status` is what the command line ends with."""

    exit_status = 2


@dataclass(slots=True)
class InputError(BenchError):
    """Bad input: a program, list, machine folder or EDS. Names the place and what was expected."""

    message: str
    file: str = ""
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        return f"{place}: {self.message}" if place else self.message


class NotEmulated(BenchError):
    """Something the manuals describe and this bench does not do yet; it says so instead of pretending."""

    def __init__(self, what: str) -> None:
        super().__init__(f"NotEmulated: {what}")


class EnvironmentLacks(BenchError):
    """The computer cannot serve what was asked for: no such CAN interface, port in use."""

    exit_status = 3


class Stop(BaseException):
    """Ends a call of a user's code from outside: no error of that code, which may catch every Exception."""


STOPS: Final = (KeyboardInterrupt, Stop)
"""What passes through a user's code and is not its fault."""


def told(error: BaseException) -> str:
    """Return an exception of a user's code as type and text; its `__str__` is a user's code too and may fail."""
    name = type(error).__name__
    try:
        return f"{name}: {error}"
    except STOPS:
        raise
    except BaseException as second:
        return f"{name} (its text cannot be had: {type(second).__name__})"
