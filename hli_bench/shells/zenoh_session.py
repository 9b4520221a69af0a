"""How a Zenoh session is opened: no scouting, no gossip, no shared memory; how long it may be silent."""

import json
import os
import re
from typing import Any, Final

import zenoh

from hli_bench.base.errors import EnvironmentLacks

PLC_LEASE_MS: Final = 500
"""A PLC's session that says nothing for so long is gone: this is how a frozen PLC is noticed."""
LEASE_MS: Final = 30_000
"""The same of a bench and of who only asks: they may stand for a while. One that ends closes its sockets."""

PATIENCE_US: Final = 100_000
"""How long a put may wait for a link that is full before the message is dropped; of a bench in real pace none is.

In lock-step a lost image or answer would end the PLC, and a busy computer needs ms.
"""
PACED_CLOSE_US: Final = 10_000
"""A client of a bench in real pace whose link stays full for so long is let go: its link is closed (decision 0025)."""
KEEP_ALIVES: Final = 240
"""So many signs of life of a bench in the time of LEASE_MS, one every 125 ms: zenoh-pico waits for the bench no longer
than for itself, and a PLC's lease is 500 ms."""
QUEUE: Final = 16
"""Batches that wait for a client, the most that Zenoh takes: more in a link without priorities, as of zenoh-pico."""

TEXT: Final = zenoh.Encoding.TEXT_PLAIN
JSON: Final = zenoh.Encoding.APPLICATION_JSON
PACKED: Final = zenoh.Encoding.APPLICATION_OCTET_STREAM
LEASE: Final = "transport/link/tx/lease"
DROP_AFTER: Final = "transport/link/tx/queue/congestion_control/drop/wait_before_drop"
CLOSE_AFTER: Final = "transport/link/tx/queue/congestion_control/block/wait_before_close"
_RUNTIME: Final = "ZENOH_RUNTIME"
_FEWER_THREADS: Final = "(acc: (handover: rx), app: (handover: rx))"
"""Zenoh's threads that read a socket also wait for it: else every message wakes one thread more on its way.

Not in a paced bench, whose cycles were no less late with it.
"""
_TEXTS: Final = ("text/", "application/json", "zenoh/string")
_SOURCE_PLACE: Final = re.compile(r"\s+at /.*", re.DOTALL)


def listen(endpoint: str, *, lockstep: bool = True) -> Any:
    """Open the bench's session: a router at `endpoint`. Raises EnvironmentLacks when it cannot listen."""
    try:
        settings: dict[str, Any] = {
            "listen/endpoints": [endpoint],
            "transport/link/tx/keep_alive": KEEP_ALIVES,
            "transport/link/tx/queue/size/data": QUEUE,
        }
        settings |= {DROP_AFTER: PATIENCE_US} if lockstep else {CLOSE_AFTER: PACED_CLOSE_US}
        return _open("router", settings, fewer_threads=lockstep)
    except zenoh.ZError as error:
        raise EnvironmentLacks(
            f"Zenoh cannot listen on {endpoint} ({_reason(error)}); is a bench up already? "
            "Choose another place with --zenoh tcp/127.0.0.1:PORT"
        ) from error


def connect(endpoint: str, lease_ms: int = LEASE_MS) -> Any:
    """Open a client's session to `endpoint`. Raises EnvironmentLacks when nobody listens there."""
    try:
        settings = {"connect/endpoints": [endpoint], DROP_AFTER: PATIENCE_US, LEASE: lease_ms}
        return _open("client", settings, fewer_threads=True)
    except zenoh.ZError as error:
        raise EnvironmentLacks(
            f"no bench listens on {endpoint} ({_reason(error)}); start one with `hli-bench serve`"
        ) from error


def queued(put: Any, kind: Any) -> Any:
    """Return a handler that puts (kind, message) in a queue and does nothing else on the network thread."""
    return on_network_thread(lambda message: put((kind, message)))


def on_network_thread(take: Any) -> Any:
    """Return a handler that is called by the network thread itself, which waits for it."""
    return zenoh.handlers.Callback(take, indirect=False)


def is_text(encoding: zenoh.Encoding | None) -> bool:
    """Tell whether a payload of that encoding is text or JSON rather than packed."""
    return encoding is not None and str(encoding).startswith(_TEXTS)


def payload(message: zenoh.Sample | zenoh.Query | zenoh.ReplyError) -> bytes:
    """Return the bytes of a message, none for a query without."""
    return message.payload.to_bytes() if message.payload is not None else b""


def _open(mode: str, settings: dict[str, Any], *, fewer_threads: bool) -> Any:
    """Open a session. The first one of a process decides on Zenoh's threads; a user's ZENOH_RUNTIME comes before."""
    if _RUNTIME in os.environ or not fewer_threads:
        return zenoh.open(_config(mode, settings))
    os.environ[_RUNTIME] = _FEWER_THREADS
    try:
        return zenoh.open(_config(mode, settings))
    finally:
        del os.environ[_RUNTIME]


def _config(mode: str, settings: dict[str, Any]) -> zenoh.Config:
    config = zenoh.Config()
    settings = {
        "mode": mode,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "scouting/delay": 0,
        "transport/shared_memory/enabled": False,
        LEASE: LEASE_MS,
        **settings,
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


def _reason(error: zenoh.ZError) -> str:
    """Return the library's message without the place in its own sources."""
    return _SOURCE_PLACE.sub("", str(error)).strip(" .]")
