"""A CiA 402 drive in cyclic synchronous position mode: CANopen on one side, its servo row on the other.

The compiled laws compute with the row; this class moves numbers between row and object dictionary and runs
the state machine. It acts at a SYNC, in this order: stops that came to an end, faults that the law raised,
RPDO data, TPDO samples. A stop begins where the axis is, with the speed that it has, and follows a ramp (see
`ramps`); it is over when the axis stands, at the latest STOP_TIMEOUT behind the end of the ramp (decided here).
Without power the axis coasts.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, Final

from hli_bench.base.errors import InputError
from hli_bench.base.time import NS_PER_S, Ns
from hli_bench.laws.rows import Cells
from hli_bench.protocols.canopen import cia402_objects as objects
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.cia402_objects import ObjectAddress
from hli_bench.protocols.canopen.datatypes import Value, integer_range
from hli_bench.protocols.canopen.device import Device
from hli_bench.protocols.canopen.eds import ObjectDictionary, load
from hli_bench.protocols.canopen.nmt import NmtState
from hli_bench.protocols.canopen.sync import SYNC_COB_ID
from hli_bench.wire.can import CanFrame
from hli_bench_drives.cia402 import telegram
from hli_bench_drives.cia402.faults import Fault, error_register
from hli_bench_drives.cia402.modes import Mode, is_supported
from hli_bench_drives.cia402.options import DriveOptions, FollowingErrorReaction
from hli_bench_drives.cia402.ramps import DISABLE, STAYS, Ramps, number_of
from hli_bench_drives.cia402.states import (
    ENABLE_OPERATION,
    ControlBit,
    State,
    StatusBit,
    Transition,
    next_transition,
    walk,
)
from hli_bench_drives.cia402.touch_probe import ProbeSource, resolve_source

STOP_TIMEOUT: Final = Ns(NS_PER_S)
"""A stop that lasts longer than its ramp by this ends anyway (decided here)."""
STANDSTILL_TURNS_PER_S: Final = 0.01
"""An axis slower than this stands (decided here)."""

_LAW_FLAGS: Final = int(
    StatusBit.TARGET_REACHED | StatusBit.INTERNAL_LIMIT | StatusBit.DRIVE_FOLLOWS | StatusBit.FOLLOWING_ERROR
)
_HALT: Final = int(ControlBit.HALT)
_ALWAYS: Final = int(StatusBit.VOLTAGE_ENABLED | StatusBit.REMOTE)
_POWERED: Final = (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE)
_TORQUE_LIMITS: Final = {
    objects.MAX_TORQUE: "torque_limit_permille",
    objects.POSITIVE_TORQUE_LIMIT: "positive_permille",
    objects.NEGATIVE_TORQUE_LIMIT: "negative_permille",
}
_STOP_OPTIONS: Final = (objects.QUICK_STOP_OPTION, objects.HALT_OPTION, objects.FAULT_REACTION_OPTION)
_SOURCES: Final = (
    (ProbeSource.INPUT_1, ProbeSource.ZERO_PULSE),
    (ProbeSource.INPUT_2, ProbeSource.ZERO_PULSE),
)
_DEFAULT_SOURCES: Final = (int(ProbeSource.INPUT_1), int(ProbeSource.INPUT_2))

_CELLS: Final[Mapping[tuple[int, int], tuple[str, int]]] = {
    objects.TARGET_POSITION: ("target", 0),
    objects.POSITION_DEMAND: ("demand", 0),
    objects.POSITION_DEMAND_INTERNAL: ("demand", 0),
    objects.POSITION_ACTUAL: ("position", 0),
    objects.POSITION_INTERNAL: ("position", 0),
    objects.VELOCITY_ACTUAL: ("velocity", 0),
    objects.FOLLOWING_ERROR: ("following_error", 0),
    objects.TORQUE_ACTUAL: ("torque_permille", 0),
    objects.PROBE_STATUS: ("probe_status", 0),
    objects.DIGITAL_INPUTS: ("digital_inputs", 0),
    objects.ENCODER_INCREMENTS: ("increments_per_turn", 0),
    **{address: ("latch", slot) for slot, address in enumerate(objects.LATCHES)},
    **{address: ("latch_time", slot) for slot, address in enumerate(objects.LATCH_TIMES)},
}
"""Objects that are a number of the row: its name, its element."""

_QUICK_STOP, _RESET_FAULT, _RESUME = 11, 15, 16
_STOP_FIRST: Final = {5: objects.DISABLE_OPERATION_OPTION, 8: objects.SHUTDOWN_OPTION}
"""Transitions whose option 1 brings the axis to a stop before power is cut."""


class Drive:
    """One drive node. `row` is an element of a structured array of dtype SERVO and belongs to this drive."""

    __slots__ = (
        "_deadline",
        "_destination",
        "_fault",
        "_flags",
        "_law_fault",
        "_mode",
        "_now",
        "_options",
        "_probe_function",
        "_probe_word",
        "_ramps",
        "_row",
        "_signature_changes",
        "_signature_default",
        "_sources",
        "_target",
        "_word",
        "device",
        "name",
        "state",
    )

    def __init__(self, name: str, device: Device, row: Any, options: DriveOptions) -> None:
        self.name = name
        self.device = device
        self.state = State.SWITCH_ON_DISABLED
        self._row = row
        self._ramps = Ramps(device.values, row)
        cells = Cells(row)
        self._target = cells("target")
        self._probe_function = cells("probe_function")
        self._flags = cells("status_flags")
        self._law_fault = cells("fault")
        self._options = options
        self._now = Ns(0)
        self._signature_changes = -1
        self._signature_default = False
        self._hook_reads(cells)
        self._hook_writes()
        self._start()
        device.attach(self)

    @property
    def node_id(self) -> int:
        """The CANopen node id."""
        return self.device.node_id

    @property
    def statusword(self) -> int:
        """Object 0x6041: state, voltage and remote, and the bits that the law computes."""
        return int(self.state) | _ALWAYS | (self._flags[0] & _LAW_FLAGS)

    @property
    def holding(self) -> bool:
        """Whether the drive stands on its demand instead of following the target."""
        if self.state is State.OPERATION_ENABLED:
            halted = bool(self._word & _HALT) or self._mode != Mode.CYCLIC_SYNC_POSITION
            return halted or self._destination is not None
        stopping = self.state in (State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE)
        return stopping or self._destination is not None

    def power_on(self) -> list[CanFrame]:
        """Boot the node."""
        return self.device.power_on()

    def step(self, now: Ns, inbox: Iterable[CanFrame]) -> list[CanFrame]:
        """Take the frames of an instant and return what the drive sends at it."""
        frames = [answer for frame in inbox for answer in self.on_frame(frame, now)]
        return frames + self.tick(now)

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Take one frame, SYNC included."""
        self._now = now
        return self.device.on_frame(frame, now)

    def hears(self) -> frozenset[int]:
        """Return the identifiers of the frames that it may act on."""
        return self.device.hears()

    def tick(self, now: Ns) -> list[CanFrame]:
        """Return what is due by time or event."""
        self._now = now
        return self.device.tick(now)

    def next_due(self, now: Ns) -> Ns | None:
        """Return when `tick` has something to do at the latest."""
        return self.device.next_due(now)

    def cyclic_signature(self) -> bool:
        """Whether numbers may pass between rows without frames.

        True while the node is OPERATIONAL with the telegram for one of its probing inputs at the usual SYNC,
        follows its target and takes touch probe functions as they come.
        """
        changes = self.device.pdos.changes
        if changes != self._signature_changes:
            self._signature_changes = changes
            configured = self.device.pdos.signature
            inputs = [one for one in (0, 1) if configured == telegram.signature(self.node_id, one)]
            self._signature_default = bool(inputs)
            self._row["telegram_input"] = inputs[0] if inputs else 0
        return (
            self.device.nmt.state is NmtState.OPERATIONAL
            and self.device.sync_cob_id == SYNC_COB_ID
            and self._signature_default
            and not self.holding
            and self._sources == _DEFAULT_SOURCES
        )

    def exchange(self, controlword: int, target: int, probe_function: int, now: Ns) -> int:
        """Act at a SYNC as on the default RPDOs with these numbers, without frames; return the statusword."""
        self.on_sync(now)
        self._write_controlword(controlword)
        self._write_target(target)
        self._write_probe_function(probe_function)
        return self.statusword

    def fault(self, code: int) -> None:
        """Let an error happen: EMCY, 0x603F and the reaction of 0x605E. A second one changes nothing."""
        if self.state in {State.FAULT_REACTION_ACTIVE, State.FAULT}:
            return
        self._fault = code
        self._show_error(code)
        self.device.emcy.occur(code, error_register(code))
        option = self._option(objects.FAULT_REACTION_OPTION)
        if option != DISABLE and self.state in _POWERED:
            self._enter(State.FAULT_REACTION_ACTIVE)
            self._stop(State.FAULT, option)
        else:
            self._enter(State.FAULT)

    def on_sync(self, now: Ns) -> None:
        """End a stop that is over, take the law's fault. Every stop is seen for a SYNC at least."""
        self._now = now
        if self._destination is not None and (self._stands() or now >= self._deadline):
            self._enter(self._destination)
        code = self._law_fault[0]
        if code == Fault.FOLLOWING_ERROR and self._options.following_error is FollowingErrorReaction.STATUS:
            self._law_fault[0] = 0
        elif code:
            self.fault(code)

    def on_reset(self) -> None:
        """Start as after power-on, with the dictionary's power-on values."""
        self._start()

    def on_nmt(self, state: NmtState) -> None:
        """Treat the end of OPERATIONAL as the loss of the connection."""
        if state is not NmtState.OPERATIONAL:
            self.on_connection_lost()

    def on_connection_lost(self) -> None:
        """React as 0x6007 says when power is on: 0 nothing, 1 fault, 2 disable voltage, 3 quick stop."""
        if self.state not in _POWERED:
            return
        match self._option(objects.ABORT_CONNECTION_OPTION):
            case 1:
                self.fault(Fault.COMMUNICATION)
            case 2:
                self._enter(State.SWITCH_ON_DISABLED)
            case 3 if self.state is State.OPERATION_ENABLED:
                self._quick_stop()
            case _:
                pass

    def _start(self) -> None:
        """Take the state and the numbers that the drive has after power-on."""
        self._word = 0
        self._fault = 0
        self._probe_word = 0
        self._destination: State | None = None
        self._deadline = Ns(0)
        row = self._row
        self._mode = int(self._stored(objects.MODE))
        self._ramps.let_go()
        first, second = (self._stored(address) for address in objects.PROBE_SOURCES)
        self._sources = (first, second)
        row["fault"] = 0
        row["target"] = self._stored(objects.TARGET_POSITION)
        row["following_window"] = self._stored(objects.FOLLOWING_WINDOW)
        row["following_timeout_ms"] = self._stored(objects.FOLLOWING_TIMEOUT)
        for address, number in _TORQUE_LIMITS.items():
            self._limit_torque(number, self._stored(address))
        self._write_probe_function(self._stored(objects.PROBE_FUNCTION))
        self._enter(State.SWITCH_ON_DISABLED)

    def _stored(self, address: ObjectAddress) -> int:
        """Return the number that is stored for an object, or how the profile lets one act that is not there."""
        values = self.device.values
        number = values.stored(*address) if values.has(*address) else objects.ABSENT.get(address, 0)
        return int(number)

    def _hook_reads(self, cells: Cells) -> None:
        """Let the objects of the machine's numbers answer from the row."""
        values = self.device.values
        present = [address for address in _CELLS if values.has(*address)]
        values.on_read_made(present, lambda address: partial(cells(*_CELLS[address]).__getitem__, 0))
        computed: dict[ObjectAddress, Callable[[], Value]] = {
            objects.STATUSWORD: lambda: self.statusword,
            objects.CONTROLWORD: lambda: self._word,
            objects.PROBE_FUNCTION: self._read_probe_function,
            objects.MODE_DISPLAY: lambda: self._mode,
            objects.RATED_TORQUE: lambda: round(float(self._row["rated_torque"]) * 1000.0),
        }
        modes = objects.SUPPORTED_MODES
        if values.has(*modes) and values.description[modes].default is None:
            computed[modes] = lambda: objects.ABSENT[modes]
        for address, source in computed.items():
            if values.has(*address):
                values.on_read(*address, source)

    def _hook_writes(self) -> None:
        """Let writes from the bus reach the row and the state machine."""
        row = self._row
        sinks: dict[tuple[int, int], Callable[[Value], None]] = {
            objects.CONTROLWORD: self._write_controlword,
            objects.TARGET_POSITION: self._write_target,
            objects.PROBE_FUNCTION: self._write_probe_function,
            objects.MODE: self._write_mode,
            objects.FOLLOWING_WINDOW: partial(row.__setitem__, "following_window"),
            objects.FOLLOWING_TIMEOUT: partial(row.__setitem__, "following_timeout_ms"),
        }
        sinks |= {address: partial(self._limit_torque, number) for address, number in _TORQUE_LIMITS.items()}
        sinks |= dict.fromkeys(_STOP_OPTIONS, self._write_option)
        for slot, address in enumerate(objects.PROBE_SOURCES):
            sinks[address] = partial(self._write_source, slot)
        values = self.device.values
        values.on_writes({address: sink for address, sink in sinks.items() if values.has(*address)})

    def _write_controlword(self, value: Value) -> None:
        """Run the state machine; the same word again changes nothing."""
        word, before = int(value), self._word
        if word == before and next_transition(self.state, word, word) is None:
            return
        self._word = word
        if self.state is State.OPERATION_ENABLED and word & ENABLE_OPERATION == ENABLE_OPERATION:
            self._destination = None
        for row in walk(self.state, word, before):
            if row.number == _RESUME and self._option(objects.QUICK_STOP_OPTION) < STAYS:
                break
            self._take(row)
        self._hold_or_follow()

    def _take(self, row: Transition) -> None:
        """Make a transition, or begin the stop that comes before it."""
        option = _STOP_FIRST.get(row.number)
        if row.number == _QUICK_STOP:
            self._quick_stop()
        elif option is not None and self._option(option) != DISABLE:
            self._stop(row.target, self._option(option))
        else:
            if row.number == _RESET_FAULT:
                self._reset_fault()
            self._enter(row.target)

    def _quick_stop(self) -> None:
        """Stop; by 0x605A at once without power (0), then without power (1..4), or staying so (5..8)."""
        option = self._option(objects.QUICK_STOP_OPTION)
        if option == DISABLE:
            self._enter(State.SWITCH_ON_DISABLED)
            return
        self._enter(State.QUICK_STOP_ACTIVE)
        if option < STAYS:
            self._stop(State.SWITCH_ON_DISABLED, option)
        else:
            self._ramps.begin(option)

    def _show_error(self, code: int) -> None:
        if self.device.values.has(*objects.ERROR_CODE):
            self.device.values.put(*objects.ERROR_CODE, code)

    def _reset_fault(self) -> None:
        """Clear the fault; one whose cause persists comes back from the law."""
        self._row["fault"] = 0
        self._row["following_elapsed_ns"] = 0
        self._show_error(0)
        self.device.emcy.recover(self._fault)
        self._fault = 0

    def _enter(self, state: State) -> None:
        """Enter a state. Operation begins with a set point and a target where the axis is."""
        powered = state in _POWERED
        if state is State.OPERATION_ENABLED:
            self._ramps.stand()
        self.state = state
        self._destination = None
        self._row["enabled"] = powered
        if not powered:
            self._ramps.let_go()

    def _stop(self, destination: State, option: int) -> None:
        """Come to a stop as an option code says, then enter `destination`."""
        if self._destination is not destination:
            self._destination = destination
            self._deadline = Ns(self._now + self._ramps.begin(option) + STOP_TIMEOUT)

    def _hold_or_follow(self) -> None:
        """Begin to halt, or to follow the target again."""
        if self.state is not State.OPERATION_ENABLED:
            return
        if not self.holding:
            self._ramps.let_go()
        elif not self._ramps.held:
            self._ramps.begin(self._option(objects.HALT_OPTION))

    def _stands(self) -> bool:
        return abs(int(self._row["velocity"])) <= STANDSTILL_TURNS_PER_S * float(
            self._row["increments_per_turn"]
        )

    def _write_target(self, value: Value) -> None:
        """Take a target; while the drive holds it does not follow."""
        self._target[0] = int(value)

    def _write_mode(self, value: Value) -> None:
        """Change the mode; 0 leaves it as it is."""
        mode = int(value)
        if mode == Mode.NONE:
            return
        if not is_supported(mode, self._option(objects.SUPPORTED_MODES)):
            raise SdoAbort(AbortCode.RANGE)
        self._mode = mode
        self._hold_or_follow()

    def _limit_torque(self, number: str, value: Value) -> None:
        """Clamp both directions (0x6072), positive (0x60E0) or negative torque (0x60E1), to the peak at the most."""
        self._row[number] = min(abs(int(value)), float(self._row["peak_permille"]))

    def _write_option(self, value: Value) -> None:
        """Take a way to stop that is built."""
        if not self._ramps.is_built(int(value)):
            raise SdoAbort(AbortCode.RANGE)

    def _write_probe_function(self, value: Value) -> None:
        self._probe_word = int(value)
        self._probe_function[0] = resolve_source(self._probe_word, self._sources)

    def _read_probe_function(self) -> int:
        """Return the word as written, or what came row to row since."""
        present = self._probe_function[0]
        as_written = present == resolve_source(self._probe_word, self._sources)
        return self._probe_word if as_written else present

    def _write_source(self, slot: int, value: Value) -> None:
        """Take a source for one touch probe: its own input or the zero pulse, more is not wired."""
        if value not in _SOURCES[slot]:
            raise SdoAbort(AbortCode.RANGE)
        first, second = self._sources
        self._sources = (int(value), second) if slot == 0 else (first, int(value))
        self._probe_function[0] = resolve_source(self._probe_word, self._sources)

    def _option(self, address: ObjectAddress) -> int:
        """Return the present value of an object; one that the dictionary lacks acts by the profile."""
        return number_of(self.device.values, address)


