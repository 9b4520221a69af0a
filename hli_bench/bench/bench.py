"""The public class: a machine that runs NC programs."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self

from hli_bench.base.endpoints import check_key, endpoint
from hli_bench.base.errors import BenchError, InputError
from hli_bench.base.time import NS_PER_S, NS_PER_US
from hli_bench.bench import build, state
from hli_bench.bench.config import MachineConfig, PlcConfig
from hli_bench.bench.folder import load
from hli_bench.bench.plc_ports import LocalPlc, loaded
from hli_bench.bench.program import opened
from hli_bench.bench.result import Collector, Result, measurements
from hli_bench.bench.standstill import Standstill
from hli_bench.bench.unprobed import remarks, unmeasured
from hli_bench.kernel.decoder import WITHOUT_MOTION
from hli_bench.kernel.records import Emitted
from hli_bench.laws import native
from hli_bench.plc import Task, period_of
from hli_bench.protocols.hli.access import Refusal
from hli_bench.runtime.engine import Engine, Observer
from hli_bench.shells.apart import apart
from hli_bench.shells.between import BetweenCalls
from hli_bench.shells.pacing import RealPace, Stopwatch
from hli_bench.shells.plc_times import PlcBook
from hli_bench.shells.processes import Deadline, PlcProcess, free_endpoint
from hli_bench.shells.realtime import Garbage, ask, frozen_garbage

if TYPE_CHECKING:
    from hli_bench.bench.door import HliDoor
    from hli_bench.bench.remote import RemoteMachine

STAND_CYCLES: Final = 60_000
"""Cycles at most in which what was aborted comes to rest (decided here)."""
START_UP_CYCLES: Final = 10_000
"""Cycles within which all drives must be in operation, or have said why not."""
WITHOUT_MOTION_PACED: Final = 50
"""Blocks without motion in a row for which a cycle passes in real pace: they take half a ms (decided here)."""
FOREVER: Final = 1 << 62
IDLE_S: Final = 0.2
"""Longest wait for a client while time stands still."""
SETTLE_CYCLES: Final = 5000
"""Within which all is answered: more than a reset may take."""
MOST_TOLD: Final = 100
"""PLCs of whose overruns people are told: clients may attach under ever new names."""
LONGEST_RUN_S: Final = 86_400.0
"""Machine time after which a client's program that is not done is aborted: a day (decided here)."""
ATTACH_S: Final = 30.0
"""Wall time in which a PLC process must have attached."""

OnRecord = Callable[[Emitted], None]
OnNote = Callable[[str], None]


