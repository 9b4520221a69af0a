"""The bench's side of the HLI over Zenoh: network threads only queue, the bench loop does everything else."""

import json
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from time import monotonic
from typing import Any, Final, Self
from urllib.parse import unquote

import zenoh

from hli_bench.base.errors import BenchError, InputError
from hli_bench.base.time import Ns
from hli_bench.protocols.hli.access import MemberWrite, Refusal
from hli_bench.protocols.hli.layout import Layout
from hli_bench.protocols.hli.packing import pack_image
from hli_bench.shells.zenoh_inbox import FREE_NS, PACED_NS, Budget, Handler, Inbox
from hli_bench.shells.zenoh_plcs import COMMANDS, Plcs
from hli_bench.shells.zenoh_questions import Questions
from hli_bench.shells.zenoh_requests import (
    LONGEST_PROGRAM,
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
    TEXT,
    is_text,
    listen,
    on_network_thread,
    payload,
)
from hli_bench.shells.zenoh_values import LastValues
from hli_bench.wire.images import TerminalLayout

LOOKS: Final = 1000
"""How often Zenoh is asked who listens after it said that this has changed: it says so before it knows itself, and
asking it takes as long as a put."""
READ_ONLY: Final = ("io/**", "hli/layout", "hli/errors", "hli/terminals", "cnc/state", "cnc/errors")
"""What only the bench puts; not the image, for which a subscriber would have it put every cycle."""
SAID: Final = 300
"""So many characters of a reason and of a path are kept and told: they may quote what a client sent."""
TELL_DROPPED_S: Final = 1.0
"""How often it is told at most that messages were dropped."""
REQUESTS: Final = 1000
"""So many requests wait to be served; those beyond are refused."""


