"""Where the command begins: a signal in its first moments ends it as Ctrl-C does, without a traceback.

Python's own handler raises KeyboardInterrupt wherever it is, in the middle of an import too, which then prints the
import; SIGTERM would end the command with a status of its own. Nothing has begun that would have to be ended, so the
process just goes, with the status of `cli.main.INTERRUPTED`. That takes the signals over when there is.
"""

import os
import signal


def main() -> int:
    """Run the command line of this process and return the exit status."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(130))
    from hli_bench.cli.main import main as command

    status = command()
    # All is written and closed: a signal on the way out changes nothing any more.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    return status
