"""Every terminal type of the folder: models, image size, entries, an edge at a cycle border."""

import struct
from typing import Any

import numpy as np
import pytest

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.base.time import Ns
from hli_bench.laws.channels import channel_edge, channel_image
from hli_bench.laws.rows import MachineRows
from hli_bench.terminals.settings import SINGLE_EVENT, TerminalSettings
from hli_bench.terminals.terminal import Terminal, type_of, types
from hli_bench.wire.images import STRUCT_CODE, size_of

EPOCH_NS = 820_540_800_000_000_000
CYCLE_NS = 1_000_000
MODELS = sorted(types())


def _settings(model: str, **given: Any) -> TerminalSettings:
    return TerminalSettings(**{"name": "t", "model": model, "period_us": 1000, **given})


def _rows(settings: TerminalSettings) -> np.ndarray:
    channels = type_of(settings).channels(settings)
    rows = MachineRows.allocate(1, 0, 1, len(channels)).channel
    for row, channel in zip(rows, channels, strict=True):
        row["delay_ns"] = channel.delay_ns
        row["single_event"] = channel.single_event
    return rows


def _entries(terminal: Terminal, data: bytes) -> dict[str, int]:
    return {
        name: struct.unpack_from("<" + STRUCT_CODE[kind], data, offset)[0]
        for name, kind, offset in terminal.layout.entries
    }


def _refresh(rows: np.ndarray, now_ns: int) -> None:
    for number in range(len(rows)):
        channel_image(rows[number], now_ns, EPOCH_NS)


def test_the_models_of_the_folder() -> None:
    assert MODELS == ["EL1008", "EL1018", "EL1252"]


@pytest.mark.parametrize("model", MODELS)
def test_layout_has_no_gap_and_fits_the_image(model: str) -> None:
    settings = _settings(model)
    layout = type_of(settings).layout(settings)
    end = 0
    for _, kind, offset in sorted(layout.entries, key=lambda entry: entry[2]):
        assert offset == end
        end = offset + size_of(kind)
    assert layout.size == end == len(type_of(settings).image(_rows(settings)))


@pytest.mark.parametrize("model", MODELS)
def test_an_edge_at_a_cycle_border_shows_when_its_delay_is_over(model: str) -> None:
    settings = _settings(model)
    rows = _rows(settings)
    terminal = Terminal(settings, rows, 0, CYCLE_NS)
    delay = int(rows[1]["delay_ns"])
    due = -(-delay // CYCLE_NS) * CYCLE_NS
    channel_edge(rows[1], 1, CYCLE_NS, EPOCH_NS)
    for now in range(CYCLE_NS, 6 * CYCLE_NS, CYCLE_NS):
        _refresh(rows, now)
        values = _entries(terminal, terminal.step(Ns(now)).data)
        assert values["ch2/input"] == (now >= CYCLE_NS + due)
        assert values["ch1/input"] == 0


@pytest.mark.parametrize("model", MODELS)
def test_a_channel_that_is_not_there(model: str) -> None:
    settings = _settings(model, wiring={"ch9": "probe"})
    with pytest.raises(InputError, match=rf"terminal\.t\.wiring\.ch9: {model} has ch1\.\.ch"):
        type_of(settings).channels(settings)


def test_an_unknown_model() -> None:
    with pytest.raises(
        InputError, match=r"terminal\.t\.model: 'EL9999' is not one of EL1008, EL1018, EL1252"
    ):
        type_of(_settings("EL9999"))


def test_el1252_image_byte_for_byte() -> None:
    settings = _settings("EL1252")
    rows = _rows(settings)
    terminal = Terminal(settings, rows, 0, CYCLE_NS)
    channel_edge(rows[1], 1, 200_000, EPOCH_NS)
    channel_edge(rows[1], 0, 700_000, EPOCH_NS)
    channel_edge(rows[0], 1, 900_000, EPOCH_NS)
    _refresh(rows, CYCLE_NS)
    image = terminal.step(Ns(CYCLE_NS))
    latches = (EPOCH_NS + 900_000, 0, EPOCH_NS + 200_000, EPOCH_NS + 700_000)
    assert image.data == bytes([1, 0, 0, 0]) + struct.pack("<4Q", *latches)
    assert len(image.data) == 36


def test_the_image_is_refreshed_only_every_period() -> None:
    settings = _settings("EL1252", period_us=4000)
    rows = _rows(settings)
    terminal = Terminal(settings, rows, 0, CYCLE_NS)
    channel_edge(rows[0], 1, 1_500_000, EPOCH_NS)
    seen = []
    for now in range(CYCLE_NS, 6 * CYCLE_NS, CYCLE_NS):
        _refresh(rows, now)
        seen.append(terminal.step(Ns(now)).data[0])
    assert seen == [0, 0, 0, 1, 1]
    assert terminal.due_ns == 8_000_000


def test_single_event_reads_once_a_cycle_or_not_at_all() -> None:
    settings = _settings("EL1252", period_us=4000, mode=SINGLE_EVENT)
    with pytest.raises(NotEmulated, match="single_event"):
        Terminal(settings, _rows(settings), 0, CYCLE_NS)


def test_a_delay_of_the_settings_replaces_that_of_the_model() -> None:
    assert type_of(_settings("EL1008")).channels(_settings("EL1008"))[0].delay_ns == 3_000_000
    assert type_of(_settings("EL1018")).channels(_settings("EL1018"))[0].delay_ns == 10_000
    given = _settings("EL1018", delay_ns=5)
    assert type_of(given).channels(given)[0].delay_ns == 5