def create(name: str, node_id: int, eds_path: Path, row: Any, options: Mapping[str, object]) -> Drive:
    """Build the drive `name` from its EDS on its servo row. Raises InputError for a bad EDS or option."""
    checked = DriveOptions.from_mapping(options, name)
    description = load(eds_path)
    _check(description, eds_path)
    try:
        return Drive(name, Device(description, node_id), row, checked)
    except InputError as error:
        raise InputError(error.message, file=str(eds_path)) from error
    except (SdoAbort, TypeError) as error:
        # an object that the device is built on is of another kind than the standard's, or half there
        raise InputError(f"its objects make no CANopen device: {error}", file=str(eds_path)) from error


@lru_cache(maxsize=64)
def _check(description: ObjectDictionary, eds_path: Path) -> None:
    """Raise InputError when an EDS lacks what a drive cannot do without, or has it as something else."""
    needed = (*objects.NEEDED, *objects.CYCLIC)
    if lacking := objects.lacking(description.entries, needed):
        raise InputError(f"a CiA 402 drive needs the objects {', '.join(lacking)}", file=str(eds_path))
    numbers = [address for address in (*needed, *objects.ABSENT) if address in description]
    wrong = [one for one in numbers if integer_range(description[one].data_type) is None]
    if wrong:
        named = ", ".join(f"{one.object_index:04X}:{one.subindex:02X}" for one in wrong)
        raise InputError(f"a CiA 402 drive needs integers in the objects {named}", file=str(eds_path))
