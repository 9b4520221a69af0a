import pytest

from hli_bench.base.errors import InputError
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis.words import HomingType, ProbingSignal
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.trees import build, converted, flatten, refusals, value_at, with_value


def test_with_value_replaces_and_keeps_the_rest() -> None:
    before = AxisParams()
    after = with_value(before, "kenngr.measure.signal", "PLC_TIMESTAMP")
    assert after.kenngr.measure.signal is ProbingSignal.PLC_TIMESTAMP
    assert before.kenngr.measure.signal is ProbingSignal.UNSET
    assert after.getriebe is before.getriebe
    assert with_value(after, "kenngr.measure.signal", "") == before


@pytest.mark.parametrize("value", [True, 1, "1", "TRUE"])
def test_with_value_takes_toml_values(value: object) -> None:
    assert with_value(AxisParams(), "kenngr.messachse", value).kenngr.messachse is True


def test_with_value_grows_arrays() -> None:
    axis = with_value(AxisParams(), "antr.function[1].wr_ident[1]", "S-0-0092")
    assert axis.antr.function[1].wr_ident == ("", "S-0-0092")
    assert value_at(axis, "antr.function[1].wr_ident[1]") == "S-0-0092"
    assert value_at(axis, "antr.function[7].id") == ""


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (
            "kenngr.measure.sgnal",
            "PLC",
            "kenngr.measure.sgnal: unknown parameter .did you mean kenngr.measure.signal",
        ),
        ("kenngr.measure.input", 256, r"kenngr.measure.input: 256 is out of range 0\.\.255 .P-AXIS-00517"),
        ("kenngr.measure.input", 1.5, "kenngr.measure.input: '1.5' is not valid, expected UNS08"),
        ("kenngr.measure.edge", "UP", r"expected \(empty\), POS, NEG \(P-AXIS-00518\)"),
        ("antr.fixed_stop.drive_ident[4].id", "x", r"index 4 is out of range 0\.\.3"),
    ],
)
def test_with_value_names_what_is_wrong(path: str, value: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        with_value(AxisParams(), path, value)


def test_flatten_and_converted() -> None:
    tree = {
        "kenngr": {"measure": {"signal": "PLC"}},
        "getriebe": [{"vb_refmax": 5}],
        "getriebe[1]": {"kv": 7},
    }
    flat = flatten(tree)
    assert flat == {"kenngr.measure.signal": "PLC", "getriebe[0].vb_refmax": 5, "getriebe[1].kv": 7}
    axis = build(AxisParams, converted(AxisParams, flat))
    assert (axis.getriebe[0].vb_refmax, axis.getriebe[1].kv) == (5, 7)


def test_default_homing_type_follows_the_drive_type() -> None:
    for drive_type in (1, 3, 4, 5, 6, 7, 8):
        values = converted(AxisParams, {"kenngr.antr_typ": drive_type})
        assert build(AxisParams, values).kenngr.homing.homing_type is HomingType.CNC_CONTROLLED
    sercos = converted(AxisParams, {"kenngr.antr_typ": 2})
    assert build(AxisParams, sercos).kenngr.homing.homing_type is HomingType.DRIVE_CONTROLLED
    given = converted(AxisParams, {"kenngr.antr_typ": 2, "kenngr.homing_type": "CNC_CONTROLLED"})
    assert build(AxisParams, given).kenngr.homing.homing_type is HomingType.CNC_CONTROLLED


@pytest.mark.req("F-070", "F-071", "F-072", "F-073")
@pytest.mark.parametrize(
    ("drive_type", "window", "torque", "active", "limit"),
    [(2, "S_0_0159", "S_0_0092", 0.0, 100.0), (8, "6065_00", "6072_00", 4294967295.0, 500.0)],
)
def test_fixed_stop_presets(drive_type: int, window: str, torque: str, active: float, limit: float) -> None:
    axis = build(AxisParams, converted(AxisParams, {"kenngr.antr_typ": drive_type}))
    first, second = axis.antr.fixed_stop.drive_ident
    assert (first.id, first.wr_ident, first.commu, first.data_type) == (
        "MON_WINDOW",
        window,
        "ACYCLIC",
        "UNS32",
    )
    assert (first.mask, first.scaling_type, first.scaling_factor) == ("NOT_USED", "UNSCALED", 1.0)
    assert (first.min_limit, first.max_limit, first.startup_value) == (0.0, 1.0e199, 1048575)
    assert (first.active_value, first.rd_ident, first.use_startup_value) == (active, "", False)
    assert (second.id, second.wr_ident, second.commu) == ("TORQUE_LIMIT", torque, "ACYCLIC")
    assert (second.data_type, second.scaling_type, second.scaling_factor) == ("UNS16", "LINEAR", 10.0)
    assert (second.min_limit, second.max_limit, second.startup_value) == (0.0, limit, limit)
    assert (second.active_value, second.rd_ident, second.use_startup_value) == (1.0, "", False)


@pytest.mark.req("F-068")
def test_fixed_stop_presets_overwrite_the_list_unless_switched_off() -> None:
    here = "antr.fixed_stop.drive_ident[1]."
    raw: dict[str, object] = {"kenngr.antr_typ": 8, here + "id": "MINE", here + "active_value": 7}
    idents = build(AxisParams, converted(AxisParams, raw)).antr.fixed_stop.drive_ident
    assert (idents[1].id, idents[1].active_value) == ("TORQUE_LIMIT", 1.0)
    for switch in ("default", "default_ident"):
        own = build(AxisParams, converted(AxisParams, raw | {here + switch: 0})).antr.fixed_stop.drive_ident
        assert (own[0].id, own[1].id, own[1].active_value) == ("MON_WINDOW", "MINE", 7.0)


def test_refusals() -> None:
    assert refusals(AxisParams, {}) == []
    given = {
        "kenngr.ref_ohne_nocken": 1,
        "kenngr.measure.signal": "PLC_FIRST_EVENT",
        "antr.function[0].commu": "CYCLIC",
        "lr_hw[0].cam_direct_access": 0,
        "antr_typ": 2,
    }
    assert refusals(AxisParams, converted(AxisParams, given)) == [
        ("kenngr.ref_ohne_nocken", "P-AXIS-00156: kenngr.ref_ohne_nocken = 1 is not emulated"),
        ("kenngr.measure.signal", "P-AXIS-00516: kenngr.measure.signal = PLC_FIRST_EVENT is not emulated"),
        ("antr.function[0].commu", "P-AXIS-00397: antr.function[0].commu = CYCLIC is not emulated"),
        ("kenngr.antr_typ", "P-AXIS-00020: kenngr.antr_typ = 2 (SERCOS) is not emulated"),
    ]
    for kind in range(1, 8):
        assert refusals(ChannelParams, {"messtyp": kind}) == []
    assert refusals(ChannelParams, {"prog_start.slope.profile": 3}) == [
        ("prog_start.slope.profile", "P-CHAN-00071: prog_start.slope.profile = 3 is not emulated")
    ]


def test_bits_of_the_axis_mode_are_refused_by_name() -> None:
    mode = converted(AxisParams, {"kenngr.achs_mode": 0x20141})
    assert [text for _, text in refusals(AxisParams, mode)] == [
        "P-AXIS-00015: kenngr.achs_mode = 0x20141: PLANDREHEN (0x40) is not emulated",
        "P-AXIS-00015: kenngr.achs_mode = 0x20141: GANTRY_SLAVE (0x20000) is not emulated",
    ]
    assert refusals(AxisParams, converted(AxisParams, {"kenngr.achs_mode": 0x400101})) == []


@pytest.mark.parametrize(
    ("kind", "refused"), [({}, 1), ({"kenngr.achs_typ": 2}, 1), ({"kenngr.achs_typ": 4}, 0)]
)
def test_modulo_calculation_is_refused_but_for_spindles(kind: dict[str, int], refused: int) -> None:
    found = refusals(AxisParams, converted(AxisParams, {"kenngr.achs_mode": 0x400104} | kind))
    assert [path for path, _ in found] == ["kenngr.achs_mode"] * refused
    assert all("MODULO (0x4) is not emulated" in text for _, text in found)


def test_a_function_is_refused_for_what_is_left_out() -> None:
    values = converted(AxisParams, {"antr.function[2].id": "ANY", "antr.function[1].commu": "ACYCLIC"})
    assert refusals(AxisParams, values) == [
        ("antr.function[2].id", "P-AXIS-00397: antr.function[2].commu = CYCLIC is not emulated, its default")
    ]
