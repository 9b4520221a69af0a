import pytest
from hypothesis import given
from hypothesis import strategies as st

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis.words import Edge, HomingType, ProbingSignal
from hli_bench.manual.drive_types import AxisMode, AxisType, DriveType
from hli_bench.manual.lists import (
    Finding,
    ParsedList,
    Severity,
    build,
    parse_axis_list,
    parse_channel_list,
    value_at,
)

CONVENTIONAL_EXAMPLE = """\
# **************************************************
#    Axis machine data X axis
# **************************************************
#
kopf.achs_nr                                        1
kopf.mds_ident                                      1
kopf.log_achs_name                                  X_axis
.........................................
#
kenngr.achs_mode                                    1
kenngr.achs_typ                                     1
.........................................
kenngr.ref_richt                                    0
kenngr.homing_without_zero_pulse                    0
kenngr.fast_from_cam                                1
kenngr.ref_ohne_nocken                              0
kenngr.vorz_richtung                                0
kenngr.beweg_richt                                  0
kenngr.ref_ohne_rev                                 0
.........................................
kenngr.antr_typ                                     5
kenngr.abs_pos_gueltig                              0
#
getriebe[0].nummer                                  1
.........................................
getriebe[0].lslope_profil.a_grenz_stufe_1           10000
getriebe[0].lslope_profil.a_grenz_stufe_2           10000
getriebe[0].lslope_profil.vb_grenz_stufe_1_2        600000
.........................................
getriebe[0].vb_refmax                               100000
getriebe[0].vb_reflow                               20000
.........................................
getriebe[0].pos_refpkt                              -2025000
.........................................
lr_hw[0].nummer                                     1
.........................................
lr_hw[0].cam_direct_access                          0
End
this is not read any more
"""


def errors(parsed: ParsedList) -> list[Finding]:
    return [finding for finding in parsed.findings if finding.severity is Severity.ERROR]


def test_what_stands_behind_the_end_is_named() -> None:
    """The control reads no further; a parameter that was lost there without a word would be hard to find."""
    text = "kopf.achs_nr 1\nEnd\n\n# a remark\nkopf.achs_nr 2\n  kenngr.messachse 1\nnonsense\n"
    parsed = parse_axis_list(text, "axis.lis")
    assert parsed.values == {"kopf.achs_nr": 1}
    (found,) = parsed.findings
    assert (found.severity, found.line, found.column) == (Severity.WARNING, 5, 1)
    assert (
        found.message == "kopf.achs_nr: stands behind `End` of line 2 and does not count, nor do 2 more lines"
    )
    assert parse_axis_list("kopf.achs_nr 1\nEnde\n# a remark\n....\n", "axis.lis").findings == []


def axis(text: str) -> AxisParams:
    parsed = parse_axis_list(text, "axis.lis")
    assert errors(parsed) == []
    return build(AxisParams, parsed.values)


@pytest.mark.req("M-039")
def test_measuring_entries_of_the_manual() -> None:
    kenngr = axis(
        "kenngr.messachse 1\nkenngr.hub_messtaster 100000\nkenngr.vb_messen 10000\nkenngr.probing_offset 0\n"
        "kenngr.measure.signal PLC\nkenngr.measure.input 1\nkenngr.measure.edge POS\n"
    ).kenngr
    assert (kenngr.messachse, kenngr.hub_messtaster, kenngr.vb_messen) == (True, 100_000, 10_000)
    assert kenngr.measure.signal is ProbingSignal.PLC
    assert (kenngr.measure.input, kenngr.measure.edge) == (1, Edge.POS)


@pytest.mark.req("H-173", "H-174", "H-175")
def test_conventional_example() -> None:
    params = axis(CONVENTIONAL_EXAMPLE)
    kenngr, gear = params.kenngr, params.getriebe[0]
    assert (kenngr.ref_richt, kenngr.homing_without_zero_pulse, kenngr.fast_from_cam) == (False, False, True)
    assert (kenngr.ref_ohne_nocken, kenngr.ref_ohne_rev, kenngr.abs_pos_gueltig) == (False, False, False)
    assert (kenngr.antr_typ, kenngr.achs_typ, kenngr.achs_mode) == (
        DriveType.LIGHTBUS,
        AxisType.TRANSLATOR,
        AxisMode.LINEAR,
    )
    assert (gear.lslope_profil.a_grenz_stufe_1, gear.lslope_profil.a_grenz_stufe_2) == (10_000, 10_000)
    assert gear.lslope_profil.vb_grenz_stufe_1_2 == 600_000
    assert (gear.vb_refmax, gear.vb_reflow, gear.pos_refpkt) == (100_000, 20_000, -2_025_000)
    assert params.lr_hw[0].cam_direct_access is False
    assert params.kopf.log_achs_name == "X_axis"


