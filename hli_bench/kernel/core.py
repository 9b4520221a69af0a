"""What the stages of the kernel share: setup, rows, conditions, path, the HLI's units, and the way out."""

from dataclasses import dataclass, field

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.path_interpolator import Path
from hli_bench.kernel.path_preparation.preparation import Preparation
from hli_bench.kernel.records import CncError, Emitted
from hli_bench.kernel.setup import AxisSetup, KernelSetup
from hli_bench.kernel.watches import Watches, room
from hli_bench.laws.rows import JOG, PATH, KernelRows, Rows
from hli_bench.manual.errors import ErrorSheet, ReactionClass, Severity
from hli_bench.manual.errors.record import BLOCK_NUMBER, DRIVE_STATUS, DRIVE_TYPE
from hli_bench.protocols.hli.control_unit import ControlUnit, ControlUnits
from hli_bench.protocols.hli.image import Image
from hli_bench.wire.can import CanFrame


@dataclass(slots=True)
class Core:
    """State that every stage may see; `cycle` is the kernel cycle being worked on."""

    setup: KernelSetup
    image: Image
    units: ControlUnits
    rows: KernelRows
    watches: Watches
    path: Path
    preparation: Preparation
    cycle: int = 0
    emitted: list[Emitted] = field(default_factory=list)
    frames: list[CanFrame] = field(default_factory=list)
    referenced: list[bool] = field(default_factory=list)
    starting: set[AxisIndex] = field(default_factory=set)
    """Axes whose drives are on their way into operation."""
    disarmed: dict[AxisIndex, int] = field(default_factory=dict)
    """Cycle in which an axis' latch control word was cleared last."""
    faults: list[tuple[ReactionClass, AxisIndex | None]] = field(default_factory=list)
    """Reaction class and axis of the errors whose reaction is still to come."""
    stopping: int = 0
    """How hard the axes have been stopped since the last program start, see `reactions.Stop`."""
    failed: bool = False
    """An error (not a warning) has been emitted since the last program start or reset."""

    @classmethod
    def build(cls, setup: KernelSetup, image: Image, units: ControlUnits) -> "Core":
        """Return the core of a kernel that has not run a cycle yet."""
        rows = KernelRows.allocate(len(setup.axes), room(len(setup.axes)))
        for axis in setup.axes:
            rows.axis[axis.index]["increments_per_unit"] = axis.increments_per_unit
        return cls(
            setup=setup,
            image=image,
            units=units,
            rows=rows,
            watches=Watches(rows.watch),
            path=Path(rows),
            preparation=Preparation(setup, rows),
            referenced=[axis.params.kenngr.abs_pos_gueltig for axis in setup.axes],
        )

    @property
    def now(self) -> Ns:
        """Instant of this cycle, ns since bench start."""
        return Ns(self.cycle * self.setup.cycle_ns)

    @property
    def dc_now(self) -> Ns:
        """DC time of this cycle."""
        return Ns(self.setup.dc_epoch_ns + self.now)

    @property
    def self_moving(self) -> list[AxisIndex]:
        """Axes that move by themselves (homing), not on the path."""
        row = self.rows.axis
        return [
            axis.index
            for axis in self.setup.axes
            if row[axis.index]["mode"] == JOG and row[axis.index]["velocity"]
        ]

    @property
    def at_rest(self) -> bool:
        """No set point moves."""
        return self.path.idle and not self.self_moving

    def forgive(self) -> None:
        """Forget the errors: a program begins, or the CNC is reset."""
        self.failed = False
        self.faults.clear()
        self.stopping = 0

    def take_back(self) -> None:
        """Give axes whose own motion was broken off (homing) back to the path; they stand."""
        mode = self.rows.axis["mode"]
        mode[mode == JOG] = PATH

    def axis(self, index: AxisIndex) -> AxisSetup:
        """Return the setup of an axis."""
        return self.setup.axes[index]

    def row(self, index: AxisIndex) -> Rows:
        """Return the row of an axis (a view)."""
        return self.rows.axis[index]  # type: ignore[no-any-return]

    def unit(self, index: AxisIndex, name: str) -> ControlUnit:
        """Return a control unit of an axis, e.g. `lr_mc_control/probing_signal`."""
        return self.units[f"ax/{self.axis(index).number}/{name}"]

    def show(self, index: AxisIndex, name: str, value: int) -> None:
        """Write a status element of an axis, e.g. `lr_state/measurement_active_r`."""
        path = f"ax/{self.axis(index).number}/{name}"
        self.image.set(self.image.layout.element(path).id, value)

    def _known(self, source: Source, axis: AxisIndex | None) -> dict[str, float | str]:
        """Return the values that a message about this block and axis can be filled with."""
        known: dict[str, float | str] = {BLOCK_NUMBER: source.name} if source.name else {}
        if axis is not None:
            known[DRIVE_TYPE] = int(self.axis(axis).params.kenngr.antr_typ)
            known[DRIVE_STATUS] = int(self.row(axis)["statusword"])
        return known

    def report(
        self,
        sheet: ErrorSheet,
        source: Source,
        *values: float | str,
        axis: AxisIndex | None = None,
        cause: str = "",
    ) -> None:
        """Emit an error or warning of the CNC; `values` in the order of the sheet, without what is known here.

        `cause` is what the bench knows beyond the message of the CNC.
        """
        named = sheet.named(values, self._known(source, axis))
        error = CncError(
            number=sheet.number,
            severity=sheet.severity,
            text=sheet.message_of(named) + (f": {cause}" if cause else ""),
            source=source,
            axis=self.axis(axis).name if axis is not None else "",
            values=named,
        )
        self.take(error, sheet.reaction_class, axis)

    def take(self, error: CncError, reaction: ReactionClass, axis: AxisIndex | None = None) -> None:
        """Emit an error or warning that has been made; an error is reacted to in this cycle."""
        self.emitted.append(error)
        if error.severity == Severity.ERROR:
            self.failed = True
            self.faults.append((reaction, axis))
