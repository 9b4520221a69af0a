"""What commands print: results on standard output, all else on standard error, as text and nothing but text.

NC programs, scripts and names of files bring texts of their own; a control character in them (an escape sequence that
clears the screen, renames the window or types into the shell) is shown as Python writes it, never sent to a terminal.
"""

import re
import sys
from typing import Final

CONTROLS: Final = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029]")
LINE_ENDS: Final = re.compile(r"[\n\r]")


def say(item: object, *, at_once: bool = False) -> None:
    """Print a text of one or more lines on standard output; `at_once` for somebody who waits for it."""
    print(plain(item), flush=at_once)


def say_line(text: str) -> None:
    """Print a text as one line on standard output, whatever it holds."""
    print(LINE_ENDS.sub(_shown, plain(text)), flush=True)


def tell(item: object) -> None:
    """Print a text on standard error."""
    print(plain(item), file=sys.stderr, flush=True)


def plain(item: object) -> str:
    """Return the text of `item` with its control characters shown; line feeds and tabs stay."""
    return CONTROLS.sub(_shown, str(item))


def _shown(found: re.Match[str]) -> str:
    return repr(found[0])[1:-1]
