"""A PLC made of zenoh, struct and json alone: forwards a touch probe to one axis.

`python plain_zenoh_plc.py ENDPOINT [MACHINE] [AXIS] [PERIOD_US]`. It takes all it needs to know from `hli/layout` and
`hli/terminals`, attaches, answers every image it is due for and ends with the bench.
"""

import json
import struct
import sys
from queue import SimpleQueue
from typing import Any

import zenoh

NAME = "plain"
CODES = {"BOOL": "?", "UNS08": "B", "UNS16": "H", "UNS32": "I", "UNS64": "Q", "SGN32": "i", "SGN64": "q"}


def main(endpoint: str, machine: str = "demo", axis: str = "3", period_us: str = "1000") -> None:
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("transport/link/tx/lease", "500")
    with zenoh.open(config) as session:
        run(session, machine, axis, int(period_us))


def run(session: zenoh.Session, machine: str, axis: str, period_us: int) -> None:
    def ask(path: str, question: str | None = None) -> bytes:
        for reply in session.get(f"{machine}/{path}", payload=question, timeout=10.0):
            if reply.ok is None:
                raise SystemExit(f"{path}: {reply.err.payload.to_string()}")
            return reply.ok.payload.to_bytes()
        raise SystemExit(f"{path}: no answer")

    inbox: SimpleQueue[tuple[str, Any]] = SimpleQueue()

    def into_inbox(kind: str) -> Any:
        # Not indirect: with a thread of its own for each subscriber the image could overtake what belongs to it.
        return zenoh.handlers.Callback(lambda sample: inbox.put((kind, sample)), indirect=False)

    session.declare_subscriber(f"{machine}/io/probe", into_inbox("probe"))
    session.declare_subscriber(f"{machine}/hli/image", into_inbox("image"))
    session.liveliness().declare_subscriber(f"{machine}/bench/alive", into_inbox("alive"), history=True)
    token = session.liveliness().declare_token(f"{machine}/plc/{NAME}/alive")

    elements = {row["path"]: row for row in json.loads(ask("hli/layout"))}
    (terminal,) = [row for row in json.loads(ask("hli/terminals")) if row["name"] == "probe"]
    entries = {entry: (CODES[kind], at) for entry, kind, at in terminal["entries"]}
    probe = ask("io/probe")
    terms = json.loads(ask(f"plc/{NAME}/attach", json.dumps({"period_us": period_us})))
    first, period = terms["cycle"], terms["period_us"] // terms["cycle_us"]

    area = f"ax/{axis}/lr_mc_control"
    written = {}
    while True:
        kind, sample = inbox.get()
        if kind == "probe":
            probe = sample.payload.to_bytes()
        if kind == "alive" and sample.kind == zenoh.SampleKind.DELETE:
            token.undeclare()
            return
        if kind != "image":
            continue
        (cycle,) = struct.unpack_from("<Q", sample.payload.to_bytes())
        if cycle < first or cycle % period:
            continue
        level, edge_ns = (
            struct.unpack_from("<" + entries[entry][0], probe, entries[entry][1])[0]
            for entry in ("ch2/input", "ch2/latch_pos")
        )
        wanted = {
            f"ax/{axis}/head/plc_present_w": True,
            f"{area}/release_feedhold/enable_w": True,
            f"{area}/release_feedhold/command_w": True,
            f"{area}/probing_signal/enable_w": True,
            f"{area}/timestamp/enable_w": True,
            f"{area}/timestamp/command_w": edge_ns,
            f"{area}/probing_signal/command_w": level,
        }
        message = struct.pack("<Q", cycle)
        for path, value in wanted.items():
            if written.get(path) != value:
                element = elements[path]
                message += struct.pack("<H" + CODES[element["type"]], element["id"], value)
                written[path] = value
        session.put(f"{machine}/plc/{NAME}/commands", message, express=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
