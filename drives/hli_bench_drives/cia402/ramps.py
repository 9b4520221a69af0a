"""How a drive comes to a stop by itself: option codes 0x605A to 0x605E, along 0x6084, 0x6085 or the torque limit."""

import math
from typing import Any, Final

from hli_bench.base.time import NS_PER_S, Ns
from hli_bench.protocols.canopen import cia402_objects as objects
from hli_bench.protocols.canopen.cia402_objects import ObjectAddress
from hli_bench.protocols.canopen.dictionary import ObjectValues

DISABLE: Final = 0
"""Power is cut at once; the axis coasts."""
SLOW_DOWN: Final = 1
QUICK: Final = 2
TORQUE: Final = 3
"""As fast as the torque limit allows."""
STAYS: Final = 5
"""Quick stop options from here on are those from 1 on, and the drive stays in QUICK STOP ACTIVE."""
_STAYING: Final = STAYS - SLOW_DOWN
_OBJECTS: Final = {SLOW_DOWN: objects.PROFILE_DECELERATION, QUICK: objects.QUICK_STOP_DECELERATION}


def number_of(values: ObjectValues, address: ObjectAddress) -> int:
    """Return the present value of an object; one that the dictionary lacks acts by the profile."""
    return values.number(*address) if values.has(*address) else objects.ABSENT.get(address, 0)


class Ramps:
    """Moves the set point of a drive's row where the bus does not."""

    __slots__ = ("_row", "_values")

    def __init__(self, values: ObjectValues, row: Any) -> None:
        self._values = values
        self._row = row

    @property
    def held(self) -> bool:
        """The set point comes to a stop by itself, or stands where it has."""
        return bool(self._row["stop_rate"] > 0.0)

    def is_built(self, option: int) -> bool:
        """Tell whether an option code acts; a stop by the voltage limit is not emulated."""
        return option in range(TORQUE + 1) or option - _STAYING in range(SLOW_DOWN, TORQUE + 1)

    def stand(self) -> None:
        """Let set point and target be where the axis is."""
        row = self._row
        count = math.floor(float(row["angle"]) * float(row["increments_per_rad"]) + 0.5) + int(
            row["encoder_offset"]
        )
        row["demand_from"] = float(count)
        row["demand"] = row["target"] = row["position"]

    def begin(self, option: int) -> Ns:
        """Begin to stop where the axis is, with the speed that it has; return how long the ramp is."""
        row = self._row
        self.stand()
        speed = float(row["speed"]) * float(row["increments_per_rad"])
        row["stop_speed"] = speed
        row["stop_rate"] = rate = self._rate(option if option < STAYS else option - _STAYING)
        return Ns(math.ceil(abs(speed) / rate * NS_PER_S))

    def let_go(self) -> None:
        """Follow the target."""
        self._row["stop_rate"] = 0.0
        self._row["stop_speed"] = 0.0

    def _rate(self, option: int) -> float:
        """Return the deceleration in increments/s2."""
        address = _OBJECTS.get(option)
        if address is not None:
            return float(max(number_of(self._values, address), 1))
        row = self._row
        limits = ("torque_limit_permille", "positive_permille", "negative_permille", "peak_permille")
        torque = min(float(row[name]) for name in limits) * 1e-3 * float(row["rated_torque"])
        return max(torque / float(row["inertia"]) * float(row["increments_per_rad"]), 1.0)
