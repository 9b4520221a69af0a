"""The PLCs that take part over Zenoh: who they are, whether they live, what they wrote."""

from collections import deque
from collections.abc import Callable
from time import monotonic
from typing import Any, Final
from zlib import crc32

import zenoh

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.access import Refusal
from hli_bench.protocols.hli.layout import Layout
from hli_bench.protocols.hli.packing import CommandsPacking
from hli_bench.shells.zenoh_inbox import Budget, Inbox
from hli_bench.shells.zenoh_requests import Attach, Request, json_object
from hli_bench.shells.zenoh_session import payload
from hli_bench.wire.hli import Commands, Write

COMMANDS: Final = "/commands"
"""End of the key of a PLC's commands."""
LONGEST_PERIOD_US: Final = 3_600_000_000
"""Of a PLC that attaches: an hour (decided here)."""
STRANGERS: Final = 64
"""So many names of clients that write without being attached are remembered, each to be told once."""
NEXT_STRANGER_S: Final = 0.01
"""When so many are remembered, a new one is told at most so often; the messages of others are dropped."""
MAIL: Final = 1000
"""So many messages of a PLC wait to be taken; of more the oldest are dropped and counted."""
LONGEST_NAME: Final = 100
"""Characters of a PLC's name (decided here)."""
TOKENS: Final = 1000
"""So many liveliness tokens are kept in mind; a PLC with one beyond is not admitted."""


