"""What the kernel is told about its axes and its channel when it is built."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from hli_bench.base.ids import AxisIndex, AxisNumber, NodeId
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.channel import ChannelParams
from hli_bench.protocols.canopen.telegram import ALL_BASES


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisSetup:
    """One axis: `kind` is T (linear), R (rotary) or S (spindle), `index` its row, `node` its drive."""

    index: AxisIndex
    number: AxisNumber
    node: NodeId
    name: str
    kind: Literal["T", "R", "S"]
    params: AxisParams
    telegrams: frozenset[int] = ALL_BASES
    """Base COB-IDs of the standard telegrams that its drive sends."""

    @property
    def unit(self) -> str:
        """Unit of its positions in results: mm or deg."""
        return "mm" if self.kind == "T" else "deg"

    @property
    def increments_per_unit(self) -> float:
        """Encoder increments per 0.1 um (0.0001 degree): P-AXIS-00234 / P-AXIS-00233."""
        gear = self.params.getriebe[0]
        return gear.wegaufz / gear.wegaufn

    def tenth_um(self, increments: float) -> float:
        """Return a distance in increments in 0.1 um."""
        return increments / self.increments_per_unit


@dataclass(frozen=True, slots=True, kw_only=True)
class KernelSetup:
    """Axes in row order, channel parameters, cycle time and the DC time of bench start (both ns)."""

    axes: Sequence[AxisSetup]
    channel: ChannelParams
    cycle_ns: int
    dc_epoch_ns: int
