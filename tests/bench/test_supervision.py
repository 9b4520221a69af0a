"""Nodes that others on the bus stop, reset or disable, at rest and moving: told at once, back after a reset.

The frames of the others go through `engine.put`, as those do that a CAN interface brings.
"""

import struct
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.protocols.canopen.nmt import NmtCommand, nmt_frame
from hli_bench.wire.can import CanFrame

Z, NODE = 2, 3
MOVE = "N10 G01 G90 Z290 F6000\nN20 M30"
LOSSES = {
    "it has booted again": [nmt_frame(NmtCommand.RESET_NODE, NODE)],
    "its telegrams stay out": [nmt_frame(NmtCommand.STOP, NODE)],
    "it is pre-operational": [nmt_frame(NmtCommand.ENTER_PRE_OPERATIONAL, NODE)],
}


@pytest.fixture(params=[False, True], ids=["one process", "pipe"])
def bench(request: pytest.FixtureRequest) -> Any:
    with Bench("demo", processes=request.param) as made:
        made.start_up()
        yield made


def write(index: int, subindex: int, data: bytes) -> CanFrame:
    command = 0x23 | (4 - len(data)) << 2
    return CanFrame(0x600 + NODE, struct.pack("<BHB", command, index, subindex) + data.ljust(4, b"\0"))


@pytest.fixture
def hear(bench: Bench) -> list[Any]:
    """Return the records of the CNC as they come."""
    records: list[Any] = []

    class Ear:
        def emitted(self, cycle: int, emitted: Any) -> None:
            records.extend((cycle, record) for record in emitted)

        def refused(self, cycle: int, refusals: Any) -> None:
            raise AssertionError(refusals)

    bench.engine.listeners.append(Ear())
    return records


@pytest.mark.parametrize("how", ["it has booted again", "its telegrams stay out"])
def test_a_lost_node_is_told_within_two_cycles_and_back_after_a_reset(
    bench: Bench, hear: list[Any], how: str
) -> None:
    bench.advance(100)
    bench.engine.put(LOSSES[how])
    begun = bench.engine.cycle
    bench.advance(3)
    ((cycle, record),) = hear
    assert cycle <= begun + 2
    assert (record.number, record.axis) == (70643, "Z")
    assert record.text.endswith(f"node {NODE}: {how}")
    state = bench.state()
    assert state["state"] == "error"
    assert state["axes"][Z]["drive"] == f"no telegrams: {how}"

    refused = bench.run(MOVE)
    assert [(error.id, error.axis) for error in refused.errors] == [(70101, "Z")]
    bench.reset()
    bench.advance(200)
    assert bench.kernel.drives.out() == []
    assert {axis["drive"] for axis in bench.state()["axes"]} == {"operation enabled"}
    assert bench.run(MOVE).status == "completed"
    bench.advance(200)
    assert bench.position_mm("Z") == pytest.approx(290.0, abs=1e-3)


def test_a_moving_axis_that_loses_its_node_ends_the_program_and_the_others_brake(
    bench: Bench, hear: list[Any]
) -> None:
    bench.kernel.start("N10 G01 G90 X400 Z200 F6000\nN20 M30".splitlines(), "p")
    bench.engine.wake()
    bench.advance(600)
    bench.engine.put(LOSSES["it is pre-operational"])
    bench.advance(500)
    assert [record.number for _, record in hear] == [70231]
    assert not bench.kernel.channel.running
    assert bench.kernel.rows.axis["velocity"].tolist() == [0.0] * 7
    assert bench.position_mm("X") < 399.0
    where = bench.position_mm("X"), bench.position_mm("Z")
    bench.advance(500)
    assert (bench.position_mm("X"), bench.position_mm("Z")) == pytest.approx(where, abs=1e-3)
    bench.reset()
    bench.advance(500)
    assert bench.run(MOVE).status == "completed"


def test_a_drive_that_others_disable_is_told_and_back_after_a_reset(bench: Bench, hear: list[Any]) -> None:
    bench.engine.put([write(0x6040, 0, struct.pack("<H", 0))])
    bench.advance(5)
    assert [(record.number, record.axis) for _, record in hear] == [(70221, "Z")]
    assert "switch on disabled" in hear[0][1].text
    bench.reset()
    bench.advance(100)
    assert bench.run(MOVE).status == "completed"


def test_a_telegram_that_others_have_changed_is_a_missing_one(bench: Bench, hear: list[Any]) -> None:
    bench.engine.put([write(0x1800, 1, struct.pack("<I", 0x80000180 + NODE))])
    bench.advance(5)
    assert [(record.number, record.axis) for _, record in hear] == [(70643, "Z")]
    bench.reset()
    bench.advance(200)
    assert bench.run(MOVE).status == "completed"


def test_a_heartbeat_that_stays_out_is_missed_within_its_consumer_time(bench: Bench, hear: list[Any]) -> None:
    bench.advance(100)
    bench.engine.put([write(0x1017, 0, bytes(2))])
    begun = bench.engine.cycle
    bench.advance(1700)
    ((cycle, record),) = hear
    assert (record.number, record.axis) == (70643, "Z")
    assert "no heartbeat for 1500 ms" in record.text
    assert cycle <= begun + 1502


def test_heartbeats_that_come_are_not_missed(bench: Bench, hear: list[Any]) -> None:
    bench.advance(10_000)
    assert hear == []


