"""Default homing in three phases: to the cam, off the cam, onto it with referencing by zero pulse or cam edge.

Source: homing manual 2.3.1; P-AXIS-00064, 00084, 00152, 00158, 00218, 00219.
"""

from functools import partial

from hli_bench.base.units import tenth_um_from_um_per_s
from hli_bench.kernel.position_controller.homing import (
    Run,
    cam,
    cam_operated,
    finish,
    jog,
    reference,
)
from hli_bench.kernel.position_controller.latches import unwrapped
from hli_bench.kernel.sequence import END, Phase, Table, Then, Until
from hli_bench.kernel.setup import AxisSetup
from hli_bench.kernel.watches import jog_stopped, moved, probe_status
from hli_bench.manual.axis.fallbacks import effective_input
from hli_bench.manual.axis.kenngr import Kenngr
from hli_bench.manual.errors import position_controller as errors

ZERO_PULSE = 0x15
"""Touch probe function: enable, encoder zero pulse, positive edge."""
STORED = 0x02
ENDLESS = 1 << 53
PAST_CAM = 10_000.0
"""0.1 um (0.0001 degree): what the axis may go behind the place where it should find the cam again (decided here)."""
LONGEST_WAY = 100_000_000
"""10 m in 0.1 um."""
LONGEST_TURN = 36_000_000
"""3600 degrees in 0.0001 degree."""
_UNSET = Kenngr()


def first(run: Run) -> str:
    """An axis that stands on the cam begins with phase 2 (homing manual 2.3.1.1)."""
    return "off cam" if cam_operated(run) else "to cam"


def table(run: Run) -> Table[Run]:
    """Return the phases; `run` decides speeds, direction and what references."""
    kenngr, gear = run.setup.params.kenngr, run.setup.params.getriebe[0]
    run.method = "cam" if kenngr.homing_without_zero_pulse else "cam, zero pulse"
    away = gear.vb_refmax if kenngr.fast_from_cam else gear.vb_reflow
    on, off = partial(cam, operated=True), partial(cam, operated=False)
    by_cam = kenngr.homing_without_zero_pulse
    found = Then(on, "stop", _reference_here) if by_cam else Then(on, "on cam")
    lost = Then(off, "lost", _no_zero_pulse)
    endless = Then(_beyond, "lost", _path_exceeded)
    stuck = Then(_too_far_off, "lost", _cam_stays)
    gone = Then(_behind_cam, "lost", _cam_gone)
    return {
        "to cam": Phase(_move(gear.vb_refmax), (Then(on, "stop on cam"), endless)),
        "stop on cam": Phase(_stop, (Then(_stands, _on_cam),)),
        "off cam": Phase(_move(away, -1), (Then(off, "stop off cam"), stuck, endless)),
        "stop off cam": Phase(_stop, (Then(_stands, "search"),)),
        "search": Phase(_move(gear.vb_reflow), (found, gone, endless)),
        "on cam": Phase(_nothing, (Then(_activated, "zero pulse"), lost, endless)),
        "zero pulse": Phase(
            _arm_zero_pulse,
            (
                Then(_latched, "stop", _reference_latched),
                Then(_too_far, "lost", _no_zero_pulse),
                lost,
                endless,
            ),
        ),
        "stop": Phase(_stop, (Then(_stands, END, finish),)),
        "lost": Phase(_stop, (Then(_stands, END),)),
    }


def _move(velocity: int, sign: int = 1) -> "partial[None]":
    return partial(_jog, velocity, sign)


def _jog(velocity: int, sign: int, run: Run) -> None:
    run.before, run.turned = run.turned, _here(run)
    jog(run, sign * run.direction, velocity)


def _here(run: Run) -> float:
    return float(run.core.row(run.axis)["actual"])


def _on_cam(run: Run) -> str:
    """Phase 2 needs the axis on the cam: one that has run over it does not know on which side it stands."""
    if cam_operated(run):
        return "off cam"
    _report_off_cam(run, "the axis has stopped behind the reference cam: it is too short for P-AXIS-00219")
    return "lost"


def _too_far_off(run: Run) -> Until:
    """P-AXIS-00531: longest way off the cam, 0 is off."""
    return _moved(run, run.setup.params.lr_hw[0].move_from_cam_max_dist or ENDLESS)


def _cam_stays(run: Run) -> None:
    _report_off_cam(run, "the reference cam stays operated")


def _report_off_cam(run: Run, cause: str) -> None:
    way, longest = abs(_here(run) - run.turned), run.setup.params.lr_hw[0].move_from_cam_max_dist
    run.core.report(
        errors.PATH_OFF_CAM,
        run.source,
        run.setup.number,
        round(way),
        longest,
        round(float(run.core.row(run.axis)["command"])),
        axis=run.axis,
        cause=cause,
    )


