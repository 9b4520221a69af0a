"""Parameters that lists may hold and that change nothing: the bench says so, and its sheets say the same."""

import pytest

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import catalogue
from hli_bench.manual.lists import Severity, parse_axis_list
from hli_bench.manual.sheet import Effect

IDENT = "antr.fixed_stop.drive_ident[0]."
DETECT = "antr.fixed_stop.detect."
TORQ = "kenngr.homing.torq_"

# entry of a list, requirement lines that nothing but the entry shows
ACCEPTED = [
    ("kenngr.echtzeit_bit_nr 1", pytest.mark.req("M-221", by="accepted")),
    ("antr.simu.rpf_weg_bis_nip 200", pytest.mark.req("H-203", by="accepted")),
    ("antr.sercos.cnc_homing_rt_bit_layout 16", pytest.mark.req("H-221", by="accepted")),
    ("antr.cnc_homing_encoder 1", pytest.mark.req("H-225", by="accepted")),
    ("getriebe[0].slope_type 1", pytest.mark.req("H-084", by="accepted")),
    ("getriebe[0].homing.torq_move_velocity 9", pytest.mark.req("H-086", "H-125", by="accepted")),
    ("getriebe[0].homing.torq_move_acceleration 50", pytest.mark.req("H-087", "H-125", by="accepted")),
    ("getriebe[0].homing.torq_move_torque_limit 9", pytest.mark.req("H-126", by="accepted")),
    ("getriebe[0].homing.torq_detect_torque_limit 9", pytest.mark.req("H-126", by="accepted")),
    (f"{TORQ}min_distance 9", pytest.mark.req("H-088", by="accepted")),
    (f"{TORQ}max_distance 200000", pytest.mark.req("H-089", "H-120", by="accepted")),
    (f"{TORQ}homing_dir POSITIVE", pytest.mark.req("H-090", "H-121", by="accepted")),
    (f"{TORQ}detect_velocity_limit 300", pytest.mark.req("H-091", "H-122", by="accepted")),
    (f"{TORQ}retraction_distance 50000", pytest.mark.req("H-092", "H-123", by="accepted")),
    (f"{TORQ}homing_position 100000", pytest.mark.req("H-093", "H-123", by="accepted")),
    (f"{TORQ}detect_time 25000", pytest.mark.req("H-094", "H-124", by="accepted")),
    (f"{TORQ}detect_pos_lag_limit 2000", pytest.mark.req("H-095", by="accepted")),
    (f"{TORQ}detect_torque_limit 600", pytest.mark.req("H-096", by="accepted")),
    (f"{DETECT}detect_velocity_limit 300", pytest.mark.req("H-099", by="accepted")),
    (f"{DETECT}detect_torque_limit 300", pytest.mark.req("H-100", by="accepted")),
    ("antr.fixed_stop.pos_lag_limit 5", pytest.mark.req("F-076", by="accepted")),
    ("antr.fixed_stop.window 5", pytest.mark.req("F-077", "F-117", by="accepted")),
    ("antr.fixed_stop.nbr_cycles 5", pytest.mark.req("F-118", by="accepted")),
    ("antr.fixed_stop.max_torque 5.0", pytest.mark.req("F-121", by="accepted")),
    ("antr.fixed_stop.error_missing_drive_releases NONE", pytest.mark.req("F-114", by="accepted")),
    (
        f"{IDENT}id TORQUE_LIMIT",
        pytest.mark.req("F-068", "F-070", "F-071", "F-072", "F-073", "H-114", "H-115", by="accepted"),
    ),
    (f"{IDENT}wr_ident S_0_0092", pytest.mark.req("F-085", "F-091", "H-117", by="accepted")),
    (f"{IDENT}commu CYCLIC", pytest.mark.req("F-087", by="accepted")),
    (f"{IDENT}data_type UNS32", pytest.mark.req("F-092", by="accepted")),
    (f"{IDENT}scaling_type LINEAR", pytest.mark.req("F-094", by="accepted")),
    (f"{IDENT}active_value 50", pytest.mark.req("F-120", by="accepted")),
    (f"{IDENT}default_ident 0", pytest.mark.req("F-110", "H-103", by="accepted")),
]


@pytest.mark.parametrize("text", [pytest.param(*row[:1], id=row[0], marks=row[1]) for row in ACCEPTED])
def test_an_entry_that_changes_nothing_is_said_to(text: str) -> None:
    path = text.split()[0]
    parsed = parse_axis_list(text, "x.lis")
    notes = [str(one) for one in parsed.findings if one.severity is Severity.NOTE]
    entry = catalogue(AxisParams).locate(path).entry

    assert not [one for one in parsed.findings if one.severity is Severity.ERROR]
    assert entry.sheet.effect is Effect.ACCEPTED, (
        "it is emulated or refused now: the lines are shown elsewhere"
    )
    assert len(notes) == 1
    assert f"{path}: accepted, changes nothing in this bench" in notes[0]
    assert entry.sheet.number in notes[0]
