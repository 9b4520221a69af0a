"""Probing sources: one module for each emulated value of P-AXIS-00516, named as the value in lower case.

A new source is a new module with the functions of `Source`; `source` finds it by its name.
"""

from functools import cache
from typing import Protocol, cast

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.base.ids import AxisIndex
from hli_bench.base.loading import module
from hli_bench.base.time import Ns
from hli_bench.kernel.core import Core
from hli_bench.kernel.sequence import Until
from hli_bench.kernel.watches import Condition
from hli_bench.manual.axis.words import Edge


class Source(Protocol):
    """What a measuring run asks of a probing source, for one axis."""

    def blocked(self, core: Core, axis: AxisIndex, edge: Edge) -> bool:
        """Tell whether the probe is operated before the run begins."""

    def first_look(self, core: Core, axis: AxisIndex, edge: Edge) -> Until:
        """Return the condition that the probe is operated when it is seen for the first time, in mid-run.

        Before a PLC has spoken its probe cannot be seen, and the run begins.
        """

    def free(self, core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> bool:
        """Tell whether it can be armed; it shows nothing of an earlier run any more, or takes it back by itself."""

    def arm(self, core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Condition | None:
        """Prepare the source; return what to wait for before the motion, None when it is ready at once."""

    def event(self, core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> Until:
        """Return the condition that means the probing event."""

    def latched(self, core: Core, axis: AxisIndex, probing_input: int, edge: Edge) -> tuple[float, Ns] | None:
        """Return position (ACS, 0.1 um) and its DC time after the event; None when there is none to be had."""

    def disarm(self, core: Core, axis: AxisIndex) -> None:
        """Switch the source off after the run."""


@cache
def source(signal: str) -> Source:
    """Return the source for a value of P-AXIS-00516. Raises NotEmulated for one that is not built."""
    try:
        return cast("Source", module(f"{__name__}.{signal.lower()}"))
    except InputError:
        raise NotEmulated(f"P-AXIS-00516: probing source {signal}") from None
