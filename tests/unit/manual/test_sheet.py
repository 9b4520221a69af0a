import subprocess
import sys

import pytest

from hli_bench.manual.axis import AxisParams
from hli_bench.manual.catalogue import Catalogue, catalogue, convert
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.sheet import LIMITS, Effect, Entry

TREES = (AxisParams, ChannelParams)
ALL = [pytest.param(tree, entry, id=entry.path) for tree in TREES for entry in catalogue(tree).entries]


@pytest.mark.parametrize("tree", TREES)
def test_numbers_and_paths_are_unique(tree: type) -> None:
    known = Catalogue(tree)
    numbers = [entry.sheet.number for entry in known.entries if entry.sheet.number]
    assert len(numbers) == len(set(numbers)) == len(known.by_number)
    aliases = [alias for entry in known.entries for alias in entry.sheet.aliases]
    assert len(known.by_pattern) == len(known.entries) + len(aliases)


@pytest.mark.parametrize(("tree", "entry"), ALL)
def test_default_is_valid(tree: type, entry: Entry) -> None:
    path = entry.path.replace("[i]", "[0]").replace("[j]", "[0]")
    text = entry.default if isinstance(entry.default, str) else str(entry.default + 0)
    assert convert(entry, path, text) == entry.default
    assert isinstance(convert(entry, path, text), entry.python_type)


@pytest.mark.parametrize(("tree", "entry"), ALL)
def test_columns_are_filled(tree: type, entry: Entry) -> None:
    sheet = entry.sheet
    assert sheet.doc.endswith(".")
    assert sheet.source
    assert set(sheet.axis_types) <= set("TRS")
    known = catalogue(tree).by_number
    for bound in (sheet.low, sheet.high):
        assert not isinstance(bound, str) or bound.rpartition("*")[2] in known
        if isinstance(bound, int):
            low, high = LIMITS.get(sheet.data_type, (bound, bound))
            assert low <= bound <= high
    for other in (*sheet.replaces, *filter(None, [sheet.replaced_by])):
        assert other in known
    if sheet.not_emulated:
        assert sheet.effect is Effect.EMULATED


@pytest.mark.parametrize(("tree", "entry"), ALL)
def test_printed_range(tree: type, entry: Entry) -> None:
    text = entry.sheet.range_text()
    assert text
    assert "<" not in text


def test_nesting_is_the_path() -> None:
    axis = AxisParams()
    assert axis.kenngr.measure.fixed_stop_detect.pos_lag_limit == -1
    assert axis.getriebe[0].lslope_profil.a_feedh == 0
    assert catalogue(AxisParams).by_number["P-AXIS-00398"].path == "antr.function[i].wr_ident[j]"
    assert catalogue(AxisParams).by_number["P-AXIS-00398"].sizes == (20, 2)


def test_find_takes_numbers_and_paths() -> None:
    known = catalogue(AxisParams)
    entry = known.by_number["P-AXIS-00219"]
    for text in ("P-AXIS-00219", "p-axis-00219", "getriebe[0].vb_refmax", "getriebe[i].vb_refmax"):
        assert known.find(text) is entry
    assert known.find("kenngr.homing_type") is known.by_number["P-AXIS-00299"]
    assert known.find("nothing") is None


def test_import_needs_no_numerics() -> None:
    code = (
        "import sys, hli_bench.manual.lists as _; print([n for n in ('numpy', 'numba') if n in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"
