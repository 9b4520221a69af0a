"""Errors handed over to the PLC one by one: `mc_error`.

Source: TF5200 HLI 1.22, error messages. The CNC writes a record while the semaphore is FALSE and sets it, the PLC reads
and clears it. What comes meanwhile waits; a PLC that does not take the records (`enable_w`) finds the newest.
"""

from collections import deque

from hli_bench.kernel.core import Core
from hli_bench.kernel.records import CncError
from hli_bench.manual.errors import by_number

PLACE = "ch/1/mc_error"
WAITING = 16
"""Records that wait for the PLC; what comes beyond is lost, the PLC does not keep up (decided here)."""


class ErrorRecords:
    """The hand-over; `step` whenever a PLC has written."""

    __slots__ = ("_core", "_ids", "_present", "_waiting")

    def __init__(self, core: Core) -> None:
        self._core = core
        layout = core.image.layout
        self._ids = dict(layout.groups[PLACE].ids) | layout.groups[f"{PLACE}/satz_r/kopf"].ids
        self._present = layout.element("ch/1/head/plc_present_w").id
        self._waiting: deque[CncError] = deque(maxlen=WAITING)
        core.image.set(self._ids["cnc_channel"], 1)

    def take(self, record: CncError) -> None:
        """Hand a record over, or let it wait for its turn."""
        self._waiting.append(record)
        self.step()

    def step(self) -> None:
        """Hand over what waits, as far as the PLC has taken what came before."""
        image = self._core.image
        while self._waiting:
            taken = image.get(self._ids["enable_w"]) and image.get(self._present)
            if taken and image.get(self._ids["semaphor_rw"]):
                return
            self._write(self._waiting.popleft())

    def _write(self, record: CncError) -> None:
        sheet = by_number().get(record.number)
        numbers = {axis.name: axis.number for axis in self._core.setup.axes}
        values = {
            "error_id": record.number,
            "reaktions_klasse": int(sheet.reaction_class) if sheet else 0,
            "behebungs_klasse": sheet.remedy_class if sheet else 0,
            "axis_r": numbers.get(record.axis, 0),
            "block_r": record.source.value,
            "semaphor_rw": True,
        }
        for name, value in values.items():
            self._core.image.set(self._ids[name], value)
