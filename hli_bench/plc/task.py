"""The cyclic task: runs a script on the images of a cycle and hands out what it changed on the HLI."""

import inspect
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hli_bench.base.errors import STOPS
from hli_bench.base.time import Ns
from hli_bench.plc.function_blocks import TASK_TIME
from hli_bench.plc.names import Frame, Hli, io_root
from hli_bench.plc.script import line_of, script_error
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.images import TerminalLayout


class Task:
    """A script with its period; `step` is called when the task is due."""

    __slots__ = (
        "_cycle",
        "_file",
        "_frame",
        "_hli",
        "_io",
        "_paths",
        "_start",
        "_terminals",
        "name",
        "period_us",
    )

    def __init__(
        self,
        name: str,
        script: Any,
        period_us: int,
        layout: Layout,
        terminal_layouts: Sequence[TerminalLayout],
    ) -> None:
        self.name = name
        self.period_us = period_us
        self._file = Path(inspect.getfile(type(script)))
        self._frame = Frame(layout)
        self._hli = Hli(self._frame)
        self._io, self._terminals = io_root(terminal_layouts)
        self._cycle = script.cycle
        self._start = getattr(script, "start", None)
        self._paths = [element.path for element in layout.elements]

    @property
    def starting(self) -> bool:
        """The script has not begun, or is in its `start`."""
        return self._start is not None

    def place(self, error: BaseException) -> str:
        """Return file and line of the script at which an error left it, the file alone when it had left it before."""
        line = line_of(error, self._file)
        return f"{self._file}:{line}" if line else str(self._file)

    def step(self, cycle: int, dc_ns: Ns, image: bytes | bytearray, io: Mapping[str, bytes]) -> Commands:
        """Run the script once on the HLI after kernel cycle `cycle` and the terminals' images by name.

        Returns what it wrote differently from last time (the first time: everything). Raises InputError with
        file and line when the script fails; the task must not be stepped any further then.
        """
        frame = self._frame
        frame.begin(image)
        for name, data in io.items():
            self._terminals[name].data = data
        TASK_TIME.set(dc_ns)
        try:
            if self._start is not None:
                self._start(self._hli, self._io)
                self._start = None
            self._cycle(self._hli, self._io)
        except STOPS:
            raise
        except BaseException as error:
            raise script_error(error, self._file) from error
        if not frame.changes:
            return Commands(self.name, cycle, ())
        changes = frame.take_changes()
        paths = self._paths
        return Commands(
            self.name,
            cycle,
            tuple([Write(paths[element], value) for element, value in changes.items()]),
        )
