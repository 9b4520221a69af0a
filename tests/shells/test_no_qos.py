"""Clients without priorities, as every zenoh-pico client is, and the signs of life that they wait for."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from queue import SimpleQueue
from threading import Thread
from typing import Any
from zlib import crc32

from hli_bench.protocols.hli.layout import Layout
from hli_bench.shells.zenoh_requests import Attach
from hli_bench.shells.zenoh_server import HliServer
from hli_bench.shells.zenoh_session import connect

LAYOUT = Layout([(1, "X", "linear"), (2, "Y", "linear")])
LAYOUT_LIMIT = 100_000
"""Bytes of the reply to `hli/layout` that docs/interfaces.md tells small clients to have room for."""
FILL = 30_000
"""Images that no buffer between two processes can hold."""
READER = """
import json, struct, sys, zenoh

config = zenoh.Config()
for key, value in {
    "mode": "client",
    "connect/endpoints": [sys.argv[1]],
    "scouting/multicast/enabled": False,
    "transport/unicast/qos/enabled": False,
}.items():
    config.insert_json5(key, json.dumps(value))
with zenoh.open(config) as session:
    images = session.declare_subscriber("demo/hli/image", zenoh.handlers.RingChannel(1))
    print("there", flush=True)
    while struct.unpack_from("<Q", images.recv().payload.to_bytes())[0] < int(sys.argv[2]):
        pass
    print("heard", flush=True)
    sys.stdin.read()
"""


def test_a_client_without_priorities_that_stood_hears_again(endpoint: str) -> None:
    with HliServer(endpoint, "demo", LAYOUT, [], lockstep=False) as server:
        command = [sys.executable, "-c", READER, endpoint, str(FILL)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as reader:
            assert reader.stdout is not None
            assert reader.stdout.readline() == "there\n"
            while not server.image_wanted:
                server.wait_request(0.05)
                server._looks = 1
            os.kill(reader.pid, signal.SIGSTOP)
            image = bytes(LAYOUT.size)
            for cycle in range(FILL):
                server.publish(cycle, 0, image, [("x", image)], {})
            os.kill(reader.pid, signal.SIGCONT)
            heard: list[str] = []
            waiting = Thread(target=lambda: heard.append(reader.stdout.readline()))  # type: ignore[union-attr]
            waiting.start()
            for cycle in range(FILL, FILL + 3000):
                server.wait_request(0.01)
                server._looks = 1
                server.publish(cycle, 0, image, [], {})
                if heard:
                    break
            reader.kill()
            waiting.join()
    assert heard == ["heard\n"]


def test_the_attach_reply_tells_which_layout_holds(endpoint: str) -> None:
    answers: SimpleQueue[Any] = SimpleQueue()
    with HliServer(endpoint, "demo", LAYOUT, []) as server, connect(endpoint) as session:
        token = session.liveliness().declare_token("demo/plc/p/alive")
        session.get("demo/plc/p/attach", answers.put, payload='{"period_us": 1000}', timeout=10.0)
        session.get("demo/hli/layout", answers.put, timeout=10.0)
        for _ in range(400):
            for request in server.wait_request(0.05):
                assert isinstance(request, Attach)
                assert request.accept(cycle=5, cycle_us=1000, lockstep=True)
            if answers.qsize() == 2:
                break
        texts = {
            str(answer.ok.key_expr): answer.ok.payload.to_bytes() for answer in (answers.get(), answers.get())
        }
        token.undeclare()
    told = json.loads(texts["demo/plc/p/attach"])
    assert told["layout"] == f"{crc32(texts['demo/hli/layout']):08x}"
    assert len(texts["demo/hli/layout"]) < LAYOUT_LIMIT


def test_the_layout_of_eight_axes_is_no_larger_than_the_documents_say() -> None:
    layout = Layout([(number, f"X{number}", "rotary") for number in range(1, 9)])
    assert len(layout.to_json()) < LAYOUT_LIMIT


def test_a_bench_gives_signs_of_life_within_the_lease_of_a_plc(endpoint: str) -> None:
    """Counted on the wire, between a client and the bench: with one every 7.5 s there would be one in this time."""
    place = endpoint.removeprefix("tcp/127.0.0.1:")
    with HliServer(endpoint, "demo", LAYOUT, []), socket.create_server(("127.0.0.1", 0)) as door:
        came: list[int] = []
        ends: list[socket.socket] = []

        def between() -> None:
            client, _ = door.accept()
            bench = socket.create_connection(("127.0.0.1", int(place)))
            ends.extend((client, bench))

            def pass_on(source: socket.socket, to: socket.socket, count: list[int]) -> None:
                try:
                    while data := source.recv(65536):
                        count.append(len(data))
                        to.sendall(data)
                except OSError:
                    pass

            Thread(target=pass_on, args=(client, bench, []), daemon=True).start()
            Thread(target=pass_on, args=(bench, client, came), daemon=True).start()

        Thread(target=between, daemon=True).start()
        with connect(f"tcp/127.0.0.1:{door.getsockname()[1]}"):
            time.sleep(1.0)
            before = len(came)
            time.sleep(5.0)
            # in 5 s at least one each 250 ms, half of what a lease of 500 ms asks for
            assert len(came) - before >= 20
        for end in ends:
            end.close()
