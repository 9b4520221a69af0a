"""One look at a bench: what `hli-bench state` and the key `cnc/state` show."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.base.units import mm
from hli_bench.bench.config import MachineConfig
from hli_bench.runtime.engine import Engine
from hli_bench.shells.pacing import Lateness
from hli_bench.wire.images import TerminalLayout


def look(
    config: MachineConfig,
    engine: Engine,
    terminals: Sequence[TerminalLayout],
    lateness: Lateness | None,
    net: Mapping[str, int],
    processes: Mapping[str, str],
) -> dict[str, Any]:
    """Return the state of a bench as plain data; positions in mm (degrees).

    `net` is what did not count over Zenoh, `processes` how those of the machine are.
    """
    kernel = engine.kernel
    axes = []
    for axis in config.axes:
        row = kernel.rows.axis[axis.index]
        axes.append(
            {
                "name": axis.name,
                "number": axis.number,
                "command_mm": mm(round(float(row["command"]))),
                "actual_mm": mm(round(float(row["actual"]))),
                "lag_mm": mm(round(float(row["lag"]))),
                "referenced": kernel.core.referenced[axis.index],
                "drive": kernel.drives.shown(axis.index),
                "statusword": int(row["statusword"]),
            }
        )
    images = _images(engine)
    return {
        "machine": config.name,
        "mode": "automatic",
        "state": "active" if kernel.channel.running else ("error" if kernel.core.failed else "ready"),
        "block": kernel.source.number,
        "held_by": kernel.holding(),
        "cycle": engine.cycle,
        "dc_ns": int(engine.dc_ns),
        "axes": axes,
        "terminals": {
            terminal.name: terminal.values(images[terminal.name])
            for terminal in terminals
            if terminal.name in images
        },
        "plcs": [
            {"name": plc.name, "period_cycles": plc.period_cycles, **plc.figures} for plc in engine.plcs
        ],
        "processes": dict(processes),
        "net": dict(net),
        "foreign_syncs": engine.foreign_syncs,
        "late_cycles": lateness.late if lateness else 0,
        "worst_lateness_us": lateness.worst_ns / 1000 if lateness else 0.0,
    }


def _images(engine: Engine) -> Mapping[str, bytes]:
    """Return the images of the terminals; of a process that has gone or is stuck what it showed last."""
    with suppress(EnvironmentLacks):
        return engine.link.images(engine.cycle)
    return engine.link.images(engine.cycle)
