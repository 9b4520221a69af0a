"""The CiA 402 drive: numbers between bus and row, state walk, faults, stops; python-canopen as master."""

import struct
from typing import Any

import canopen
import numpy as np
import pytest
from hli_bench_drives.cia402.drive import STOP_TIMEOUT, Drive, DriveOptions, create
from hli_bench_drives.cia402.states import State, state_of
from hli_bench_drives.models import servo402

from hli_bench.base.errors import InputError
from hli_bench.base.time import Ns
from hli_bench.laws.rows import LOG, SERVO
from hli_bench.laws.servo import supervise
from hli_bench.protocols.canopen import telegram
from hli_bench.protocols.canopen.aborts import AbortCode
from hli_bench.runtime.frames import cycle_frames
from hli_bench.wire.can import CanFrame

NODE_ID = 3


def command(bus: Any, word: int, target: int = 0) -> int:
    """Send RPDO1 and a SYNC; return the statusword of TPDO1."""
    bus.send_message(0x203, struct.pack("<Hi", word, target))
    sent = {frame.cob_id: frame.data for frame in bus.cycle()}
    return int(struct.unpack_from("<H", sent[0x183])[0])


def emergencies(bus: Any) -> list[tuple[Any, ...]]:
    return [struct.unpack_from("<HB", frame.data) for frame in bus.seen if frame.cob_id == 0x83]


def held(row: Any) -> bool:
    """Tell whether the set point comes to a stop by itself."""
    return bool(row["stop_rate"] > 0.0)


def refused(master: Any, index: int, subindex: int, data: bytes) -> AbortCode:
    with pytest.raises(canopen.SdoAbortedError) as error:
        master.sdo.download(index, subindex, data)
    return AbortCode(error.value.code)


class CyclicNode402(canopen.BaseNode402):
    """python-canopen's 402 master whose waiting for a TPDO is one bus cycle."""

    def check_statusword(self, timeout: float | None = None) -> int:
        for pdo in self.rpdo.values():
            if pdo.enabled:
                self.network.send_message(pdo.cob_id, pdo.data)
        self.network.cycle()
        return int(self.statusword)


def test_python_canopens_402_master_walks_to_operation_enabled_and_back(
    bus: Any, eds: Any, row: Any, drive: Drive
) -> None:
    master = bus.add_node(CyclicNode402(NODE_ID, str(eds)))
    master.nmt.state = "OPERATIONAL"
    master.setup_402_state_machine()
    bus.cycle()
    assert master.state == "SWITCH ON DISABLED"
    master.state = "OPERATION ENABLED"
    assert drive.state is State.OPERATION_ENABLED
    assert row["enabled"] == 1
    assert master.op_mode == "CYCLIC SYNCHRONOUS POSITION"
    assert master.is_op_mode_supported("CYCLIC SYNCHRONOUS POSITION")
    assert not master.is_op_mode_supported("HOMING")
    master.state = "SWITCHED ON"
    assert row["enabled"] == 0
    master.state = "SWITCH ON DISABLED"
    assert drive.state is State.SWITCH_ON_DISABLED


def test_one_state_per_controlword_seen_at_the_same_sync(bus: Any, drive: Drive) -> None:
    bus.send_message(0, b"\x01\x03")
    drive.device.values.put(0x605C, 0, 0)
    shown = [state_of(command(bus, word)) for word in (0x0F, 0x06, 0x07, 0x0F, 0x07, 0x06, 0x00)]
    assert shown == [
        State.SWITCH_ON_DISABLED,
        State.READY_TO_SWITCH_ON,
        State.SWITCHED_ON,
        State.OPERATION_ENABLED,
        State.SWITCHED_ON,
        State.READY_TO_SWITCH_ON,
        State.SWITCH_ON_DISABLED,
    ]
    command(bus, 0x06)
    assert state_of(command(bus, 0x0F)) is State.OPERATION_ENABLED


def test_target_takes_effect_at_the_sync_after_it_was_sent(enabled: Drive, bus: Any, row: Any) -> None:
    bus.send_message(0x203, struct.pack("<Hi", 0x0F, -123456))
    assert row["target"] == 0
    bus.cycle()
    assert row["target"] == -123456


