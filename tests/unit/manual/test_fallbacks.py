import pytest

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis import fallbacks as effective
from hli_bench.manual.axis.words import Edge, ProbingSignal
from hli_bench.manual.trees import with_value

OWN = "kenngr.measure.fixed_stop_detect."
COMMON = "antr.fixed_stop.detect."


def axis(**values: object) -> AxisParams:
    params = AxisParams()
    for path, value in values.items():
        params = with_value(params, path, value)
    return params


@pytest.mark.req("M-036", "M-206", "M-245", "M-246", "M-248")
@pytest.mark.parametrize(
    ("values", "signal"),
    [
        ({"kenngr.antr_typ": 8}, "DRIVE"),
        ({"kenngr.antr_typ": 4}, "PLC_FIRST_EVENT"),
        ({"kenngr.antr_typ": 16}, "PLC_FIRST_EVENT"),
        ({"kenngr.antr_typ": 1}, "DRIVE"),
        ({"kenngr.antr_typ": 8, "kenngr.measure.signal": "DRIVE_TYPE_DEFAULT"}, "DRIVE"),
        ({"kenngr.antr_typ": 8, "kenngr.probing_signal_via_plc": 1}, "PLC"),
        ({"kenngr.antr_typ": 8, "kenngr.mess_signal_achs_steuer": 1}, "PLC"),
        ({"kenngr.meas_signal_fixed_stop": 1}, "FIXED_STOP"),
        ({"kenngr.meas_signal_drive": 1}, "DRIVE"),
        ({"kenngr.antr_typ": 2, "kenngr.mess_signal_sercos": 1}, "DRIVE"),
        ({"kenngr.meas_signal_fixed_stop": 1, "kenngr.measure.signal": "PLC_TIMESTAMP"}, "PLC_TIMESTAMP"),
    ],
)
def test_signal(values: dict[str, object], signal: str) -> None:
    assert effective.effective_signal(axis(**values).kenngr) is ProbingSignal(signal)


@pytest.mark.req("M-038", "M-212", "M-240")
@pytest.mark.parametrize(
    ("values", "edge"),
    [
        ({}, "POS"),
        ({"kenngr.mess_neg_flanke": 1}, "NEG"),
        ({"kenngr.mess_neg_flanke": 1, "kenngr.measure.edge": "POS"}, "POS"),
        ({"kenngr.measure.edge": "NEG"}, "NEG"),
    ],
)
def test_edge(values: dict[str, object], edge: str) -> None:
    assert effective.effective_edge(axis(**values).kenngr) is Edge(edge)


@pytest.mark.req("M-037", "M-211")
@pytest.mark.parametrize(
    ("values", "number"),
    [
        ({}, 1),
        ({"antr.probing_input_nbr": 2}, 2),
        ({"antr.probing_input_nbr": 2, "kenngr.measure.input": 1}, 1),
        ({"antr.canopen.probing_input_number": 2}, 1),
        ({"antr.canopen.probing_input_number": 2, "kenngr.antr_typ": 8}, 2),
        ({"kenngr.measure.input": 4}, 4),
    ],
)
def test_input(values: dict[str, object], number: int) -> None:
    assert effective.effective_input(axis(**values)) == number


@pytest.mark.req("M-222", "M-223")
@pytest.mark.parametrize(
    ("values", "limit"),
    [
        ({}, 0),
        ({"kenngr.fixed_stop_pos_lag_limit": 7}, 7),
        ({"kenngr.fixed_stop_pos_lag_limit": 7, COMMON + "pos_lag_limit": 8}, 8),
        ({"kenngr.fixed_stop_pos_lag_limit": 7, COMMON + "pos_lag_limit": 0}, 0),
        ({COMMON + "pos_lag_limit": 8, OWN + "pos_lag_limit": 9}, 9),
        ({COMMON + "pos_lag_limit": 8, OWN + "pos_lag_limit": 0}, 0),
    ],
)
def test_position_lag_limit(values: dict[str, object], limit: int) -> None:
    assert effective.fixed_stop_pos_lag_limit(axis(**values)) == limit


