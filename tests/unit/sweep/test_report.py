import re
from html.parser import HTMLParser

import pytest

from hli_bench.sweep.campaign import read
from hli_bench.sweep.report import divider, groups, report_html
from hli_bench.sweep.store import Store
from hli_bench.sweep.work import Row

TEXT = """\
program = "p.nc"
repeats = 30
[grid]
"plant.probe.bounce_us" = [1000, 2000]
"axis.Z.kenngr.measure.signal" = ["PLC", "DRIVE"]
[random]
"plant.probe.pretravel_um" = { uniform = [0, 80] }
[metrics]
error_um = "measurements.0.acs_mm"
"""


@pytest.fixture
def campaign(tmp_path):
    (tmp_path / "p.nc").write_text("N20 M30\n")
    (tmp_path / "c.toml").write_text(TEXT)
    return read(tmp_path / "c.toml")


@pytest.fixture
def table(campaign, tmp_path):
    with Store(tmp_path / "out", campaign) as store:
        rows = [Row(run, (run * 1.0,), "completed", "", 7) for run in range(119)]
        store.add([*rows, Row(119, (None,), "error", "P-ERR-1 <b>", 3)])
        return store.finish()


class Checker(HTMLParser):
    """Follows which tags are open."""

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attrs):
        if tag not in {"meta", "path", "br"}:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag != "path":
            assert self.open.pop() == tag


def test_the_page_is_whole_and_needs_nothing_else(campaign, table):
    page = report_html(campaign, table)
    checker = Checker()
    checker.feed(page)
    assert checker.open == []
    assert not re.search(r"https?://|<script|src=|href=", page)
    assert "P-ERR-1 &lt;b&gt;" in page
    assert "axis.Z.kenngr.measure.signal = DRIVE" in page


def test_the_first_grid_key_with_texts_divides(campaign):
    assert divider(campaign) == "axis.Z.kenngr.measure.signal"


def test_a_random_number_is_shown_in_ranges_that_hold_every_run(campaign, table):
    columns = {name: table.column(name).to_numpy(zero_copy_only=False) for name in table.column_names}
    found = groups(campaign, columns, "plant.probe.pretravel_um")
    assert len(found) == 8
    assert sum(group.rows.sum() for group in found) == 120
