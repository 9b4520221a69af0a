"""Drives whose EDS lacks what is optional: they move, and what they lack is refused before or where it is asked for."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file

GONE = (0x1401, 0x1601, 0x1801, 0x1802, 0x1803, 0x1A01, 0x1A02, 0x1A03, *range(0x60B8, 0x60BE), 0x60D0)
MODEL = """
from pathlib import Path
from types import SimpleNamespace
from hli_bench_drives.cia402 import drive
EDS = Path(__file__).with_suffix(".eds")
MODEL = SimpleNamespace(name="small", eds=str(EDS))
def create(name, node_id, row, options):
    return drive.create(name, node_id, EDS, row, options)
"""


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Return a maker of a drive model without some objects: settings that give it to Z."""

    def make(*gone: int) -> dict[str, object]:
        name = f"small_{len(gone)}"
        text = data_file("eds", "servo402.eds").read_text()
        for index in gone:
            text = text.replace(f"[{index:04X}", f"[Gone{index:04X}")
        (tmp_path / f"{name}.py").write_text(MODEL)
        (tmp_path / f"{name}.eds").write_text(text)
        return {"axis.Z.drive": name}

    monkeypatch.syspath_prepend(str(tmp_path))
    yield make
    for name in [name for name in sys.modules if name.startswith("small_")]:
        del sys.modules[name]


def test_a_drive_without_touch_probe_and_torque_moves(small: Any) -> None:
    with Bench("demo", small(*GONE, 0x6072, 0x6077, 0x60F4)) as bench:
        result = bench.run("N10 G01 G90 Z290 F6000\nN20 M30")
        assert result.status == "completed"
        bench.advance(200)
        assert bench.position_mm("Z") == pytest.approx(290.0, abs=1e-3)
        refused = bench.run("N10 #MEAS [AX=Z SIGNAL=DRIVE]\nN20 M30")
        assert [(error.id, error.axis, error.block) for error in refused.errors] == [(70293, "Z", "N10")]


def test_the_source_drive_is_refused_before_the_run(small: Any) -> None:
    settings = {**small(*GONE), "axis.Z.kenngr.measure.signal": "DRIVE"}
    with pytest.raises(InputError, match=r"axis\.Z\.kenngr\.measure\.signal: DRIVE is not possible"):
        Bench("demo", settings)


def test_a_drive_that_does_not_tell_where_it_is_cannot_be_an_axis(small: Any) -> None:
    with pytest.raises(InputError, match=r"axis\.Z\.drive: .*first telegram"):
        Bench("demo", small(0x1A00))
