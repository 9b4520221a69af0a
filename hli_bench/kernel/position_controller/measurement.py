"""A measuring run as a table: arm the sources, run, latch each axis, brake, relieve a fixed stop.

Source: measurement manual 4 (every moved axis delivers), 7.2 (fixed stop), P-CHAN-00176, P-CHAN-00266.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.base.units import mm_per_min, tenth_um_from_um_per_s, tenth_um_per_s
from hli_bench.kernel.blocks import MeasuringRun
from hli_bench.kernel.core import Core
from hli_bench.kernel.position_controller import probing
from hli_bench.kernel.position_controller.measuring_rules import (
    FEED_FROM_AXIS,
    STROKE_TYPES,
    Probe,
    effective_probe,
    refused,
    to_fixed_stop,
)
from hli_bench.kernel.records import MeasuredValue
from hli_bench.kernel.sequence import END, Level, Phase, Table, Then, Until, always
from hli_bench.kernel.watches import Condition, cycle_reached, path_done
from hli_bench.laws.rows import SEGMENTS
from hli_bench.manual.axis.fallbacks import effective_probing_offset
from hli_bench.manual.axis.words import Edge
from hli_bench.manual.errors import decoder as decoder_errors
from hli_bench.manual.errors import path_interpolator as errors
from hli_bench.manual.errors import path_preparation as preparation_errors
from hli_bench.manual.errors import position_controller as position_errors

RETRACTION_FEED: Final = 1000.0
"""mm/min of the way back to the measured position after a fixed stop (decided here, decision 0010)."""
_NEVER: Final = 1 << 62
ARMING_CYCLES: Final = 500
"""Cycles after which a source that does not get ready is an error (decided here)."""
ARRIVAL_CYCLES: Final = 20
"""Cycles behind the end of the interpolation in which an event still counts (decided here, decision 0012)."""


@dataclass(slots=True)
class Run:
    """One measuring run."""

    core: Core
    block: MeasuringRun
    probes: Mapping[AxisIndex, Probe]
    error_no_signal: bool | None
    """What ERR_NO_SIGNAL of #MEAS says, None when the program does not: P-CHAN-00176 and the type decide."""
    pending: dict[AxisIndex, Condition | None]
    """Axes that have not delivered yet, with what to wait for before the motion."""
    values: dict[AxisIndex, MeasuredValue] = field(default_factory=dict)
    segment: int = -1
    begun: Ns = Ns(0)
    """DC time at which the motion began: an event before it does not belong to the run."""
    target_path: float = 0.0
    """Path (0.1 um) to the programmed target: an event behind it came too late for V.A.MERF."""
    before_target: dict[AxisIndex, bool] = field(default_factory=dict)
    events: dict[AxisIndex, Until] = field(default_factory=dict)
    """The probing event of each axis; made once, since an edge has a memory."""
    first_looks: dict[AxisIndex, Until] = field(default_factory=dict)
    """That an axis' probe is operated when it is first seen, for sources that may not see it at once."""
    cut: bool = False
    """Delete distance to go has come while the run was on its way."""
    missed: list[AxisIndex] = field(default_factory=list)
    """Axes for which the run came to its end without a value."""
    reported: set[AxisIndex] = field(default_factory=set)
    """Those of which the CNC itself says so."""

    @property
    def fixed_stop(self) -> bool:
        """The event is a mechanical stop."""
        return to_fixed_stop(self.block, self.probes)


def may_begin(core: Core, block: MeasuringRun, probes: Mapping[AxisIndex, Probe]) -> bool:
    """Tell whether all sources of a run can be armed in this cycle; if not they can in the next one."""
    return all(
        probing.source(probe.signal).free(core, axis, probe.input, probe.edge)
        for axis in block.axes
        for probe in [effective_probe(block, probes, axis)]
    )


