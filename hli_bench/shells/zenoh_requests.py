"""What clients ask of the bench over Zenoh, each to be answered once."""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from io import StringIO
from typing import Any, Final

import zenoh

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.access import MemberWrite, Refusal
from hli_bench.shells.zenoh_session import JSON, PACKED, TEXT, payload

LONGEST_PROGRAM: Final = 16 << 20
"""Bytes of an NC program that a client may send (decided here)."""
LONGEST_QUESTION: Final = 4096
"""Bytes of a JSON object that a client may send (decided here)."""


@dataclass(slots=True, kw_only=True, eq=False)
class Request:
    """Something asked with `key`. A put (`query` None) gets no answer, nor does who has gone meanwhile."""

    key: str
    report: Callable[[list[Refusal]], None]
    query: Any = None

    def reply(self, answer: bytes | str = b"") -> None:
        """Answer that it has been done; a str is sent as JSON."""
        if self.query is not None:
            with suppress(zenoh.ZError), self.query as query:
                query.reply(self.key, answer, encoding=JSON if isinstance(answer, str) else PACKED)

    def refuse(self, reason: str) -> None:
        """Answer that it was not done and why; it is counted and put in `hli/errors` too."""
        path = self.key.partition("/")[2].removeprefix("hli/unit/")
        self.report([Refusal(path, reason)])
        self.deny(reason)

    def deny(self, reason: str) -> None:
        """Answer that it was not done and why."""
        if self.query is not None:
            with suppress(zenoh.ZError), self.query as query:
                query.reply_err(reason, encoding=TEXT)


@dataclass(slots=True, kw_only=True, eq=False)
class WriteRequest(Request):
    """A member of a control unit to be written."""

    write: MemberWrite


@dataclass(slots=True, kw_only=True, eq=False)
class Attach(Request):
    """A PLC wants to take part, every `period_us`."""

    plc: str
    period_us: int
    admit: Callable[[str], str]
    layout: str
    """CRC-32 of the layout, so that a PLC sees whether the ids it has learnt hold for this bench."""

    def accept(self, *, cycle: int, cycle_us: int, lockstep: bool) -> bool:
        """Take the PLC in: it answers the images from `cycle` on whose number its period in cycles divides.

        False: it has gone meanwhile, or another took its name; the request is refused then.
        """
        reason = self.admit(self.plc)
        if reason:
            self.refuse(reason)
            return False
        self.reply(
            json.dumps(
                {
                    "cycle": cycle,
                    "cycle_us": cycle_us,
                    "period_us": self.period_us,
                    "lockstep": lockstep,
                    "layout": self.layout,
                }
            )
        )
        return True


@dataclass(slots=True, kw_only=True, eq=False)
class RunProgram(Request):
    """An NC program to run, under the name it was given; the reply is the result as JSON.

    It is text, never a path: who wants a file to run reads it.
    """

    packed: bytes
    name: str

    def lines(self) -> Iterator[str]:
        """Yield the lines of the text, as those of a file are read."""
        text = self.packed.decode("utf-8-sig", "replace")
        return (line.rstrip("\n") for line in StringIO(text, newline=None))


@dataclass(slots=True, kw_only=True, eq=False)
class Reset(Request):
    """A CNC reset."""


@dataclass(slots=True, kw_only=True, eq=False)
class State(Request):
    """One look at the bench; the reply is JSON."""


@dataclass(slots=True, kw_only=True, eq=False)
class FaultOrder(Request):
    """A fault to inject, to clear or to list: the JSON object that the client sent."""

    order: Mapping[str, Any]


def json_object(query: zenoh.Query) -> dict[str, Any]:
    """Return the JSON object in a query's payload. Raises InputError when it is something else."""
    packed = payload(query)
    if len(packed) > LONGEST_QUESTION:
        raise InputError(f"{len(packed)} bytes: a JSON object of at most {LONGEST_QUESTION} expected")
    try:
        found = json.loads(packed)
    except (ValueError, RecursionError) as error:
        raise InputError(f"no JSON: {error}") from error
    if not isinstance(found, dict):
        raise InputError("a JSON object expected")
    return found
