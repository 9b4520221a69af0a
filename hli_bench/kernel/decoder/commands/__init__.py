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