def test_an_emergency_message_is_an_error_also_of_a_drive_that_goes_on(bench: Bench, hear: list[Any]) -> None:
    """A command telegram that is too short: the drive leaves it out and says so (0x8210)."""
    bench.engine.put([CanFrame(0x200 + NODE, b"\x0f")])
    bench.advance(5)
    assert [(record.number, record.axis) for _, record in hear] == [(70222, "Z")]
    assert "0x8210" in hear[0][1].text
    bench.reset()
    bench.advance(100)
    assert bench.run(MOVE).status == "completed"


def test_a_node_that_does_not_come_back_says_why(bench: Bench, hear: list[Any]) -> None:
    """Somebody gives the node another id by LSS: it hears neither NMT nor SDO of the CNC any more."""
    identity = (0xFF0402, 0x402, 0x10000, NODE)
    chosen = [CanFrame(0x7E5, struct.pack("<BI3x", 0x40 + at, value)) for at, value in enumerate(identity)]
    bench.engine.put([*chosen, CanFrame(0x7E5, bytes((0x11, 50)).ljust(8, b"\0"))])
    bench.engine.put([nmt_frame(NmtCommand.RESET_COMMUNICATION, NODE)])
    bench.advance(3)
    assert [(record.number, record.axis) for _, record in hear] == [(70643, "Z")]
    bench.reset()
    begun = bench.engine.cycle
    while not bench.kernel.drives.settled:
        bench.advance(1)
    assert bench.engine.cycle - begun <= 1502
    reason = f"node {NODE}: no boot-up message after NMT reset communication"
    assert bench.kernel.drives.out() == [f"Z ({reason})"]
    assert [error.id for error in bench.run(MOVE).errors] == [70101]


@pytest.mark.parametrize("absolute", [1, 0])
def test_a_lost_node_takes_the_reference_of_an_incremental_encoder(absolute: int) -> None:
    with Bench("demo", {"axis.Z.kenngr.abs_pos_gueltig": absolute}) as bench:
        bench.start_up()
        bench.kernel.core.referenced[Z] = True
        records: list[int] = []
        bench.engine.listeners.append(Numbers(records))
        bench.engine.put([nmt_frame(NmtCommand.RESET_NODE, NODE)])
        bench.advance(3)
        assert records == ([70643] if absolute else [70643, 70389])
        assert bench.kernel.core.referenced[Z] == bool(absolute)


class Numbers:
    """Keeps the numbers of the errors."""

    def __init__(self, numbers: list[int]) -> None:
        self._numbers = numbers

    def emitted(self, cycle: int, emitted: Any) -> None:
        self._numbers += [record.number for record in emitted]

    def refused(self, cycle: int, refusals: Any) -> None:
        raise AssertionError(refusals)


def test_drive_objects_are_written_while_somebody_reads_over_the_same_server(
    bench: Bench, hear: list[Any]
) -> None:
    """A tool reads the status word with every cycle; its answers are not those to #DRIVE."""
    text = "N10 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=50 WAIT]\n" * 5 + "N20 M30"
    bench.kernel.start(text.splitlines(), "p")
    bench.engine.wake()
    read = CanFrame(0x600 + NODE, struct.pack("<BHB4x", 0x40, 0x6041, 0))
    for _ in range(60):
        bench.engine.put([read, read])
        bench.advance(1)
    assert hear == []
    assert bench.kernel.channel.completed


def test_a_tool_has_a_server_of_its_own(bench: Bench) -> None:
    """0x1201 gets its identifiers over the first server, then answers on them; both at once."""
    frames: list[CanFrame] = []

    class Bus(Numbers):
        def cycles(self, first: int, count: int) -> None:
            pass

        def frames(self, cycle: int, passed: Any) -> None:
            frames.extend(passed)

        def edges(self, edges: Any) -> None:
            pass

        def commands(self, commands: Any) -> None:
            pass

    bench.engine.observers.append(Bus([]))
    bench.engine.put([write(0x1201, 1, struct.pack("<I", 0x683)), write(0x1201, 2, struct.pack("<I", 0x693))])
    bench.advance(2)
    read = struct.pack("<BHB4x", 0x40, 0x6041, 0)
    bench.engine.put([CanFrame(0x683, read)])
    bench.advance(2)
    (answer,) = [frame for frame in frames if frame.cob_id == 0x693]
    assert struct.unpack_from("<H", answer.data, 4)[0] & 0x6F == 0x27
    refused = [
        write(0x1201, 1, struct.pack("<I", 0x684)),
        write(0x1201, 2, struct.pack("<I", 0x80000000 + 0x183)),
    ]
    bench.engine.put(refused[:1])
    bench.advance(2)
    (aborted,) = [frame for frame in frames if frame.cob_id == 0x583 and frame.data[0] == 0x80]
    assert aborted.data[1:4] == bytes((0x01, 0x12, 1)), "a valid identifier is taken back first"
    bench.engine.put(refused[1:])
    bench.advance(2)
    frames.clear()
    bench.engine.put([CanFrame(0x683, read)])
    bench.advance(2)
    assert [frame for frame in frames if frame.cob_id == 0x693] == []


def test_a_foreign_sync_is_counted_and_changes_nothing(bench: Bench, hear: list[Any]) -> None:
    first = bench.run(MOVE)
    assert first.notes == () or all("SYNC" not in note for note in first.notes)
    bench.kernel.start("N10 G01 G90 Z280 F6000\nN20 M30".splitlines(), "p")
    bench.engine.wake()
    for _ in range(3):
        bench.advance(20)
        bench.engine.put([CanFrame(0x80)])
    bench.advance(2000)
    assert bench.engine.foreign_syncs == 3
    assert bench.state()["foreign_syncs"] == 3
    assert hear == []
    assert bench.position_mm("Z") == pytest.approx(280.0, abs=1e-3)
