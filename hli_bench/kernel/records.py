"""What the stages of the kernel pass on and what it emits: errors, messages, measured values, homing results."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from hli_bench.base.ids import AxisIndex
from hli_bench.base.time import Ns
from hli_bench.kernel.blocks import Source


@dataclass(frozen=True, slots=True, kw_only=True)
class CncError:
    """An error or warning of the emulated CNC: output of the machine, never an exception."""

    number: int
    severity: str
    text: str
    source: Source
    axis: str = ""
    values: Mapping[str, float | int | str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageText:
    """A #MSG text that was handed out."""

    source: Source
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredValue:
    """A latched position of one axis.

    `acs_tenth_um` is rounded to whole 0.1 um; `dc_ns` is the instant the position belongs to;
    `edge` is "POS" or "NEG"; `origin` the value of P-AXIS-00516 that delivered it.
    """

    source: Source
    axis: AxisIndex
    origin: str
    acs_tenth_um: int
    dc_ns: Ns
    edge: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Unmeasured:
    """An axis that a measuring run gave no value.

    `fixed_stop`: it was to find a stop; `unserved` names the control units that no PLC served meanwhile, and why;
    `reported`: the CNC itself says so, by an error or a warning.
    """

    source: Source
    axis: AxisIndex
    fixed_stop: bool
    unserved: tuple[str, ...]
    reported: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Homed:
    """An axis has been referenced."""

    source: Source
    axis: AxisIndex
    position_tenth_um: int
    method: str


Emitted = CncError | MessageText | MeasuredValue | Homed
