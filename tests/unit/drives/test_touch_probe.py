"""Function words of the touch probe against the published bit table, and against the law that acts on them."""

from typing import Any

import numpy as np
import pytest
from hli_bench_drives.cia402.faults import Fault, error_register
from hli_bench_drives.cia402.modes import Mode, SupportedModes, is_supported
from hli_bench_drives.cia402.touch_probe import (
    ProbeFunction,
    ProbeSource,
    ProbeStatus,
    probe_input,
    resolve_source,
    touch_probe,
    zero_pulse,
)
from hli_bench_drives.models import servo402

from hli_bench.base.time import Ns
from hli_bench.laws.rows import SERVO
from hli_bench.laws.touch_probe import probe_arm, probe_edge


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        (probe_input(1, positive=True), 0x0011),
        (probe_input(1, positive=False), 0x0021),
        (probe_input(2, positive=True), 0x1100),
        (probe_input(2, positive=False), 0x2100),
        (probe_input(1, positive=True, drive_defined=True), 0x0019),
        (probe_input(2, positive=False, drive_defined=True), 0x2900),
        (zero_pulse(1), 0x0015),
        (zero_pulse(2), 0x1500),
        (touch_probe(2, ProbeFunction.CONTINUOUS | ProbeFunction.ENABLE), 0x0300),
    ],
)
def test_function_words(word: int, expected: int) -> None:
    assert word == expected


def test_source_by_60d0_replaces_only_its_own_touch_probe() -> None:
    zero, first, second = ProbeSource.ZERO_PULSE, ProbeSource.INPUT_1, ProbeSource.INPUT_2
    assert resolve_source(0x1919, (zero, second)) == 0x1115
    assert resolve_source(0x1919, (first, zero)) == 0x1511
    assert resolve_source(0x1511, (first, second)) == 0x1511


@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize("positive", [True, False])
def test_armed_drive_latches_its_edge_once(number: int, positive: bool) -> None:
    rows: Any = np.zeros(1, SERVO)
    drive = servo402.create("Z", 1, rows[0], {})
    drive.exchange(0, 0, probe_input(number, positive=positive), Ns(0))
    probe_arm(rows[0])
    values = drive.device.values
    assert values.get(0x60B9) == ProbeStatus.ENABLED << 8 * (number - 1)
    slot = 2 * (number - 1) + (not positive)
    for position, at in ((-500, (1 << 32) + 7), (900, 9)):
        probe_edge(rows[0], number - 1, int(not positive), 1, 0, 0)
        probe_edge(rows[0], number - 1, int(positive), position, at, 0)
    assert values.get(0x60BA + slot) == -500
    assert values.get(0x60D1 + slot) == 7
    stored = ProbeStatus.POSITIVE_STORED if positive else ProbeStatus.NEGATIVE_STORED
    assert values.get(0x60B9) == (ProbeStatus.ENABLED | stored) << 8 * (number - 1)
    drive.exchange(0, 0, 0, Ns(0))
    probe_arm(rows[0])
    assert values.get(0x60B9) == 0


@pytest.mark.parametrize(
    ("code", "register"),
    [
        (Fault.FOLLOWING_ERROR, 0x21),
        (Fault.CONTINUOUS_OVER_CURRENT, 0x03),
        (Fault.DC_LINK_OVER_VOLTAGE, 0x05),
        (Fault.DRIVE_TEMPERATURE, 0x09),
        (Fault.COMMUNICATION, 0x11),
        (Fault.ENCODER, 0x01),
        (Fault.DECELERATION, 0x81),
    ],
)
def test_error_register_bits(code: Fault, register: int) -> None:
    assert error_register(code) == register


def test_supported_modes_bits() -> None:
    for mode in Mode:
        bit = SupportedModes.__members__.get(mode.name)
        for supported in SupportedModes:
            assert is_supported(mode, supported) == (supported is bit)