class Plcs:
    """Mailboxes by PLC; all but `take` are for the bench's thread.

    `late` counts, by attached PLC, commands that answered an older cycle.
    """

    def __init__(
        self,
        machine: str,
        layout: Layout,
        inbox: Inbox,
        budget_ns: int,
        report: Callable[[list[Refusal]], None],
        tell_detached: Callable[[str, str], None],
        on_note: Callable[[str], None] = lambda _: None,
    ) -> None:
        """`report` takes refusals, `tell_detached` the name of a client that takes no part and why.

        `on_note` gets a line for people when commands of a PLC are refused for the first time.
        """
        self._on_note = on_note
        self._told: deque[str] = deque(maxlen=STRANGERS)
        """PLCs of whose refused commands people know."""
        self._crc = f"{crc32(layout.to_json().encode()):08x}"
        self._machine = machine
        self._name_at = len(f"{machine}/plc/")
        self._inbox = inbox
        self._budget_ns = budget_ns
        self._report = report
        self._tell_detached = tell_detached
        self._packing = CommandsPacking(layout)
        self._mail: dict[str, deque[bytes]] = {}
        self._lapsed: dict[str, dict[str, Write]] = {}
        """What PLCs wrote in answers that were too old, by path: PLCs send changes, so to them it is set."""
        self._strangers: deque[str] = deque(maxlen=STRANGERS)
        self._next_stranger = 0.0
        self._alive: set[str] = set()
        self._departed: list[str] = []
        self.late: dict[str, int] = {}

    @property
    def attached(self) -> list[str]:
        """Names of the PLCs that take part."""
        return list(self._mail)

    @property
    def someone_left(self) -> bool:
        """Whether `departed` has something to tell."""
        return bool(self._departed)

    def alive(self, plc: str) -> bool:
        """Tell whether a PLC's session lives."""
        self._inbox.handle(Budget(self._budget_ns))
        return plc in self._alive

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
            self._inbox.wait(remaining)
        return Commands(plc, cycle, overdue) if overdue else None

    def latest_commands(self, plc: str, cycle: int, oldest: int = 0) -> Commands | None:
        """Return all that `plc` wrote since the last call, with the newest cycle it answered, or None.

        An answer to a cycle after `cycle`, where the bench is, is refused. One to a cycle before `oldest` does not
        count by itself: its writes count with the next answer that is in time, as the PLC will not repeat them. What
        the budget of a look does not suffice for is left for the next call.
        """
        budget = Budget(self._budget_ns)
        self._inbox.handle(budget)
        mail = self._mail.get(plc)
        writes: tuple[Write, ...] = ()
        newest = -1
        while mail:
            commands = self._unpacked(plc, mail.popleft())
            if commands is not None and commands.cycle > cycle:
                self._refuse_future(commands, cycle)
            elif commands is not None and commands.cycle < oldest:
                self._refuse(plc, f"answers a cycle {cycle - commands.cycle} cycles ago: too old to count")
                self._lapsed.setdefault(plc, {}).update({write.path: write for write in commands.writes})
            elif commands is not None:
                writes += (*self._lapsed.pop(plc, {}).values(), *commands.writes)
                newest = max(newest, commands.cycle)
            if not budget.left:
                break
        return Commands(plc, newest, writes) if newest >= 0 else None

    def departed(self) -> list[str]:
        """Return the PLCs whose session ended or froze since the last call; they are attached no more."""
        departed, self._departed = self._departed, []
        return departed

    def detach(self, plc: str, reason: str = "") -> None:
        """Let go of a PLC and tell it so, with the reason, unless it has gone."""
        self._lapsed.pop(plc, None)
        if self._mail.pop(plc, None) is not None:
            self._tell_detached(plc, reason)
        self.late.pop(plc, None)

    def take(self, sample: zenoh.Sample) -> None:
        """Queue commands, on the network thread: those of attached PLCs have room beside all others."""
        known = str(sample.key_expr)[self._name_at : -len(COMMANDS)] in self._mail
        self._inbox.put(self._on_commands, sample, share=2 if known else 1)

    def on_alive(self, sample: zenoh.Sample) -> None:
        """Note that the session of a PLC has come or gone."""
        plc = _plc(sample)
        if sample.kind == zenoh.SampleKind.PUT:
            if len(self._alive) < TOKENS:
                self._alive.add(plc)
            self._no_stranger(plc)
            return
        self._alive.discard(plc)
        self._lapsed.pop(plc, None)
        self.late.pop(plc, None)
        if self._mail.pop(plc, None) is not None:
            self._departed.append(plc)

    def on_attach(self, query: zenoh.Query) -> Attach | None:
        """Return the request of a PLC to take part, None when it makes no sense and is refused."""
        path, plc = str(query.key_expr).removeprefix(f"{self._machine}/"), _plc(query)
        asked: dict[str, Any] = {"key": f"{self._machine}/{path}", "report": self._report, "query": query}
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
            reason = f"period_us: expected 1 to {LONGEST_PERIOD_US}"
        elif "*" in path:
            reason = "the name of one PLC expected"
        elif len(plc) > LONGEST_NAME:
            reason = f"a name of {len(plc)} characters: at most {LONGEST_NAME} expected"
        else:
            reason = self._not_admitted(plc)
        if reason:
            Request(**asked).refuse(reason)
            return None
        return Attach(**asked, plc=plc, period_us=period, admit=self._admit, layout=self._crc)

    def _on_commands(self, sample: zenoh.Sample) -> None:
        plc = str(sample.key_expr)[self._name_at : -len(COMMANDS)]
        mail = self._mail.get(plc)
        if mail is not None:
            mail.append(payload(sample))
            if len(mail) > MAIL:
                mail.popleft()
                self._inbox.dropped += 1
        elif plc not in self._strangers:
            if len(self._strangers) == STRANGERS and monotonic() < self._next_stranger:
                self._inbox.dropped += 1
                return
            self._next_stranger = monotonic() + NEXT_STRANGER_S
            self._strangers.append(plc)
            self._refuse(plc, "attach first")
            self._tell_detached(plc, "attach first")

    def _unpacked(self, plc: str, message: bytes) -> Commands | None:
        """Return the commands; of a malformed message the cycle only, None when not even that is there."""
        try:
            return self._packing.unpack(plc, message)
        except InputError as error:
            self._refuse(plc, error.message)
        try:
            return Commands(plc, self._packing.cycle(message), ())
        except InputError:
            return None

    def _refuse(self, plc: str, reason: str) -> None:
        if plc in self._mail and plc not in self._told:
            self._told.append(plc)
            self._on_note(f"plc {plc}: commands: {reason}")
        self._report([Refusal(f"plc/{plc}/commands", reason, plc)])

    def _refuse_future(self, commands: Commands, cycle: int) -> None:
        self._refuse(commands.plc, f"answers cycle {commands.cycle}, the bench is at {cycle}")

    def _no_stranger(self, plc: str) -> None:
        if plc in self._strangers:
            self._strangers.remove(plc)

    def _not_admitted(self, plc: str) -> str:
        """Return why a PLC of that name cannot take part now, "" when it can."""
        if plc in self._mail:
            return f"a PLC called {plc!r} is attached already"
        if plc not in self._alive:
            return f"no liveliness token {self._machine}/plc/{plc}/alive: declare it first, hold it while attached"
        return ""

    def _admit(self, plc: str) -> str:
        """Give a PLC its mailbox and return "", or return why not: since it asked it may have gone."""
        reason = self._not_admitted(plc)
        if not reason:
            self._no_stranger(plc)
            self._mail[plc] = deque()
        return reason


def _plc(message: zenoh.Sample | zenoh.Query) -> str:
    """Return the name in `<machine>/plc/<name>/<word>`."""
    return str(message.key_expr).split("/")[-2]