def test_row_numbers_appear_in_their_objects(master: Any, row: Any) -> None:
    numbers = {
        "demand": (0x6062, -5),
        "position": (0x6064, -(1 << 31)),
        "velocity": (0x606C, 77),
        "torque_permille": (0x6077, -900),
        "target": (0x607A, 12),
        "probe_status": (0x60B9, 0x0301),
        "following_error": (0x60F4, -6),
        "digital_inputs": (0x60FD, 0x80010004),
        "increments_per_turn": (0x608F, 4096),
    }
    for name, (_, value) in numbers.items():
        row[name] = value
    row["latch"] = (1, -2, 3, -4)
    row["latch_time"] = (5, 6, 7, 0xFFFFFFFF)
    row["rated_torque"] = 2.39
    for index, value in numbers.values():
        item = master.sdo[index] if index != 0x608F else master.sdo[index][1]
        assert item.raw == value
    assert [master.sdo[index].raw for index in range(0x60BA, 0x60BE)] == [1, -2, 3, -4]
    assert [master.sdo[index].raw for index in range(0x60D1, 0x60D5)] == [5, 6, 7, 0xFFFFFFFF]
    assert master.sdo[0x6063].raw == -(1 << 31)
    assert master.sdo[0x60FC].raw == -5
    assert master.sdo[0x6076].raw == 2390


def test_following_window_reaches_the_row_and_off_is_accepted(master: Any, row: Any) -> None:
    assert (row["following_window"], row["following_timeout_ms"]) == (1048575, 10)
    master.sdo[0x6065].raw = 4294967295
    master.sdo[0x6066].raw = 250
    assert (row["following_window"], row["following_timeout_ms"]) == (4294967295, 250)
    assert master.sdo[0x6065].raw == 4294967295


def test_torque_clamp_is_the_least_limit_and_takes_the_full_range(master: Any, row: Any) -> None:
    assert row["torque_limit_permille"] == 3000
    for written, clamp in ((50000, 3000), (65535, 3000), (100, 100), (0, 0), (5000, 3000)):
        master.sdo[0x6072].raw = written
        assert master.sdo[0x6072].raw == written
        assert row["torque_limit_permille"] == clamp
    master.sdo[0x60E0].raw = 700
    master.sdo[0x60E1].raw = 600
    limits = ("torque_limit_permille", "positive_permille", "negative_permille")
    assert [row[name] for name in limits] == [3000, 700, 600]


@pytest.mark.parametrize("mode", [-1, 1, 3, 4, 6, 7, 9, 10, 127])
def test_modes_that_are_not_advertised_are_refused(master: Any, mode: int) -> None:
    assert master.sdo[0x6502].raw == 0x80
    assert refused(master, 0x6060, 0, struct.pack("b", mode)) is AbortCode.RANGE
    master.sdo[0x6060].raw = 8
    assert master.sdo[0x6061].raw == 8


def test_torque_offset_takes_only_zero(master: Any) -> None:
    assert refused(master, 0x60B2, 0, b"\x01\0") is AbortCode.TOO_HIGH
    assert refused(master, 0x60B2, 0, b"\xff\xff") is AbortCode.TOO_LOW
    master.sdo[0x60B2].raw = 0


@pytest.mark.req("M-129")
def test_default_telegram_carries_latch_control_word_status_word_and_position(
    master: Any, bus: Any, row: Any
) -> None:
    master.nmt.state = "OPERATIONAL"
    bus.send_message(0x303, b"\x11\x00")
    bus.cycle()
    assert row["probe_function"] == 0x0011
    row["probe_status"] = 0x0003
    row["latch"][0] = -4711
    assert CanFrame(0x283, struct.pack("<Hi", 3, -4711)) in bus.cycle()


@pytest.mark.req("M-128")
@pytest.mark.parametrize(
    ("sources", "written", "acted"),
    [
        ((1, 2), 0x0019, 0x0011),
        ((5, 2), 0x0019, 0x0015),
        ((1, 2), 0x2900, 0x2100),
        ((1, 5), 0x2900, 0x2500),
        ((5, 5), 0x0011, 0x0011),
        ((5, 5), 0x0000, 0x0000),
    ],
)
def test_probe_source_is_set_up_in_the_drive(
    master: Any, row: Any, sources: tuple[int, int], written: int, acted: int
) -> None:
    for sub, source in enumerate(sources, start=1):
        master.sdo[0x60D0][sub].raw = source
    master.sdo[0x60B8].raw = written
    assert row["probe_function"] == acted
    assert master.sdo[0x60B8].raw == written


