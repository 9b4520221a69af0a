"""Lists, machine folders, settings and campaigns: every text ends in values or in an InputError or NotEmulated."""

from functools import partial
from pathlib import Path

import pytest

from hli_bench.base.errors import InputError
from hli_bench.base.loading import data_file
from hli_bench.bench.folder import load
from hli_bench.bench.sources import parse_set
from hli_bench.manual.lists import parse_axis_list, parse_channel_list
from hli_bench.sweep import campaign
from tests.fuzz.inputs import broken, seeds, tried

DEMO = data_file("machines", "demo")
SETTINGS = (
    "plant.probe.Z.face_mm=100",
    "axis.Z.kenngr.measure.signal=PLC_TIMESTAMP",
    "axis.Z.getriebe[0].vb_refmax=50000",
    "plant.axis.Z.pitch_mm=5.0",
    "plc.0.script=demo.py",
    'terminal.probe.wiring.ch2="probe"',
    "fault.0.kind=probe_stuck",
    "dc_epoch=2030-01-01",
    "cycle_us=1000",
)


@pytest.mark.parametrize("name", ["z.lis", "channel.lis"])
def test_lists(name: str) -> None:
    text = (DEMO / name).read_text(encoding="utf-8")
    parse = parse_channel_list if name == "channel.lis" else parse_axis_list
    for seed in seeds():
        given = broken(text, seed, "getriebe[].x 1", "End", "( remark", "0x10001")
        for lenient in (False, True):
            tried(partial(parse, given, name, lenient=lenient), seed, given)


def test_machine_files(tmp_path: Path) -> None:
    for path in DEMO.glob("*.lis"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    text = (DEMO / "machine.toml").read_text(encoding="utf-8")
    for seed in seeds():
        given = broken(
            text, seed, "[[plc]]", "[axis.X]", "lenient = true\n", "[plant.stop.Z]\nat_mm = 1\n", "1e999"
        )
        (tmp_path / "machine.toml").write_text(given, encoding="utf-8", newline="")
        tried(partial(load, tmp_path), seed, given)


def _set(text: str) -> None:
    load("demo", parse_set([text]))


def test_settings() -> None:
    for seed in seeds():
        given = broken(SETTINGS[seed % len(SETTINGS)], seed)
        tried(partial(_set, given), seed, given)


def test_campaigns(tmp_path: Path) -> None:
    text = data_file("campaigns", "probe_error.toml").read_text(encoding="utf-8")
    (tmp_path / "probe_once.nc").write_bytes(data_file("campaigns", "probe_once.nc").read_bytes())
    path = tmp_path / "campaign.toml"
    for seed in seeds():
        given = broken(
            text, seed, "settings[[]]", "measurements.0.acs", "'" * 3, "uniform = [1, 2]", "(((((("
        )
        path.write_text(given, encoding="utf-8", newline="")
        tried(partial(campaign.read, path), seed, given)


def test_a_machine_file_that_is_no_text_is_told(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="is not UTF-8 text: byte 0xff at offset 0"):
        load(tmp_path)
