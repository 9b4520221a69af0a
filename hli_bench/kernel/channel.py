"""The NC channel: takes the decoder's items in order, lets motion run ahead, stops at what must wait for it."""

from collections import Counter, deque
from collections.abc import Generator, Iterable, Mapping

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import mm
from hli_bench.kernel.activities import Activity, DriveObject, Dwelling, Measuring
from hli_bench.kernel.axis_manager.homing_order import HomingOrder
from hli_bench.kernel.blocks import (
    Block,
    DriveWrite,
    Dwell,
    Flush,
    Home,
    Idle,
    Line,
    MachineState,
    MeasureSettings,
    MeasuringRun,
    ProgramEnd,
    Source,
    Text,
)
from hli_bench.kernel.core import Core
from hli_bench.kernel.decoder import Decoder
from hli_bench.kernel.drive_manager.objects import ObjectChannel
from hli_bench.kernel.drive_manager.probe_telegrams import DRIVE_INPUTS, ProbeTelegrams
from hli_bench.kernel.hindrances import unserved
from hli_bench.kernel.monitoring import Monitoring
from hli_bench.kernel.path_blocks import PathBlocks
from hli_bench.kernel.path_preparation.limits import forbidden
from hli_bench.kernel.position_controller import measurement
from hli_bench.kernel.position_controller.measuring_rules import Probe, default_probe, take_settings
from hli_bench.kernel.records import CncError, MeasuredValue, MessageText, Unmeasured
from hli_bench.kernel.watches import cycle_reached, jog_stopped, path_done, segment_reached
from hli_bench.laws.rows import FOLLOW, SEGMENTS
from hli_bench.manual.axis.words import ProbingSignal
from hli_bench.manual.errors import by_number
from hli_bench.manual.errors import path_interpolator as errors
from hli_bench.manual.errors import position_controller as position_errors

_NOWHERE = Source("", 0)
_SOON = -1
"""A program has begun and not seen a cycle yet."""
Item = Block | Flush | CncError | Idle
Items = Generator[Item, MachineState | None, None]
READY_CYCLES = 500
"""Cycles that a program start waits for drives on their way into operation (decided here)."""
STEPS = 200
"""Steps of a program in one cycle at most, the others follow in the next (decided here)."""
TEXTS = 1000
"""Synchronous texts that may wait for their place before decoding waits for them (decided here)."""
REFILL = SEGMENTS // 2
"""Free segments at which the look-ahead goes on."""


