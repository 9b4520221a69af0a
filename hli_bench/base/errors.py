"""Usage errors: the bench was used wrongly. What the emulated CNC reports is a record, never one of these."""

from dataclasses import dataclass


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