def test_probe_source_changed_while_armed_counts_at_once(master: Any, row: Any) -> None:
    master.sdo[0x60B8].raw = 0x0019
    master.sdo[0x60D0][1].raw = 5
    assert row["probe_function"] == 0x0015
    for sub, source in ((1, 2), (1, 3), (2, 1), (2, 6)):
        assert refused(master, 0x60D0, sub, struct.pack("<h", source)) is AbortCode.RANGE


def test_following_error_of_the_law_becomes_a_fault(enabled: Drive, bus: Any, row: Any) -> None:
    row["velocity"] = 200_000
    row["fault"] = 0x8611
    row["status_flags"] = 0x2000
    status = command(bus, 0x0F, 500)
    assert state_of(status) is State.FAULT_REACTION_ACTIVE
    assert status & 0x2000
    assert (row["enabled"], held(row)) == (1, True)
    assert emergencies(bus) == [(0x8611, 0x21)]
    row["velocity"] = 0
    assert state_of(command(bus, 0x0F)) is State.FAULT
    assert row["enabled"] == 0
    assert emergencies(bus) == []
    assert enabled.device.values.get(0x603F) == 0x8611
    assert enabled.device.values.get(0x1001) == 0x21
    assert enabled.device.values.get(0x1003, 1) == 0x8611


def test_fault_reset_needs_the_edge_and_sends_the_reset_message(enabled: Drive, bus: Any, row: Any) -> None:
    command(bus, 0x8F)
    row["fault"] = 0x8611
    command(bus, 0x8F)
    assert state_of(command(bus, 0x8F)) is State.FAULT
    command(bus, 0x00)
    row["following_elapsed_ns"] = 5
    assert state_of(command(bus, 0x80)) is State.SWITCH_ON_DISABLED
    assert emergencies(bus) == [(0x0000, 0)]
    assert (row["fault"], row["following_elapsed_ns"]) == (0, 0)
    assert enabled.device.values.get(0x603F) == 0
    assert state_of(command(bus, 0x06)) is State.READY_TO_SWITCH_ON


def test_fault_reaction_option_0_cuts_power_at_once(enabled: Drive, bus: Any, row: Any) -> None:
    enabled.device.values.put(0x605E, 0, 0)
    row["velocity"] = 200_000
    row["fault"] = 0x8611
    assert state_of(command(bus, 0x0F)) is State.FAULT
    assert row["enabled"] == 0


def test_a_stop_that_does_not_end_is_over_after_its_time(enabled: Drive, bus: Any, row: Any) -> None:
    row["velocity"] = -200_000
    row["fault"] = 0x8611
    command(bus, 0x0F)
    begun = bus.now
    while state_of(command(bus, 0x0F)) is State.FAULT_REACTION_ACTIVE:
        assert bus.now < begun + STOP_TIMEOUT
    assert bus.now == begun + STOP_TIMEOUT


def test_following_error_may_stay_a_status_bit(bus: Any, row: Any) -> None:
    row = np.zeros(1, SERVO)[0]
    drive = servo402.create("Z", NODE_ID, row, {"following_error": "status"})
    drive.exchange(0x06, 0, 0, Ns(0))
    drive.exchange(0x0F, 0, 0, Ns(0))
    row["fault"] = 0x8611
    assert state_of(drive.exchange(0x0F, 5, 0, Ns(0))) is State.OPERATION_ENABLED
    assert (row["fault"], row["target"]) == (0, 5)
    row["fault"] = 0x7305
    assert state_of(drive.exchange(0x0F, 5, 0, Ns(0))) is State.FAULT_REACTION_ACTIVE


@pytest.mark.parametrize(
    ("option", "moving", "standing"),
    [
        (0, State.SWITCH_ON_DISABLED, State.SWITCH_ON_DISABLED),
        (2, State.QUICK_STOP_ACTIVE, State.SWITCH_ON_DISABLED),
        (6, State.QUICK_STOP_ACTIVE, State.QUICK_STOP_ACTIVE),
    ],
)
def test_quick_stop_options(
    enabled: Drive, bus: Any, row: Any, option: int, moving: State, standing: State
) -> None:
    enabled.device.values.put(0x605A, 0, option)
    row["velocity"] = 200_000
    assert state_of(command(bus, 0x02, 9999)) is moving
    assert row["enabled"] == (option != 0)
    assert held(row) == (option != 0)
    row["velocity"] = 0
    assert state_of(command(bus, 0x02, 9999)) is standing
    resumed = state_of(command(bus, 0x0F, 9999))
    assert resumed is (State.OPERATION_ENABLED if option == 6 else State.SWITCH_ON_DISABLED)
    if option == 6:
        assert (row["target"], held(row)) == (9999, False)


