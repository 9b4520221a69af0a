"""The kernel as one node: the order of its cycle, and the only place that brings the stages together."""

from collections.abc import Iterable
from contextlib import suppress

import numpy as np

from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import mm
from hli_bench.kernel.blocks import Source
from hli_bench.kernel.channel import Channel
from hli_bench.kernel.core import Core
from hli_bench.kernel.decoder import WITHOUT_MOTION, Decoder, DecoderAxis, DecoderDefaults
from hli_bench.kernel.drive_manager.manager import DriveManager
from hli_bench.kernel.error_records import ErrorRecords
from hli_bench.kernel.hindrances import holding, in_vain, unheard
from hli_bench.kernel.monitoring import Monitoring
from hli_bench.kernel.reactions import Stop, react
from hli_bench.kernel.records import CncError, Emitted
from hli_bench.kernel.setup import KernelSetup
from hli_bench.laws.rows import KernelRows
from hli_bench.manual.errors import hli as hli_errors
from hli_bench.protocols.hli.control_unit import ControlUnit, ControlUnits
from hli_bench.protocols.hli.image import Image, Value
from hli_bench.protocols.hli.layout import layout_of
from hli_bench.wire.can import CanFrame

_TYPE_NUMBER = {"T": 1, "R": 2, "S": 4}
_LAYOUT_KIND = {"T": "linear", "R": "rotary", "S": "spindle"}
FULL_OVERRIDE = 1000
AUTOMATIC = 2
"""The mode in which programs run."""
READY, ACTIVE, HELD, ERROR = 3, 4, 5, 6
"""States of the channel."""
DEFAULTS = {"release_feedhold": True, "override": FULL_OVERRIDE, "override_feedrate": FULL_OVERRIDE}
"""What holds while no PLC commands it, by the last part of a unit's path."""


