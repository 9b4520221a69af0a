"""A quiet stretch in one call: machine, sense and act, cycle after cycle, until something needs a decision.

A stride can stop in two places within a cycle, and go on from there: behind the machine when a drive raised a
fault, and behind `sense` when a condition fired. `phase` says where to begin, the result where it stopped.
"""

from typing import Final

from hli_bench.laws.compiled import law
from hli_bench.laws.control import act, sense, write_log
from hli_bench.laws.machine import advance_machine
from hli_bench.laws.publish import publish
from hli_bench.laws.rows import LOG_CYCLES, Rows

MACHINE: Final = 0
"""Begin of a cycle; as a result: all cycles done."""
SENSE: Final = 1
"""Machine has moved, the kernel has not looked yet; as a result: a drive raised a fault."""
ACT: Final = 2
"""Kernel has looked, not interpolated yet; as a result: conditions fired, or the caller wants to."""
PLACES: Final = 4
"""The result of a stride is cycles completed x PLACES + where it stopped."""


@law
def exchange_out(axis: Rows, servo: Rows) -> None:
    """Command telegrams: the targets sent after the last SYNC take effect with this one.

    Control and latch control words are not in it: a cycle in which one changes is not quiet.
    """
    for number in range(axis.shape[0]):
        servo[number]["target"] = axis[number]["target"]


@law
def exchange_in(axis: Rows, servo: Rows) -> None:
    """Actual value telegrams: what the drives captured at SYNC reaches the kernel."""
    for number in range(axis.shape[0]):
        kernel = axis[number]
        drive = servo[number]
        kernel["statusword"] = (kernel["statusword"] & 0xC3FF) | drive["status_flags"]
        kernel["received"] = drive["position"]
        kernel["probe_status"] = drive["probe_status"]
        kernel["digital_inputs"] = drive["digital_inputs"]
        kernel["torque_permille"] = drive["torque_permille"]
        kernel["following_error"] = drive["following_error"]
        slot = 2 * drive["telegram_input"]
        for i in range(2):
            kernel["latch"][i] = drive["latch"][slot + i]


@law
def stride(
    axis: Rows,
    path: Rows,
    segment: Rows,
    leg: Rows,
    watch: Rows,
    history: Rows,
    log: Rows,
    servo: Rows,
    switch: Rows,
    signal: Rows,
    channel: Rows,
    edge: Rows,
    edges: Rows,
    pending: Rows,
    image: Rows,
    offsets: Rows,
    cycle_ns: int,
    sub_steps: int,
    dc_epoch_ns: int,
    cycle: int,
    cycles: int,
    phase: int,
    stop_to_act: int,
    logged: int,
) -> int:
    """Run up to `cycles` cycles; cycle `cycle` is the first. Return cycles completed x PLACES + where it stopped.

    With `stop_to_act` the first cycle is left behind `sense`, so that the caller can decide before `act`.
    `logged`: somebody reads the log.
    """
    for done in range(cycles):
        if phase == MACHINE:
            begin_ns = (cycle - 1) * cycle_ns
            faults = advance_machine(
                servo,
                switch,
                signal,
                channel,
                edge,
                edges,
                pending,
                cycle_ns,
                sub_steps,
                dc_epoch_ns,
                begin_ns,
            )
            exchange_in(axis, servo)
            exchange_out(axis, servo)
            phase = SENSE
            if faults:
                return done * PLACES + SENSE
        if phase == SENSE:
            phase = ACT
            if sense(axis, path, watch, history, cycle) or stop_to_act:
                return done * PLACES + ACT
        act(axis, path, segment, leg, cycle_ns)
        if logged:
            write_log(axis, log, cycle % LOG_CYCLES)
        phase = MACHINE
        cycle += 1
        if edges[0] > edge.shape[0] // 2:
            cycles = done + 1
            break
    publish(axis, path, segment, leg, image, offsets)
    return cycles * PLACES + MACHINE
