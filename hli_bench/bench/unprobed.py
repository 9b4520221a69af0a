"""Notices that a measuring run could not find anything: the plant has no face for the probe, or no PLC tells of it."""

from collections.abc import Mapping, Sequence
from typing import Final

from hli_bench.base.ids import AxisIndex
from hli_bench.bench.config import AxisConfig, MachineConfig
from hli_bench.bench.result import Error, Measurement
from hli_bench.kernel.position_controller.measurement import FIXED_STOP_TYPE
from hli_bench.manual.axis.fallbacks import effective_signal
from hli_bench.manual.axis.words import ProbingSignal
from hli_bench.manual.errors.path_interpolator import FIXED_STOP_NOT_FOUND
from hli_bench.plant.settings import PROBE

RUN_STARTED: Final = ("V.A.MERF", "V.A.MEIN")
"""Variables that a result has of every axis of a measuring run, whatever came of it."""


def nothing_to_probe(
    config: MachineConfig,
    variables: Mapping[str, float],
    found: Sequence[Measurement],
    errors: Sequence[Error],
    unserved: Mapping[AxisIndex, Sequence[str]],
) -> list[str]:
    """Return a remark for each axis that was to probe, and did not: no face at all, no PLC that says so, no signal.

    `unserved` names the control units of each axis that no PLC served, and why.
    """
    settled = {one.axis for one in found} | {
        one.axis for one in errors if one.id == FIXED_STOP_NOT_FOUND.number
    }
    to_probe = [
        axis
        for axis in config.axes
        if axis.name not in settled
        and all(f"{name}.{axis.name}" in variables for name in RUN_STARTED)
        and _waits_for_a_face(config, axis)
    ]
    if not any(axis.face for axis in config.plant.axes) and all(
        fault.target != PROBE for fault in config.faults
    ):
        return [
            f"axis {axis.name} measured nothing, as the plant has no face: "
            f"plant.probe.{axis.name}.face_mm and plant.probe.{axis.name}.material set one"
            for axis in to_probe
        ]
    reported = {one.axis for one in errors}
    remarks: list[str] = []
    for axis in to_probe:
        units = unserved.get(axis.index, ())
        remarks += [f"axis {axis.name} measured nothing, as no PLC serves {unit}" for unit in units]
        if not units and axis.name not in reported:
            remarks.append(f"axis {axis.name} measured nothing: no probing signal came on its way")
    return remarks


def _waits_for_a_face(config: MachineConfig, axis: AxisConfig) -> bool:
    """Tell whether the event is a touch of the probe and not a fixed stop."""
    stop = config.channel.messtyp == FIXED_STOP_TYPE or config.channel.meas_fixed_stop_no_error
    return not stop and effective_signal(axis.params.kenngr) is not ProbingSignal.FIXED_STOP