@pytest.mark.parametrize(
    ("index", "word", "after"),
    [(0x605B, 0x06, State.READY_TO_SWITCH_ON), (0x605C, 0x07, State.SWITCHED_ON)],
)
def test_power_is_cut_at_once_or_after_a_stop(
    enabled: Drive, bus: Any, row: Any, index: int, word: int, after: State
) -> None:
    enabled.device.values.put(index, 0, 1)
    row["velocity"] = 200_000
    assert state_of(command(bus, word, 50)) is State.OPERATION_ENABLED
    assert (held(row), enabled.holding) == (True, True)
    assert state_of(command(bus, 0x0F, 50)) is State.OPERATION_ENABLED
    assert (row["target"], held(row), enabled.holding) == (50, False, False)
    command(bus, word, 50)
    row["velocity"] = 0
    assert state_of(command(bus, word, 50)) is after
    assert row["enabled"] == 0


def test_power_is_cut_at_once_without_the_option(enabled: Drive, bus: Any, row: Any) -> None:
    enabled.device.values.put(0x605C, 0, 0)
    row["velocity"] = 200_000
    assert state_of(command(bus, 0x07)) is State.SWITCHED_ON


def test_halt_holds(enabled: Drive, bus: Any, row: Any) -> None:
    command(bus, 0x10F, 1000)
    assert (held(row), row["enabled"]) == (True, 1)
    command(bus, 0x10F, 1000)
    assert held(row)
    command(bus, 0x0F, 1000)
    assert (row["target"], held(row)) == (1000, False)


@pytest.mark.parametrize(
    ("option", "state"),
    [
        (0, State.OPERATION_ENABLED),
        (1, State.FAULT_REACTION_ACTIVE),
        (2, State.SWITCH_ON_DISABLED),
        (3, State.QUICK_STOP_ACTIVE),
    ],
)
def test_lost_connection_options(enabled: Drive, bus: Any, row: Any, option: int, state: State) -> None:
    enabled.device.values.put(0x6007, 0, option)
    row["velocity"] = 200_000
    bus.send_message(0, b"\x80\x03")
    assert enabled.state is state


def test_lost_heartbeat_of_the_master_stops_the_drive(enabled: Drive, bus: Any, row: Any) -> None:
    bus.send_message(0x603, struct.pack("<BHBI", 0x23, 0x1016, 1, 0x7F << 16 | 20))
    bus.send_message(0x77F, b"\x05")
    bus.cycle(19)
    assert enabled.state is State.OPERATION_ENABLED
    bus.cycle(1)
    assert emergencies(bus) == [(0x8130, 0x11), (0x8100, 0x11)]
    bus.cycle(1)
    assert enabled.state is State.FAULT


def test_reset_node_starts_as_after_power_on(enabled: Drive, bus: Any, row: Any) -> None:
    bus.send_message(0x603, struct.pack("<BHBI", 0x2B, 0x6072, 0, 100))
    bus.send_message(0x603, struct.pack("<BHBI", 0x2B, 0x60B8, 0, 0x11))
    row["fault"] = 0x8611
    bus.cycle()
    bus.send_message(0, b"\x81\x03")
    assert bus.seen[-1] == CanFrame(0x703, b"\0")
    assert enabled.state is State.SWITCH_ON_DISABLED
    assert (row["enabled"], row["fault"], row["probe_function"]) == (0, 0, 0)
    assert row["torque_limit_permille"] == 3000
    assert enabled.device.values.get(0x1001) == 0


def test_options_are_checked() -> None:
    assert DriveOptions.from_mapping({}).following_error == "fault"
    with pytest.raises(InputError, match="'lag' is none of following_error"):
        DriveOptions.from_mapping({"lag": 1}, "Z")
    with pytest.raises(InputError, match="'ignore' is none of fault, status"):
        DriveOptions.from_mapping({"following_error": "ignore"}, "Z")


