"""Frames made from the log against the frames that really passed."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from hli_bench.base.ids import NodeId
from hli_bench.bench.bench import Bench
from hli_bench.laws.rows import LOG, LOG_CYCLES
from hli_bench.protocols.canopen import telegram
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.runtime.frames import (
    CycleBuffer,
    SilentNodes,
    actual_telegrams,
    cycle_frames,
    from_cnc,
)
from hli_bench.runtime.machine_side import SYNC
from hli_bench.wire.can import CanFrame

NODES = [NodeId(5), NodeId(2), NodeId(9)]


def random_rows(cycles: int, axes: int = len(NODES)) -> Any:
    generator = np.random.default_rng(1)
    return np.frombuffer(generator.bytes(cycles * axes * LOG.itemsize), LOG).reshape(cycles, axes).copy()


class Bus:
    """Takes the place of the link's telegram exchange, so that every cycle passes in real frames."""

    def __init__(self, bench: Bench) -> None:
        link = bench.engine.link
        self.cycles: dict[int, list[CanFrame]] = {}
        self._orders: list[CanFrame] = []
        self._exchange = link.telegrams
        link.telegrams = self.telegrams
        link.quiet = lambda _: 0

    def telegrams(self, cycle: int, inbox: Sequence[CanFrame]) -> list[CanFrame]:
        """Between two SYNCs: what the drives answered to one, and what the CNC sent in front of the next."""
        if cycle > 1:
            self.cycles[cycle - 1] += inbox
        sent = self._exchange(cycle, inbox)
        self.cycles[cycle] = [SYNC, *sent]
        return sent


class Listener:
    """Observer that makes the frames of every cycle from the log."""

    def __init__(self, bench: Bench) -> None:
        self.nodes = [axis.node for axis in bench.kernel.setup.axes]
        self.log = bench.kernel.rows.log
        self.silent = SilentNodes(self.nodes)
        self.others: dict[int, list[CanFrame]] = {}
        self.made: dict[int, list[CanFrame]] = {}

    def cycles(self, first: int, count: int) -> None:
        for cycle in range(first, first + count):
            self.silent.begin_cycle()
            others = self.others.get(cycle, [])
            self.silent.take(others)
            row = self.log[cycle % LOG_CYCLES]
            self.made[cycle] = cycle_frames(self.nodes, row, others, self.silent.now)

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        self.others.setdefault(cycle, []).extend(frames)
        if cycle == 0:
            self.silent.take(frames)

    def edges(self, edges: object) -> None: ...

    def emitted(self, cycle: int, records: object) -> None: ...

    def commands(self, commands: object) -> None: ...

    def refused(self, cycle: int, refusals: object) -> None: ...


def in_order(frames: Sequence[CanFrame]) -> list[CanFrame]:
    """TPDOs in front of what else the drives sent: the bench hands both over by identifier."""
    actual = [f for f in frames if 0x180 <= f.cob_id < 0x580 and f.cob_id & 0x80]
    others = [f for f in frames if f not in actual and f.cob_id != SYNC.cob_id]
    command = [f for f in others if f.cob_id & 0x780 in (0x200, 0x300)]
    beside = [f for f in others if f not in command]
    return [
        SYNC,
        *actual,
        *(f for f in beside if not from_cnc(f)),
        *command,
        *(f for f in beside if from_cnc(f)),
    ]


def test_the_log_gives_the_very_frames_that_passed_from_boot_up_to_a_latch() -> None:
    settings = {
        "plant.probe.Z.face_mm": 299,
        "plant.probe.Z.material": "below",
        "axis.Z.kenngr.measure.signal": "DRIVE",
    }
    with Bench("demo", settings, plc=[]) as bench:
        listener, bus = Listener(bench), Bus(bench)
        bench.engine.observers.append(listener)
        result = bench.run("N10 G100 G90 Z290 F2000\nN20 M30")
        assert len(result.measurements) == 1
        last = bench.engine.cycle
    assert any(frame.cob_id == 0x283 and frame.data != bytes(6) for frame in listener.made[last])
    for cycle in range(1, last):
        assert listener.made[cycle] == in_order(bus.cycles[cycle]), cycle