def begin(
    core: Core, block: MeasuringRun, probes: Mapping[AxisIndex, Probe], *, error_no_signal: bool | None
) -> Run | None:
    """Arm the sources of a run; None when it cannot begin (reported)."""
    if refused(core, block, probes):
        return None
    run = Run(core, block, probes, error_no_signal, {})
    for axis in block.axes:
        probe = _probe(run, axis)
        if probing.source(probe.signal).blocked(core, axis, probe.edge):
            _already_operated(axis, run)
            return None if core.failed else run
    for axis in block.axes:
        probe = _probe(run, axis)
        run.pending[axis] = probing.source(probe.signal).arm(core, axis, probe.input, probe.edge)
        core.show(axis, "lr_state/measurement_active_r", True)
        core.show(axis, "lr_state/measure_value_ok_r", False)
    return run


def _probe(run: Run, axis: AxisIndex) -> Probe:
    return effective_probe(run.block, run.probes, axis)


def _already_operated(axis: AxisIndex, run: Run) -> None:
    """Report that the level which the edge leads to is there already; the run ends."""
    core, probe = run.core, _probe(run, axis)
    level = f"{'TRUE' if probe.edge is Edge.POS else 'FALSE'}, the level behind its edge {probe.edge.value},"
    number, source = core.axis(axis).number, run.block.source
    if not core.setup.channel.meas_allow_actuated_probe:
        core.report(errors.PROBE_ALREADY_OPERATED, source, number, source.number, level, axis=axis)
        run.reported.add(axis)
    run.missed.append(axis)
    run.pending.clear()


def _nothing(run: Run) -> None:
    """A phase that only waits."""


def _start_path(run: Run) -> None:
    core = run.core
    core.preparation.synchronise()
    offsets = {
        axis: float(effective_probing_offset(core.axis(axis).params.kenngr, run.block.measuring_type))
        for axis in run.block.target
    }
    put = core.preparation.measuring_run(run.block, _feed(run), offsets)
    if put is None:
        if core.setup.channel.meas_error_no_move_path:
            core.report(errors.NO_MOTION_INFORMATION, run.block.source)
        run.missed += run.pending
        return
    run.segment, run.target_path = put
    run.begun = core.dc_now
    if run.block.measuring_type in STROKE_TYPES:
        _spare_probe(run)


def _feed(run: Run) -> float:
    """Return the feed in 0.1 um/s: the F word, with type 2 P-AXIS-00215 of the axis."""
    if run.block.measuring_type != FEED_FROM_AXIS:
        return tenth_um_per_s(run.block.feed)
    axis = run.core.axis(next(iter(run.block.target)))
    return tenth_um_from_um_per_s(axis.params.kenngr.vb_messen)


def _spare_probe(run: Run) -> None:
    """Lower the feed so that the way to standstill stays within the stroke of the probe (P-AXIS-00086)."""
    core = run.core
    strokes = [core.axis(axis).params.kenngr.hub_messtaster for axis in run.block.axes]
    before, after = core.preparation.limit_feed(run.segment, float(min(strokes)))
    if after < before:
        wanted, corrected = (round(mm_per_min(one), 3) for one in (before, after))
        shortest = core.axis(run.block.axes[strokes.index(min(strokes))]).number
        sheet = preparation_errors.MEASURING_FEED_CORRECTED
        core.report(sheet, run.block.source, corrected, shortest, wanted)


def _latch(axis: AxisIndex, run: Run) -> None:
    """Take the value of an axis; a fixed stop found by one axis is the event of all."""
    core = run.core
    for one in tuple(run.pending) if run.fixed_stop else (axis,):
        probe = _probe(run, one)
        latched = probing.source(probe.signal).latched(core, one, probe.input, probe.edge)
        if latched is None:
            sheet = position_errors.TIMESTAMP_NOT_AVAILABLE
            core.report(sheet, run.block.source, core.axis(one).number, axis=one)
            run.pending.clear()
            return
        position, dc_ns = latched
        if dc_ns < run.begun:
            sheet = errors.PROBE_EVENT_TOO_EARLY
            core.report(sheet, run.block.source, axis=one)
            run.pending.clear()
            return
        _keep(run, one, probe, position, dc_ns)


