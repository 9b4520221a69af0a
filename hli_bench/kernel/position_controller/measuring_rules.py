"""What a measuring run may be: how its axes are probed, and what forbids it before it begins.

Source: measurement manual 3, 4, 7.2; diagnosis of the errors named here.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import MeasureSettings, MeasuringRun
from hli_bench.kernel.core import Core
from hli_bench.kernel.records import CncError
from hli_bench.kernel.setup import AxisSetup
from hli_bench.manual.axis.fallbacks import (
    effective_edge,
    effective_input,
    effective_signal,
    fixed_stop_start_per_mille,
    has_criterion,
    permitted_inputs,
    resolved_signal,
)
from hli_bench.manual.axis.words import Edge, ProbingSignal
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.errors import ErrorSheet
from hli_bench.manual.errors import path_interpolator as errors
from hli_bench.manual.errors import path_preparation as preparation_errors
from hli_bench.manual.errors import position_controller as position_errors
from hli_bench.protocols.canopen.telegram import PROBE

FEED_FROM_AXIS: Final = 2
MAIN_AXES_ONLY: Final = 4
FIXED_STOP_TYPE: Final = 7
STROKE_TYPES: Final = (FEED_FROM_AXIS, MAIN_AXES_ONLY)
"""Measurement types whose feed P-AXIS-00086 limits."""
MAIN_AXIS_NAMES: Final = ("X", "Y", "Z")
MOST_AXES: Final = {FEED_FROM_AXIS: 1, MAIN_AXES_ONLY: len(MAIN_AXIS_NAMES)}


@dataclass(slots=True)
class Probe:
    """How one axis is probed: P-AXIS-00516..00518, or what #MEAS made of them."""

    signal: ProbingSignal
    input: int
    edge: Edge


def default_probe(core: Core, axis: AxisIndex) -> Probe:
    """Return how an axis is probed by its list."""
    params = core.axis(axis).params
    return Probe(effective_signal(params.kenngr), effective_input(params), effective_edge(params.kenngr))


def take_settings(core: Core, probes: dict[AxisIndex, Probe], settings: MeasureSettings) -> None:
    """Change how axes are probed as #MEAS says, #MEAS DEFAULT back to their lists; report what is not possible."""
    if settings.axis is None:
        if settings.reset:
            probes.update((axis.index, default_probe(core, axis.index)) for axis in core.setup.axes)
        return
    axis = core.axis(settings.axis)
    before = default_probe(core, axis.index) if settings.reset else probes[axis.index]
    signal = ProbingSignal(settings.signal) if settings.signal else before.signal
    after = Probe(
        resolved_signal(signal, axis.params.kenngr.antr_typ),
        before.input if settings.input is None else settings.input,
        Edge(settings.edge) if settings.edge else before.edge,
    )
    refusal = _change_refused(axis, before, after)
    if refusal is None:
        probes[axis.index] = after
        return
    core.report(refusal, settings.source, *_values(refusal, axis, before, after), axis=axis.index)


def _values(refusal: ErrorSheet, axis: AxisSetup, before: Probe, after: Probe) -> tuple[int | str, ...]:
    """Return what is handed over with a refused change, in the order of the sheet."""
    drive_type = int(axis.params.kenngr.antr_typ)
    if refusal is errors.MEAS_INPUT_INVALID:
        return axis.number, drive_type, after.input, _largest_input(axis, after)
    if refusal is errors.MEAS_NOT_A_MEASUREMENT_AXIS:
        return (axis.number,)
    return axis.number, drive_type, after.signal.value, after.input, before.input


def _largest_input(axis: AxisSetup, probe: Probe) -> int:
    inputs = permitted_inputs(probe.signal, axis.params.kenngr.antr_typ)
    return 0 if inputs is None else inputs.stop - 1


def _change_refused(axis: AxisSetup, before: Probe, after: Probe) -> ErrorSheet | None:
    """Return why an axis cannot be probed in another way, None when it can."""
    if not axis.params.kenngr.messachse:
        return errors.MEAS_NOT_A_MEASUREMENT_AXIS
    drive_type = axis.params.kenngr.antr_typ
    inputs = permitted_inputs(after.signal, drive_type)
    if inputs is not None and after.input not in inputs:
        return errors.MEAS_INPUT_INVALID
    if after.signal is ProbingSignal.DRIVE and PROBE not in axis.telegrams:
        return position_errors.PROBE_COMMAND_FAILED
    if after.signal is ProbingSignal.DRIVE and drive_type is DriveType.SERCOS:
        if after.input != before.input:
            return position_errors.INPUT_NOT_CHANGEABLE
        if after.edge is not before.edge:
            return position_errors.EDGE_NOT_CHANGEABLE
    return None