class Kernel:
    """The emulated CNC. Between `sense` and `act` of a cycle the bench calls `decide`, when there is a reason to."""

    def __init__(self, setup: KernelSetup) -> None:
        self.setup = setup
        axes = [(axis.number, axis.name, _LAYOUT_KIND[axis.kind]) for axis in setup.axes]
        self.image = Image(layout_of(tuple(axes)))
        units = ControlUnits(self.image, DEFAULTS)
        self.core = Core.build(setup, self.image, units)
        self._monitoring = Monitoring(self.core)
        self.drives = DriveManager(self.core, self._monitoring)
        self.channel = Channel(self.core, self.drives.objects, self._monitoring)
        self.failure: Exception | None = None
        """What went wrong in a cycle that is none of the CNC's errors: bad NC text, something not built, a fault."""
        layout = self.image.layout
        areas = [f"ax/{axis.number}" for axis in setup.axes]
        shown = [f"{area}/lr_state/active_position_acs_r" for area in areas]
        shown += [f"{area}/head/error_r" for area in areas] + ["ch/1/bahn_state/block_nr_r"]
        offsets = np.array([layout.element(path).offset for path in shown])
        self.shown = np.frombuffer(self.image.data, np.uint8), offsets
        """Bytes of the HLI image, and where in it stands what the laws keep up to date (`laws.publish`)."""
        self._held = False
        """Feedhold of the channel is in effect."""
        self._errors = ErrorRecords(self.core)
        self._mode = layout.group("ch/1/channel_mc_control/mode_and_state/state_r").ids
        self._seen: tuple[object, ...] = ()
        self.image.set(self._mode["mode"], AUTOMATIC)
        self._show_state()
        self._show_heads()

    @property
    def rows(self) -> KernelRows:
        """The kernel's rows, for the compiled laws."""
        return self.core.rows

    def start(self, lines: Iterable[str], name: str, without_motion: int = WITHOUT_MOTION) -> None:
        """Begin an NC program. Usage errors of its text come out of `decide`.

        For so many blocks without motion in a row a cycle passes.
        """
        axes = [
            DecoderAxis(axis.index, axis.name, axis.number, axis.kind, axis.params.kenngr.messachse)
            for axis in self.setup.axes
        ]
        decoder = Decoder(lines, name, axes, DecoderDefaults(self.setup.channel.messtyp), without_motion)
        self.channel.start(decoder)
        self._show_state()

    def decide(self) -> None:
        """Decide what comes next: called between `sense` and `act`, `core.cycle` being the cycle.

        Nothing raises out of it but an interrupt: what goes wrong is kept in `failure`, and the axes brake.
        """
        try:
            self._go_on()
        except BaseException as error:
            self._break_off(error)
            if not isinstance(error, Exception):
                raise
        finally:
            if self.core.failed:
                self._wind_up()
            self._errors.step()
            self._show_state()

    def _go_on(self) -> None:
        for unit in self.core.units.sample():
            self._unit_changed(unit)
        self._monitoring.check(self.channel.source)
        self.drives.step(self.channel.source)
        self.channel.step()
        self.drives.serve_objects()

    def _break_off(self, error: BaseException) -> None:
        """Something raised: leave nothing behind of what was under way. Its own clean-up may be what has failed."""
        core = self.core
        core.failed = True
        if self.failure is None and isinstance(error, Exception):
            self.failure = error
        with suppress(Exception):
            self.channel.break_off()
        core.rows.axis["probe_function"] = 0
        for axis in self.setup.axes:
            core.show(axis.index, "lr_state/measurement_active_r", False)
        react(core, Stop.FEEDHOLD)

    def _wind_up(self) -> None:
        """Errors act in the cycle in which they come, whoever reported them; then the program ends."""
        core = self.core
        try:
            broken = self.channel.break_off()
        except Exception as error:
            self._break_off(error)
            broken = True
        react(core, Stop.FEEDHOLD if broken else Stop.NONE)
        self.channel.wind_up(run_out=core.stopping <= Stop.RUN_OUT)

    def take_failure(self) -> Exception | None:
        """Return what went wrong in a cycle that is none of the CNC's errors, once."""
        failure, self.failure = self.failure, None
        return failure

    def begin_cycle(self, cycle: int) -> None:
        """Tell the kernel which cycle it is in."""
        self.core.cycle = cycle

    def take_orders(self) -> list[CanFrame]:
        """Return NMT and SDO frames to be sent in this cycle."""
        frames, self.core.frames = self.core.frames, []
        return frames

    def take_emitted(self) -> list[Emitted]:
        """Return what was emitted since the last call."""
        emitted, self.core.emitted = self.core.emitted, []
        for record in emitted:
            if isinstance(record, CncError):
                self._errors.take(record)
        return emitted

    def reset(self) -> None:
        """CNC reset: end the program, clear errors, bring drives that dropped out back into operation."""
        try:
            self.channel.break_off()
        except Exception as error:
            self._break_off(error)
        react(self.core, Stop.FEEDHOLD)
        self.channel.end()
        self.core.forgive()
        for axis in self.setup.axes:
            self.core.show(axis.index, "head/error_r", False)
        self.drives.reset()

    def plc_lost(self, name: str) -> None:
        """A PLC has gone or frozen: the CNC reacts as to a PLC stop, the program ends with an error."""
        if self.channel.running:
            self.core.report(hli_errors.PLC_STOPPED, self.channel.source, name)

    def position_mm(self, axis: AxisIndex) -> float:
        """Return the actual position of an axis in mm (degrees), in whole 0.1 um as the HLI shows it."""
        return mm(round(float(self.core.row(axis)["actual"])))

    def holding(self) -> list[str]:
        """Return the elements that make commanded motion stand."""
        return holding(self.core)

    def unheard(self) -> list[str]:
        """Return the enabled control units whose commands count for nothing, with the reason."""
        return unheard(self.core)

    def in_vain(self, member: str) -> str:
        """Return why what a PLC has just written to a member counts for nothing, "" when it does count."""
        return in_vain(self.core, member)

    @property
    def source(self) -> Source:
        """The block in execution."""
        return self.channel.source

    def _unit_changed(self, unit: ControlUnit) -> None:
        """A PLC changed a unit: act, acknowledge what is in effect; some are asked by who needs them."""
        area, number, name = unit.path.split("/", 2)
        if area == "ch":
            unit.acknowledge(self._channel_unit_changed(name, unit))
        else:
            index = next(axis.index for axis in self.setup.axes if axis.number == int(number))
            unit.acknowledge(self._axis_unit_changed(index, name, unit))

    def _axis_unit_changed(self, index: AxisIndex, name: str, unit: ControlUnit) -> Value:
        """Act; return what is in effect now. The override of an axis acts in none of its motions that are built."""
        core = self.core
        if name in ("lr_mc_control/release_feedhold", "ipo_mc_control/feedhold"):
            released = core.unit(index, "lr_mc_control/release_feedhold").effective
            held = core.unit(index, "ipo_mc_control/feedhold").effective
            core.row(index)["released"] = bool(released) and not held
        elif name == "lr_mc_control/probing_signal":
            core.show(index, "lr_state/probe_actuated_r", unit.redirected and bool(unit.effective))
        elif name == "lr_mc_control/reference_cam":
            return unit.effective if not core.axis(index).params.lr_hw[0].cam_direct_access else False
        elif name == "ipo_mc_control/override":
            return FULL_OVERRIDE
        elif name == "ipo_mc_control/override_valid":
            return False
        return unit.effective

    def _channel_unit_changed(self, name: str, unit: ControlUnit) -> Value:
        """Act; return what is in effect now."""
        if name == "bahn_mc_control/feedhold":
            self._held = bool(unit.effective)
            self.core.path.hold(on=self._held)
        elif name == "bahn_mc_control/delete_distance_to_go":
            return self.channel.delete_distance_to_go(on=bool(unit.effective))
        elif name == "bahn_mc_control/override_feedrate":
            value = min(int(unit.effective), self.setup.channel.max_vb_override)
            self.core.path.override(value / FULL_OVERRIDE)
            return value
        return unit.effective

    def _show_state(self) -> None:
        """Show state and block of the channel, when they have changed."""
        channel, failed = self.channel, self.core.failed
        seen = (channel.running, failed, self._held, channel.standing)
        if seen == self._seen:
            return
        self._seen = seen
        active = HELD if self._held else ACTIVE
        state = ERROR if failed else active if channel.running else READY
        self.image.set(self._mode["state"], state)
        self.core.rows.path[0]["block"] = channel.standing.value if channel.running else 0

    def _show_heads(self) -> None:
        for axis in self.setup.axes:
            core = self.core
            core.show(axis.index, "head/log_ax_n_r", axis.number)
            core.show(axis.index, "head/axis_type_r", _TYPE_NUMBER[axis.kind])
            core.show(axis.index, "lr_state/drive_type_r", int(axis.params.kenngr.antr_typ))
            core.show(axis.index, "lr_state/homing_done_r", core.referenced[axis.index])
