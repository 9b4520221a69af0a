"""What commands print: results on standard output, all else on standard error, as text and nothing but text."""

import sys

from hli_bench.base.plain import plain, plain_line


def say(item: object, *, at_once: bool = False) -> None:
    """Print a text of one or more lines on standard output; `at_once` for somebody who waits for it."""
    print(plain(item), flush=at_once)


def say_line(text: str) -> None:
    """Print a text as one line on standard output, whatever it holds."""
    print(plain_line(text), flush=True)


def tell(item: object) -> None:
    """Print a text on standard error."""
    print(plain(item), file=sys.stderr, flush=True)