class HliServer:
    """A router session with the keys of a machine; use it as a context manager and from one thread.

    `plcs` are those who take part; `refused` counts writes and requests, `dropped` messages that came too fast.
    """

    def __init__(
        self,
        endpoint: str,
        machine: str,
        layout: Layout,
        terminals: Sequence[TerminalLayout],
        *,
        lockstep: bool = True,
        on_fault: Callable[[str], None] = lambda _: None,
    ) -> None:
        """Listen on `endpoint`, for a bench that waits for its PLCs or for one that keeps its cycle.

        `on_fault` gets a line when something that a client sent could not be handled. Raises EnvironmentLacks when it
        cannot listen.
        """
        self.machine = machine
        self._on_fault = on_fault
        self._io: Mapping[str, bytes] = {}
        """The images that were put last; the bench makes new ones only when one has changed."""
        self._values = LastValues(layout, terminals)
        self._budget_ns = FREE_NS if lockstep else PACED_NS
        self._inbox = Inbox()
        self.plcs = Plcs(
            machine, layout, self._inbox, self._budget_ns, self.report, self._tell_detached, on_fault
        )
        self._questions = Questions(machine, self._values, self._budget_ns, self.report)
        self._requests: deque[Request] = deque()
        self._told_dropped = (0, 0.0)
        """How many had been dropped when it was told last, and when that was."""
        self._looks = LOOKS
        self._image_wanted = False
        self._congestion = zenoh.CongestionControl.DROP if lockstep else zenoh.CongestionControl.BLOCK
        """In real pace nothing is dropped for a client that does not read: its link is closed (decision 0025)."""
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
    def dropped(self) -> int:
        """Messages dropped so far, because more came than the bench takes."""
        return self._inbox.dropped

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
        if self.plcs.attached or self.image_wanted:
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
        self._inbox.handle(Budget(self._budget_ns))
        return bool(
            self._requests
            or self._questions.waiting
            or self.plcs.someone_left
            or self._inbox.dropped != self._told_dropped[0]
        )

    def requests(self, most: int = REQUESTS) -> list[Request]:
        """Return what was asked since the last call, in order, at most so much; reading queries are answered here."""
        self._inbox.handle(Budget(self._budget_ns))
        self._questions.answer()
        if self._inbox.dropped != self._told_dropped[0]:
            self._tell_dropped()
        return [self._requests.popleft() for _ in range(min(most, len(self._requests)))]

    def states(self) -> list[State]:
        """Return requests for the state only, and answer reading queries: the bench is held and can do no more."""
        self._inbox.handle(Budget(self._budget_ns))
        self._questions.answer()
        found = [request for request in self._requests if isinstance(request, State)]
        self._requests = deque(request for request in self._requests if not isinstance(request, State))
        return found

    def wait_request(self, timeout_s: float) -> list[Request]:
        """Wait until something is asked or a PLC departs, at most `timeout_s`; return what was asked."""
        deadline = monotonic() + timeout_s
        while True:
            requests = self.requests()
            remaining = deadline - monotonic()
            if requests or self.plcs.someone_left or remaining <= 0:
                return requests
            if not self._questions.waiting:
                self._inbox.wait(remaining)

    def report(self, refusals: Iterable[Refusal]) -> None:
        """Count refusals and put each in `hli/errors`."""
        for refusal in refusals:
            said = replace(refusal, path=_short(refusal.path), reason=_short(refusal.reason))
            record = {"cycle": self._values.cycle, **asdict(said)}
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
        questions, plcs = self._questions, self.plcs
        self._image = session.declare_publisher(
            f"{machine}/hli/image",
            encoding=PACKED,
            congestion_control=self._congestion,
            express=True,
        )
        self._matching = self._image.declare_matching_listener(on_network_thread(self._on_matching))
        self._alive = session.liveliness().declare_token(f"{machine}/bench/alive")
        for key, on_sample in (
            (f"plc/*{COMMANDS}", on_network_thread(plcs.take)),
            ("hli/unit/**", self._queued(self._on_member)),
            ("cnc/reset", self._queued(self._on_reset_put)),
            *((key, self._queued(self._on_read_only)) for key in READ_ONLY),
        ):
            # Remote only: the bench's own puts of units would come back as writes.
            session.declare_subscriber(f"{machine}/{key}", on_sample, allowed_origin=zenoh.Locality.REMOTE)
        session.liveliness().declare_subscriber(
            f"{machine}/plc/*/alive", self._queued(plcs.on_alive, share=3), history=True
        )
        for key, on_query in (
            ("hli/layout", questions.reader(values.whole_layout)),
            ("hli/terminals", questions.reader(values.terminal_layouts)),
            ("hli/image", questions.reader(values.whole_image)),
            ("hli/errors", questions.reader(values.hli_errors)),
            ("cnc/errors", questions.reader(values.cnc_errors)),
            ("hli/unit/**", self._on_unit_query),
            ("io/**", questions.on_io),
            ("cnc/state", self._on_state),
            ("cnc/run", self._on_run),
            ("cnc/reset", self._on_reset),
            ("bench/fault", self._on_fault_order),
            ("plc/*/attach", self._on_attach),
        ):
            session.declare_queryable(f"{machine}/{key}", self._queued(on_query), complete=True)

    def _queued(self, handle: Handler, share: int = 1) -> Any:
        """Return a handler for the network thread: it leaves the message for `handle`, or refuses a query at once.

        Whatever goes wrong in `handle` is the answer to who sent the message; the bench goes on.
        """

        def guarded(message: Any) -> None:
            try:
                handle(message)
            except BenchError:
                raise
            except Exception as error:
                self._failed(message, error)

        def put(message: Any) -> None:
            if not self._inbox.put(guarded, message, share=share) and isinstance(message, zenoh.Query):
                with message:
                    message.reply_err("more messages came than the bench takes: ask again", encoding=TEXT)

        return on_network_thread(put)

    def _failed(self, message: Any, error: Exception) -> None:
        """Something that a client sent could not be handled: a fault of the bench, which is told and goes on."""
        reason = f"the bench failed at this message: {type(error).__name__}: {_short(str(error))}"
        query = message if isinstance(message, zenoh.Query) else None
        Request(**self._asked(self._path(message), query)).refuse(reason)
        self._on_fault(f"{_short(str(message.key_expr))}: {reason}")

    def _tell_dropped(self) -> None:
        """Report once in a while that messages were dropped."""
        told, when = self._told_dropped
        now = monotonic()
        if now - when >= TELL_DROPPED_S:
            dropped = self._inbox.dropped
            self._told_dropped = (dropped, now)
            reason = f"{dropped - told} messages dropped, more came than the bench takes; {dropped} so far"
            self.report([Refusal("", reason)])
            if not told:
                self._on_fault(reason)

    def _tell_detached(self, plc: str, reason: str) -> None:
        self._session.put(f"{self.machine}/plc/{plc}/detached", reason, encoding=TEXT)

    def _on_matching(self, _: zenoh.MatchingStatus) -> None:
        self._looks = LOOKS

    def _put(self, path: str, value: bytes | str) -> None:
        encoding = JSON if isinstance(value, str) else PACKED
        self._session.put(
            f"{self.machine}/{path}", value, encoding=encoding, congestion_control=self._congestion
        )

    def _path(self, message: zenoh.Sample | zenoh.Query) -> str:
        return str(message.key_expr).removeprefix(f"{self.machine}/")

    def _asked(self, path: str, query: zenoh.Query | None = None) -> dict[str, Any]:
        return {"key": f"{self.machine}/{path}", "report": self.report, "query": query}

    def _ask(self, request: Request) -> None:
        if len(self._requests) < REQUESTS:
            self._requests.append(request)
        else:
            self._inbox.dropped += 1
            request.deny(f"{REQUESTS} requests wait already: ask again")

    def _on_attach(self, query: zenoh.Query) -> None:
        request = self.plcs.on_attach(query)
        if request is not None:
            self._ask(request)

    def _on_member(self, sample: zenoh.Sample) -> None:
        if sample.kind == zenoh.SampleKind.PUT:
            self._ask(self._write(sample, None))
        else:
            Request(**self._asked(self._path(sample))).refuse("a member cannot be deleted")

    def _on_read_only(self, sample: zenoh.Sample) -> None:
        Request(**self._asked(self._path(sample))).refuse("written by the bench, a client may only read it")

    def _write(self, message: zenoh.Sample | zenoh.Query, query: zenoh.Query | None) -> WriteRequest:
        path = self._path(message)
        write = MemberWrite(path.removeprefix("hli/unit/"), payload(message), is_text(message.encoding))
        return WriteRequest(**self._asked(path, query), write=write)

    def _on_unit_query(self, query: zenoh.Query) -> None:
        if query.payload is None or "*" in str(query.key_expr):
            self._questions.on_unit(query)
        else:
            self._ask(self._write(query, query))

    def _on_state(self, query: zenoh.Query) -> None:
        self._ask(State(**self._asked("cnc/state", query)))

    def _on_reset(self, query: zenoh.Query) -> None:
        self._ask(Reset(**self._asked("cnc/reset", query)))

    def _on_reset_put(self, _: zenoh.Sample) -> None:
        self._ask(Reset(**self._asked("cnc/reset")))

    def _on_run(self, query: zenoh.Query) -> None:
        """Take a program; its text is decoded when it is run."""
        name = unquote(query.parameters.get("name") or "")
        run = RunProgram(**self._asked("cnc/run", query), packed=payload(query), name=_short(name))
        if len(run.packed) > LONGEST_PROGRAM:
            run.refuse(f"a program of {len(run.packed)} bytes: at most {LONGEST_PROGRAM} expected")
        elif not run.packed or run.packed.isspace():
            run.refuse("no NC program in the payload")
        else:
            self._ask(run)

    def _on_fault_order(self, query: zenoh.Query) -> None:
        try:
            order = json_object(query)
        except InputError as error:
            Request(**self._asked("bench/fault", query)).refuse(error.message)
            return
        self._ask(FaultOrder(**self._asked("bench/fault", query), order=order))


def _short(text: str) -> str:
    return text if len(text) <= SAID else f"{text[:SAID]}... ({len(text)} characters)"
