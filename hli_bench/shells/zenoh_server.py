"""The bench's side of the HLI over Zenoh: network threads only queue, the bench loop does everything else."""

import json
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any, Final, Self
from urllib.parse import unquote

import zenoh

from hli_bench.base.errors import InputError
from hli_bench.base.time import Ns
from hli_bench.protocols.hli.access import MemberWrite, Refusal
from hli_bench.protocols.hli.layout import Layout
from hli_bench.protocols.hli.packing import CommandsPacking, pack_image
from hli_bench.shells.zenoh_requests import (
    Attach,
    FaultOrder,
    Request,
    Reset,
    RunProgram,
    State,
    WriteRequest,
    json_object,
)
from hli_bench.shells.zenoh_session import (
    JSON,
    PACKED,
    is_text,
    listen,
    on_network_thread,
    payload,
    queued,
)
from hli_bench.shells.zenoh_values import Answers, LastValues
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.images import TerminalLayout

COMMANDS: Final = "/commands"
"""End of the key of a PLC's commands."""
LONGEST_PERIOD_US: Final = 3_600_000_000
"""Of a PLC that attaches: an hour (decided here)."""
STRANGERS: Final = 64
"""So many names of clients that write without being attached are remembered, each to be told once."""
LOOKS: Final = 1000
"""How often Zenoh is asked who listens after it said that this has changed: it says so before it knows itself, and
asking it takes as long as a put."""
READ_ONLY: Final = ("io/**", "hli/layout", "hli/errors", "hli/terminals", "cnc/state", "cnc/errors")
"""What only the bench puts; not the image, for which a subscriber would have it put every cycle."""
REPLIES_A_CALL: Final = 64
"""Replies to reading queries sent per look at the inbox, so that a wide query does not stop the cycle."""


