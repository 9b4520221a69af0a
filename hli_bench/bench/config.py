"""What a machine is built from: axes, PLC tasks, faults and the whole as frozen records."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from hli_bench.base.errors import InputError
from hli_bench.base.ids import AxisIndex, AxisNumber, NodeId
from hli_bench.base.time import NS_PER_US, Ns
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.drive_types import AxisType
from hli_bench.manual.lists import Finding, Severity
from hli_bench.plant.settings import PlantSettings
from hli_bench.terminals.settings import Channel, TerminalSettings
from hli_bench.terminals.terminal import type_of

SUB_STEP_US: Final = 125
"""Sub-step of servo and mechanics, decided here."""
AxisKind = Literal["T", "R", "S"]
KIND_LETTERS: Final[Mapping[AxisType, AxisKind]] = {
    AxisType.TRANSLATOR: "T",
    AxisType.ROTATOR: "R",
    AxisType.SPINDEL: "S",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisConfig:
    """One axis, in row order: who it is, its drive, where it stands, its parameters."""

    index: AxisIndex
    name: str
    number: AxisNumber
    node_id: NodeId
    drive: str
    following_error: str | None
    start_mm: float
    params: AxisParams

    @property
    def kind(self) -> AxisKind:
        """T (linear), R (rotary) or S (spindle)."""
        return KIND_LETTERS[self.params.kenngr.achs_typ]


@dataclass(frozen=True, slots=True)
class PlcConfig:
    """One PLC task; `period_us` None: what the script says; `process`: it runs in a process of its own."""

    name: str
    script: Path
    period_us: int | None
    process: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultConfig:
    """One scheduled fault; `until_ns` None: to the end of the run."""

    kind: str
    target: str
    at_ns: Ns
    until_ns: Ns | None
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineConfig:
    """A machine as it is to be built. `notes`: what is to be said of lists that were accepted."""

    name: str
    folder: Path
    cycle_us: int
    dc_epoch_ns: Ns
    seed: int
    channel: ChannelParams
    axes: tuple[AxisConfig, ...]
    plant: PlantSettings
    terminals: tuple[TerminalSettings, ...]
    plcs: tuple[PlcConfig, ...]
    faults: tuple[FaultConfig, ...]
    notes: tuple[Finding, ...]

    @property
    def cycle_ns(self) -> int:
        """The cycle in ns."""
        return self.cycle_us * NS_PER_US

    @property
    def sub_steps(self) -> int:
        """How many sub-steps the servo and the mechanics take in a cycle."""
        return self.cycle_us // SUB_STEP_US

    def channels(self) -> tuple[Channel, ...]:
        """Return the inputs of all terminals, in the order of their rows."""
        return tuple(channel for one in self.terminals for channel in type_of(one).channels(one))

    def remarks(self) -> Iterator[str]:
        """Yield what people are told of the lists: each warning, and in one line what changes nothing."""
        unused = []
        for note in self.notes:
            if note.severity is Severity.WARNING:
                yield f"warning: {note}"
            else:
                path, _, _ = note.message.partition(":")
                unused.append(f"{path} ({note.place()})")
        if unused:
            yield f"note: given, and nothing in this bench uses it: {', '.join(unused)}"

    def axis(self, name: str) -> AxisConfig:
        """Return the axis of that name. Raises InputError when there is none."""
        for axis in self.axes:
            if axis.name == name:
                return axis
        raise InputError(f"{name!r} is not an axis of {self.name} ({', '.join(a.name for a in self.axes)})")
