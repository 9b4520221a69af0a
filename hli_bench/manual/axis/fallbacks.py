"""Effective values: which of several parameters counts. Pure look-ups, no behaviour.

Sources: measurement manual 8.2.2 and 8.2.4, homing manual 3.2.4, TF5200 axis parameters.
"""

from dataclasses import dataclass

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis.getriebe import Getriebe
from hli_bench.manual.axis.kenngr import Kenngr
from hli_bench.manual.axis.words import Edge, ProbingSignal
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.measuring_methods import chosen

WITHOUT_HARDWARE = frozenset({DriveType.SIMULATION, DriveType.VIRTUAL})
"""Drive types whose default source is PLC_FIRST_EVENT, not DRIVE (TF5200 axis parameters, P-AXIS-00516)."""

TWO_INPUTS = frozenset({DriveType.SERCOS, DriveType.CANOPEN, DriveType.PROFIDRIVE})
"""Drive types with two probing inputs (P-AXIS-00517)."""


@dataclass(frozen=True, slots=True)
class TwoStepSlope:
    """Linear slope of one motion kind; accelerations in mm/s² (°/s²), changeover speed in µm/s (0.001°/s)."""

    acceleration_1: int
    acceleration_2: int
    deceleration_1: int
    deceleration_2: int
    changeover: int


def effective_signal(kenngr: Kenngr) -> ProbingSignal:
    """Return the source of the probing signal: P-AXIS-00516, else the old parameters, else by drive type."""
    signal = kenngr.measure.signal
    if signal is ProbingSignal.UNSET:
        signal = chosen(kenngr)
    return resolved_signal(signal, kenngr.antr_typ)


def effective_edge(kenngr: Kenngr) -> Edge:
    """Return POS or NEG: P-AXIS-00518, else P-AXIS-00113."""
    if kenngr.measure.edge is not Edge.UNSET:
        return kenngr.measure.edge
    return Edge.NEG if kenngr.mess_neg_flanke else Edge.POS


def resolved_signal(signal: ProbingSignal, drive_type: DriveType) -> ProbingSignal:
    """Return a source by name, DRIVE_TYPE_DEFAULT as the one that the drive type has."""
    if signal is not ProbingSignal.DRIVE_TYPE_DEFAULT:
        return signal
    return ProbingSignal.PLC_FIRST_EVENT if drive_type in WITHOUT_HARDWARE else ProbingSignal.DRIVE


def effective_input(axis: AxisParams) -> int:
    """Return the probing input; one that the source has not is corrected to 1, with warning 110587."""
    wanted = _listed_input(axis)
    permitted = permitted_inputs(effective_signal(axis.kenngr), axis.kenngr.antr_typ)
    return wanted if permitted is None or wanted in permitted else 1


def _listed_input(axis: AxisParams) -> int:
    """Return P-AXIS-00517, else 00430, else (CANopen) 00295, else 1."""
    if axis.kenngr.measure.input:
        return axis.kenngr.measure.input
    if axis.antr.probing_input_nbr:
        return axis.antr.probing_input_nbr
    if axis.kenngr.antr_typ is DriveType.CANOPEN and axis.antr.canopen.probing_input_number:
        return axis.antr.canopen.probing_input_number
    return 1


def permitted_inputs(signal: ProbingSignal, drive_type: DriveType) -> range | None:
    """Return the probing inputs that a source has; None where the source uses none. Source: P-AXIS-00517."""
    if signal is ProbingSignal.PLC_EXT_LATCH_CONTROL:
        return range(1, 256)
    if signal is ProbingSignal.EXT_PROBE_WITH_DRIVE:
        return range(1, 3)
    if signal is not ProbingSignal.DRIVE:
        return None
    return range(1, 3 if drive_type in TWO_INPUTS else 2)


def fixed_stop_pos_lag_limit(axis: AxisParams) -> int:
    """Return the position lag that means a stop in 0.1 µm, 0 for off: P-AXIS-00774, 00769, 00331."""
    for limit in (
        axis.kenngr.measure.fixed_stop_detect.pos_lag_limit,
        axis.antr.fixed_stop.detect.pos_lag_limit,
    ):
        if limit >= 0:
            return limit
    return axis.kenngr.fixed_stop_pos_lag_limit


def fixed_stop_min_time_us(axis: AxisParams, cycle_us: int) -> int:
    """Return how long the criteria must hold in µs: P-AXIS-00775, 00770, cycles of 00332."""
    detect = axis.kenngr.measure.fixed_stop_detect
    return (
        detect.min_time
        or axis.antr.fixed_stop.detect.min_time
        or axis.kenngr.fixed_stop_nbr_cycles * cycle_us
    )


