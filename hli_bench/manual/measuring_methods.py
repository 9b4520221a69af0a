"""The parameters before P-AXIS-00516 that chose how an axis measures; only one of them may be set.

Source: measurement manual 8.2.4; diagnosis of 110399 to 110402.
"""

from collections.abc import Iterator, Mapping
from typing import Final, NamedTuple

from hli_bench.manual.axis.kenngr import Kenngr
from hli_bench.manual.axis.words import ProbingSignal
from hli_bench.manual.sheet import Value

SIGNAL: Final = "kenngr.measure.signal"


class Method(NamedTuple):
    """An older parameter with the source that it stands for, None: a hardware interface of the CNC itself."""

    name: str
    number: str
    source: ProbingSignal | None

    @property
    def path(self) -> str:
        """The list path."""
        return f"kenngr.{self.name}"


METHODS: Final = (
    Method("meas_signal_fixed_stop", "P-AXIS-00330", ProbingSignal.FIXED_STOP),
    Method("meas_signal_drive", "P-AXIS-00269", ProbingSignal.DRIVE),
    Method("mess_signal_sercos", "P-AXIS-00116", ProbingSignal.DRIVE),
    Method("probing_signal_via_plc", "P-AXIS-00257", ProbingSignal.PLC),
    Method("mess_signal_achs_steuer", "P-AXIS-00115", ProbingSignal.PLC),
    Method("mess_signal_taster", "P-AXIS-00117", None),
)
"""In the order in which they count when several are set; the others are taken as 0 (decided here)."""

CORRECTIONS: Final[Mapping[tuple[str, str], int]] = {
    ("P-AXIS-00117", "P-AXIS-00115"): 110_400,
    ("P-AXIS-00117", "P-AXIS-00269"): 110_401,
    ("P-AXIS-00115", "P-AXIS-00269"): 110_402,
}
"""Numbers of the warnings: (corrected, kept)."""
ONE_ONLY: Final = 110_399
"""Number of the warning for other pairs (decided here)."""


def chosen(kenngr: Kenngr) -> ProbingSignal:
    """Return the source that the older parameters choose; DRIVE_TYPE_DEFAULT when none is set that the bench has."""
    sources = (one.source for one in METHODS if getattr(kenngr, one.name))
    return next((one for one in sources if one is not None), ProbingSignal.DRIVE_TYPE_DEFAULT)


def corrections(values: Mapping[str, Value]) -> Iterator[tuple[str, str]]:
    """Yield what is to be said of older parameters that do not count: (path, text)."""
    given = [one for one in METHODS if values.get(one.path)]
    if values.get(SIGNAL):
        for one in given:
            yield one.path, f"{one.path}: does not count beside {SIGNAL} ({one.number}, P-AXIS-00516)"
        return
    for one in given[1:]:
        number = CORRECTIONS.get((one.number, given[0].number), ONE_ONLY)
        beside = f"{given[0].path} ({one.number}, {given[0].number})"
        yield one.path, f"{one.path}: corrected to 0 beside {beside}: only one method (P-ERR-{number})"


def unbuilt(values: Mapping[str, Value]) -> Iterator[tuple[str, str]]:
    """Yield the method that the bench does not have: (path, text)."""
    given = [one for one in METHODS if values.get(one.path)]
    if given and given[0].source is None and not values.get(SIGNAL):
        one = given[0]
        yield (
            one.path,
            (
                f"{one.number}: {one.path} = 1: a probe at a hardware interface of the CNC is not emulated; "
                f"{SIGNAL} names another source"
            ),
        )