class Bench:
    """A bench of its own: kernel, drives, plant, terminals and PLC tasks in this process, in virtual time.

    `settings` are dotted keys of the machine folder, as with `--set`. `plc` replaces the machine's PLC
    scripts; an empty list leaves it without any. `on_note` gets lines for people: warnings about the machine folder,
    settings without effect, that the laws are compiled, what the operating system gave for `realtime`, PLCs that hold a
    program for long, do not answer, or are refused. Use it as a context manager.
    Raises InputError for a bad machine folder or setting, NotEmulated for what is not built.
    """

    def __init__(
        self,
        machine: str | Path = "demo",
        settings: Mapping[str, object] | None = None,
        *,
        plc: Sequence[str | Path] | None = None,
        pace: str = "free",
        can: str = "inproc",
        zenoh: str | None = None,
        processes: bool = False,
        observers: Sequence[Observer] = (),
        on_record: OnRecord | None = None,
        on_note: OnNote = lambda _: None,
        realtime: bool = False,
    ) -> None:
        if realtime and pace != "real":
            raise InputError(f"realtime is for a bench by the clock (pace real), not for pace {pace}")
        if pace not in ("free", "real"):
            raise InputError(f"pace {pace!r}: expected free or real")
        if settings is not None and not isinstance(settings, Mapping):
            raise InputError(f"settings {settings!r}: expected a mapping of keys to values")
        if not isinstance(machine, str | Path):
            raise InputError(f"machine {machine!r}: expected a name or a folder")
        if zenoh is not None:
            endpoint(zenoh)
        if isinstance(plc, str | Path):
            raise InputError(f"plc {str(plc)!r}: expected a list of scripts")
        self.config: MachineConfig = load(machine, settings or {}, with_plcs=plc is None)
        for remark in self.config.remarks():
            on_note(remark)
        for key in settings or {} if plc else ():
            if key.startswith(("plc.", "plc[")):
                on_note(
                    f"warning: {key} has no effect: the scripts given as plc replace the machine's tasks; "
                    "leave them out and set plc.0.script"
                )
        self._on_note = on_note
        native.prepare(lambda: on_note(native.COMPILING), apart)
        with ExitStack() as stack:
            self._closing = stack
            self._realtime = realtime
            self.kernel = build.kernel(self.config)
            self._remote: RemoteMachine | None = None
            self._ended_told: set[str] = set()
            self.engine = self._engine(machine, settings or {}, can, processes=processes)
            self.engine.observers += observers
            self._tap = _Tap(on_record)
            self.engine.listeners.append(self._tap)
            self._endpoint = zenoh
            self._plc_times = PlcBook() if pace == "real" else None
            self._overran: set[str] = set()
            self._door = self._open_door(zenoh, lockstep=pace == "free") if zenoh else None
            self._garbage = Garbage()
            self._pace = RealPace(self.config.cycle_ns, idle=self._garbage.idle) if pace == "real" else None
            self._standstill = Standstill(self.kernel, on_note)
            self._plcs = plc_configs(self.config, plc)
            self._up = self._closed = False
            self._foreign_told = False
            self._lost: dict[str, str] = {}
            """What there is to say of PLCs whose scripts did not return, to be said in every result."""
            self.interrupted: Result | None = None
            """What a program had done when it was interrupted."""
            # Built: from here on `close` ends what the stack holds.
            self._for_clients = zenoh is not None
            self._between = BetweenCalls(self._attend)
            stack.callback(self._between.close)
            self._closing = stack.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the bench: processes, sessions, buses."""
        self._closed = True
        self._closing.close()

    def start_up(self) -> None:
        """Switch on: bring all drives into operation, then start the PLC tasks. `run` does it when needed."""
        with self._between.busy():
            self._start_up()

    def _start_up(self) -> None:
        if self._closed:
            raise BenchError("this bench is closed; make a new one")
        if self._up:
            return
        if self.engine.cycle:
            raise BenchError("this bench has failed to start; make a new one")
        self.engine.power_on()
        drives = self.kernel.drives
        self._advance(lambda: drives.settled or self.kernel.failure is not None, START_UP_CYCLES)
        self._raise_failure()
        if not drives.ready:
            raise BenchError(f"drives did not come into operation: {', '.join(drives.out())}")
        self._attach_plcs()
        self._up = True
        if self._pace is not None:
            self._keep_calm()
            self._pace.restart()
        if self._for_clients:
            self._between.start()

    def run(
        self, program: str | Path | Iterable[str], name: str = "", *, limit_s: float | None = None
    ) -> Result:
        """Run an NC program to its end and return the result.

        `program` is NC text, a path, or lines. A program that is not done after `limit_s` of machine time is
        aborted. Raises InputError (file, line, column) for text that is no NC program and NotEmulated for
        what is not built; errors of the emulated CNC stand in the result. When it is interrupted (Ctrl-C),
        `interrupted` holds the result so far.
        """
        if limit_s is not None and not 0.0 < limit_s < math.inf:
            raise InputError(f"limit_s {limit_s!r}: expected seconds above 0")
        with self._between.busy(), opened(program, name) as (lines, known_as):
            return self._run(lines, known_as, limit_s)

    def _run(self, lines: Iterable[str], name: str, limit_s: float | None) -> Result:
        watch = Stopwatch()
        self.start_up()
        collector = Collector(self.kernel.setup.axes)
        self._tap.collector = collector
        first, syncs = self.engine.cycle, self.engine.foreign_syncs
        self._standstill.begin(first)
        last = FOREVER if limit_s is None else first + self._cycles(limit_s)
        if self._pace is not None:
            self._pace.resume()
            self._pace.take_part()
        if self._plc_times is not None:
            self._plc_times.begin(plc.name for plc in self.engine.plcs)
        ended = False
        holding: list[str] = []
        stopped: KeyboardInterrupt | None = None
        try:
            self.kernel.start(lines, name, WITHOUT_MOTION if self._pace is None else WITHOUT_MOTION_PACED)
            self.engine.wake()
            if self._door is not None:
                self._door.state_changed()
            ended = self._advance(lambda: not self.kernel.channel.running, last)
            holding = [] if ended else self.kernel.holding()
        except KeyboardInterrupt as interrupt:
            holding, stopped = self.kernel.holding(), interrupt
        finally:
            last = self.engine.cycle
            if not ended:
                self.engine.hand_out()
                self.reset()
            self._tap.collector = None
            self._stand()
            if self._door is not None:
                self._door.state_changed()
        self._raise_failure()
        status = collector.status(completed=self.kernel.channel.completed) if ended else "aborted"
        result = self._result(name, status, collector, last - first, syncs, watch, holding)
        if stopped is not None:
            self.interrupted = result
            raise stopped
        self._settle()
        if self._pace is not None:
            self._garbage.between_programs()
        return result

    def _stand(self) -> None:
        """Let what a program has left moving come to rest: it brakes already."""
        last = self.engine.cycle + STAND_CYCLES
        for _ in range(1 + len(self.engine.plcs)):
            # A PLC that fails meanwhile takes part no more, and why the program ended is what counts.
            with suppress(BenchError):
                # Cycle by cycle: when the next program begins must not depend on how long the stretches are.
                while not self.kernel.core.at_rest and self.engine.cycle < last:
                    self._advance(lambda: False, self.engine.cycle + 1)
                return

    def _raise_failure(self) -> None:
        """Raise what went wrong in a cycle and is none of the CNC's errors; by now everything stands."""
        failure = self.kernel.take_failure()
        if failure is not None:
            raise failure

    def _cycles(self, seconds: float) -> int:
        """Return how many cycles it takes until so much machine time is over, at least one."""
        return max(-(-round(seconds * NS_PER_S) // self.config.cycle_ns), 1)

    def _result(
        self,
        name: str,
        status: str,
        collector: Collector,
        cycles: int,
        syncs: int,
        watch: Stopwatch,
        holding: Sequence[str],
    ) -> Result:
        """Return the result of a program that took `cycles`; what `holding` names held its motion.

        `syncs` SYNC frames had come from others when it began.
        """
        return Result(
            program=name,
            status=status,
            messages=collector.messages,
            errors=collector.errors,
            variables=self.kernel.channel.variables(),
            measurements=measurements(self.kernel),
            unmeasured=unmeasured(self.config, self.kernel.channel.unmeasured),
            homing=collector.homing,
            sim_s=round(cycles * self.config.cycle_ns * 1e-9, 9),
            wall_s=watch.seconds(),
            cycles=cycles,
            notes=(
                *(f"motion was held: {element}" for element in holding),
                *(f"enabled in vain: {unit}" for unit in self.kernel.unheard()),
                *self._without_plc(),
                *(
                    [f"{collector.left_out} more messages and errors are left out"]
                    if collector.left_out
                    else ()
                ),
                *(self._plc_times.remarks() if self._plc_times else ()),
                *remarks(self.config, self.kernel.channel.unmeasured),
                *self._foreign_syncs(self.engine.foreign_syncs - syncs),
            ),
            plcs=self._plc_times.rows() if self._plc_times else (),
            lateness=self._pace.take_part() if self._pace else None,
        )

    def advance(self, cycles: int) -> None:
        """Let `cycles` cycles pass without a program."""
        with self._between.busy():
            self.start_up()
            if self._pace is not None:
                self._pace.resume()
            self._advance(lambda: False, self.engine.cycle + cycles)
            self._raise_failure()

    def reset(self) -> None:
        """CNC reset: errors are cleared, drives that dropped out come back."""
        with self._between.busy():
            self.kernel.reset()
            self.engine.wake()

    def _settle(self) -> None:
        """Let the cycles pass in which what clients asked for takes effect, so that they are answered."""
        door = self._door
        if door is not None and door.waiting:
            self._advance(lambda: not door.waiting, self.engine.cycle + SETTLE_CYCLES)

    def _attend(self) -> None:
        """Serve clients between the calls of this class, as `serve` does in free pace."""
        door = self._door
        if door is None or not self._up:
            return
        try:
            door.wait(0.0)
            door.refuse_programs()
            if self._pace is not None and door.waiting:
                self._pace.resume()
            self._settle()
        except Exception as error:
            # Who runs the bench meets it with the next call; a thread of its own has nobody to raise it to.
            self._on_note(f"clients are served no more: {type(error).__name__}: {error}")
            raise SystemExit from error

    def position_mm(self, axis: str) -> float:
        """Return the actual position of an axis in machine coordinates, mm or degrees."""
        return self.kernel.position_mm(self.config.axis(axis).index)

    def serve(self) -> None:
        """Stay up: run what clients ask for, until KeyboardInterrupt. Needs `zenoh`.

        In free pace time stands still while no program runs; a client's write lets the cycles pass that it
        needs to take effect.
        """
        door = self._door
        if door is None:
            raise InputError("a bench that stays up needs an endpoint (--zenoh)")
        with self._between.busy():
            self.start_up()
            self._serve(door)

    def _serve(self, door: "HliDoor") -> None:
        from hli_bench.bench.door import result_reply

        while True:
            while door.programs:
                request = door.programs.pop(0)
                run = partial(self.run, request.lines(), request.name or "program", limit_s=LONGEST_RUN_S)
                result_reply(run, request, self._on_note)
            if self._pace is not None or door.waiting:
                self._advance(lambda: False, self.engine.cycle + 1)
                if (failure := self.kernel.take_failure()) is not None:
                    self._on_note(f"the bench failed between programs: {type(failure).__name__}: {failure}")
            else:
                door.wait(IDLE_S)
                self._tell_ended()

    def _tell_ended(self) -> None:
        """Tell once of processes that have ended while time stands still; the next cycle ends the bench with that."""
        for name, condition in self._remote.processes.items() if self._remote is not None else ():
            if condition.startswith("ended") and name not in self._ended_told:
                self._ended_told.add(name)
                self._on_note(f"the process of the {name} has {condition}: no cycle can pass any more")

    def state(self) -> dict[str, Any]:
        """Return one look at the bench: CNC mode, axes, drives, terminals, PLCs, late cycles."""
        lateness = self._pace.lateness if self._pace else None
        net = self._door.counts if self._door is not None else {}
        processes = self._remote.processes if self._remote is not None else {}
        return state.look(self.config, self.engine, self.terminal_layouts, lateness, net, processes)

    def _advance(self, until: Callable[[], bool], limit: int) -> bool:
        while not until():
            if self.engine.cycle >= limit:
                return False
            if self._pace is not None:
                self._pace.wait()
            each = self._pace is not None or (self._door is not None and self._door.watched)
            self.engine.step(self.engine.cycle + 1 if each else limit)
            if self.engine.cycle >= self._standstill.due:
                self._standstill.look(self.engine.cycle)
            if self.engine.foreign_syncs and not self._foreign_told:
                self._foreign_told = True
                for note in self._foreign_syncs(self.engine.foreign_syncs):
                    self._on_note(f"{note}; they are counted in `state` and in results")
            if self._door is not None:
                self._door.after_step()
        return True

    def _engine(
        self, machine: str | Path, settings: Mapping[str, object], can: str, *, processes: bool
    ) -> Engine:
        if can == "inproc" and not processes:
            side = build.machine_side(self.config, self.kernel.rows.axis)
            self.terminal_layouts = build.terminal_layouts(self.config)
            return Engine(self.kernel, side, side.pending)
        # Zenoh and CAN are imported by benches that have them: they take longer than a short program.
        from hli_bench.bench.remote import RemoteEngine, RemoteMachine

        rows = self.kernel.rows.axis
        remote = self._remote = self._closing.enter_context(
            RemoteMachine(self.config, machine, settings, can, rows, realtime=self._realtime)
        )
        self.terminal_layouts = build.terminal_layouts(self.config)
        return RemoteEngine(self.kernel, remote)

    def _keep_calm(self) -> None:
        """Ask Python and the operating system not to hold a cycle, until the bench is closed."""
        calm = ask(realtime=self._realtime)
        self._closing.callback(calm.close)
        self._closing.enter_context(frozen_garbage())
        for note in calm.notes:
            self._on_note(note)

    def _open_door(self, endpoint: str, *, lockstep: bool) -> "HliDoor":
        from hli_bench.bench.door import HliDoor
        from hli_bench.shells.zenoh_server import HliServer

        check_key(self.config.name, "the machine", str(self.config.folder))
        for terminal in self.config.terminals:
            check_key(terminal.name, "a terminal", str(self.config.folder))
        layout = self.kernel.image.layout
        server = HliServer(
            endpoint,
            self.config.name,
            layout,
            self.terminal_layouts,
            lockstep=lockstep,
            on_fault=self._on_note,
        )
        self._closing.enter_context(server)
        self._tap.door = HliDoor(
            server,
            self.engine,
            lockstep=lockstep,
            state=self.state,
            on_note=self._on_note,
            plc_times=self._plc_times,
            on_overrun=self._overran_plc,
        )
        if self._remote is not None:
            self._remote.on_silence = self._tap.door.show_only
        return self._tap.door

    def _foreign_syncs(self, count: int) -> Iterator[str]:
        """Yield how many SYNC frames of others the drives have left out."""
        if count:
            yield f"{count} foreign SYNC on the CAN bus: the drives act on that of the CNC only"

    def _without_plc(self) -> Iterator[str]:
        """Yield what there is to say of the bench's own PLCs that take part no more."""
        present = {plc.name for plc in self.engine.plcs}
        for plc in self._plcs:
            if plc.name not in present:
                what = "process has ended" if plc.process else "script has failed"
                yield self._lost.get(plc.name) or f"PLC {plc.name} takes part no more: its {what}"

    def _lost_plc(self, name: str, note: str) -> None:
        """Tell at once, and in the result, that a script has not returned."""
        self._lost[name] = note
        self._on_note(note)

    def _overran_plc(self, name: str, cycle: int) -> None:
        """Have an overrun recorded; people are told once of each PLC that has many."""
        self.engine.overran(name, cycle)
        if name in self._overran or len(self._overran) >= MOST_TOLD or self._plc_times is None:
            return
        times = self._plc_times.often(name)
        if times is not None:
            self._overran.add(name)
            self._on_note(
                f"PLC {name} does not keep its period: {times.overruns} overruns in {times.runs} runs"
            )

    def _attach_plcs(self) -> None:
        for plc in self._plcs:
            if plc.process:
                self._start_plc_process(plc)
                continue
            script = loaded(plc.script)
            period_us = plc.period_us or period_of(script, plc.script)
            task = Task(plc.name, script, period_us, self.kernel.image.layout, self.terminal_layouts)
            port = LocalPlc(
                task,
                self.config.cycle_ns,
                partial(self._lost_plc, plc.name),
                self._plc_times.enter(plc.name, period_us * NS_PER_US) if self._plc_times else None,
                self._overran_plc,
            )
            self.engine.attach(port)

    def _start_plc_process(self, plc: PlcConfig) -> None:
        """Start a script as a process of its own and wait until it has attached."""
        if self._door is None:
            self._endpoint = free_endpoint()
            self._door = self._open_door(self._endpoint, lockstep=self._pace is None)
        assert self._endpoint is not None
        door = self._door
        process = self._closing.enter_context(
            PlcProcess(
                plc.script, self._endpoint, plc.name, plc.period_us, ends=lambda: not door.alive(plc.name)
            )
        )
        deadline = Deadline(ATTACH_S)
        while not deadline.over:
            if self._door.attached(plc.name):
                return
            process.check()
            self._door.wait(IDLE_S)
        raise BenchError(f"plc {plc.name}: {plc.script} has not attached")


def plc_configs(config: MachineConfig, scripts: Sequence[str | Path] | None) -> list[PlcConfig]:
    """Return the PLC tasks: the machine's own, or one for each of `scripts`. Raises InputError for equal names."""
    if scripts is None:
        return list(config.plcs)
    names = [Path(script).stem for script in scripts]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"plc: two scripts are called {name!r}, and PLCs are told apart by their names")
    return [PlcConfig(Path(script).stem, Path(script), None, False) for script in scripts]


class _Tap:
    """Listener of the bench itself: gathers records for the result, hands them on as they come."""

    def __init__(self, on_record: OnRecord | None) -> None:
        self._on_record = on_record
        self.door: HliDoor | None = None
        self.collector: Collector | None = None

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        """Gather what belongs to the running program."""
        if self.collector is not None:
            self.collector.take(records)
        if self.door is not None:
            self.door.emitted(records)
        if self._on_record is not None:
            for record in records:
                self._on_record(record)

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        """Report to clients; without any, a script that writes what it must not is an error of the set-up."""
        if self.door is not None:
            self.door.refused(refusals)
            return
        first = refusals[0]
        raise InputError(f"plc {first.writer}: {first.path}: {first.reason}")