class Channel:
    """Runs one program at a time. `step` is called in every cycle that needs a decision."""

    def __init__(self, core: Core, objects: ObjectChannel, monitoring: Monitoring) -> None:
        self._core = core
        self._objects = objects
        self._telegrams = ProbeTelegrams(objects)
        self._monitoring = monitoring
        self._decoder: Decoder | None = None
        self._items: Items | None = None
        self._answer: MachineState | None = None
        self._barrier: Item | None = None
        self._postponed: Line | None = None
        self._activity: Activity | None = None
        self._texts: deque[tuple[int, Text]] = deque()
        self._wake: list[int] = []
        self._begin_by: int | None = None
        self._error_no_signal: bool | None = None
        self._probes: dict[AxisIndex, Probe] = {}
        self._measured: dict[AxisIndex, float] = {}
        self._latched: dict[AxisIndex, bool] = {}
        self._delivered: Counter[AxisIndex] = Counter()
        self.measured: list[tuple[MeasuredValue, float]] = []
        """Every value this program has measured, with its V.A.MEAS.PCS.VALUE in mm."""
        self.unmeasured: list[Unmeasured] = []
        """Every axis of a measuring run of this program that came to its end without a value."""
        self._unserved: dict[AxisIndex, list[str]] = {}
        """Units that no PLC served when the measuring run of an axis began, and why."""
        self._source = _NOWHERE
        self._path = PathBlocks(core)
        self.running = False
        self.completed = False

    @property
    def source(self) -> Source:
        """The block in execution."""
        return self._path.source or self._source

    @property
    def standing(self) -> Source:
        """The block that is executed, or was taken over last, while no path runs."""
        return self._source

    def delete_distance_to_go(self, *, on: bool) -> bool:
        """Drop the rest of the block in motion; tell whether there is one to be dropped."""
        if isinstance(self._activity, Measuring):
            return on and self._activity.cut()
        return self._path.delete_distance_to_go(on=on)

    def start(self, decoder: Decoder) -> None:
        """Begin a program."""
        self._core.forgive()
        self._decoder = decoder
        self._items = decoder.blocks()
        self._answer = None
        self._barrier = self._postponed = self._activity = None
        self._texts.clear()
        self._path.forget()
        self._measured.clear()
        self._latched.clear()
        self._delivered.clear()
        self.measured.clear()
        self.unmeasured.clear()
        core = self._core
        self._probes = {axis.index: default_probe(core, axis.index) for axis in core.setup.axes}
        self._error_no_signal = None
        self._source = _NOWHERE
        self._begin_by = _SOON
        self.running = True
        self.completed = False

    def step(self) -> None:
        """Go on as far as this cycle allows."""
        for handle in self._wake:
            self._core.watches.forget(handle)
        self._wake.clear()
        if not self.running or self._has_failed():
            return
        self._path.cut(self._texts)
        self._hand_out_texts()
        for _ in range(STEPS):
            if not self._proceed() or not self.running or self._has_failed():
                return
        self._go_on_in_next_cycle()

    def break_off(self) -> bool:
        """Go on with nothing that has not begun; tell whether an activity was broken off."""
        activity, self._activity = self._activity, None
        self._barrier = self._postponed = None
        if activity is not None:
            activity.abort()
        return activity is not None

    def wind_up(self, *, run_out: bool) -> None:
        """End a program that was broken off as soon as nothing moves; what runs out brings its texts."""
        if not self.running:
            return
        if run_out:
            self._path.cut(self._texts)
            self._hand_out_texts()
        if self._core.at_rest:
            self._end(completed=False)
        else:
            self._wait_for_rest()

    def end(self) -> None:
        """End the program at once (CNC reset); the next one begins when what moves stands."""
        self._end(completed=False)

    def _go_on_in_next_cycle(self) -> None:
        self._wake.append(self._core.watches.watch(cycle_reached(self._core.cycle + 1)))

    def _has_failed(self) -> bool:
        return self._core.failed

    def _may_begin(self, begin_by: int) -> bool:
        """Tell whether the machine stands and its drives are in operation; late drives are not waited for."""
        core = self._core
        if not core.at_rest:
            self._wait_for_rest()
            return False
        if core.starting and core.cycle < begin_by:
            self._wake.append(core.watches.watch(cycle_reached(begin_by)))
            return False
        core.take_back()
        self._monitoring.rearm()
        core.preparation.synchronise()
        self._begin_by = None
        return True

    def _proceed(self) -> bool:
        """Do the next thing; False when it has to wait."""
        if self._begin_by == _SOON:
            # Only now the cycle is known: nobody may have decided for long.
            self._begin_by = self._core.cycle + READY_CYCLES
        if self._begin_by is not None:
            if not self._may_begin(self._begin_by):
                return False
            if not self._in_operation(_NOWHERE, [axis.index for axis in self._core.setup.axes]):
                return True
        if self._activity is not None:
            if not self._activity.step():
                return False
            self._activity = None
        if self._postponed is not None:
            return self._put(self._postponed)
        if self._barrier is not None:
            return self._at_barrier(self._barrier)
        if len(self._texts) == TEXTS:
            return False
        return self._next_item()

    def _at_barrier(self, barrier: Item) -> bool:
        """Execute a block once all motion before it is done; False when it has to wait."""
        if not self._core.path.idle:
            self._wait_for_rest()
            return False
        self._hand_out_texts()
        if self._path.settle(barrier):
            return True
        if isinstance(barrier, MeasuringRun) and not self._may_measure(barrier):
            self._go_on_in_next_cycle()
            return False
        self._barrier = None
        self._behind_motion(barrier)
        return True

    def _next_item(self) -> bool:
        assert self._items is not None
        answer, self._answer = self._answer, None
        item = self._items.send(answer) if answer is not None else next(self._items)
        match item:
            case Line():
                return self._put(item)
            case Idle():
                self._go_on_in_next_cycle()
                return False
            case Text(synchronous=False):
                self._core.emitted.append(MessageText(source=item.source, text=item.text))
            case Text():
                self._texts.append((int(self._core.rows.path[0]["tail"]), item))
                if len(self._texts) == 1:
                    self._hand_out_texts()
            case MeasureSettings():
                self._set_measuring(item)
            case DriveWrite(synchronous=False):
                self._activity = DriveObject.begin(self._core, self._objects, item)
            case CncError():
                self._core.take(item, by_number()[item.number].reaction_class)
            case _:
                self._barrier = item
        return True

    def _put(self, line: Line) -> bool:
        if self._core.preparation.room == 0:
            self._postponed = line
            self._wake.append(self._core.watches.watch(segment_reached(self._core.path.tail - REFILL)))
            return False
        self._postponed = None
        self._source = line.source
        if not self._may_move(line.source, line.target):
            return True
        self._path.put(line)
        return True

    def _behind_motion(self, item: Item) -> None:
        """Execute what must not begin before all motion is done."""
        core = self._core
        assert not isinstance(item, Line | Text | MeasureSettings | CncError | Idle)
        self._source = item.source
        self._path.forget()
        match item:
            case Flush():
                self._answer = self._state()
            case MeasuringRun():
                if self._may_move(item.source, item.target):
                    self._activity = self._measuring(item)
            case Home():
                if not item.ranks:
                    core.report(errors.HOMING_WITHOUT_AXES, item.source)
                elif self._in_operation(item.source, item.ranks):
                    self._activity = HomingOrder(core, self._monitoring, item)
            case DriveWrite():
                self._activity = DriveObject.begin(core, self._objects, item)
            case Dwell():
                self._activity = Dwelling(core, item)
            case ProgramEnd():
                self._end(completed=True)

    def _may_measure(self, block: MeasuringRun) -> bool:
        """Tell whether drives and sources are ready; they can be in a later cycle."""
        carried = [
            self._telegrams.carry(self._core.axis(axis), self._probes[axis].input)
            for axis in block.axes
            if self._probes[axis].signal is ProbingSignal.DRIVE and self._probes[axis].input in DRIVE_INPUTS
        ]
        for axis in self._telegrams.take_refused():
            sheet = position_errors.DRIVE_COMMAND_NOT_SUPPORTED
            self._core.report(sheet, block.source, axis.number, axis=axis.index)
        return all(carried) and measurement.may_begin(self._core, block, self._probes)

    def _measuring(self, block: MeasuringRun) -> Activity | None:
        for axis in block.axes:
            self._unserved[axis] = unserved(self._core, axis, self._probes[axis].signal)
        run = measurement.begin(self._core, block, self._probes, error_no_signal=self._error_no_signal)
        return None if run is None else Measuring(self._core, self._monitoring, run, self._take)

    def _in_operation(self, source: Source, axes: Iterable[AxisIndex]) -> bool:
        """Report the first axis whose drive is out of operation."""
        core = self._core
        for index in axes:
            if core.row(index)["mode"] == FOLLOW:
                core.report(position_errors.DRIVE_NOT_ENABLED, source, core.axis(index).number, axis=index)
                return False
        return True

    def _may_move(self, source: Source, target: Mapping[AxisIndex, float]) -> bool:
        """Check what forbids the motion: a drive out of operation, a missing reference, software limits."""
        return self._in_operation(source, target) and not forbidden(self._core, source, target)

    def _set_measuring(self, settings: MeasureSettings) -> None:
        if settings.error_no_signal is not None:
            self._error_no_signal = settings.error_no_signal
        take_settings(self._core, self._probes, settings)

    def _hand_out_texts(self) -> None:
        """Emit the SYN texts whose place in the motion has been reached; watch for the next."""
        core = self._core
        while self._texts:
            segment, text = self._texts[0]
            if not core.path.idle and core.path.segment < segment:
                self._wake.append(core.watches.watch(segment_reached(segment)))
                return
            self._texts.popleft()
            core.emitted.append(MessageText(source=text.source, text=text.text))

    def _wait_for_rest(self) -> None:
        watches = self._core.watches
        if not self._core.path.idle:
            self._wake.append(watches.watch(path_done()))
        self._wake += [watches.watch(jog_stopped(axis)) for axis in self._core.self_moving]

    def _state(self) -> MachineState:
        core = self._core
        return MachineState(
            command={axis.index: mm(float(core.row(axis.index)["command"])) for axis in core.setup.axes},
            actual={axis.index: mm(round(float(core.row(axis.index)["actual"]))) for axis in core.setup.axes},
            measured=dict(self._measured),
            delivered=dict(self._delivered),
            latched=dict(self._latched),
            referenced={axis.index: core.referenced[axis.index] for axis in core.setup.axes},
        )

    def _end(self, *, completed: bool) -> None:
        if self._items is not None:
            self._items.close()
        self._items = None
        self._activity = None
        self._path.abandon()
        self.running = False
        self.completed = completed

    def variables(self) -> dict[str, float]:
        """Return the NC variables that the program set, read or measured, by name."""
        return {} if self._decoder is None else self._decoder.variables(self._state())

    def _take(self, run: measurement.Run) -> None:
        """Keep what a measuring run delivered; axes without a new value keep their old one."""
        for axis in run.block.axes:
            self._latched[axis] = run.before_target.get(axis, False)
        self.unmeasured += [self._unmeasured(run, axis) for axis in run.missed]
        self._measured |= {axis: mm(value.acs_tenth_um) for axis, value in run.values.items()}
        self._delivered.update(run.values.keys())
        assert self._decoder is not None
        state = self._state()
        self._decoder.run_ended(state)
        for axis, value in run.values.items():
            self.measured.append((value, self._decoder.measured_pcs(axis)))

    def _unmeasured(self, run: measurement.Run, axis: AxisIndex) -> Unmeasured:
        """Return the record of an axis that got no value; a unit counts as unserved when it was so all the time."""
        now = unserved(self._core, axis, self._probes[axis].signal)
        units = tuple(unit for unit in self._unserved.get(axis, ()) if unit in now)
        return Unmeasured(
            source=run.block.source,
            axis=axis,
            fixed_stop=run.fixed_stop,
            unserved=units,
            reported=axis in run.reported,
        )
