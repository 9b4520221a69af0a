"""What a client may send to a bench: nothing of it ends the bench, holds it or fills its memory."""

import json
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from hli_bench.base.loading import data_file
from hli_bench.protocols.hli.layout import Layout
from hli_bench.shells import zenoh_inbox
from hli_bench.shells.zenoh_inbox import WAITING, WAITING_BYTES, Budget, Inbox
from hli_bench.shells.zenoh_plcs import MAIL, STRANGERS, Plcs
from hli_bench.shells.zenoh_requests import LONGEST_PROGRAM
from hli_bench.shells.zenoh_server import REQUESTS, SAID, HliServer
from hli_bench.shells.zenoh_session import connect

LAYOUT = Layout([(1, "X", "linear"), (2, "Y", "linear")])
TIME = "ax/2/lr_mc_control/timestamp/command_w"
PATIENCE_S = 30.0


def message(size: int = 8, key: str = "demo/plc/p/commands") -> Any:
    return SimpleNamespace(payload=bytes(size), key_expr=key)


# --- the inbox


def test_what_does_not_fit_is_dropped_and_counted() -> None:
    inbox, seen = Inbox(), []
    taken = [inbox.put(seen.append, message()) for _ in range(WAITING + 5)]
    assert taken == [True] * WAITING + [False] * 5
    assert inbox.dropped == 5
    assert inbox.put(seen.append, message(), share=2), "an attached PLC has room beside all others"
    inbox.handle(Budget(10**12))
    assert len(seen) == WAITING + 1
    assert inbox.put(seen.append, message())


