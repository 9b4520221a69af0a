"""Texts as a terminal may show them: with their control characters as Python writes them.

NC programs, scripts and names of files bring texts of their own; an escape sequence in one clears the screen, renames
the window or types into the shell.
"""

import re
from typing import Final

CONTROLS: Final = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029]")
LINE_ENDS: Final = re.compile(r"[\n\r]")


def plain(item: object) -> str:
    """Return the text of `item` with its control characters shown; line feeds and tabs stay."""
    return CONTROLS.sub(_shown, str(item))


def plain_line(item: object) -> str:
    """Return the text of `item` as one line."""
    return LINE_ENDS.sub(_shown, plain(item))


def _shown(found: re.Match[str]) -> str:
    return repr(found[0])[1:-1]
