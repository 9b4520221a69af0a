"""The bench's door to the net: what clients ask for over Zenoh, done between cycles."""

import json
import traceback
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

from hli_bench.base.errors import BenchError, InputError, NotEmulated
from hli_bench.base.time import Ns
from hli_bench.bench.plc_ports import AttachedPlc, OnOverrun, period_cycles
from hli_bench.bench.result import error_of
from hli_bench.kernel.records import CncError, Emitted
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.engine import Engine
from hli_bench.shells.plc_times import PlcBook
from hli_bench.shells.zenoh_inbox import FREE_NS, PACED_NS, Budget
from hli_bench.shells.zenoh_requests import (
    Attach,
    FaultOrder,
    Request,
    Reset,
    RunProgram,
    State,
    WriteRequest,
)
from hli_bench.shells.zenoh_server import HliServer
from hli_bench.wire.hli import Commands

ANSWERS: Final = 1000
"""So many clients wait at most to hear that something has taken effect."""
TRACEBACK_LINES: Final = -10
"""The last of them say where it was."""
RESET_CYCLES: Final = 10_000
"""Cycles within which the drives must be back after a reset, else it is answered all the same."""


class HliDoor:
    """Serves clients; `after_step` is called after every stretch of cycles, `wait` while time stands still.

    `on_note` gets lines for people.
    """

    def __init__(
        self,
        server: HliServer,
        engine: Engine,
        *,
        lockstep: bool,
        state: Callable[[], dict[str, Any]],
        on_note: Callable[[str], None],
        plc_times: PlcBook | None = None,
        on_overrun: OnOverrun = lambda *_: None,
    ) -> None:
        self._server = server
        self._engine = engine
        self._lockstep = lockstep
        self._budget_ns = FREE_NS if lockstep else PACED_NS
        self._state = state
        self._on_note = on_note
        self._plc_times = plc_times
        self._on_overrun = on_overrun
        self._published = -1
        self._written: list[tuple[int, WriteRequest]] = []
        self._resets: list[tuple[int, Reset]] = []
        self._settle_until = 0
        self._told: set[tuple[str, str]] = set()
        """PLCs and elements of whose refused writes people know."""
        self.programs: list[RunProgram] = []
        """Programs that clients want to run; the bench takes them when it is idle."""

    @property
    def watched(self) -> bool:
        """Somebody listens to the image and no attached PLC sets the pace: it is put every cycle."""
        return not self._server.plcs.attached and self._server.image_wanted

    @property
    def waiting(self) -> bool:
        """What a client did, or its departure, has not taken effect yet."""
        return bool(self._written or self._resets) or self._engine.cycle < self._settle_until

    @property
    def counts(self) -> dict[str, int]:
        """Writes and requests that were refused, messages that were dropped, since the bench came up."""
        return {"refused": self._server.refused, "dropped": self._server.dropped}

    def attached(self, name: str) -> bool:
        """Tell whether a PLC of that name takes part from another process."""
        return name in self._server.plcs.attached

    def alive(self, name: str) -> bool:
        """Tell whether a PLC of that name has a session, attached or not."""
        return self._server.plcs.alive(name)

    def after_step(self) -> None:
        """Publish the cycle, do what was asked, let go of PLCs that have departed."""
        engine = self._engine
        if self._published != engine.cycle:
            self.publish(engine.cycle, engine.dc_ns, engine.link.images(engine.cycle))
        if self._written or self._resets:
            self._acknowledge()
        if self._server.stirs or engine.lost:
            self._attend()

    def show_only(self) -> None:
        """Answer who looks, while a process of the bench does not answer and no cycle can pass."""
        for request in self._server.states():
            self._serve(request)

    def refuse_programs(self) -> None:
        """Refuse what clients want to run on a bench that a script runs."""
        while self.programs:
            self.programs.pop(0).refuse(
                "this bench is run by a program of its own and takes none from clients"
            )

    def wait(self, timeout_s: float) -> None:
        """Wait for something to do while time stands still, and do it."""
        requests = self._server.wait_request(timeout_s)
        self._let_go()
        for request in requests:
            self._serve(request)

    def publish(self, cycle: int, dc_ns: Ns, io: Mapping[str, bytes]) -> None:
        """Put terminals, changed units and the image of a cycle, once."""
        if cycle == self._published:
            return
        self._published = cycle
        image = self._engine.kernel.image
        self._server.publish(cycle, dc_ns, bytes(image.data), image.take_changed(), io)

    def emitted(self, records: Iterable[Emitted]) -> None:
        """Put error records of the CNC."""
        for record in records:
            if isinstance(record, CncError):
                error = error_of(record)
                self._server.put_error({name: getattr(error, name) for name in error.__slots__})

    def refused(self, refusals: Iterable[Refusal]) -> None:
        """Report writes that were refused; people are told of those of PLCs, once for each element, a line a reason."""
        refusals = list(refusals)
        self._server.report(refusals)
        new: dict[tuple[str, str], list[str]] = {}
        for refusal in refusals:
            if refusal.writer and (refusal.writer, refusal.path) not in self._told:
                self._told.add((refusal.writer, refusal.path))
                new.setdefault((refusal.writer, refusal.reason), []).append(refusal.path)
        for (writer, reason), paths in new.items():
            more = f" and {len(paths) - 1} more" if len(paths) > 1 else ""
            self._on_note(f"plc {writer}: {paths[0]}{more}: {reason}")

    def state_changed(self) -> None:
        """Put mode and state of the CNC."""
        self._server.put_state(self._state())

    def _attend(self) -> None:
        """Do what was asked, as far as a cycle has time for it.

        Who departed goes first: one who comes may have the name of one who went.
        """
        self._let_go()
        budget = Budget(self._budget_ns)
        while requests := self._server.requests(1):
            self._serve(requests[0])
            if not budget.left:
                break

    def _serve(self, request: Request) -> None:
        """Do what was asked; whatever goes wrong in it is the answer to who asked, and the bench goes on."""
        try:
            self._do(request)
        except BenchError:
            raise
        except Exception as error:
            reason = f"the bench failed at this: {type(error).__name__}: {error}"
            self._on_note(f"{request.key}: {reason}")
            request.refuse(reason)

    def _do(self, request: Request) -> None:
        match request:
            case WriteRequest():
                self._write(request)
            case Attach():
                self._attach(request)
            case RunProgram():
                if self._engine.kernel.channel.running or self.programs:
                    request.refuse("a program is running; a CNC reset aborts it (hli-bench reset)")
                else:
                    self.programs.append(request)
            case Reset():
                self._engine.kernel.reset()
                self._engine.wake()
                self._remember(self._resets, request, self._engine.cycle)
            case State():
                request.reply(json.dumps(self._state()))
            case FaultOrder():
                request.refuse("NotEmulated: faults into a bench that is up")
            case _:
                request.refuse("unknown request")

    def _write(self, request: WriteRequest) -> None:
        engine = self._engine
        try:
            write = engine.access.write_of(request.write)
        except InputError as error:
            refusals = engine.refuse([Refusal(request.write.path, error.message)])
        else:
            refusals = engine.apply(Commands("", engine.cycle, (write,)))
        if refusals:
            request.deny(refusals[0].reason)
            return
        self._remember(self._written, request, engine.cycle + 1)

    def _remember(self, requests: list[tuple[int, Any]], request: Request, cycle: int) -> None:
        """Remember who is to be answered; of puts only that they are to take effect."""
        if request.query is None:
            self._settle_until = max(self._settle_until, self._engine.cycle + 1)
        elif len(requests) < ANSWERS:
            requests.append((cycle, request))
        else:
            request.deny(f"done, but {ANSWERS} clients wait already to hear when it has taken effect")

    def _acknowledge(self) -> None:
        """Answer the writes that the kernel has seen by now, and the resets after which all drives are back."""
        cycle = self._engine.cycle
        while self._written and self._written[0][0] <= cycle:
            request = self._written.pop(0)[1]
            request.reply(self._remark(request))
        drives = self._engine.kernel.drives
        while self._resets and cycle > self._resets[0][0] + (0 if drives.settled else RESET_CYCLES):
            names = drives.out()
            out = f"still out of operation: {', '.join(names)}" if names else ""
            self._resets.pop(0)[1].reply(json.dumps({"note": out}) if out else "")
            self.state_changed()

    def _remark(self, request: WriteRequest) -> str:
        """Return as JSON that what was written to a unit does not count, and why; "" when it does."""
        reason = self._engine.kernel.in_vain(request.write.path)
        return json.dumps({"note": f"does not count: {reason}"}) if reason else ""

    def _attach(self, request: Attach) -> None:
        engine = self._engine
        cycle_ns = engine.kernel.setup.cycle_ns
        try:
            cycles = period_cycles(request.plc, request.period_us, cycle_ns)
        except InputError as error:
            request.refuse(error.message)
            return
        if any(plc.name == request.plc for plc in engine.plcs):
            request.refuse(f"a PLC called {request.plc!r} is attached already")
            return
        port = AttachedPlc(
            request.plc,
            cycles,
            self._server.plcs,
            self.publish,
            lockstep=self._lockstep,
            cycle_ns=cycle_ns,
            times=self._plc_times.enter(request.plc, cycles * cycle_ns) if self._plc_times else None,
            on_overrun=self._on_overrun,
        )
        first = (engine.cycle // cycles + 1) * cycles
        if request.accept(cycle=first, cycle_us=cycle_ns // 1000, lockstep=self._lockstep):
            engine.attach(port)

    def _let_go(self) -> None:
        for name in self._server.plcs.departed():
            if self._engine.kernel.channel.running:
                self._on_note(f"PLC {name} has gone in a program: its session has ended, or was silent")
            self._engine.lose(name)
            self._settle_until = self._engine.cycle + 1
        while self._engine.lost:
            plc = self._engine.lost.pop()
            reason = ""
            if isinstance(plc, AttachedPlc) and self.attached(plc.name):
                reason = f"has not answered for {plc.patience_s:g} s, up to cycle {self._engine.cycle}"
                self._on_note(
                    f"PLC {plc.name} is alive and {reason}: it takes part no more until it attaches anew"
                )
            self._server.plcs.detach(plc.name, reason)


def result_reply(run: Callable[[], Any], request: RunProgram, on_note: Callable[[str], None]) -> None:
    """Run a client's program and answer with its result, or with what was wrong with it.

    Whatever the program does to the bench is the client's answer, and the bench stays up; a fault of the bench itself
    is told with its traceback. Only when a part of the bench is gone (a process, a bus) it ends with that.
    """
    try:
        result = run()
    except (InputError, NotEmulated) as error:
        request.refuse(str(error))
    except BenchError as error:
        request.refuse(f"the bench ends: {error}")
        raise
    except Exception as error:
        request.refuse(f"the bench failed at this program: {type(error).__name__}: {error}")
        on_note("".join(traceback.format_exception(error, limit=TRACEBACK_LINES)).rstrip())
    else:
        request.reply(json.dumps(result.to_dict()))
