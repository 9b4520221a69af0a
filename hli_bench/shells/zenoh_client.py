"""A bench that is up, from outside: elements, programs, state, faults. What the command line uses."""

import json
import struct
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import Any, Final, Self
from urllib.parse import quote

import zenoh

from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.protocols.hli.layout import Layout
from hli_bench.shells.zenoh_session import LEASE_MS, TEXT, connect, payload, queued
from hli_bench.wire.images import TerminalLayout

ANSWER_S: Final = 5.0
"""How long the bench may take to answer anything but a program."""

PROGRAM_S: Final = 24 * 3600.0
LARGEST_IMAGE: Final = 1 << 20
"""Bytes of a terminal's process image; EtherCAT terminals have up to 1.5 kB."""
RESET_S: Final = 60.0
"""A reset is answered when all drives are back, at the latest after 2000 cycles."""


@dataclass(frozen=True, slots=True)
class Terms:
    """On which a PLC takes part: the first cycle it answers, the bench's cycle, its period, if it is waited for."""

    cycle: int
    cycle_us: int
    period_us: int
    lockstep: bool


class HliClient:
    """A client's session with one bench; use it as a context manager."""

    def __init__(self, endpoint: str, machine: str = "", lease_ms: int = LEASE_MS) -> None:
        """Connect; without `machine` the bench is asked for its name. It lets go of who is silent for `lease_ms`.

        Raises EnvironmentLacks when nobody listens on `endpoint` or no bench answers there.
        """
        self.endpoint = endpoint
        self.interrupted: dict[str, Any] | None = None
        """What a program had done when it was interrupted."""
        self.session = connect(endpoint, lease_ms)
        try:
            question = f"{machine or '*'}/hli/layout"
            answers = self._answers(self.session.get(question, timeout=ANSWER_S))
            key, layout = next(iter(answers.items()), ("", b""))
            if not key:
                raise EnvironmentLacks(f"no bench{f' of machine {machine!r}' * bool(machine)} at {endpoint}")
            self.machine = key.partition("/")[0]
            self.layout = Layout.from_json(layout)
            self.terminals = self._terminal_layouts()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the session."""
        self.session.close()

    def ls(self, part: str = "") -> list[tuple[str, str, str, str]]:
        """Return (path, type, unit, access) of the HLI elements and terminal entries with `part` in the path."""
        rows = [
            (element.path, element.type, element.unit, element.access) for element in self.layout.elements
        ]
        for terminal in self.terminals:
            rows += [(f"io/{terminal.name}/{entry}", kind, "", "r") for entry, kind, _ in terminal.entries]
        return [row for row in rows if part in row[0]]

    def get(self, name: str) -> Any:
        """Return the value of an element, or of all members of a unit or terminal by name.

        Raises InputError when there is nothing of that name.
        """
        selector = f"{self._path(name)}?format=json"
        return self._read(selector, self._one(selector))

    def set(self, name: str, text: str) -> str:
        """Write `text` (`TRUE`, `123`) to an element; return when done, with what the bench remarks on it or "".

        Raises InputError when it is refused.
        """
        path = self._path(name)
        if path.startswith("io/"):
            raise InputError(f"{name} is an input; only HLI elements can be set")
        return self._note(path, self._one(path, text, encoding=TEXT))

    def watch(self, name: str, timeout_s: float | None = None) -> Iterator[Any]:
        """Yield the value of an element, unit or terminal entry now and whenever it changes.

        Ends when the bench does, or when nothing changes for `timeout_s`.
        """
        path = self._path(name)
        element = path.removeprefix("hli/unit/")
        is_member = path.startswith("hli/") and element not in self.layout.groups
        put_path = path.rpartition("/")[0] if is_member else path
        changes: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        watched = [
            self.session.declare_subscriber(f"{self.machine}/{put_path}", queued(changes.put, "change")),
            self.session.liveliness().declare_subscriber(
                f"{self.machine}/bench/alive", queued(changes.put, "alive"), history=True
            ),
        ]
        try:
            last = self.get(name)
            yield last
            while self._changed(changes, timeout_s):
                value = self.get(name)
                if value != last:
                    last = value
                    yield value
        finally:
            for subscriber in watched:
                subscriber.undeclare()

    def run(self, text: str, name: str = "") -> dict[str, Any]:
        """Run an NC program and return its result. Raises InputError when the bench refuses it.

        KeyboardInterrupt aborts it and goes on; `interrupted` holds the result then.
        """
        selector = f"cnc/run?name={quote(name)}" if name else "cnc/run"
        replies = self._get(selector, text, PROGRAM_S)
        try:
            return self._object(selector, self._only(selector, replies))
        except KeyboardInterrupt:
            self.reset()
            self.interrupted = self._object(selector, self._only(selector, replies))
            raise

    def reset(self) -> str:
        """CNC reset; return when it has taken effect, with which drives are out of operation all the same or ""."""
        return self._note("cnc/reset", self._one("cnc/reset", timeout_s=RESET_S))

    def state(self) -> dict[str, Any]:
        """Return one look at the bench."""
        return self._object("cnc/state", self._one("cnc/state"))

    def cnc_errors(self) -> list[dict[str, Any]]:
        """Return the last error records of the CNC."""
        errors = self._read("cnc/errors", self._one("cnc/errors"))
        if not isinstance(errors, list):
            raise self._strange("cnc/errors")
        return errors

    def hli_errors(self) -> dict[str, Any]:
        """Return how many writes were refused, and the last of them."""
        return self._object("hli/errors", self._one("hli/errors"))

    def fault(self, order: Mapping[str, Any]) -> Any:
        """Send a fault order and return the answer. Raises InputError when it is refused."""
        return self._read("bench/fault", self._one("bench/fault", json.dumps(order)) or b"null")

    def attach(self, plc: str, period_us: int) -> Terms:
        """Attach a PLC whose liveliness token stands; return on which terms. Raises InputError when it is refused."""
        selector = f"plc/{plc}/attach"
        terms = self._object(selector, self._one(selector, json.dumps({"period_us": period_us})))
        match terms:
            case {
                "cycle": int(first),
                "cycle_us": int(cycle),
                "period_us": int(period),
                "lockstep": bool(step),
            } if 0 < cycle <= period:
                return Terms(first, cycle, period, step)
        raise self._strange(selector)

    def ask_packed(self, path: str, question: str | None = None) -> bytes:
        """Return the bench's answer to a get of `path` as it came. Raises InputError when it refuses."""
        return self._one(path, question)

    def _path(self, name: str) -> str:
        if not name.startswith("io/"):
            return f"hli/unit/{self.layout.resolve(name)}"
        known = {
            f"io/{terminal.name}{entry}"
            for terminal in self.terminals
            for entry in ("", *(f"/{entry}" for entry, _, _ in terminal.entries))
        }
        if name not in known:
            raise InputError(f"no terminal entry {name!r}; there are {', '.join(sorted(known))}")
        return name

    def _one(
        self, selector: str, question: str | None = None, timeout_s: float = ANSWER_S, encoding: Any = None
    ) -> bytes:
        return self._only(selector, self._get(selector, question, timeout_s, encoding))

    def _get(
        self, selector: str, question: str | None, timeout_s: float, encoding: Any = None
    ) -> Iterable[zenoh.Reply]:
        key = f"{self.machine}/{selector}"
        replies: Iterable[zenoh.Reply] = self.session.get(
            key, payload=question, encoding=encoding, timeout=timeout_s
        )
        return replies

    def _only(self, selector: str, replies: Iterable[zenoh.Reply]) -> bytes:
        """Return the answer of the bench. Raises InputError when it refuses, EnvironmentLacks when there is none."""
        answers = self._answers(replies)
        if not answers:
            raise EnvironmentLacks(f"the bench at {self.endpoint} has ended or does not answer {selector}")
        return next(iter(answers.values()))

    @staticmethod
    def _answers(replies: Iterable[zenoh.Reply]) -> dict[str, bytes]:
        """Return the answers by key. Raises InputError with the bench's reason when it refuses."""
        found: dict[str, bytes] = {}
        for reply in replies:
            if reply.ok is not None:
                found[str(reply.ok.key_expr)] = payload(reply.ok)
            elif reply.err is not None:
                reason = payload(reply.err).decode("utf-8", "replace")
                if reason != "Timeout":
                    raise InputError(reason)
        return found

    def _terminal_layouts(self) -> list[TerminalLayout]:
        rows = self._read("hli/terminals", self._one("hli/terminals"))
        try:
            layouts = [
                TerminalLayout(row["name"], tuple((e, kind, at) for e, kind, at in row["entries"]))
                for row in rows
            ]
            sizes = [layout.size for layout in layouts]
        except (KeyError, TypeError, ValueError, struct.error) as error:
            raise self._strange("hli/terminals") from error
        if any(not 0 <= size <= LARGEST_IMAGE for size in sizes):
            raise self._strange("hli/terminals")
        return layouts

    def _read(self, selector: str, answer: bytes) -> Any:
        """Return what is in an answer. Raises EnvironmentLacks when it is no JSON: anybody may answer to a key."""
        try:
            return json.loads(answer)
        except (ValueError, RecursionError) as error:
            raise self._strange(selector) from error

    def _object(self, selector: str, answer: bytes) -> dict[str, Any]:
        found = self._read(selector, answer)
        if not isinstance(found, dict):
            raise self._strange(selector)
        return found

    def _note(self, selector: str, answer: bytes) -> str:
        return str(self._object(selector, answer).get("note", "")) if answer else ""

    def _strange(self, selector: str) -> EnvironmentLacks:
        return EnvironmentLacks(
            f"{self.endpoint} answers {selector} with something that no bench of this version says"
        )

    @staticmethod
    def _changed(changes: SimpleQueue[tuple[str, Any]], timeout_s: float | None) -> bool:
        """Wait for the next change; False when there is none in time or the bench has ended."""
        try:
            kind, message = changes.get(timeout=timeout_s)
            while kind == "change" and not changes.empty():
                kind, message = changes.get_nowait()
        except Empty:
            return False
        return kind == "change" or bool(message.kind == zenoh.SampleKind.PUT)