def fixed_stop_start_per_mille(axis: AxisParams) -> int:
    """Return the share of the block before detection is armed in 0.1 %, -1 for not set: P-AXIS-00777, 00772.

    A value above 1000 is returned as it is: the run then ends with P-ERR-51026.
    """
    own = axis.kenngr.measure.fixed_stop_detect.start_distance_per_mille
    return max(own if own >= 0 else axis.antr.fixed_stop.detect.start_distance_per_mille, -1)


def fixed_stop_start_distance(axis: AxisParams, block_length: float) -> float:
    """Return the path in the block (length in 0.1 µm) after which detection is armed: the smaller of both.

    Decided here: P-AXIS-00776 = 0 (its default) counts as not set when a share is given, since the
    share could otherwise never act.
    """
    own = axis.kenngr.measure.fixed_stop_detect.start_distance
    distance = own if own >= 0 else max(axis.antr.fixed_stop.detect.start_distance, 0)
    per_mille = fixed_stop_start_per_mille(axis)
    if per_mille < 0:
        return float(distance)
    share = block_length * per_mille / 1000.0
    return min(float(distance), share) if distance > 0 else share


def fixed_stop_max_delta(axis: AxisParams) -> int:
    """Return the largest path within the minimum time at a stop in 0.1 µm, -1 for off: P-AXIS-00778, 00773.

    P-AXIS-00773 = 0 is off, as its own sheet says.
    """
    own = axis.kenngr.measure.fixed_stop_detect.max_delta_position_window
    if own >= 0:
        return own
    common = axis.antr.fixed_stop.detect.max_delta_position_window
    return common if common > 0 else -1


def has_criterion(axis: AxisParams) -> bool:
    """Tell whether anything is configured by which a measuring run can know its stop."""
    return fixed_stop_pos_lag_limit(axis) > 0 or fixed_stop_max_delta(axis) >= 0


def effective_probing_offset(kenngr: Kenngr, messtyp: int) -> int:
    """Return the path past the target in 0.1 µm: P-AXIS-00467 for all types but 3, old 00114 for type 2."""
    if messtyp == 3:
        return 0
    return kenngr.probing_offset or (kenngr.mess_offset if messtyp == 2 else 0)


def rapid_slope(gear: Getriebe) -> TwoStepSlope:
    """Return the G00 slope; missing decelerations are the accelerations."""
    slope = gear.lslope_profil
    return TwoStepSlope(
        slope.a_grenz_stufe_1,
        slope.a_grenz_stufe_2,
        slope.d_grenz_stufe_1 or slope.a_grenz_stufe_1,
        slope.d_grenz_stufe_2 or slope.a_grenz_stufe_2,
        slope.vb_grenz_stufe_1_2,
    )


def feed_slope(gear: Getriebe) -> TwoStepSlope:
    """Return the G01 slope; missing decelerations are the accelerations."""
    slope = gear.lslope_profil
    return TwoStepSlope(
        slope.a_stufe_1,
        slope.a_stufe_2,
        slope.d_stufe_1 or slope.a_stufe_1,
        slope.d_stufe_2 or slope.a_stufe_2,
        slope.vb_stufe_1_2,
    )


def feedhold_deceleration(gear: Getriebe) -> int:
    """Return P-AXIS-00024 in mm/s² (°/s²), else the smaller of P-AXIS-00005 and 00006."""
    slope = gear.lslope_profil
    return slope.a_feedh or min(slope.a_grenz_stufe_1, slope.a_grenz_stufe_2)


def homing_acceleration(gear: Getriebe) -> int:
    """Return P-AXIS-00285 in mm/s² (°/s²), else the smaller of P-AXIS-00005 and 00006."""
    return gear.a_ref or min(gear.lslope_profil.a_grenz_stufe_1, gear.lslope_profil.a_grenz_stufe_2)


def homing_ramp_time_us(gear: Getriebe) -> int:
    """Return P-AXIS-00286 in µs, but at least P-AXIS-00201."""
    return max(gear.tr_ref, gear.dynamik.tr_min)


def emergency_deceleration(gear: Getriebe) -> int:
    """Return P-AXIS-00003 in mm/s² (°/s²), else P-AXIS-00008."""
    return gear.dynamik.a_emergency or gear.dynamik.a_max
