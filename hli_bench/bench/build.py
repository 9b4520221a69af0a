"""A machine's configuration becomes nodes: kernel, drives, plant, terminals."""

from typing import Any

from hli_bench.base.errors import InputError
from hli_bench.bench.config import AxisConfig, MachineConfig
from hli_bench.bench.drive_models import drive_model, eds_of
from hli_bench.kernel.cycle import Kernel
from hli_bench.kernel.setup import AxisSetup, KernelSetup
from hli_bench.laws.rows import Rows
from hli_bench.manual.axis.fallbacks import effective_signal
from hli_bench.manual.axis.words import ProbingSignal
from hli_bench.plant import build as plant
from hli_bench.protocols.canopen.eds import load
from hli_bench.protocols.canopen.telegram import ALL_BASES, MOTION, PROBE, mapped
from hli_bench.runtime.machine_side import DriveNode, Forced, MachineSide
from hli_bench.terminals.terminal import Terminal, type_of
from hli_bench.wire.images import TerminalLayout


def kernel(config: MachineConfig) -> Kernel:
    """Return the CNC of a machine."""
    axes = [
        AxisSetup(
            index=axis.index,
            number=axis.number,
            node=axis.node_id,
            name=axis.name,
            kind=axis.kind,
            params=axis.params,
            telegrams=_telegrams(axis),
        )
        for axis in config.axes
    ]
    return Kernel(
        KernelSetup(
            axes=axes, channel=config.channel, cycle_ns=config.cycle_ns, dc_epoch_ns=config.dc_epoch_ns
        )
    )


def _telegrams(axis: AxisConfig) -> frozenset[int]:
    """Return what an axis' drive sends, as its EDS says. Raises InputError when that is not enough for the axis."""
    key = f"axis.{axis.name}"
    try:
        eds = eds_of(drive_model(axis.drive))
        found = ALL_BASES if eds is None else mapped(load(eds))
    except InputError as error:
        raise InputError(f"{key}.drive: {error}") from error
    if MOTION not in found:
        raise InputError(
            f"{key}.drive: {eds} does not map status word and actual position to its first telegram"
        )
    if effective_signal(axis.params.kenngr) is ProbingSignal.DRIVE and PROBE not in found:
        raise InputError(
            f"{key}.kenngr.measure.signal: DRIVE is not possible, {eds} does not map touch probe status and latch "
            "(60B9, 60BA) to its second telegram"
        )
    return found


def machine_side(config: MachineConfig, axis_rows: Rows) -> MachineSide:
    """Return drives, plant and terminals of a machine, all in one process; `axis_rows` hold the telegrams."""
    built = plant.build(config.plant, config.channels())
    return MachineSide(
        rows=built.rows,
        axis=axis_rows,
        pending=built.pending,
        drives=drives(config, built.rows.servo),
        terminals=terminals(config, built.rows.channel),
        signals=built.signals.names,
        cycle_ns=config.cycle_ns,
        sub_steps=config.sub_steps,
        dc_epoch_ns=config.dc_epoch_ns,
        forced=forced(config),
    )


def drives(config: MachineConfig, servo: Rows) -> list[DriveNode]:
    """Return the drives of a machine on their rows. Raises InputError that names whose model is wrong."""
    built: list[DriveNode] = []
    for axis in config.axes:
        options = {} if axis.following_error is None else {"following_error": axis.following_error}
        try:
            model = drive_model(axis.drive)
            built.append(model.create(axis.name, axis.node_id, servo[axis.index], options))
        except InputError as error:
            raise InputError(f"axis.{axis.name}.drive: {error}") from error
    return built


def forced(config: MachineConfig) -> list[Forced]:
    """Return the stuck signals that `fault[]` schedules."""
    found: list[Forced] = []
    for fault in config.faults:
        found.append(Forced(fault.at_ns, fault.target, int(fault.value)))
        if fault.until_ns is not None:
            found.append(Forced(fault.until_ns, fault.target, None))
    return found


def terminals(config: MachineConfig, channels: Any) -> list[Terminal]:
    """Return the terminals on their rows."""
    built: list[Terminal] = []
    first = 0
    for settings in config.terminals:
        built.append(Terminal(settings, channels, first, config.cycle_ns))
        first += len(type_of(settings).channels(settings))
    return built


def terminal_layouts(config: MachineConfig) -> list[TerminalLayout]:
    """Return where the entries of each terminal lie in its image."""
    return [type_of(settings).layout(settings) for settings in config.terminals]
