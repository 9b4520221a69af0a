"""What the decoder of one program knows: axes, modal values, positions, measured values."""

from collections.abc import Generator, Mapping, Sequence
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.base.ids import AxisIndex
from hli_bench.base.units import TENTH_UM_PER_MM
from hli_bench.kernel.blocks import Block, Flush, Idle, MachineState, Source
from hli_bench.kernel.decoder.configuration import DecoderAxis, DecoderDefaults
from hli_bench.kernel.decoder.coordinates import Coordinates
from hli_bench.kernel.decoder.faults import CncStop
from hli_bench.kernel.decoder.measurements import Measurements
from hli_bench.kernel.records import CncError
from hli_bench.manual.errors import decoder as errors

LARGEST: Final = 2**31 - 1
"""Positions are SGN32 in 0.1 um or 0.0001 degrees. Source: TF5200 programming manual, ranges of values."""
LARGEST_POSITION: Final = LARGEST / TENTH_UM_PER_MM
Item = Block | Flush | CncError | Idle
Steps = Generator[Item, MachineState | None, None]
"""What every command yields; a `Flush` is answered with a `MachineState`."""


class Context:
    """State of one program run."""

    __slots__ = (
        "absolute",
        "axes",
        "by_name",
        "by_number",
        "coordinates",
        "defaults",
        "ended",
        "feed",
        "measurements",
        "measuring_type",
        "name",
        "rapid",
    )

    def __init__(self, name: str, axes: Sequence[DecoderAxis], defaults: DecoderDefaults) -> None:
        self.name = name
        self.defaults = defaults
        self.axes = {axis.index: axis for axis in axes}
        self.by_name = {axis.name.upper(): axis for axis in axes}
        self.by_number = {axis.number: axis for axis in axes}
        main = [self.by_name[letter].index for letter in "XYZ" if letter in self.by_name]
        self.coordinates = Coordinates(
            1 + max(self.axes, default=-1), (main[0], main[1], main[2]) if len(main) == 3 else None
        )
        self.measurements = Measurements(self.coordinates)
        self.measuring_type = defaults.measuring_type
        self.absolute = True
        self.rapid = False
        self.feed = 0.0
        self.ended = False

    def flush(self, source: Source) -> Steps:
        """Ask the machine, unless nothing has moved since it was asked last."""
        if self.measurements.state is not None and not self.coordinates.void:
            return
        state = yield Flush(source=source, takes_positions=bool(self.coordinates.void))
        if state is None:
            raise InputError("a Flush must be answered with a MachineState", self.name, source.line)
        self.measurements.learn(state)
        self.coordinates.learn(state.command)

    def check_format(self, target: Mapping[AxisIndex, float], source: Source) -> None:
        """Raise CncStop for a position that the position format does not hold."""
        for axis, position in target.items():
            if not -LARGEST_POSITION <= position <= LARGEST_POSITION:
                name, number = self.axes[axis].name, self.axes[axis].number
                found = position * TENTH_UM_PER_MM
                raise CncStop(
                    errors.COORDINATE_FORMAT, source, number, -LARGEST, LARGEST, found, found, axis=name
                )

    def moved(self) -> None:
        """Note that what the machine said last no longer holds."""
        self.measurements.state = None

    def path_axis(self, index: AxisIndex) -> bool:
        """Tell whether the axis can be programmed as a path axis."""
        return self.axes[index].kind != "S"
