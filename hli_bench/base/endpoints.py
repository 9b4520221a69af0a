"""Where a bench listens, PROTOCOL/ADDRESS as Zenoh takes it, and which names can stand in its keys."""

import re
from typing import Final

from hli_bench.base.errors import InputError

DEFAULT_PORT: Final = 7447
DEFAULT_ENDPOINT: Final = f"tcp/127.0.0.1:{DEFAULT_PORT}"
"""Where `serve` listens and clients connect unless told otherwise."""
LAST_PORT: Final = 65535
_CHUNK: Final = re.compile(r"(?!@)[^/#?$*\x00-\x1f\ud800-\udfff]{1,200}")
"""Zenoh keeps `/ # ? $ *` for itself, and a first `@`; a key is UTF-8, which a file name need not be."""
_FORM: Final = re.compile(
    r"(?:(?:tcp|udp|ws|tls|quic)/(?:\[[^\s\[\]]+\]|[^\s\[\]:/?#]+):(?P<port>\d{1,5})|unixsock-stream/[^\s?#]+)"
    r"(?:\?[^\s#]*)?(?:#\S*)?"
)
"""An address and what may follow it: `?metadata`, `#config`."""


def endpoint(text: str) -> str:
    """Return `text` if it has the form of an endpoint. Raises InputError."""
    found = _FORM.fullmatch(text)
    if found is None or int(found["port"] or 0) > LAST_PORT:
        raise InputError(
            f"{text!r}: expected PROTOCOL/HOST:PORT, e.g. {DEFAULT_ENDPOINT} "
            f"(also udp, ws, tls, quic; port up to {LAST_PORT}), or unixsock-stream/FILE"
        )
    return text


def check_key(name: str, what: str, file: str = "") -> None:
    """Raise InputError if a name cannot be a part of a Zenoh key. `what` says whose name it is."""
    if not _CHUNK.fullmatch(name):
        raise InputError(
            f"{what} is called {name!r}, which can be no part of a Zenoh key: "
            "expected 1 to 200 characters, none of them / # ? $ *, the first no @",
            file,
        )