def _keep(run: Run, axis: AxisIndex, probe: Probe, position: float, dc_ns: Ns) -> None:
    core = run.core
    del run.pending[axis]
    run.values[axis] = MeasuredValue(
        source=run.block.source,
        axis=axis,
        origin=probe.signal.value,
        acs_tenth_um=round(position),
        dc_ns=dc_ns,
        edge=probe.edge.value,
    )
    run.before_target[axis] = _before_target(run, axis, position)
    together = run.block.together if axis in run.block.together else (axis,)
    if all(one in run.values for one in together):
        core.emitted += [value for one, value in run.values.items() if one in together]
    core.show(axis, "lr_state/measure_value_ok_r", True)


def _before_target(run: Run, axis: AxisIndex, position: float) -> bool:
    """Tell whether a position lies before the programmed target: only behind one with P-AXIS-00467 it may not."""
    segment = run.core.rows.segment[run.segment % SEGMENTS]
    if segment["length"] <= run.target_path:
        return True
    leg = run.core.rows.leg[run.segment % SEGMENTS, axis]
    if not leg["moves"]:
        return run.core.path.done <= run.target_path
    return bool((position - leg["start"]) / leg["direction"] <= run.target_path)


def _all_latched(phase: str, run: Run) -> str:
    return phase if run.pending else "braking"


def _brake(run: Run) -> None:
    run.core.path.brake(run.core.preparation.brake_ramp(run.segment))


def _is_cut(run: Run) -> Until:
    return Level(lambda: run.cut)


def _cut_off(run: Run) -> None:
    """Brake and drop the run (TF5200 delete distance to go 2.8); that no value came is no error then."""
    run.missed += run.pending
    if run.error_no_signal:
        run.core.report(errors.NO_SIGNAL_IGNORED, run.block.source)
        run.reported.update(run.pending)
    run.core.path.stop()


def _missed(run: Run) -> None:
    """The path has ended and an axis has not delivered."""
    core = run.core
    run.missed += run.pending
    for axis in run.pending:
        number = core.axis(axis).number
        if not _event_demanded(run):
            continue
        if run.fixed_stop:
            core.report(errors.FIXED_STOP_NOT_FOUND, run.block.source, number, axis=axis)
        else:
            core.report(errors.NO_MEASUREMENT, run.block.source, number, axis=axis)
        run.reported.add(axis)


def _event_demanded(run: Run) -> bool:
    """Tell whether a run without event is an error: as the program says, else by channel and type."""
    if run.error_no_signal is not None:
        return run.error_no_signal
    if run.fixed_stop:
        return not run.core.setup.channel.meas_fixed_stop_no_error
    return run.core.setup.channel.meas_error_no_signal or run.block.measuring_type == FEED_FROM_AXIS


def _all_or_none(run: Run, *, ended: bool) -> None:
    """Under a #CS a value needs every main axis: what only some of them latched is not taken over.

    Of a run that came to its end this is told; one that was broken off had no chance to deliver more.
    """
    latched = [axis for axis in run.block.together if axis in run.values]
    silent = [axis for axis in run.block.together if axis not in run.values]
    if not (latched and silent):
        return
    for axis in latched:
        del run.values[axis]
        run.before_target[axis] = False
        run.core.show(axis, "lr_state/measure_value_ok_r", False)
    if ended:
        run.missed += latched
        run.reported.update(latched)
    if ended and not run.core.failed:
        for axis in silent:
            number = run.core.axis(axis).number
            run.core.report(decoder_errors.TRANSFORMED_VALUES, run.block.source, number, axis=axis)


def _not_ready(run: Run) -> None:
    core = run.core
    axis = next(axis for axis, condition in run.pending.items() if condition is not None)
    core.report(errors.PROBING_NOT_INITIALISED, run.block.source, axis=axis)
    run.pending.clear()


