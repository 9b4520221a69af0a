"""A measuring run as a table: arm the sources, run, latch each axis, brake, relieve a fixed stop.

Source: measurement manual 4 (every moved axis delivers), 7.2 (fixed stop), P-CHAN-00176, P-CHAN-00266.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import tenth_um_per_s
from hli_bench.kernel.blocks import MeasuringRun
from hli_bench.kernel.core import Core
from hli_bench.kernel.position_controller import probing
from hli_bench.kernel.records import MeasuredValue
from hli_bench.kernel.sequence import END, Phase, Table, Then, Until, always
from hli_bench.kernel.watches import Condition, cycle_reached, path_done
from hli_bench.manual.axis.fallbacks import (
    effective_edge,
    effective_input,
    effective_probing_offset,
    effective_signal,
    fixed_stop_start_per_mille,
)
from hli_bench.manual.axis.words import Edge, ProbingSignal
from hli_bench.manual.errors import path_interpolator as errors
from hli_bench.manual.errors import position_controller as position_errors

FIXED_STOP_TYPE: Final = 7
RETRACTION_FEED: Final = 1000.0
"""mm/min of the way back to the measured position after a fixed stop (decided here, decision 0010)."""
_NEVER: Final = 1 << 62
ARMING_CYCLES: Final = 500
"""Cycles after which a source that does not get ready is an error (decided here)."""


@dataclass(slots=True)
class Probe:
    """How one axis is probed: P-AXIS-00516..00518, or what #MEAS made of them."""

    signal: ProbingSignal
    input: int
    edge: Edge


@dataclass(slots=True)
class Run:
    """One measuring run."""

    core: Core
    block: MeasuringRun
    probes: Mapping[AxisIndex, Probe]
    error_no_signal: bool
    pending: dict[AxisIndex, Condition | None]
    """Axes that have not delivered yet, with what to wait for before the motion."""
    values: dict[AxisIndex, MeasuredValue] = field(default_factory=dict)
    segment: int = -1
    target_path: float = 0.0
    """Path (0.1 um) to the programmed target: an event behind it came too late for V.A.MERF."""
    before_target: dict[AxisIndex, bool] = field(default_factory=dict)
    events: dict[AxisIndex, Until] = field(default_factory=dict)
    """The probing event of each axis; made once, since an edge has a memory."""

    @property
    def fixed_stop(self) -> bool:
        """Measurement type 7: the event is a mechanical stop, whatever P-AXIS-00516 says."""
        return self.block.measuring_type == FIXED_STOP_TYPE


def default_probe(core: Core, axis: AxisIndex) -> Probe:
    """Return how an axis is probed by its list."""
    params = core.axis(axis).params
    return Probe(effective_signal(params.kenngr), effective_input(params), effective_edge(params.kenngr))


def refused(core: Core, block: MeasuringRun) -> bool:
    """Report what forbids a run before it begins; tell whether anything did."""
    for index in sorted({*block.target, *block.axes}):
        axis = core.axis(index)
        if not axis.params.kenngr.messachse:
            core.report(errors.NOT_A_MEASUREMENT_AXIS, block.source, axis.number, axis=index)
            return True
        per_mille = fixed_stop_start_per_mille(axis.params)
        if block.measuring_type == FIXED_STOP_TYPE and per_mille > 1000:
            core.report(errors.FIXED_STOP_START_TOO_LARGE, block.source, axis.number, per_mille, axis=index)
            return True
    if not block.axes:
        core.report(errors.MEASURING_PATH_TOO_SMALL, block.source)
        return True
    return False


def begin(
    core: Core, block: MeasuringRun, probes: Mapping[AxisIndex, Probe], *, error_no_signal: bool
) -> Run | None:
    """Arm the sources of a run; None when it cannot begin (reported)."""
    if refused(core, block):
        return None
    run = Run(core, block, probes, error_no_signal, {})
    for axis in block.axes:
        probe = _probe(run, axis)
        source = probing.source(probe.signal)
        if source.blocked(core, axis, probe.edge):
            core.report(
                errors.PROBE_ALREADY_OPERATED,
                block.source,
                core.axis(axis).number,
                block.source.number,
                axis=axis,
            )
            return None
        run.pending[axis] = source.arm(core, axis, probe.input, probe.edge)
        core.show(axis, "lr_state/measurement_active_r", True)
        core.show(axis, "lr_state/measure_value_ok_r", False)
    return run


def _probe(run: Run, axis: AxisIndex) -> Probe:
    probe = run.probes[axis]
    return Probe(ProbingSignal.FIXED_STOP, probe.input, probe.edge) if run.fixed_stop else probe


def _nothing(run: Run) -> None:
    """A phase that only waits."""


def _start_path(run: Run) -> None:
    core = run.core
    core.preparation.synchronise()
    offsets = {
        axis: float(effective_probing_offset(core.axis(axis).params.kenngr, run.block.measuring_type))
        for axis in run.block.target
    }
    put = core.preparation.measuring_run(run.block, offsets)
    if put is None:
        core.report(errors.MEASURING_PATH_TOO_SMALL, run.block.source)
        return
    run.segment, run.target_path = put