def test_large_messages_are_bounded_by_their_bytes() -> None:
    inbox, seen = Inbox(), []
    large = message(WAITING_BYTES // 4)
    assert [inbox.put(seen.append, large) for _ in range(5)] == [True] * 4 + [False]
    inbox.handle(Budget(10**12))
    assert inbox.put(seen.append, large)


def test_a_look_handles_messages_while_its_budget_lasts(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0]
    monkeypatch.setattr(zenoh_inbox, "monotonic_ns", lambda: now[0])
    inbox, seen = Inbox(), []

    def slow(one: Any) -> None:
        now[0] += 30
        seen.append(one)

    for _ in range(10):
        inbox.put(slow, message())
    inbox.handle(Budget(100))
    assert len(seen) == 4
    inbox.handle(Budget(0))
    assert len(seen) == 5, "one at least, else it would never end"


# --- the bench's side, with the network threads left out


class Told:
    def __init__(self) -> None:
        self.refused: list[Any] = []
        self.detached: list[tuple[str, str]] = []
        self.inbox = Inbox()
        self.plcs = Plcs(
            "demo", LAYOUT, self.inbox, 10**12, self.refused.extend, lambda *plc: self.detached.append(plc)
        )


def sample(name: str, content: bytes) -> Any:
    class Content(bytes):
        def to_bytes(self) -> bytes:
            return bytes(self)

    return SimpleNamespace(payload=Content(content), key_expr=f"demo/plc/{name}/commands", kind=None)


def test_names_that_clients_make_up_are_told_seldom_and_not_gathered() -> None:
    told = Told()
    for number in range(WAITING):
        told.plcs.take(sample(f"s{number}", struct.pack("<Q", 1)))
    told.inbox.handle(Budget(10**12))
    assert STRANGERS <= len(told.detached) == len(told.refused) < WAITING
    assert told.inbox.dropped == WAITING - len(told.detached)
    assert told.detached[0] == ("s0", "attach first")


def test_a_plc_that_floods_its_own_mailbox_loses_its_oldest() -> None:
    told = Told()
    told.plcs._alive.add("p")
    assert told.plcs._admit("p") == ""
    element = LAYOUT.element(TIME).id
    for turn in range(2):
        for number in range(WAITING):
            told.plcs.take(sample("p", struct.pack("<QHq", 1, element, turn * WAITING + number)))
        told.plcs.alive("p")
    commands = told.plcs.latest_commands("p", 1)
    assert commands is not None
    assert [write.value for write in commands.writes] == list(range(2 * WAITING - MAIL, 2 * WAITING))
    assert told.inbox.dropped == 2 * WAITING - MAIL


def test_commands_longer_than_any_plc_needs_are_refused() -> None:
    told = Told()
    told.plcs._alive.add("p")
    told.plcs._admit("p")
    told.plcs.take(
        sample("p", struct.pack("<Q", 1) + struct.pack("<Hq", LAYOUT.element(TIME).id, 1) * 100_000)
    )
    assert told.plcs.latest_commands("p", 1) is not None
    assert "commands have at most" in told.refused[0].reason


def test_requests_that_nobody_serves_are_bounded(endpoint: str) -> None:
    with HliServer(endpoint, "demo", LAYOUT, []) as server:
        for _ in range(REQUESTS + 3):
            server._on_reset_put(None)
        assert server.dropped == 3
        assert len(server.requests()) == REQUESTS


def test_what_is_dropped_is_told(endpoint: str) -> None:
    lines: list[str] = []
    with HliServer(endpoint, "demo", LAYOUT, [], on_fault=lines.append) as server:
        server._inbox.dropped = 7
        assert server.stirs
        server.requests()
        assert server.refused == 1
        assert lines == ["7 messages dropped, more came than the bench takes; 7 so far"]
        server._inbox.dropped = 9
        server.requests()
        assert server.refused == 1, "at most once a second"


def test_a_message_that_cannot_be_handled_is_told_and_the_bench_goes_on(endpoint: str) -> None:
    lines: list[str] = []
    with HliServer(endpoint, "demo", LAYOUT, [], on_fault=lines.append) as server:
        server._failed(SimpleNamespace(key_expr="demo/cnc/reset"), RecursionError("too deep"))
        assert server.refused == 1
        assert lines == ["demo/cnc/reset: the bench failed at this message: RecursionError: too deep"]


# --- a bench that is up

FLOOD = """
import random, sys
from hli_bench.shells.zenoh_session import connect

with connect(sys.argv[1]) as session:
    for _ in range(int(sys.argv[2])):
        session.put(f"demo/plc/{random.getrandbits(60)}/commands", bytes(8))
    session.get("demo/cnc/state", timeout=30.0).recv()
"""


def rss_kb(pid: int) -> int:
    status = Path(f"/proc/{pid}/status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0])


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_flood_of_puts_grows_no_memory_and_is_told(serve: Callable[..., Any], pace: str) -> None:
    bench = serve("--plc", "none", "--pace", pace)
    with bench.client() as client:
        client.state()
        before = rss_kb(bench.command.process.pid)
        subprocess.run([sys.executable, "-c", FLOOD, bench.endpoint, "100000"], check=True)
        errors = client.hli_errors()
        net = client.state()["net"]
    assert rss_kb(bench.command.process.pid) - before < 30_000
    assert net["dropped"] > 0
    assert net["refused"] == errors["refused"]
    assert any("messages dropped" in record["reason"] for record in errors["last"])


HOSTILE = {
    "a path": "/etc/hostname.nc",
    "backslashes": "\\" * 1200,
    "brackets": "N10 P1 = " + "[" * 5000 + "\nN20 M30",
    "a long name": "N10 V.P." + "A" * 300 + " = 1\nN20 M30",
    "a long path": "a" * 300 + ".nc",
    "a null": "N10 G01 X\0 1\nN20 M30",
    "no text": b"\xff\xfe\x00\x80".decode("latin-1"),
    "surrogates": 'N10 #MSG ["\ud7ff"] M',
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE)
def test_whatever_a_client_runs_is_answered_and_the_bench_stays(bench: Any, text: str) -> None:
    with bench.client() as client:
        replies = list(client.session.get("demo/cnc/run", payload=text, timeout=PATIENCE_S))
        assert [
            reply.ok is not None or "Timeout" not in reply.err.payload.to_string() for reply in replies
        ] == [True]
        assert client.run("N10 G04 0.001\nN20 M30")["status"] == "completed"


def test_a_program_is_text_and_never_a_path(bench: Any, program: Callable[[str], Path]) -> None:
    path = program("N10 G04 0.001\nN20 M30\n")
    with bench.client() as client:
        (reply,) = client.session.get("demo/cnc/run", payload=str(path), timeout=PATIENCE_S)
    assert reply.ok is None
    assert "program:1:" in reply.err.payload.to_string()


def test_a_program_that_is_too_long_is_refused(bench: Any) -> None:
    with bench.client() as client:
        text = ";" + "x" * LONGEST_PROGRAM
        (reply,) = client.session.get("demo/cnc/run", payload=text, timeout=PATIENCE_S)
        assert f"at most {LONGEST_PROGRAM} expected" in reply.err.payload.to_string()
        assert len(client.hli_errors()["last"][-1]["reason"]) < 2 * SAID


@pytest.mark.parametrize("text", [b"soon" * 100_000, b"16#" + b"F" * 5000, b"9" * 5000, b"3#" + b"1" * 60])
def test_a_value_of_any_length_is_refused_and_not_kept(bench: Any, text: bytes) -> None:
    with bench.client() as client, connect(bench.endpoint) as session:
        before = client.hli_errors()["refused"]
        session.put(f"demo/hli/unit/{TIME}", text, encoding="text/plain")
        bench.settled(lambda _: client.hli_errors()["refused"] > before)
        assert len(json.dumps(client.hli_errors()["last"][-1])) < 3 * SAID


@pytest.mark.parametrize("size", [0, 17])
def test_an_image_of_a_wrong_size_is_left_out_by_an_attached_plc(serve: Any, probe: Path, size: int) -> None:
    bench = serve("--plc", "none", "--pace", "free")
    plc = bench.plc(data_file("plc_scripts", "demo.py"))
    with connect(bench.endpoint) as session:
        for _ in range(3):
            session.put("demo/hli/image", bytes(size))
            session.put("demo/io/probe", bytes(size))
            session.put("demo/hli/errors", b"[" * size)
        list(session.get("demo/cnc/state", timeout=PATIENCE_S))
    run = bench.run(probe)
    assert run.end() == 0, run.err
    assert plc.process.poll() is None
    assert any(f"hli/image: an image of {size} bytes" in line for line in plc.out), plc.out
