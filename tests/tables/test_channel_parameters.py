"""Key columns of the channel parameters, typed a second time from the measurement manual."""

from types import SimpleNamespace

import pytest

from hli_bench.manual.catalogue import catalogue, convert
from hli_bench.manual.channel import ChannelParams


@pytest.mark.parametrize(
    ("number", "path", "data_type", "default"),
    [
        pytest.param(57, "messtyp", "UNS16", 1, marks=pytest.mark.req("M-185", "M-188")),
        pytest.param(97, "use_drive_curr_limit", "BOOLEAN", 0, marks=pytest.mark.req("M-185")),
        pytest.param(176, "meas_error_no_signal", "BOOLEAN", 0, marks=pytest.mark.req("M-185")),
        pytest.param(214, "meas_deceleration_mode", "UNS16", 0, marks=pytest.mark.req("M-185")),
        pytest.param(266, "meas_fixed_stop_no_error", "BOOLEAN", 0, marks=pytest.mark.req("M-185")),
        pytest.param(296, "meas_use_std_dynamic", "BOOLEAN", 0, marks=pytest.mark.req("M-185")),
        (311, "meas_pcs_value_no_probe_radius", "BOOLEAN", 0),
        (29, "kasto_multi_block", "BOOLEAN", 0),
        (30, "kasto_residual_path", "SGN32", 0),
        (257, "kasto_prog_meas_trigger", "BOOLEAN", 0),
        (71, "prog_start.slope.profile", "SGN16", 0),
        (56, "max_vb_override", "UNS16", 1000),
        (455, "channel_init_actpos_exclusive", "BOOLEAN", 0),
    ],
)
def test_sheet_matches_manual(
    books: SimpleNamespace, number: int, path: str, data_type: str, default: int
) -> None:
    assert books.differences(f"P-CHAN-{number:05d}") == []
    entry = catalogue(ChannelParams).by_number[f"P-CHAN-{number:05d}"]
    assert (entry.path, entry.sheet.data_type, entry.default) == (path, data_type, default)


@pytest.mark.req("M-188")
def test_measurement_type_range() -> None:
    entry = catalogue(ChannelParams).by_number["P-CHAN-00057"]
    assert [convert(entry, "messtyp", str(kind)) for kind in range(1, 8)] == list(range(1, 8))
    for wrong in ("0", "8"):
        with pytest.raises(Exception, match=r"out of range 1\.\.7"):
            convert(entry, "messtyp", wrong)
