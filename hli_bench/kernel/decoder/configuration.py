"""What the decoder is told about the channel before a program starts."""

from dataclasses import dataclass
from typing import Literal

from hli_bench.base.ids import AxisIndex

AxisKind = Literal["T", "R", "S"]
"""Translatory, rotary, spindle (the axis types of the axis parameter sheets)."""


@dataclass(frozen=True, slots=True)
class DecoderAxis:
    """An axis of the channel: its place in the rows, NC name, logical number, kind, P-AXIS-00118."""

    index: AxisIndex
    name: str
    number: int
    kind: AxisKind
    measuring: bool


@dataclass(frozen=True, slots=True)
class DecoderDefaults:
    """Channel values a program starts with: `measuring_type` is P-CHAN-00057."""

    measuring_type: int = 1