class HliServer:
    """A router session with the keys of a machine; use it as a context manager and from one thread.

    `late` counts, by attached PLC, commands that answered an older cycle; `refused` counts writes and requests.
    """

    def __init__(
        self,
        endpoint: str,
        machine: str,
        layout: Layout,
        terminals: Sequence[TerminalLayout],
        *,
        lockstep: bool = True,
    ) -> None:
        """Listen on `endpoint`, for a bench that waits for its PLCs or for one that keeps its cycle.

        Raises EnvironmentLacks when it cannot listen.
        """
        self.machine = machine
        self._name_at = len(f"{machine}/plc/")
        self.late: dict[str, int] = {}
        self._io: Mapping[str, bytes] = {}
        """The images that were put last; the bench makes new ones only when one has changed."""
        self._values = LastValues(layout, terminals)
        self._packing = CommandsPacking(layout)
        self._mail: dict[str, deque[bytes]] = {}
        self._strangers: deque[str] = deque(maxlen=STRANGERS)
        self._alive_plcs: set[str] = set()
        self._departed: list[str] = []
        self._requests: list[Request] = []
        self._answers: deque[tuple[Any, Answers]] = deque()
        self._inbox: SimpleQueue[tuple[Callable[[Any], None], Any] | zenoh.Sample] = SimpleQueue()
        """What came, with what handles it; commands come bare: no Python runs for them before the bench looks."""
        self._looks = LOOKS
        self._image_wanted = False
        self._session = listen(endpoint, lockstep=lockstep)
        try:
            self._declare()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the session; a process with callbacks that does not hangs at its exit."""
        self._session.close()

    @property
    def refused(self) -> int:
        """Writes and requests refused so far."""
        return self._values.refused

    @property
    def attached(self) -> list[str]:
        """Names of the PLCs that take part."""
        return list(self._mail)

    def alive(self, plc: str) -> bool:
        """Tell whether a PLC's session lives."""
        self._drain()
        return plc in self._alive_plcs

    def publish(
        self,
        cycle: int,
        dc_ns: Ns,
        image: bytes,
        units: Iterable[tuple[str, bytes]],
        io: Mapping[str, bytes],
    ) -> None:
        """Put what changed in a cycle: terminals, units, then the image, which says that all is there.

        An image that nobody listens to is kept for queries only.
        """
        if io is not self._io:
            self._io = io
            for terminal, data in io.items():
                for path, packed in self._values.take_terminal(terminal, data):
                    self._put(path, packed)
        for path, packed in units:
            self._put(f"hli/unit/{path}", packed)
        self._values.cycle, self._values.dc_ns, self._values.image = cycle, dc_ns, image
        if self._mail or self.image_wanted:
            self._image.put(pack_image(cycle, dc_ns, image))

    @property
    def image_wanted(self) -> bool:
        """Whether anybody listens to `hli/image`."""
        if self._looks:
            self._looks -= 1
            self._image_wanted = bool(self._image.matching_status.matching)
        return self._image_wanted

    @property
    def stirs(self) -> bool:
        """Whether something was asked or a PLC departed since the last look."""
        self._drain()
        return bool(self._requests or self._answers or self._departed)

    def requests(self) -> list[Request]:
        """Return what was asked since the last call, in order; reading queries are answered here."""
        self._drain()
        self._answer(REPLIES_A_CALL)
        requests, self._requests = self._requests, []
        return requests

    def wait_request(self, timeout_s: float) -> list[Request]:
        """Wait until something is asked or a PLC departs, at most `timeout_s`; return what was asked."""
        deadline = monotonic() + timeout_s
        while True:
            requests = self.requests()
            remaining = deadline - monotonic()
            if requests or self._departed or remaining <= 0:
                return requests
            if not self._answers:
                self._wait(remaining)

    def commands(self, plc: str, cycle: int, timeout_s: float) -> Commands | None:
        """Wait for the answer of `plc` to `cycle`; None when it does not come in time or the PLC departs.

        Answers to older cycles that arrive meanwhile are counted in `late`; their writes come first, because
        what a PLC wrote counts from then on. An answer to a cycle that has not been is refused.
        """
        deadline = monotonic() + timeout_s
        overdue: tuple[Write, ...] = ()
        while (mail := self._mail.get(plc)) is not None:
            while mail:
                commands = self._unpacked(plc, mail.popleft())
                if commands is None:
                    continue
                if commands.cycle == cycle:
                    return Commands(plc, cycle, overdue + commands.writes) if overdue else commands
                if commands.cycle < cycle:
                    self.late[plc] = self.late.get(plc, 0) + 1
                    overdue += commands.writes
                else:
                    self._refuse_future(commands, cycle)
            remaining = deadline - monotonic()
            if remaining <= 0:
                break
            self._wait(remaining)
        return Commands(plc, cycle, overdue) if overdue else None

    def latest_commands(self, plc: str, cycle: int) -> Commands | None:
        """Return all that `plc` wrote since the last call, with the newest cycle it answered, or None.

        An answer to a cycle after `cycle`, where the bench is, is refused.
        """
        self._drain()
        mail = self._mail.get(plc)
        writes: tuple[Write, ...] = ()
        newest = -1
        while mail:
            commands = self._unpacked(plc, mail.popleft())
            if commands is None:
                continue
            if commands.cycle > cycle:
                self._refuse_future(commands, cycle)
                continue
            writes += commands.writes
            newest = max(newest, commands.cycle)
        return Commands(plc, newest, writes) if newest >= 0 else None

    def departed(self) -> list[str]:
        """Return the PLCs whose session ended or froze since the last call; they are attached no more."""
        self._drain()
        departed, self._departed = self._departed, []
        return departed

    def detach(self, plc: str) -> None:
        """Let go of a PLC and tell it so, unless it has gone."""
        if self._mail.pop(plc, None) is not None:
            self._put(f"plc/{plc}/detached", b"")
        self.late.pop(plc, None)

    def report(self, refusals: Iterable[Refusal]) -> None:
        """Count refusals and put each in `hli/errors`."""
        for refusal in refusals:
            record = {"cycle": self._values.cycle, **asdict(refusal)}
            self._values.refused += 1
            self._values.refusals.append(record)
            self._put("hli/errors", json.dumps(record))

    def put_state(self, state: Mapping[str, Any]) -> None:
        """Put `cnc/state`; to be called when mode or state changed."""
        self._put("cnc/state", json.dumps(state))

    def put_error(self, error: Mapping[str, Any]) -> None:
        """Put an error record of the CNC in `cnc/errors` and keep it for a get."""
        self._values.errors.append(error)
        self._put("cnc/errors", json.dumps(error))

    def _declare(self) -> None:
        session, machine, values = self._session, self.machine, self._values
        self._image = session.declare_publisher(
            f"{machine}/hli/image",
            encoding=PACKED,
            congestion_control=zenoh.CongestionControl.DROP,
            express=True,
        )
        self._matching = self._image.declare_matching_listener(on_network_thread(self._on_matching))
        self._alive = session.liveliness().declare_token(f"{machine}/bench/alive")
        put = self._inbox.put
        for key, on_sample in (
            (f"plc/*{COMMANDS}", on_network_thread(put)),
            ("hli/unit/**", queued(put, self._on_member)),
            ("cnc/reset", queued(put, self._on_reset_put)),
            *((key, queued(put, self._on_read_only)) for key in READ_ONLY),
        ):
            # Remote only: the bench's own puts of units would come back as writes.
            session.declare_subscriber(f"{machine}/{key}", on_sample, allowed_origin=zenoh.Locality.REMOTE)
        session.liveliness().declare_subscriber(
            f"{machine}/plc/*/alive", queued(put, self._on_alive), history=True
        )
        for key, on_query in (
            ("hli/layout", self._reader(values.whole_layout)),
            ("hli/terminals", self._reader(values.terminal_layouts)),
            ("hli/image", self._reader(values.whole_image)),
            ("hli/errors", self._reader(values.hli_errors)),
            ("cnc/errors", self._reader(values.cnc_errors)),
            ("hli/unit/**", self._on_unit_query),
            ("io/**", self._on_io_query),
            ("cnc/state", self._on_state),
            ("cnc/run", self._on_run),
            ("cnc/reset", self._on_reset),
            ("bench/fault", self._on_fault),
            ("plc/*/attach", self._on_attach),
        ):
            session.declare_queryable(f"{machine}/{key}", queued(put, on_query), complete=True)

    def _on_matching(self, _: zenoh.MatchingStatus) -> None:
        self._looks = LOOKS

    def _put(self, path: str, value: bytes | str) -> None:
        encoding = JSON if isinstance(value, str) else PACKED
        self._session.put(f"{self.machine}/{path}", value, encoding=encoding)

    def _path(self, message: zenoh.Sample | zenoh.Query) -> str:
        return str(message.key_expr).removeprefix(f"{self.machine}/")

    def _asked(self, path: str, query: zenoh.Query | None = None) -> dict[str, Any]:
        return {"key": f"{self.machine}/{path}", "report": self.report, "query": query}

    def _drain(self) -> None:
        while not self._inbox.empty():
            self._handle(self._inbox.get_nowait())

    def _wait(self, timeout_s: float) -> None:
        try:
            message = self._inbox.get(timeout=timeout_s)
        except Empty:
            return
        self._handle(message)

    def _handle(self, message: tuple[Callable[[Any], None], Any] | zenoh.Sample) -> None:
        if isinstance(message, tuple):
            handle, what = message
            handle(what)
        else:
            self._on_commands(message)

    def _on_commands(self, sample: zenoh.Sample) -> None:
        plc = str(sample.key_expr)[self._name_at : -len(COMMANDS)]
        mail = self._mail.get(plc)
        if mail is not None:
            mail.append(payload(sample))
        elif plc not in self._strangers:
            self._strangers.append(plc)
            self._refuse_commands(plc, "attach first")
            self._put(f"plc/{plc}/detached", b"")

    def _unpacked(self, plc: str, message: bytes) -> Commands | None:
        """Return the commands; of a malformed message the cycle only, None when not even that is there."""
        try:
            return self._packing.unpack(plc, message)
        except InputError as error:
            self._refuse_commands(plc, error.message)
        try:
            return Commands(plc, self._packing.cycle(message), ())
        except InputError:
            return None

    def _refuse_commands(self, plc: str, reason: str) -> None:
        self.report([Refusal(f"plc/{plc}/commands", reason, plc)])

    def _refuse_future(self, commands: Commands, cycle: int) -> None:
        self._refuse_commands(commands.plc, f"answers cycle {commands.cycle}, the bench is at {cycle}")

    def _on_alive(self, sample: zenoh.Sample) -> None:
        plc = _plc(sample)
        if sample.kind == zenoh.SampleKind.PUT:
            self._alive_plcs.add(plc)
            self._no_stranger(plc)
            return
        self._alive_plcs.discard(plc)
        self.late.pop(plc, None)
        if self._mail.pop(plc, None) is not None:
            self._departed.append(plc)

    def _no_stranger(self, plc: str) -> None:
        if plc in self._strangers:
            self._strangers.remove(plc)

    def _on_attach(self, query: zenoh.Query) -> None:
        path, plc = self._path(query), _plc(query)
        period: Any
        try:
            period = json_object(query).get("period_us")
        except InputError:
            period = None
        if isinstance(period, float) and period.is_integer():
            period = int(period)
        if isinstance(period, bool) or not isinstance(period, int):
            reason = 'JSON {"period_us": whole number} expected'
        elif not 0 < period <= LONGEST_PERIOD_US:
            reason = f"period_us = {period}: expected 1 to {LONGEST_PERIOD_US}"
        elif "*" in path:
            reason = "the name of one PLC expected"
        else:
            reason = self._not_admitted(plc)
        if reason:
            Request(**self._asked(path, query)).refuse(reason)
            return
        self._requests.append(
            Attach(**self._asked(path, query), plc=plc, period_us=period, admit=self._admit)
        )

    def _not_admitted(self, plc: str) -> str:
        """Return why a PLC of that name cannot take part now, "" when it can."""
        if plc in self._mail:
            return f"a PLC called {plc!r} is attached already"
        if plc not in self._alive_plcs:
            return f"no liveliness token {self.machine}/plc/{plc}/alive: declare it first, hold it while attached"
        return ""

    def _admit(self, plc: str) -> str:
        """Give a PLC its mailbox and return "", or return why not: since it asked it may have gone."""
        reason = self._not_admitted(plc)
        if not reason:
            self._no_stranger(plc)
            self._mail[plc] = deque()
        return reason

    def _on_member(self, sample: zenoh.Sample) -> None:
        if sample.kind == zenoh.SampleKind.PUT:
            self._requests.append(self._write(sample, None))
        else:
            Request(**self._asked(self._path(sample))).refuse("a member cannot be deleted")

    def _on_read_only(self, sample: zenoh.Sample) -> None:
        Request(**self._asked(self._path(sample))).refuse("written by the bench, a client may only read it")

    def _write(self, message: zenoh.Sample | zenoh.Query, query: zenoh.Query | None) -> WriteRequest:
        path = self._path(message)
        write = MemberWrite(path.removeprefix("hli/unit/"), payload(message), is_text(message.encoding))
        return WriteRequest(**self._asked(path, query), write=write)

    def _on_state(self, query: zenoh.Query) -> None:
        self._requests.append(State(**self._asked("cnc/state", query)))

    def _on_reset(self, query: zenoh.Query) -> None:
        self._requests.append(Reset(**self._asked("cnc/reset", query)))

    def _on_reset_put(self, _: zenoh.Sample) -> None:
        self._requests.append(Reset(**self._asked("cnc/reset")))

    def _on_run(self, query: zenoh.Query) -> None:
        text, name = payload(query).decode("utf-8", "replace"), unquote(query.parameters.get("name") or "")
        run = RunProgram(**self._asked("cnc/run", query), text=text, name=name)
        if text.strip():
            self._requests.append(run)
        else:
            run.refuse("no NC program in the payload")

    def _on_fault(self, query: zenoh.Query) -> None:
        try:
            order = json_object(query)
        except InputError as error:
            Request(**self._asked("bench/fault", query)).refuse(error.message)
            return
        self._requests.append(FaultOrder(**self._asked("bench/fault", query), order=order))

    def _reader(self, answers: Callable[[], Answers]) -> Callable[[zenoh.Query], None]:
        return lambda query: self._answers.append((query, answers()))

    def _on_unit_query(self, query: zenoh.Query) -> None:
        path, as_text = self._path(query), _wants_text(query)
        if "*" in path:
            answers = self._values.units(self._wanted(query), as_text=as_text)
            self._answers.append((query, answers))
            return
        if query.payload is not None:
            self._requests.append(self._write(query, query))
            return
        try:
            name = self._values.layout.resolve(path.removeprefix("hli/unit/"))
        except InputError as error:
            Request(**self._asked(path, query)).refuse(error.message)
            return
        self._answers.append((query, iter([(path, self._values.unit(name, as_text=as_text))])))

    def _on_io_query(self, query: zenoh.Query) -> None:
        answers = self._values.terminal_images(self._wanted(query), as_text=_wants_text(query))
        self._answers.append((query, answers))

    def _wanted(self, query: zenoh.Query) -> Callable[[str], bool]:
        key = query.key_expr
        return lambda path: key.intersects(f"{self.machine}/{path}")

    def _answer(self, budget: int) -> None:
        while self._answers and budget > 0:
            query, answers = self._answers[0]
            for path, value in answers:
                encoding = JSON if isinstance(value, str) else PACKED
                query.reply(f"{self.machine}/{path}", value, encoding=encoding)
                budget -= 1
                if budget <= 0:
                    return
            self._answers.popleft()
            query.drop()


def _plc(message: zenoh.Sample | zenoh.Query) -> str:
    """Return the name in `<machine>/plc/<name>/<word>`."""
    return str(message.key_expr).split("/")[-2]


def _wants_text(query: zenoh.Query) -> bool:
    return query.parameters.get("format") in ("text", "json")
