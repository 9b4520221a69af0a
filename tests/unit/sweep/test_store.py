import os

import pyarrow.parquet as pq
import pytest

from hli_bench.base.errors import InputError
from hli_bench.sweep.campaign import read
from hli_bench.sweep.store import Store
from hli_bench.sweep.work import Row

TEXT = """\
program = "p.nc"
repeats = 4
[grid]
"plant.probe.bounce_us" = [1000, 2000]
[metrics]
time_s = "sim_s"
"""


@pytest.fixture
def campaign(tmp_path):
    (tmp_path / "p.nc").write_text("N20 M30\n")
    (tmp_path / "c.toml").write_text(TEXT)
    return read(tmp_path / "c.toml")


def rows(*numbers):
    return [Row(number, (None if number == 2 else number / 8,), "completed", "", 7) for number in numbers]


def test_rows_are_kept_chunk_by_chunk_and_end_in_the_order_of_the_runs(campaign, tmp_path):
    with Store(tmp_path / "out", campaign) as store:
        store.add(rows(7, 6))
        store.add(rows(0, 1, 2, 3))
    with Store(tmp_path / "out", campaign) as store:
        assert store.done() == {0, 1, 2, 3, 6, 7}
        store.add(rows(4, 5))
        store.finish()
    table = pq.read_table(tmp_path / "out" / "runs.parquet")
    assert table.column_names == ["run", "plant.probe.bounce_us", "time_s", "status", "errors", "cycles"]
    assert table.column("run").to_pylist() == list(range(8))
    assert table.column("plant.probe.bounce_us").to_pylist() == [1000] * 4 + [2000] * 4
    assert table.column("time_s").to_pylist()[:4] == [0.0, 0.125, None, 0.375]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "campaign.json",
        "lock",
        "runs.parquet",
    ]


def test_a_half_written_part_does_not_count(campaign, tmp_path):
    with Store(tmp_path / "out", campaign) as store:
        store.add(rows(0, 1))
        (tmp_path / "out" / "parts" / "x.parquet.new").write_bytes(b"PAR1")
    with Store(tmp_path / "out", campaign) as store:
        assert store.done() == {0, 1}
        assert not list((tmp_path / "out" / "parts").glob("*.new"))


def test_killed_between_table_and_the_end_of_the_parts(campaign, tmp_path):
    with Store(tmp_path / "out", campaign) as store:
        store.add(rows(*range(8)))
        part = next((tmp_path / "out" / "parts").iterdir())
        os.link(part, tmp_path / "kept")
        store.finish()
    (tmp_path / "out" / "parts").mkdir()
    os.link(tmp_path / "kept", part)
    with Store(tmp_path / "out", campaign) as store:
        assert store.done() == set(range(8))
        assert store.finish().num_rows == 8


def test_another_campaign_is_refused_and_says_what_differs(campaign, tmp_path):
    with Store(tmp_path / "out", campaign):
        pass
    (tmp_path / "c.toml").write_text(TEXT.replace("2000", "3000"))
    with (
        pytest.raises(InputError, match=r"runs of another campaign \(different: grid\)"),
        Store(tmp_path / "out", read(tmp_path / "c.toml")),
    ):
        pass


def test_one_sweep_at_a_time(campaign, tmp_path):
    with (
        Store(tmp_path / "out", campaign),
        pytest.raises(InputError, match="at work in this folder"),
        Store(tmp_path / "out", campaign),
    ):
        pass
