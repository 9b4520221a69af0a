"""Whole benches in virtual time: what the tests here share."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hli_bench import Bench
from hli_bench.kernel.records import Emitted
from hli_bench.laws.rows import LOG_CYCLES
from hli_bench.protocols.hli.access import Refusal
from hli_bench.wire.can import CanFrame
from hli_bench.wire.hli import Commands
from hli_bench.wire.signals import Edge

FACE_Z = {"plant.probe.Z.face_mm": 100.0, "plant.probe.Z.material": "below"}

FOLLOWING = 10
"""Cycles of a start-up in which set points follow the actual positions."""

PROBE_SCRIPT = '''
from hli_bench.plc import Plc

class Probing(Plc):
    """{doc}"""
    period_us = {period_us}

    def start(self, hli, io):
        for n in {axes}:
            axis = hli.ax[n]
            axis.head.plc_present_w = {present}
            axis.lr_mc_control.probing_signal.enable_w = {signal}
            axis.lr_mc_control.timestamp.enable_w = {stamp}

    def cycle(self, hli, io):
        probe = io.probe.ch2
        for n in {axes}:
            axis = hli.ax[n].lr_mc_control
            axis.probing_signal.command_w = probe.input
            axis.timestamp.command_w = probe.{latch}
'''


class Recorder:
    """An observer that keeps the log of every cycle, frames, edges, records and PLC writes."""

    def __init__(self) -> None:
        self.kernel: Any = None
        self.blocks: list[np.ndarray] = []
        self.bus: list[tuple[int, CanFrame]] = []
        self.signals: list[Edge] = []
        self.records: list[tuple[int, Emitted]] = []
        self.writes: list[Commands] = []

    def cycles(self, first: int, count: int) -> None:
        slots = np.arange(first, first + count) % LOG_CYCLES
        self.blocks.append(self.kernel.rows.log[slots].copy())

    def frames(self, cycle: int, frames: Sequence[CanFrame]) -> None:
        self.bus += [(cycle, frame) for frame in frames]

    def edges(self, edges: Sequence[Edge]) -> None:
        self.signals += edges

    def emitted(self, cycle: int, records: Sequence[Emitted]) -> None:
        self.records += [(cycle, record) for record in records]

    def commands(self, commands: Commands) -> None:
        self.writes.append(commands)

    def overran(self, cycle: int, plc: str) -> None:
        pass

    def refused(self, cycle: int, refusals: Sequence[Refusal]) -> None:
        raise AssertionError(refusals)

    @property
    def log(self) -> np.ndarray:
        """Rows of cycle 1, 2, ... by axis."""
        return np.concatenate(self.blocks)

    def column(self, field: str, axis: int) -> np.ndarray:
        return self.log[field][:, axis]

    def velocity(self, axis: int) -> np.ndarray:
        """Velocity of the set point in mm/s over each cycle of 1 ms; 0 while it follows the drive at power-on."""
        velocity = np.diff(self.column("command", axis)) * 1e-4 / 1e-3
        velocity[:FOLLOWING] = 0.0
        return velocity

    def cycle_of(self, kind: type) -> list[int]:
        return [cycle for cycle, record in self.records if isinstance(record, kind)]

    def sdo_writes(self, node: int, index: int) -> list[int]:
        """Values of expedited downloads to `index` of a node, in order."""
        return [
            int.from_bytes(frame.data[4 : 8 - ((frame.data[0] >> 2) & 3)], "little")
            for _, frame in self.bus
            if frame.cob_id == 0x600 + node
            and frame.data[0] & 0xE0 == 0x20
            and int.from_bytes(frame.data[1:3], "little") == index
        ]

    def sdo_answers(self, node: int, index: int) -> list[int]:
        """Command bytes of the answers about `index`: 0x60 done, 0x80 refused."""
        return [
            frame.data[0]
            for _, frame in self.bus
            if frame.cob_id == 0x580 + node and int.from_bytes(frame.data[1:3], "little") == index
        ]


Make = Callable[..., Bench]


@pytest.fixture
def make() -> Iterator[Make]:
    """Return a maker of benches; `recorder` hangs itself on. They are closed when the test is over."""
    with ExitStack() as stack:

        def build(
            settings: Mapping[str, object] | None = None, *, recorder: Recorder | None = None, **options: Any
        ) -> Bench:
            observers = [recorder] if recorder is not None else []
            bench = stack.enter_context(Bench("demo", settings or {}, observers=observers, **options))
            if recorder is not None:
                recorder.kernel = bench.kernel
                bench.advance(2 * FOLLOWING)
            return bench

        yield build


@pytest.fixture
def recorder() -> Recorder:
    return Recorder()


@pytest.fixture
def new_recorder() -> type[Recorder]:
    return Recorder


@pytest.fixture
def face() -> dict[str, object]:
    """A workpiece below Z 100."""
    return dict(FACE_Z)


@pytest.fixture
def script(tmp_path: Path) -> Callable[..., Path]:
    """Return a maker of PLC scripts."""

    def write(text: str, name: str = "plc") -> Path:
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        return path

    return write


@pytest.fixture
def probing(script: Callable[..., Path]) -> Callable[..., Path]:
    """Return a maker of probing scripts: EL1252 channel 2 to `axes`."""

    def write(
        axes: Sequence[int] = (1, 2, 3),
        *,
        period_us: int = 1000,
        latch: str = "latch_pos",
        signal: bool = True,
        stamp: bool = True,
        present: bool = True,
        name: str = "probing_under_test",
    ) -> Path:
        return script(
            PROBE_SCRIPT.format(
                doc=name,
                axes=tuple(axes),
                period_us=period_us,
                latch=latch,
                signal=signal,
                stamp=stamp,
                present=present,
            ),
            name,
        )

    return write


@pytest.fixture
def errors() -> Callable[[Any], list[tuple[int, str, str]]]:
    """Return what tells the errors of a result: number, axis, block."""
    return lambda result: [(one.id, one.axis, one.block) for one in result.errors]