@pytest.mark.req("H-203")
def test_old_spelling_of_the_simulation_path() -> None:
    assert axis("antr_simu.rpf_weg_bis_nip 200").antr.simu.rpf_weg_bis_nip == 200


@pytest.mark.req("H-178")
def test_sercos_homing_example() -> None:
    antr = axis(
        "kenngr.homing_type CNC_CONTROLLED\nkenngr.homing_without_zero_pulse 0\n"
        "antr.sercos.drive_supports_cnc_homing 1\nantr.cnc_homing_encoder 1\n"
        "antr.sercos.cnc_homing_rt_bit_layout 16\n"
    ).antr
    assert antr.sercos.drive_supports_cnc_homing
    assert (antr.cnc_homing_encoder, antr.sercos.cnc_homing_rt_bit_layout) == (1, 16)


@pytest.mark.req("H-136", "H-135")
def test_reference_monitoring_in_both_spellings() -> None:
    parsed = axis(
        "antr.sercos.at[1].ident_nr 36846\nantr.sercos.at[1].ident_len 2\nantr.sercos.at[1].nc_ref P-0-4078\n"
        "antr.homing_check.element_name P-0-4078\nantr.homing_check.bit_nr 2\n"
    ).antr
    assert (parsed.reference_check.element_name, parsed.reference_check.bit_nr) == ("P-0-4078", 2)
    assert (parsed.sercos.at[1].ident_nr, parsed.sercos.at[1].ident_len) == (36846, 2)
    assert parsed.sercos.at[1].nc_ref == "P-0-4078"
    assert axis("antr.reference_check.bit_nr 6").antr.reference_check.bit_nr == 6


@pytest.mark.req("H-085", "H-111", "H-112", "H-113")
def test_fixed_stop_homing_example() -> None:
    params = axis(
        "kenngr.homing_type TORQ\nkenngr.homing.torq_homing_position 100000\n"
        "kenngr.homing.torq_homing_dir POSITIVE\nkenngr.homing.torq_retraction_distance 50000\n"
        "kenngr.homing.torq_max_distance 200000\nkenngr.homing.torq_min_distance 0\n"
        "kenngr.homing.torq_detect_time 25000\nkenngr.homing.torq_detect_pos_lag_limit 2000\n"
        "kenngr.homing.torq_detect_velocity_limit 300\nkenngr.homing.torq_detect_torque_limit 600\n"
        "getriebe[0].homing.torq_move_acceleration 50\ngetriebe[0].vb_not_referenced 2000\n"
    )
    homing = params.kenngr.homing
    assert homing.homing_type is HomingType.TORQ
    assert (homing.torq_homing_position, homing.torq_homing_dir) == (100_000, "POSITIVE")
    assert (homing.torq_retraction_distance, homing.torq_max_distance) == (50_000, 200_000)
    assert (homing.torq_detect_time, homing.torq_detect_pos_lag_limit) == (25_000, 2_000)
    assert (homing.torq_detect_velocity_limit, homing.torq_detect_torque_limit) == (300, 600)
    assert (params.getriebe[0].homing.torq_move_acceleration, params.getriebe[0].vb_not_referenced) == (
        50,
        2000,
    )