def numbers(one: telegram.Telegram, row: Any) -> list[Any]:
    return [
        row[number.name] if number.element is None else row[number.name][number.element]
        for number in one.numbers
    ]


@pytest.mark.parametrize("cycle", range(3))
def test_frames_are_those_of_the_default_telegram_of_the_drives(cycle: int) -> None:
    row = random_rows(3)[cycle]
    expected = [
        frame
        for axis, node in enumerate(NODES)
        for one in (*telegram.TPDOS, *telegram.RPDOS)
        for frame in [CanFrame(one.base + node, one.layout.pack(*numbers(one, row[axis])))]
    ]
    made = cycle_frames(NODES, row)
    assert made[0] == SYNC
    assert sorted(made[1:], key=lambda frame: frame.cob_id) == sorted(
        expected, key=lambda frame: frame.cob_id
    )


def test_a_cycle_is_sync_actual_answers_command_orders() -> None:
    others = [
        CanFrame(0x602, bytes(8)),
        CanFrame(0x582, bytes(8)),
        nmt_frame(NmtCommand.START),
        CanFrame(0x85, bytes(8)),
    ]
    frames = cycle_frames(NODES, random_rows(1)[0], others, frozenset({9}))
    ids = [frame.cob_id for frame in frames]
    assert ids == [
        *(0x80, 0x182, 0x185, 0x282, 0x285, 0x382, 0x385, 0x482, 0x485, 0x582, 0x85),
        *(0x202, 0x205, 0x209, 0x302, 0x305, 0x309, 0x602, 0x000),
    ]


def test_many_cycles_at_once_give_the_payloads_of_each() -> None:
    rows = random_rows(50)
    for pdo in actual_telegrams(NODES):
        payload = pdo.payload(rows)
        for cycle, row in enumerate(rows):
            frames = {frame.cob_id: frame.data for frame in cycle_frames(NODES, row)}
            assert payload[cycle].tobytes() == frames[pdo.cob_id]


def test_an_nmt_order_acts_in_the_next_cycle_and_a_boot_up_at_once() -> None:
    silent = SilentNodes(NODES)
    silent.take([CanFrame(0x700 + node, b"\0") for node in NODES])
    assert silent.now == set(NODES)
    silent.take([nmt_frame(NmtCommand.START, 2)])
    assert silent.now == set(NODES)
    silent.begin_cycle()
    assert silent.now == {5, 9}
    silent.take([nmt_frame(NmtCommand.START)])
    silent.begin_cycle()
    assert silent.now == set()
    silent.take([nmt_frame(NmtCommand.STOP, 9)])
    silent.begin_cycle()
    assert silent.now == {9}


def test_a_late_listener_believes_what_heartbeats_say() -> None:
    silent = SilentNodes(NODES)
    silent.take([CanFrame(0x705, b"\x05"), CanFrame(0x702, b"\x7f")])
    assert silent.now == {2}


def test_the_buffer_hands_out_cycles_in_order_across_the_end_of_the_ring() -> None:
    ring = np.zeros((LOG_CYCLES, 2), LOG)
    buffer, taken, cycle = CycleBuffer(ring), [], 1
    generator = np.random.default_rng(2)
    while cycle < 5000:
        count = int(generator.integers(1, LOG_CYCLES + 1))
        for number in range(cycle, cycle + count):
            ring[number % LOG_CYCLES]["target"] = number
        buffer.add(cycle, count)
        cycle += count
        while buffer.count >= 250:
            assert buffer.first == len(taken) + 1
            taken += buffer.take(250)["target"][:, 1].tolist()
    taken += buffer.take(buffer.count)["target"][:, 1].tolist()
    assert taken == list(range(1, cycle))