def _behind_cam(run: Run) -> Until:
    """The axis is back where it came off the cam."""
    return _moved(run, round(_way_back(run)))


def _way_back(run: Run) -> float:
    """Return on which way the cam must come again, and what a PLC may need to tell it: half a second, 1 mm."""
    slow = tenth_um_from_um_per_s(run.setup.params.getriebe[0].vb_reflow)
    return abs(run.turned - run.before) + 0.5 * slow + PAST_CAM


def _cam_gone(run: Run) -> None:
    _report_path(run, _way_back(run), run.turned, "the reference cam has not come back")


def _stop(run: Run) -> None:
    jog(run, 0, 0)


def _stands(run: Run) -> Until:
    return jog_stopped(run.axis)


def _nothing(run: Run) -> None:
    """A phase that only waits."""


def _moved(run: Run, way: int) -> Until:
    return moved(run.axis, float(way), float(run.core.row(run.axis)["actual"]))


def _activated(run: Run) -> Until:
    """P-AXIS-00494: the zero pulse counts from this way behind the cam on."""
    return _moved(run, run.setup.params.kenngr.shift_offset_zero_pulse_activation)


def _too_far(run: Run) -> Until:
    """P-AXIS-00404: longest way of the search, 0 is off."""
    return _moved(run, run.setup.params.lr_hw[0].zero_pulse_search_max_dist or ENDLESS)


def _beyond(run: Run) -> Until:
    return moved(run.axis, float(longest_way(run.setup)), run.begin)


def _report_path(run: Run, longest: float, begin: float, cause: str) -> None:
    row, gear = run.core.row(run.axis), run.setup.params.getriebe[0]
    row["probe_function"] = 0
    run.core.report(
        errors.HOMING_PATH,
        run.source,
        run.setup.number,
        round(longest),
        round(abs(_here(run) - begin)),
        round(float(row["command"])),
        gear.moduloo - gear.modulou,
        axis=run.axis,
        cause=cause,
    )


def longest_way(axis: AxisSetup) -> int:
    """Return how far from its begin homing may take the axis, 0.1 um (0.0001 degree).

    P-AXIS-00412 for rotary axes and spindles. Without it (decided here) the way between the software limits that the
    list sets, with the reference position and a tenth more, else 10 m or 3600 degrees: a cam that never comes, or never
    goes, must not let the axis run for ever.
    """
    kenngr, reference = axis.params.kenngr, axis.params.getriebe[0].pos_refpkt
    if axis.kind != "T":
        return kenngr.homing_max_movement_dist or LONGEST_TURN
    limits = (kenngr.swe_neg, kenngr.swe_pos)
    if kenngr.swe_neg >= kenngr.swe_pos or limits == (_UNSET.swe_neg, _UNSET.swe_pos):
        return LONGEST_WAY
    return round(1.1 * (max(kenngr.swe_pos, reference) - min(kenngr.swe_neg, reference)))


def _shift(run: Run) -> int:
    return 8 * (effective_input(run.setup.params) - 1)


def _arm_zero_pulse(run: Run) -> None:
    run.core.row(run.axis)["probe_function"] = ZERO_PULSE << _shift(run)


def _latched(run: Run) -> Until:
    stored = STORED << _shift(run)
    return probe_status(run.axis, stored, stored)


def _reference_latched(run: Run) -> None:
    """The zero pulse's count becomes the reference position, whatever the axis did since."""
    row = run.core.row(run.axis)
    reference(run, unwrapped(row, int(row["latch"][0])))
    row["probe_function"] = 0


def _reference_here(run: Run) -> None:
    """Without a zero pulse the actual position of the cycle that sees the cam becomes the reference position."""
    reference(run, int(run.core.row(run.axis)["feedback"]))


def _no_zero_pulse(run: Run) -> None:
    run.core.row(run.axis)["probe_function"] = 0
    run.core.report(errors.ZERO_PULSE_PATH, run.source, run.setup.number, axis=run.axis)


def _path_exceeded(run: Run) -> None:
    rotary = run.setup.params.kenngr.homing_max_movement_dist and run.setup.kind != "T"
    limit = (
        "P-AXIS-00412"
        if rotary
        else "the way between the software limits, or the longest where there are none"
    )
    missing = "the zero pulse" if run.core.row(run.axis)["probe_function"] else "the reference cam"
    state = "operated" if cam_operated(run) else "not operated"
    _report_path(
        run,
        longest_way(run.setup),
        run.begin,
        f"{missing} has not come; the cam is {state}; the limit is {limit}",
    )
