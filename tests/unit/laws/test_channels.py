"""Terminal channels: input delay, DC time latches, continuous and single-event mode, the image at a cycle border."""

from typing import Any

import numpy as np

from hli_bench.laws.channels import channel_edge, channel_image
from hli_bench.laws.rows import CHANNEL, MachineRows
from hli_bench.plant.settings import Face
from hli_bench.terminals.settings import Channel

EPOCH_NS = 820_540_800_000_000_000


def _channel(delay_ns: int = 0, single_event: bool = False) -> np.ndarray:
    rows = MachineRows.allocate(1, 0, 1, 1).channel
    rows["signal"] = 0
    rows["delay_ns"] = delay_ns
    rows["single_event"] = single_event
    assert rows.dtype == CHANNEL
    return rows


def _edge(rows: np.ndarray, level: int, at_ns: int) -> None:
    channel_edge(rows[0], level, at_ns, EPOCH_NS)


def _image(rows: np.ndarray, now_ns: int) -> tuple[int, int, int, int]:
    """Return input, status, latches (0 or bench time)."""
    channel_image(rows[0], now_ns, EPOCH_NS)
    row = rows[0]
    latches = [int(row[name]) - EPOCH_NS if row[name] else 0 for name in ("latch_pos", "latch_neg")]
    return int(row["input"]), int(row["status"]), latches[0], latches[1]


def test_both_edges_within_one_cycle() -> None:
    rows = _channel()
    _edge(rows, 1, 1_200_000)
    _edge(rows, 0, 1_700_000)
    assert _image(rows, 2_000_000) == (0, 0, 1_200_000, 1_700_000)


def test_continuous_mode_overwrites_its_own_latch_only() -> None:
    rows = _channel()
    for at, level in ((100, 1), (200, 0), (300, 1)):
        _edge(rows, level, at)
    assert _image(rows, 1_000_000) == (1, 0, 300, 200)


def test_single_event_keeps_the_first_edge_until_it_is_read() -> None:
    rows = _channel(single_event=True)
    for at, level in ((100, 1), (200, 0), (300, 1), (400, 0)):
        _edge(rows, level, at)
    assert _image(rows, 1_000_000) == (0, 2, 100, 200)
    _edge(rows, 1, 1_000_500)
    assert _image(rows, 2_000_000) == (1, 1, 1_000_500, 200)
    assert _image(rows, 3_000_000) == (1, 1, 1_000_500, 200)
    _edge(rows, 0, 3_000_100)
    assert _image(rows, 4_000_000) == (0, 2, 1_000_500, 3_000_100)
    assert _image(rows, 5_000_000)[:2] == (0, 0)


def test_an_edge_at_the_cycle_border_is_in_the_image_of_that_cycle() -> None:
    rows = _channel()
    _edge(rows, 1, 1_000_000)
    assert _image(rows, 1_000_000) == (1, 0, 1_000_000, 0)


def test_the_image_never_shows_a_time_that_lies_ahead() -> None:
    rows = _channel(delay_ns=800)
    _edge(rows, 1, 999_900)
    assert _image(rows, 1_000_000) == (0, 0, 0, 0)
    assert _image(rows, 2_000_000) == (1, 0, 1_000_700, 0)


def test_a_pulse_shorter_than_the_filter_does_not_get_through() -> None:
    rows = _channel(delay_ns=3_000_000)
    _edge(rows, 1, 1_000)
    _edge(rows, 0, 1_500_000)
    assert _image(rows, 5_000_000) == (0, 0, 0, 0)
    _edge(rows, 1, 6_000_000)
    assert _image(rows, 8_000_000)[0] == 0
    assert _image(rows, 9_000_000)[0] == 1


def test_edges_further_apart_than_the_delay_all_count() -> None:
    rows = _channel(delay_ns=500)
    _edge(rows, 1, 1_000)
    _edge(rows, 0, 1_500)
    _edge(rows, 1, 2_100)
    assert _image(rows, 1_000_000) == (1, 0, 2_600, 2_000)


def test_input_and_latch_of_a_probed_edge_agree(rig: Any, axis: Any) -> None:

    bench = rig([axis(face=Face(mm=1.0, material="above"))], [Channel(""), Channel("probe")])
    while not bench.rows.channel[1]["input"]:
        bench.move(10.0, 1)
    [(at, _, _)] = bench.edges()
    assert bench.now_ns - 1_000_000 < at <= bench.now_ns
    assert bench.rows.channel[1]["latch_pos"] == EPOCH_NS + at
    assert bench.rows.channel[0]["input"] == 0