def _latch(axis: AxisIndex, run: Run) -> None:
    core, probe = run.core, _probe(run, axis)
    latched = probing.source(probe.signal).latched(core, axis, probe.input, probe.edge)
    if latched is None:
        core.report(
            position_errors.TIMESTAMP_NOT_AVAILABLE, run.block.source, core.axis(axis).number, axis=axis
        )
        run.pending.clear()
        return
    position, dc_ns = latched
    del run.pending[axis]
    run.values[axis] = MeasuredValue(
        source=run.block.source,
        axis=axis,
        origin=probe.signal.value,
        acs_tenth_um=round(position),
        dc_ns=dc_ns,
        edge=probe.edge.value,
    )
    run.before_target[axis] = core.path.done <= run.target_path
    core.emitted.append(run.values[axis])
    core.show(axis, "lr_state/measure_value_ok_r", True)
    if run.fixed_stop:
        run.pending.clear()


def _all_latched(run: Run) -> str:
    return "running" if run.pending else "braking"


def _brake(run: Run) -> None:
    run.core.path.brake(run.core.preparation.brake_ramp(run.segment))


def _missed(run: Run) -> None:
    """The path has ended and an axis has not delivered."""
    core, channel = run.core, run.core.setup.channel
    for axis in run.pending:
        number = core.axis(axis).number
        if run.fixed_stop:
            if not channel.meas_fixed_stop_no_error:
                core.report(errors.FIXED_STOP_NOT_FOUND, run.block.source, number, axis=axis)
        elif run.error_no_signal or run.block.measuring_type == 2:
            core.report(errors.NO_MEASUREMENT, run.block.source, number, axis=axis)


def _not_ready(run: Run) -> None:
    core = run.core
    axis = next(iter(run.pending))
    core.report(errors.PROBING_NOT_INITIALISED, run.block.source, run.block.source.number, axis=axis)
    run.pending.clear()


def _retract(run: Run) -> None:
    """Take the interpolation back to the measured (or, without a stop, the actual) positions."""
    core = run.core
    core.preparation.synchronise()
    target = {axis: float(core.row(axis)["actual"]) for axis in run.block.axes}
    target |= {axis: float(value.acs_tenth_um) for axis, value in run.values.items()}
    core.preparation.retraction(target, tenth_um_per_s(RETRACTION_FEED))


def _finish(run: Run) -> None:
    core = run.core
    core.preparation.synchronise()
    for axis in run.block.axes:
        probing.source(_probe(run, axis).signal).disarm(core, axis)
        core.show(axis, "lr_state/measurement_active_r", False)


def _after_standstill(run: Run) -> str:
    return "retracting" if run.fixed_stop else "finishing"


def _ready(run: Run) -> Until:
    """The next source that has to get ready (they are asked one after the other)."""
    condition = next((one for one in run.pending.values() if one is not None), None)
    return condition or cycle_reached(run.core.cycle)


def _one_is_ready(run: Run) -> None:
    for axis, condition in run.pending.items():
        if condition is not None:
            run.pending[axis] = None
            return


def arming(run: Run) -> str:
    """Return the phase that a run begins or goes on with: as long as a source is not ready, `arming`."""
    return "arming" if any(one is not None for one in run.pending.values()) else "starting"


def _begun(run: Run) -> str:
    return "running" if run.segment >= 0 else "finishing"


def _event(axis: AxisIndex, run: Run) -> Until:
    if axis not in run.pending:
        return cycle_reached(_NEVER)
    if axis not in run.events:
        probe = _probe(run, axis)
        run.events[axis] = probing.source(probe.signal).event(run.core, axis, probe.input, probe.edge)
    return run.events[axis]


def table(run: Run) -> Table[Run]:
    """Return the phases of a run; each axis that has to deliver is one way out of the phase `running`."""
    events = tuple(
        Then(partial(_event, axis), _all_latched, partial(_latch, axis)) for axis in run.block.axes
    )
    overdue = run.core.cycle + ARMING_CYCLES
    return {
        "arming": Phase(
            _nothing,
            (
                Then(_ready, arming, _one_is_ready),
                Then(lambda _: cycle_reached(overdue), "finishing", _not_ready),
            ),
        ),
        "starting": Phase(_start_path, (Then(always, _begun),)),
        "running": Phase(_nothing, (*events, Then(lambda _: path_done(), _after_standstill, _missed))),
        "braking": Phase(_brake, (Then(lambda _: path_done(), _after_standstill),)),
        "retracting": Phase(_retract, (Then(lambda _: path_done(), "finishing"),)),
        "finishing": Phase(_finish, (Then(always, END),)),
    }


def abort(run: Run) -> None:
    """Switch the sources off when the program ends in the middle of a run."""
    _finish(run)
