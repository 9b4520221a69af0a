"""The touch probe of a drive (CiA 402, 60B8..60BD) on its two inputs and the encoder's zero pulse."""

import math

from hli_bench.laws.compiled import law
from hli_bench.laws.integers import wrap32
from hli_bench.laws.rows import Row
from hli_bench.laws.servo import count


@law
def probe_arm(row: Row) -> None:
    """Take over a changed touch probe function: the status of an input clears when its enable bit rises or falls."""
    new = row["probe_function"]
    old = row["probe_function_seen"]
    if new == old:
        return
    for number in range(2):
        bit = 0x01 << (8 * number)
        if (new ^ old) & bit:
            row["probe_status"] &= 0xFFFF ^ (0xFF << (8 * number))
            if new & bit:
                row["probe_status"] |= bit
    row["probe_function_seen"] = new


@law
def probe_edge(row: Row, number: int, level: int, position: int, at_dc_ns: int, zero_pulse: int) -> None:
    """Latch a touch probe input's edge (CiA 402, 60B8..60BD): input `number` 0 or 1, or the zero pulse.

    The time latch (60D1..60D4) holds the low 32 bits of the DC time.
    """
    shift = 8 * number
    function = row["probe_function"] >> shift
    if function & 0x01 == 0 or ((function & 0x04) != 0) != (zero_pulse != 0):
        return
    if function & (0x10 if level else 0x20) == 0:
        return
    stored = (0x02 if level else 0x04) << shift
    if row["probe_status"] & stored and function & 0x02 == 0:
        return
    slot = 2 * number + (0 if level else 1)
    row["latch"][slot] = wrap32(position)
    row["latch_time"][slot] = at_dc_ns % 0x100000000
    row["probe_status"] |= stored


@law
def zero_pulses(row: Row, sub: int, begin_ns: int, step_ns: int, dc_epoch_ns: int) -> None:
    """Latch the encoder's zero pulse when this sub-step passes it (an input is armed for it)."""
    turn = row["increments_per_turn"]
    before = count(row, row["angles"][sub]) - row["encoder_offset"] - row["zero_pulse"]
    after = count(row, row["angles"][sub + 1]) - row["encoder_offset"] - row["zero_pulse"]
    if before == after:
        return
    if after > before:
        pulse = (before // turn + 1) * turn
        if pulse > after:
            return
    else:
        pulse = -((-before) // turn + 1) * turn
        if pulse < after:
            return
    at = begin_ns + int(math.floor((pulse - before) / (after - before) * step_ns + 0.5))
    position = pulse + row["zero_pulse"] + row["encoder_offset"]
    for number in range(2):
        probe_edge(row, number, 1, position, dc_epoch_ns + at, 1)