def to_fixed_stop(block: MeasuringRun, probes: Mapping[AxisIndex, Probe]) -> bool:
    """Tell whether a run ends at a mechanical stop: type 7 does whatever P-AXIS-00516 says, others by their source."""
    stops = (probes[axis].signal is ProbingSignal.FIXED_STOP for axis in block.axes)
    return block.measuring_type == FIXED_STOP_TYPE or any(stops)


def effective_probe(block: MeasuringRun, probes: Mapping[AxisIndex, Probe], axis: AxisIndex) -> Probe:
    """Return how an axis is probed in a run."""
    probe = probes[axis]
    if block.measuring_type == FIXED_STOP_TYPE:
        return Probe(ProbingSignal.FIXED_STOP, probe.input, probe.edge)
    return probe


def refused(core: Core, block: MeasuringRun, probes: Mapping[AxisIndex, Probe]) -> bool:
    """Report what forbids a run before it begins; tell whether anything did."""
    before = len(core.emitted)
    _refuse(core, block, probes)
    return any(isinstance(one, CncError) and one.severity == "error" for one in core.emitted[before:])


def _refuse(core: Core, block: MeasuringRun, probes: Mapping[AxisIndex, Probe]) -> None:
    """Report the first thing that forbids a run."""
    fixed_stop = to_fixed_stop(block, probes)
    for index in sorted({*block.target, *block.axes}):
        if (
            _wrong_axis(core, block, index)
            or _wrong_source(core, block, probes, index)
            or (fixed_stop and _stop_refused(core, block, index))
        ):
            return
    most = MOST_AXES.get(block.measuring_type, len(core.setup.axes))
    if len(block.target) > most:
        count, kind = len(block.target), block.measuring_type
        core.report(errors.TOO_MANY_MEASURING_AXES, block.source, count, most, kind)


def _wrong_axis(core: Core, block: MeasuringRun, index: AxisIndex) -> bool:
    """Report an axis that may not be in this run."""
    axis, kind = core.axis(index), block.measuring_type
    if not axis.params.kenngr.messachse:
        core.report(errors.NOT_A_MEASUREMENT_AXIS, block.source, axis.number, axis=index)
        return True
    if kind in STROKE_TYPES and axis.params.kenngr.hub_messtaster == 0:
        core.report(preparation_errors.PROBE_STROKE_ZERO, block.source, axis.number, axis=index)
        return True
    if kind == MAIN_AXES_ONLY and axis.name not in MAIN_AXIS_NAMES:
        count, most = len(block.target), MOST_AXES[kind]
        allowed = most if count > most else f"main axes only ({axis.name} is not a main axis)"
        core.report(errors.TOO_MANY_MEASURING_AXES, block.source, count, allowed, kind, axis=index)
        return True
    return False


def _wrong_source(
    core: Core, block: MeasuringRun, probes: Mapping[AxisIndex, Probe], index: AxisIndex
) -> bool:
    """Report a signal or input that does not fit: an input that the source has not, a stop beside other signals."""
    axis, probe = core.axis(index), effective_probe(block, probes, index)
    inputs = permitted_inputs(probe.signal, axis.params.kenngr.antr_typ)
    if index in block.axes and inputs is not None and probe.input not in inputs:
        values = _values(errors.MEAS_INPUT_INVALID, axis, probe, probe)
        core.report(errors.MEAS_INPUT_INVALID, block.source, *values, axis=index)
        return True
    if index in block.axes and to_fixed_stop(block, probes) and probe.signal is not ProbingSignal.FIXED_STOP:
        core.report(
            errors.FIXED_STOP_PARAMETERS,
            block.source,
            axis.number,
            "kenngr.measure.signal",
            probe.signal.value,
            block.measuring_type,
            len(block.axes),
            axis=index,
        )
        return True
    return False


def _stop_refused(core: Core, block: MeasuringRun, index: AxisIndex) -> bool:
    """Report a start of the detection behind the end of the block; warn of an axis without any criterion."""
    axis = core.axis(index)
    per_mille = fixed_stop_start_per_mille(axis.params)
    if per_mille > 1000:
        core.report(errors.FIXED_STOP_START_TOO_LARGE, block.source, axis.number, per_mille, 1000, axis=index)
        return True
    if not has_criterion(axis.params):
        core.report(position_errors.NO_DETECTION_CRITERION, block.source, axis.number, axis=index)
    return False
