"""One module per '#' command; each has `run(context, memory, scanner) -> Steps`."""

from collections.abc import Callable
from typing import Final

from hli_bench.kernel.decoder.commands import channel, cs, drive, meas, msg
from hli_bench.kernel.decoder.context import Context, Steps
from hli_bench.kernel.decoder.text import Scanner
from hli_bench.kernel.decoder.variables import Variables

Command = Callable[[Context, Variables, Scanner], Steps]

COMMANDS: Final[dict[str, Command]] = {
    "CHANNEL": channel.run,
    "CS": cs.run,
    "DRIVE": drive.run,
    "MEAS": meas.run,
    "MSG": msg.run,
}

KNOWN: Final = {
    "ADD": "addition to #MSG",
    "AX": "axis links and axis exchange",
    "CALL": "axis exchange",
    "CONTOUR": "contour mode",
    "DISABLE": "axis links",
    "ENABLE": "axis links",
    "ERROR": "error output by the program",
    "FLUSH": "flushing by the program",
    "GANTRY": "gantry by the program",
    "GET": "positions into variables",
    "HSC": "smoothing",
    "IDENT": "SERCOS parameters",
    "KIN": "kinematic transformation",
    "MACHINE": "parameters by the program",
    "MCS": "machine coordinates",
    "OPTIONAL": "optional execution",
    "PSET": "position preset",
    "ROTATION": "contour rotation",
    "SET": "axis links and other settings",
    "SLOPE": "slope type by the program",
    "TIME": "waiting",
    "TRAFO": "kinematic transformation",
    "VAR": "declaration of variables",
    "WAIT": "waiting for independent axes",
}
"""Commands of the dialect that not built, with what is missing."""
