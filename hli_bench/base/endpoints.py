"""Where a bench listens: PROTOCOL/ADDRESS as Zenoh takes it."""

import re
from typing import Final

from hli_bench.base.errors import InputError

DEFAULT_PORT: Final = 7447
DEFAULT_ENDPOINT: Final = f"tcp/127.0.0.1:{DEFAULT_PORT}"
"""Where `serve` listens and clients connect unless told otherwise."""
LAST_PORT: Final = 65535
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