@pytest.mark.req("M-165", "M-166")
def test_drive_function_examples() -> None:
    functions = axis(
        "antr.function[0].id MON_WINDOW\nantr.function[0].wr_ident[0] 6065_00\nantr.function[0].commu ACYCLIC\n"
        "antr.function[0].data_type UNS32\nantr.function[0].mask NOT_USED\n"
        "antr.function[0].scaling_type UNSCALED\nantr.function[0].scaling_factor 1.0\n"
        "antr.function[0].min_limit 0.0\nantr.function[0].max_limit 4294967295\n"
        "antr.function[1].id TORQUE_LIMIT\nantr.function[1].wr_ident[0] 6072_00\n"
        "antr.function[1].commu ACYCLIC\nantr.function[1].data_type UNS16\nantr.function[1].mask NOT_USED\n"
        "antr.function[1].scaling_type LINEAR\nantr.function[1].scaling_factor 10.0\n"
    ).antr.function
    assert [function.id for function in functions] == ["MON_WINDOW", "TORQUE_LIMIT"]
    assert [function.wr_ident for function in functions] == [("6065_00", ""), ("6072_00", "")]
    assert [function.data_type for function in functions] == ["UNS32", "UNS16"]
    assert [function.scaling_factor for function in functions] == [1.0, 10.0]
    assert (functions[0].min_limit, functions[0].max_limit) == (0.0, 4_294_967_295.0)


@pytest.mark.req("H-209")
def test_misprinted_homing_type() -> None:
    assert axis("kenngr.homing_type DRIVE_CONROLLED").kenngr.homing.homing_type is HomingType.DRIVE_CONTROLLED


@pytest.mark.req("M-199", "M-200", "M-201", "M-202", "M-203", "M-204", "M-205")
@pytest.mark.parametrize("signal", [signal for signal in ProbingSignal if signal])
def test_every_printed_signal_is_accepted(signal: str) -> None:
    assert axis(f"kenngr.measure.signal {signal}").kenngr.measure.signal == signal


def test_all_findings_are_collected_with_their_lines() -> None:
    parsed = parse_axis_list(
        "kenngr.measure.signa PLC\n"
        "  kenngr.measure.input 300 # too large\n"
        "kenngr.measure.edge\n"
        "kenngr.measure.signal plc\n"
        "kenngr.messachse 2\n"
        "kenngr.vb_messen 10\n"
        "kenngr.vb_messen 20\n"
        "getriebe[9].vb_reflow 1\n"
        "antr.function[0].scaling_factor 0\n"
        "kenngr.vb_messen 1.5 mm\n",
        "z.lis",
    )
    signals = ", ".join(["(empty)", *filter(None, ProbingSignal)])
    assert [str(finding) for finding in errors(parsed)] == [
        "z.lis:1:1: kenngr.measure.signa: unknown parameter (did you mean kenngr.measure.signal?)",
        "z.lis:2:3: kenngr.measure.input: 300 is out of range 0..255 (P-AXIS-00517)",
        "z.lis:3:1: kenngr.measure.edge: the value is missing",
        f"z.lis:4:1: kenngr.measure.signal: 'plc' is not valid, expected {signals} (P-AXIS-00516)",
        "z.lis:5:1: kenngr.messachse: '2' is not valid, expected BOOLEAN (P-AXIS-00118)",
        "z.lis:7:1: kenngr.vb_messen: given twice, lines 6 and 7",
        "z.lis:8:1: getriebe[9].vb_reflow: index 9 is out of range 0..3",
        "z.lis:9:1: antr.function[0].scaling_factor: 0 is out of range (any number but 0)",
        "z.lis:10:1: kenngr.vb_messen: given twice, lines 6 and 10",
    ]
    assert parsed.values == {"kenngr.vb_messen": 10}


def test_alias_and_path_are_the_same_parameter() -> None:
    parsed = parse_axis_list("kenngr.homing_type DISABLED\nkenngr.homing.homing_type TORQ\n")
    assert [finding.message for finding in errors(parsed)] == [
        "kenngr.homing.homing_type: given twice, lines 1 and 2"
    ]


def test_hint_by_last_word() -> None:
    parsed = parse_axis_list("axis.vb_refmax 1")
    assert "did you mean getriebe[0].vb_refmax?" in errors(parsed)[0].message


@pytest.mark.req("H-160")
def test_speeds_against_one_another() -> None:
    parsed = parse_axis_list("getriebe[0].vb_reflow 300\ngetriebe[0].vb_refmax 200\n", "x.lis")
    assert [str(finding) for finding in errors(parsed)] == [
        "x.lis:1: getriebe[0].vb_reflow: 300 is above getriebe[0].vb_refmax = 200 (P-AXIS-00219)",
        "x.lis:2: getriebe[0].vb_refmax: 200 is below getriebe[0].vb_reflow = 300 (P-AXIS-00218)",
    ]