def without(eds: Any, *indices: int) -> str:
    """Return the text of an EDS without some objects."""
    text: str = eds.read_text()
    for index in indices:
        text = text.replace(f"[{index:04X}", f"[Gone{index:04X}")
    return text


def test_an_eds_without_a_needed_object_is_bad_input(eds: Any, row: Any, tmp_path: Any) -> None:
    poor = tmp_path / "poor.eds"
    poor.write_text(without(eds, 0x6041, 0x6064))
    with pytest.raises(InputError, match=r"poor.eds: a CiA 402 drive needs the objects 6041:00, 6064:00"):
        create("Z", 1, poor, row, {})
    poor.write_text(eds.read_text().replace("[6041]\n", "[6041]\nDataType=9\n"))
    text = poor.read_text()
    at = text.index("DataType=0x0006", text.index("[6041]"))
    poor.write_text(text[:at] + text[at + len("DataType=0x0006\n") :])
    with pytest.raises(InputError, match="needs integers in the objects 6041:00"):
        create("Z", 1, poor, row, {})


def test_a_drive_without_what_is_optional_runs(eds: Any, row: Any, tmp_path: Any) -> None:
    """No option codes, limits, window, touch probe, register of errors: it acts as the profile says."""
    small = tmp_path / "small.eds"
    gone = (0x1001, 0x1003, 0x6007, 0x603F, *range(0x605A, 0x605F), 0x6065, 0x6066, 0x6072, 0x6084, 0x6085)
    probe = (0x1401, 0x1601, 0x1801, 0x1802, 0x1803, 0x1A01, 0x1A02, 0x1A03, *range(0x60B8, 0x60BE), 0x60D0)
    small.write_text(
        without(eds, *gone, *probe, *range(0x60D1, 0x60D5), 0x60E0, 0x60E1).replace(
            "0x00000080\nPDO", "\nPDO"
        )
    )
    drive = create("Z", NODE_ID, small, row, {})
    drive.power_on()
    for word in (0x06, 0x07, 0x0F):
        drive.exchange(word, 5, 0, Ns(0))
    assert drive.state is State.OPERATION_ENABLED
    assert (row["torque_limit_permille"], row["following_window"]) == (3000, 0xFFFFFFFF)
    drive.device.values.download(0x6060, 0, b"\x08")
    assert drive.device.values.number(0x6502) == 0x80, "left open in the file"
    drive.fault(0x7305)
    drive.exchange(0x0F, 5, 0, Ns(0))
    drive.exchange(0x0F, 5, 0, Ns(1))
    assert drive.state is State.FAULT


def test_ratings_are_those_of_the_machine_folder(row: Any) -> None:
    row["rated_torque"], row["peak_permille"] = 2.5, 2000
    drive = servo402.create("Z", 1, row, {})
    assert row["torque_limit_permille"] == 2000
    assert drive.device.values.number(0x6076) == 2500


