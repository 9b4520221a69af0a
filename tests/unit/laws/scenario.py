"""A fixed scenario of three jogging axes with stop, face, cam and terminals; prints a digest of every row.

Run as a script: `scenario.py CYCLES PER_STRIDE`.
"""

import hashlib
import sys

import numpy as np

from hli_bench.laws.native import bind
from hli_bench.laws.rows import JOG, KernelRows
from hli_bench.laws.stride import MACHINE, PLACES, stride
from hli_bench.plant.build import build
from hli_bench.plant.settings import AxisPlant, Cam, Face, PlantAxis, PlantSettings, Probe, Stop
from hli_bench.terminals.settings import Channel

EPOCH_NS = 820_540_800_000_000_000
PLANT = AxisPlant(
    inertia_kg_m2=3.3e-3,
    mass_kg=0.0,
    pitch_mm=10.0,
    viscous_nm_s=0.002,
    coulomb_nm=0.05,
    static_nm=0.06,
    rated_torque_nm=15.0,
    peak_permille=3000.0,
    increments_per_turn=1_048_576,
    zero_pulse_increments=524_288,
    kv_per_s=50.0,
    speed_bandwidth_per_s=300.0,
    speed_reset_ms=20.0,
)


def digest(cycles: int, per_stride: int) -> str:
    """Return the digest of all rows after `cycles` cycles in strides of `per_stride`."""
    axes = [
        PlantAxis(
            name="X",
            rotary=False,
            absolute=True,
            start_mm=0.0,
            plant=PLANT,
            stop=Stop(mm=3.0, side="above", stiffness_n_per_um=100.0),
        ),
        PlantAxis(
            name="Y",
            rotary=False,
            absolute=False,
            start_mm=-7.0,
            plant=PLANT,
            cam=Cam(from_mm=-9.0, to_mm=-8.0, hysteresis_um=50.0),
        ),
        PlantAxis(
            name="Z",
            rotary=False,
            absolute=True,
            start_mm=20_479.9,
            plant=PLANT,
            face=Face(mm=20_481.0, material="above"),
            probe_inputs=("probe", ""),
        ),
    ]
    channels = [Channel("probe", 500), Channel("cam.Y", 3_000_000), Channel("probe", single_event=True)]
    plant = build(PlantSettings(axes=axes, probe=Probe(bounce_us=300.0, sigma_um=1.0), seed=3), channels)
    machine = plant.rows
    kernel = KernelRows.allocate(3, 4)
    machine.servo["enabled"] = 1
    machine.servo[0]["torque_limit_permille"] = 100.0
    kernel.axis["increments_per_unit"] = 10.48576
    kernel.axis["feedback"] = machine.servo["position"]
    kernel.axis["reference"] = machine.servo["position"]
    kernel.axis["target"] = machine.servo["position"]
    kernel.axis["mode"] = JOG
    kernel.axis["jog_acceleration"] = 2e7
    kernel.axis["jog_velocity"] = [3e5, -2e5, 5e5]
    kernel.axis["probe_function"] = [0x0015, 0x0015, 0x0033]
    go = bind(
        stride,
        kernel.axis,
        kernel.path,
        kernel.segment,
        kernel.leg,
        kernel.watch,
        kernel.history,
        kernel.log,
        machine.servo,
        machine.switch,
        machine.signal,
        machine.channel,
        machine.edge,
        machine.edges,
        plant.pending,
        # 16 bytes an axis, an error flag an axis, the number of the block
        np.zeros(56, np.uint8),
        np.array([0, 16, 32, 48, 49, 50, 52]),
        1_000_000,
        8,
        EPOCH_NS,
    )
    cycle = 1
    while cycle <= cycles:
        cycle += go(cycle, min(per_stride, cycles + 1 - cycle), MACHINE, 0, 1) // PLACES
    assert machine.edges[0] > 3
    rows = (
        kernel.axis,
        kernel.history,
        machine.servo,
        machine.switch,
        machine.signal,
        machine.channel,
        machine.edge,
    )
    named = hashlib.sha256()
    for row in rows:
        for name in row.dtype.names or ("",):
            named.update(np.ascontiguousarray(row[name] if name else row).tobytes())
    return named.hexdigest()


if __name__ == "__main__":
    sys.stdout.write(digest(int(sys.argv[1]), int(sys.argv[2])))