def test_bound_at_its_default_is_a_warning() -> None:
    parsed = parse_axis_list("kenngr.vb_messen 200001", "x.lis")
    assert errors(parsed) == []
    message = parsed.findings[0].message
    assert message.endswith("is above getriebe[0].dynamik.vb_max = 200000, its default (P-AXIS-00212)")


@pytest.mark.req("H-183", "H-184", "H-187")
@pytest.mark.parametrize(
    ("text", "valid"),
    [
        ("1", True),
        ("0x4", True),
        ("0x20001", True),
        ("0x404", True),
        ("0x5", False),
        ("0x40", False),
        ("0x2", False),
        ("0x3", False),
        ("0x11", False),
        ("0x20000001", False),
        ("0", False),
    ],
)
def test_axis_mode(text: str, *, valid: bool) -> None:
    parsed = parse_axis_list(f"kenngr.achs_mode {text}")
    assert (errors(parsed) == []) is valid


def test_modulo_linear_without_modulo_warns() -> None:
    findings = parse_axis_list("kenngr.achs_mode 0x401").findings
    assert [finding.severity for finding in findings] == [Severity.WARNING]


@pytest.mark.req("H-200")
def test_homing_without_cam_needs_one_phase() -> None:
    assert "needs kenngr.ref_ohne_rev 1" in parse_axis_list("kenngr.ref_ohne_nocken 1").findings[0].message
    assert parse_axis_list("kenngr.ref_ohne_nocken 1\nkenngr.ref_ohne_rev 1").findings == []


def test_accepted_parameter_is_noted() -> None:
    parsed = parse_axis_list(
        "kenngr.max_vb_override 1\ngetriebe[0].vb_refmax 90000\ngetriebe[1].vb_refmax 90000"
    )
    assert [finding.severity for finding in parsed.findings] == [Severity.NOTE, Severity.NOTE]
    assert [finding.message.split(":")[0] for finding in parsed.findings] == [
        "kenngr.max_vb_override",
        "getriebe[1].vb_refmax",
    ]


@pytest.mark.req("M-227")
def test_start_share_above_block_length_is_kept_with_a_warning() -> None:
    parsed = parse_axis_list("kenngr.measure.fixed_stop_detect.start_distance_per_mille 1200")
    assert list(parsed.values.values()) == [1200]
    assert [finding.severity for finding in parsed.findings] == [Severity.WARNING]


def test_values_of_every_kind() -> None:
    params = axis(
        "kenngr.messachse TRUE\nkenngr.achs_typ ACHSTYP_ROTATOR\nkenngr.antr_typ 0x0008\n"
        'antr.function[0].id "TORQUE LIMIT"\nantr.function[0].max_limit 1.0e+199 (off)\n'
        "getriebe[1].vb_reflow\t5\nkenngr.swe_neg -5 # remark\n"
    )
    assert params.kenngr.messachse is True
    assert params.kenngr.achs_typ is AxisType.ROTATOR
    assert params.kenngr.antr_typ is DriveType.CANOPEN
    assert (params.antr.function[0].id, params.antr.function[0].max_limit) == ("TORQUE LIMIT", 1.0e199)
    assert (params.getriebe[1].vb_reflow, params.getriebe[0].vb_reflow) == (5, 16666)
    assert params.kenngr.swe_neg == -5


@pytest.mark.req("M-186", "M-187")
def test_old_parameters_are_accepted() -> None:
    kenngr = axis(
        "kenngr.fixed_stop_pos_lag_limit 500\nkenngr.fixed_stop_nbr_cycles 4\nkenngr.mess_neg_flanke 1\n"
        "kenngr.mess_signal_achs_steuer 1\nkenngr.mess_signal_sercos 0\nkenngr.mess_signal_taster 0\n"
        "kenngr.probing_signal_via_plc 1\nkenngr.meas_signal_fixed_stop 0\n"
    ).kenngr
    assert (kenngr.fixed_stop_pos_lag_limit, kenngr.fixed_stop_nbr_cycles) == (500, 4)
    assert (kenngr.mess_neg_flanke, kenngr.mess_signal_achs_steuer) == (True, True)
    assert (kenngr.probing_signal_via_plc, kenngr.meas_signal_fixed_stop) == (True, False)