def _retract(run: Run) -> None:
    """Take the interpolation back to the measured (or, without a stop, the actual) positions."""
    core = run.core
    core.preparation.synchronise()
    target = {axis: float(core.row(axis)["actual"]) for axis in run.block.axes}
    target |= {axis: float(value.acs_tenth_um) for axis, value in run.values.items()}
    core.preparation.retraction(target, tenth_um_per_s(RETRACTION_FEED))


def _disarm(run: Run) -> None:
    core = run.core
    core.preparation.synchronise()
    for axis in run.block.axes:
        probing.source(_probe(run, axis).signal).disarm(core, axis)
        core.show(axis, "lr_state/measurement_active_r", False)


def _finish(run: Run) -> None:
    _disarm(run)
    _all_or_none(run, ended=True)


def _after_standstill(run: Run) -> str:
    return "retracting" if run.fixed_stop else "finishing"


def _ready(axis: AxisIndex, run: Run) -> Until:
    return run.pending[axis] or cycle_reached(run.core.cycle)


def _is_ready(axis: AxisIndex, run: Run) -> None:
    run.pending[axis] = None


def arming(run: Run) -> str:
    """Return the phase that a run begins or goes on with: as long as a source is not ready, `arming`."""
    if run.missed:
        return "finishing"
    return "arming" if any(one is not None for one in run.pending.values()) else "starting"


def _arrived(run: Run) -> Until:
    return cycle_reached(run.core.cycle + ARRIVAL_CYCLES)


def _begun(run: Run) -> str:
    return "running" if run.segment >= 0 else "finishing"


def _event(axis: AxisIndex, run: Run) -> Until:
    if axis not in run.pending:
        return cycle_reached(_NEVER)
    if axis not in run.events:
        probe = _probe(run, axis)
        run.events[axis] = probing.source(probe.signal).event(run.core, axis, probe.input, probe.edge)
    return run.events[axis]


def _first_look(axis: AxisIndex, run: Run) -> Until:
    if axis not in run.first_looks:
        probe = _probe(run, axis)
        run.first_looks[axis] = probing.source(probe.signal).first_look(run.core, axis, probe.edge)
    return run.first_looks[axis]


def table(run: Run) -> Table[Run]:
    """Return the phases of a run; each axis that has to deliver is one way out of the phase `running`."""

    def events(phase: str) -> Iterator[Then[Run]]:
        for axis in run.block.axes:
            yield Then(partial(_first_look, axis), "braking", partial(_already_operated, axis))
        for axis in run.block.axes:
            yield Then(partial(_event, axis), partial(_all_latched, phase), partial(_latch, axis))

    ready = [Then(partial(_ready, axis), arming, partial(_is_ready, axis)) for axis in run.block.axes]
    overdue = run.core.cycle + ARMING_CYCLES
    return {
        "arming": Phase(_nothing, (*ready, Then(lambda _: cycle_reached(overdue), "finishing", _not_ready))),
        "starting": Phase(_start_path, (Then(always, _begun),)),
        "running": Phase(
            _nothing,
            (Then(_is_cut, "cut"), *events("running"), Then(lambda _: path_done(), "arriving")),
        ),
        "cut": Phase(_cut_off, (Then(lambda _: path_done(), _after_standstill),)),
        "arriving": Phase(_nothing, (*events("arriving"), Then(_arrived, _after_standstill, _missed))),
        "braking": Phase(_brake, (Then(lambda _: path_done(), _after_standstill),)),
        "retracting": Phase(_retract, (Then(lambda _: path_done(), "finishing"),)),
        "finishing": Phase(_finish, (Then(always, END),)),
    }


def abort(run: Run) -> None:
    """Switch the sources off when the program ends in the middle of a run."""
    _disarm(run)
    _all_or_none(run, ended=False)
