"""What a recording keeps of a run, and that it stays small."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from hli_bench.bench.bench import Bench
from hli_bench.kernel.cycle import Kernel
from hli_bench.kernel.records import MeasuredValue
from hli_bench.laws.rows import LOG_CYCLES
from hli_bench.runtime.recording import CONDENSE, InputTap, Recording, _Samples, input_taps
from hli_bench.wire.signals import Edge

SETTINGS = {
    "plant.probe.Z.face_mm": 299.0123,
    "plant.probe.Z.material": "below",
    "axis.Z.kenngr.measure.signal": "PLC_TIMESTAMP",
}
UNIT = "ax/3/lr_mc_control/probing_signal"
MS = 1_000_000


@pytest.fixture(scope="module")
def run() -> tuple[Bench, Recording]:
    bench = Bench("demo", SETTINGS)
    recording = Recording(bench.kernel, input_taps(bench.config.terminals), {"demo": MS})
    bench.engine.observers.append(recording)
    assert bench.run("N10 G01 G90 X5 F6000\nN20 G100 Z290 F500\nN30 G01 Z300\nN40 M30").completed
    return bench, recording


def test_curves_are_in_mm_and_begin_where_the_axis_stands(run: tuple[Bench, Recording]) -> None:
    bench, recording = run
    z, x = recording.curve("Z"), recording.curve("X")
    assert z.actual_low[0] == pytest.approx(300.0)
    assert z.actual_low.min() == pytest.approx(299.0, abs=0.1)
    assert x.command_high[-1] == pytest.approx(5.0)
    assert x.at_ns[-1] == bench.engine.cycle * MS
    assert (x.lag_high == x.lag_low).all()
    assert x.lag_high == pytest.approx(x.command_low - x.actual_low, abs=0.2)


def test_a_window_has_every_cycle_around_the_measured_value(run: tuple[Bench, Recording]) -> None:
    _, recording = run
    (window,) = recording.windows
    assert isinstance(window.value, MeasuredValue)
    latched = (window.value.dc_ns - recording.dc_epoch_ns) // MS
    assert window.first == latched - 50
    assert window.first + len(window.rows) - 1 == window.emitted_ns // MS + 20
    z = window.rows["actual"][:, 2]
    assert (np.diff(z[:51]) < 0).all()
    assert z[latched - window.first] >= window.value.acs_tenth_um >= z[latched - window.first + 1]


def test_edge_input_command_and_state_follow_each_other_by_cycles(run: tuple[Bench, Recording]) -> None:
    _, recording = run
    (window,) = recording.windows
    edge = next(edge for edge in recording.edges_seen if edge.signal == "probe")
    command = next(c for c in recording.hli if c.path == f"{UNIT}/command_w" and c.value)
    state = next(c for c in recording.hli if c.path == f"{UNIT}/state_r" and c.value)
    assert command.at_ns == -(-edge.at_ns // MS) * MS
    assert state.at_ns == command.at_ns + MS == window.emitted_ns
    assert not recording.level("probe", edge.at_ns - 1)
    assert recording.level("probe", edge.at_ns)


def test_connected_inputs_are_known(run: tuple[Bench, Recording]) -> None:
    _, recording = run
    assert recording.inputs[0] == InputTap("EL1252 probe/ch2", "probe", 0, MS)
    assert recording.inputs[3] == InputTap("EL1018 cams/ch3", "cam.Z", 10_000, MS)


class Made:
    """A recording that is fed from a ring without a bench."""

    def __init__(self, kernel: Kernel, samples: int) -> None:
        self.ring: Any = kernel.rows.log
        self.ring["statusword"] = 1
        self.recording = Recording(kernel, samples=samples)
        self.cycle = 0

    def feed(self, values: np.ndarray) -> None:
        for chunk in np.split(values, range(700, len(values), 700)):
            slots = np.arange(self.cycle + 1, self.cycle + 1 + len(chunk)) % LOG_CYCLES
            self.ring["actual"][slots, 0] = chunk
            self.recording.cycles(self.cycle + 1, len(chunk))
            self.cycle += len(chunk)


@pytest.fixture
def made() -> Made:
    return Made(Bench("demo", plc=[]).kernel, 1000)


def test_a_long_run_is_kept_in_few_samples_without_losing_a_spike(made: Made) -> None:
    values = np.zeros(100_000)
    values[54_321] = 10_000.0
    values[77_777] = -20_000.0
    made.feed(values)
    curve = made.recording.curve("X")
    assert 500 <= len(curve.at_ns) <= 1000
    assert curve.actual_high.max() == 1.0
    assert curve.actual_low.min() == -2.0
    spike = curve.at_ns[curve.actual_high.argmax()]
    assert 0 <= 54_322 * MS - spike < np.diff(curve.at_ns).max()


def test_samples_span_their_cycles_wherever_blocks_ended(made: Made) -> None:
    values = np.random.default_rng(4).normal(0, 1e4, 30_000)
    made.feed(values)
    curve = made.recording.curve("X")
    cycles = np.arange(1, len(values) + 1)
    interval = int(np.diff(curve.at_ns).max()) // MS
    for at_ns, low, high in zip(curve.at_ns, curve.actual_low, curve.actual_high, strict=True):
        inside = values[cycles // interval == at_ns // MS // interval]
        assert (low, high) == (inside.min() / 1e4, inside.max() / 1e4)


def test_no_cycle_makes_many_samples_coarser(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[int] = []
    merged = _Samples._merged

    def counted(samples: _Samples, pieces: Sequence[Any]) -> Any:
        taken.append(sum(len(numbers) for numbers, _ in pieces))
        return merged(samples, pieces)

    monkeypatch.setattr(_Samples, "_merged", counted)
    for _ in range(20_000):
        made.feed(np.zeros(1))
    assert made.recording._samples.interval == 32
    assert max(taken) <= 2 * CONDENSE
    assert len(made.recording.curve("X").at_ns) == 20_000 // 32 + 1


def test_a_move_within_one_sample_is_a_move(made: Made) -> None:
    made.ring["command"][...] = 0.0
    made.ring["command"][17, 0] = 5e4
    made.feed(np.zeros(100_000))
    curve = made.recording.curve("X")
    assert (curve.command_low.min(), curve.command_high.max()) == (0.0, 5.0)


def test_a_cycle_before_the_first_telegram_is_not_shown(made: Made) -> None:
    made.ring["statusword"] = 0
    made.feed(np.zeros(5))
    made.ring["statusword"] = 0x40
    made.feed(np.full(5, 7e4))
    assert list(made.recording.curve("X").actual_low) == [7.0] * 5


def test_events_do_not_pile_up(made: Made) -> None:
    for number in range(50_000):
        made.recording.edges([Edge("probe", number, bool(number % 2))])
    assert len(made.recording.edges_seen) == 20_000
    assert made.recording.edges_seen[-1].at_ns == 49_999