class TestRowToRow:
    """The exchange of numbers without frames."""

    def random_cycle(self, generator: np.random.Generator) -> Any:
        log = np.zeros(1, LOG)
        for name in LOG.names or ():
            field = log[name]
            if field.dtype.kind in "iu":
                limits = np.iinfo(field.dtype)
                log[name] = generator.integers(
                    limits.min, limits.max, field.shape, field.dtype, endpoint=True
                )
        return log[0]

    def test_late_frames_equal_those_of_the_device(self, enabled: Drive, bus: Any, row: Any) -> None:
        generator = np.random.default_rng(402)
        for _ in range(50):
            logged = self.random_cycle(generator)
            row["status_flags"] = generator.integers(0, 0x10000)
            for name in ("position", "probe_status", "digital_inputs", "torque_permille"):
                row[name] = logged[name]
            row["latch"][:2] = logged["latch"]
            row["following_error"] = logged["following_error"]
            logged["statusword"] = enabled.statusword
            logged["controlword"] = 0x0F
            _, *made = cycle_frames([NODE_ID], logged.reshape(1))
            assert made[: len(telegram.TPDOS)] == bus.cycle()
            for frame in made[len(telegram.TPDOS) :]:
                bus.send_message(frame.cob_id, frame.data)
            bus.cycle()
            assert row["target"] == logged["target"]
            assert enabled.device.values.get(0x60B8) == logged["probe_function"]
            bus.send_message(0x303, b"\0\0")

    def test_exchange_does_what_the_frames_do(self) -> None:
        rows = np.zeros(2, SERVO)
        by_frames, by_numbers = (servo402.create("Z", NODE_ID, row, {}) for row in rows)
        for drive in (by_frames, by_numbers):
            drive.power_on()
            drive.on_frame(CanFrame(0, b"\x01\x03"), Ns(0))
        generator = np.random.default_rng(6040)
        words = (0x00, 0x02, 0x06, 0x07, 0x0F, 0x0F, 0x0F, 0x10F, 0x80)
        for cycle in range(400):
            now = Ns(cycle * 1_000_000)
            word = int(generator.choice(words))
            target, probe = int(generator.integers(-1000, 1000)), int(generator.integers(0, 0x10000))
            rows["velocity"] = generator.integers(0, 2) * 200_000
            rows["demand"] = generator.integers(-1000, 1000)
            if generator.integers(0, 40) == 0:
                rows["fault"] = 0x8611
            by_frames.on_frame(CanFrame(0x203, struct.pack("<Hi", word, target)), now)
            by_frames.on_frame(CanFrame(0x303, struct.pack("<H", probe)), now)
            by_frames.on_frame(CanFrame(0x80), now)
            assert by_numbers.exchange(word, target, probe, now) == by_frames.statusword
            assert rows[0].tobytes() == rows[1].tobytes()
            assert by_numbers.tick(now) == by_frames.tick(now)

    def test_signature(self, drive: Drive, master: Any) -> None:
        assert not drive.cyclic_signature()
        master.nmt.state = "OPERATIONAL"
        assert drive.cyclic_signature()
        master.sdo[0x1800][2].raw = 2
        assert not drive.cyclic_signature()
        master.sdo[0x1800][2].raw = 1
        assert drive.cyclic_signature()
        master.pdo.read()
        mapping = master.tpdo[4]
        mapping.clear()
        mapping.add_variable(0x60FD, 0, 32)
        mapping.save()
        assert not drive.cyclic_signature()
        mapping.add_variable(0x60BB, 0, 32)
        mapping.save()
        assert drive.cyclic_signature()
        master.sdo[0x60D0][1].raw = 5
        assert not drive.cyclic_signature()
        master.sdo[0x60D0][1].raw = 1
        assert drive.cyclic_signature()
        master.sdo[0x1005].raw = 0x81
        assert not drive.cyclic_signature(), "it does not act on the SYNC of the CNC any more"
        master.sdo[0x1005].raw = 0x80
        assert drive.cyclic_signature()
        drive.exchange(0x06, 0, 0, Ns(0))
        drive.exchange(0x0F, 0, 0, Ns(0))
        assert drive.cyclic_signature()
        drive.exchange(0x10F, 0, 0, Ns(0))
        assert not drive.cyclic_signature()


class TestWithTheFollowingErrorLaw:
    """Window and time-out written over SDO, watched by the compiled law, reported by the drive."""

    def cycles_until_fault(self, window: int, timeout_ms: int, error: int) -> int | None:
        rows: Any = np.zeros(1, SERVO)
        drive = servo402.create("Z", NODE_ID, rows[0], {})
        drive.device.values.download(0x6065, 0, struct.pack("<I", window))
        drive.device.values.download(0x6066, 0, struct.pack("<H", timeout_ms))
        for word in (0x06, 0x0F):
            drive.exchange(word, 0, 0, Ns(0))
        rows["following_error"] = error
        for cycle in range(1, 100):
            rows["status_flags"] = 0
            supervise(rows[0], 1_000_000)
            status = drive.exchange(0x0F, 0, 0, Ns(cycle * 1_000_000))
            if state_of(status) is not State.OPERATION_ENABLED:
                return cycle
        return None

    @pytest.mark.parametrize("sign", [-1, 1])
    def test_error_outside_the_window_for_longer_than_the_time_out(self, sign: int) -> None:
        assert self.cycles_until_fault(1_048_575, 10, sign * 1_048_576) == 11
        assert self.cycles_until_fault(1_048_575, 0, sign * 1_048_576) == 1
        assert self.cycles_until_fault(1_048_575, 10, sign * 1_048_575) is None

    @pytest.mark.parametrize("off", [0, 0xFFFFFFFF])
    def test_switched_off(self, off: int) -> None:
        assert self.cycles_until_fault(off, 0, 2_000_000_000) is None