@pytest.mark.req("M-224")
@pytest.mark.parametrize(
    ("values", "time_us"),
    [
        ({}, 0),
        ({"kenngr.fixed_stop_nbr_cycles": 5}, 10_000),
        ({"kenngr.fixed_stop_nbr_cycles": 5, COMMON + "min_time": 300}, 300),
        ({COMMON + "min_time": 300, OWN + "min_time": 400}, 400),
    ],
)
def test_minimum_time(values: dict[str, object], time_us: int) -> None:
    assert effective.fixed_stop_min_time_us(axis(**values), cycle_us=2000) == time_us


@pytest.mark.req("M-149", "M-151", "M-225", "M-226", "M-227")
@pytest.mark.parametrize(
    ("values", "distance"),
    [
        ({}, 0),
        ({OWN + "start_distance": 300}, 300),
        ({OWN + "start_distance": -1}, 0),
        ({OWN + "start_distance": -1, COMMON + "start_distance": 200}, 200),
        ({OWN + "start_distance_per_mille": 500}, 500),
        ({OWN + "start_distance_per_mille": 0}, 0),
        ({COMMON + "start_distance_per_mille": 250}, 250),
        ({OWN + "start_distance_per_mille": 500, OWN + "start_distance": 300}, 300),
        ({OWN + "start_distance_per_mille": 100, OWN + "start_distance": 300}, 100),
    ],
)
def test_start_distance_in_a_block_of_1000(values: dict[str, object], distance: float) -> None:
    assert effective.fixed_stop_start_distance(axis(**values), 1000) == distance


@pytest.mark.req("M-230", "M-231")
@pytest.mark.parametrize(
    ("values", "window"),
    [
        ({}, -1),
        ({OWN + "max_delta_position_window": 5}, 5),
        ({COMMON + "max_delta_position_window": 6}, 6),
        ({COMMON + "max_delta_position_window": 0}, -1),
        ({OWN + "max_delta_position_window": 5, COMMON + "max_delta_position_window": 6}, 5),
    ],
)
def test_largest_position_change(values: dict[str, object], window: int) -> None:
    assert effective.fixed_stop_max_delta(axis(**values)) == window


@pytest.mark.req("M-035", "M-218")
def test_probing_offset() -> None:
    new = axis(**{"kenngr.probing_offset": 5, "kenngr.mess_offset": 7}).kenngr
    assert [effective.effective_probing_offset(new, kind) for kind in (1, 2, 3, 7)] == [5, 5, 0, 5]
    old = axis(**{"kenngr.mess_offset": 7}).kenngr
    assert [effective.effective_probing_offset(old, kind) for kind in (1, 2, 3, 7)] == [0, 7, 0, 0]


def test_homing_dynamics() -> None:
    slope = {
        "getriebe[0].lslope_profil.a_grenz_stufe_1": 900,
        "getriebe[0].lslope_profil.a_grenz_stufe_2": 700,
    }
    assert effective.homing_acceleration(axis(**slope).getriebe[0]) == 700
    assert effective.homing_acceleration(axis(**slope, **{"getriebe[0].a_ref": 500}).getriebe[0]) == 500
    assert effective.homing_ramp_time_us(AxisParams().getriebe[0]) == 10_000
    assert effective.homing_ramp_time_us(axis(**{"getriebe[0].tr_ref": 20_000}).getriebe[0]) == 20_000


def test_slopes() -> None:
    here = "getriebe[0].lslope_profil."
    gear = axis(
        **{here + "a_grenz_stufe_1": 11, here + "a_grenz_stufe_2": 12, here + "d_grenz_stufe_2": 13},
        **{here + "a_stufe_1": 21, here + "a_stufe_2": 22, here + "d_stufe_1": 23, here + "vb_stufe_1_2": 24},
    ).getriebe[0]
    assert effective.rapid_slope(gear) == effective.TwoStepSlope(11, 12, 11, 13, 100_000)
    assert effective.feed_slope(gear) == effective.TwoStepSlope(21, 22, 23, 22, 24)
    assert effective.feedhold_deceleration(gear) == 11
    assert effective.emergency_deceleration(gear) == 1000