@pytest.mark.req("H-114", "H-115", "H-117")
def test_drive_objects_of_the_fixed_stop_homing_example() -> None:
    here = "antr.fixed_stop.drive_ident"
    idents = axis(
        f"{here}[0].id TORQUE_LIMIT\n{here}[0].commu ACYCLIC\n{here}[0].wr_ident S_0_0092\n"
        f"{here}[0].data_type UNS16\n{here}[0].startup_value 1000\n{here}[0].scaling_type UNSCALED\n"
        f"{here}[0].max_limit 1000\n{here}[0].min_limit 0\n{here}[0].mask NOT_USED\n"
        f"{here}[0].scaling_factor 1\n{here}[0].active_value 50\n{here}[0].use_startup_value 0\n"
        f"{here}[0].default_ident 0\n"
        f"{here}[1].id MON_WINDOW\n{here}[1].commu ACYCLIC\n{here}[1].wr_ident S-0-0159\n"
        f"{here}[1].data_type UNS32\n{here}[1].startup_value 7000\n{here}[1].scaling_type UNSCALED\n"
        f"{here}[1].max_limit 429496729\n{here}[1].min_limit 0\n{here}[1].active_value 429496728\n"
        f"{here}[1].use_startup_value 0\n{here}[1].default_ident 0\nkenngr.antr_typ 2\n"
    ).antr.fixed_stop.drive_ident
    assert [ident.id for ident in idents] == ["TORQUE_LIMIT", "MON_WINDOW"]
    assert [ident.wr_ident for ident in idents] == ["S_0_0092", "S-0-0159"]
    assert [ident.active_value for ident in idents] == [50.0, 429496728.0]
    assert [ident.startup_value for ident in idents] == [1000.0, 7000.0]


@pytest.mark.req("F-085", "F-091")
def test_limits_of_drive_objects() -> None:
    here = "antr.fixed_stop.drive_ident"
    assert errors(parse_axis_list(f"{here}[3].wr_ident {'x' * 29}")) == []
    assert errors(parse_axis_list(f"{here}[3].wr_ident {'x' * 30}")) != []
    assert errors(parse_axis_list(f"{here}[4].wr_ident x")) != []


@pytest.mark.req("M-208", "M-209", "M-210")
@pytest.mark.parametrize(
    ("signal", "drive_type", "number", "fits"),
    [
        ("PLC_EXT_LATCH_CONTROL", 8, 255, True),
        ("DRIVE", 8, 2, True),
        ("DRIVE", 8, 3, False),
        ("DRIVE", 2, 2, True),
        ("DRIVE", 3, 3, False),
        ("DRIVE", 5, 1, True),
        ("DRIVE", 5, 2, False),
        ("DRIVE", 1, 2, False),
        ("PLC", 5, 9, True),
    ],
)
def test_probing_input_by_source_and_drive_type(
    signal: str, drive_type: int, number: int, *, fits: bool
) -> None:
    parsed = parse_axis_list(
        f"kenngr.measure.signal {signal}\nkenngr.antr_typ {drive_type}\nkenngr.measure.input {number}\n"
    )
    found = [finding.severity for finding in parsed.findings if "P-AXIS-00517" in finding.message]
    assert found == ([] if fits else [Severity.WARNING])


def test_channel_list() -> None:
    parsed = parse_channel_list("messtyp 7\nmeas_fixed_stop_no_error 1\nprog_start.slope.profile 0\n")
    assert parsed.findings == []
    assert parsed.values == {"messtyp": 7, "meas_fixed_stop_no_error": True, "prog_start.slope.profile": 0}


@given(st.text())
def test_no_text_raises(text: str) -> None:
    parsed = parse_axis_list(text)
    build(AxisParams, parsed.values)


@given(st.integers(-(2**33), 2**33))
def test_whole_numbers_stay_in_their_type(number: int) -> None:
    parsed = parse_axis_list(f"getriebe[0].pos_refpkt {number}")
    assert (errors(parsed) == []) is (-(2**31) <= number <= 2**31 - 1)
    if not errors(parsed):
        assert value_at(build(AxisParams, parsed.values), "getriebe[0].pos_refpkt") == number
