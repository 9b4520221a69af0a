"""The HLI over real Zenoh sessions: the bench's side in this process, clients in others."""

import json
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest

from hli_bench.base import loading
from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.protocols.hli.access import Access
from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout
from hli_bench.shells import plc_process
from hli_bench.shells.zenoh_client import HliClient
from hli_bench.shells.zenoh_plcs import STRANGERS
from hli_bench.shells.zenoh_requests import (
    Attach,
    FaultOrder,
    Request,
    Reset,
    RunProgram,
    State,
    WriteRequest,
)
from hli_bench.shells.zenoh_server import HliServer
from hli_bench.shells.zenoh_session import connect, queued
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.images import TerminalLayout

AXES = [(number, name, "linear") for number, name in enumerate(("X", "Y", "Z", "X2", "A", "B", "S"), 1)]
LAYOUT = Layout(AXES)
PROBE = TerminalLayout(
    "probe", (("ch2/input", "BOOL", 0), ("ch2/latch_pos", "UNS64", 8), ("ch2/latch_neg", "UNS64", 16))
)
CAMS = TerminalLayout("cams", tuple((f"ch{number}/input", "BOOL", number - 1) for number in range(1, 9)))
UNIT = "ax/3/lr_mc_control/probing_signal"
TIME = "ax/3/lr_mc_control/timestamp"
PATIENCE_S = 30.0
CYCLES_THAT_FILL = 20_000
"""Images that no buffer between two processes can hold."""


def free_endpoint() -> str:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return f"tcp/127.0.0.1:{listener.getsockname()[1]}"


class SmallBench:
    """What a bench does with its server, without a machine: writes are applied, requests answered."""

    def __init__(self) -> None:
        self.endpoint = free_endpoint()
        self.image = Image(LAYOUT)
        self.access = Access(self.image)
        self.server = HliServer(self.endpoint, "demo", LAYOUT, [PROBE, CAMS])
        self.cycle = 0
        self.seen: list[Request] = []

    def publish(self, **io: bytes) -> None:
        self.cycle += 1
        changed = self.image.take_changed()
        self.server.publish(self.cycle, self.cycle * 1_000_000, bytes(self.image.data), changed, io)

    def answer(self, request: Request) -> None:
        self.seen.append(request)
        match request:
            case WriteRequest():
                self.write(request)
            case Attach():
                request.accept(cycle=self.cycle + 1, cycle_us=1000, lockstep=True)
            case RunProgram():
                request.reply(
                    json.dumps(
                        {"status": "completed", "program": request.name, "text": "\n".join(request.lines())}
                    )
                )
            case State():
                request.reply(json.dumps({"mode": 2}))
            case FaultOrder():
                request.reply(json.dumps(request.order))
            case Reset():
                request.reply()

    def write(self, request: WriteRequest) -> None:
        try:
            commands = Commands("", self.cycle, (self.access.write_of(request.write),))
        except InputError as error:
            request.refuse(error.message)
            return
        refusals = self.access.apply(commands)
        self.server.report(refusals)
        if refusals:
            request.deny(refusals[0].reason)
        else:
            self.publish()
            request.reply()

    def serve(self, done: Callable[[], bool]) -> None:
        for _ in range(int(PATIENCE_S / 0.05)):
            for request in self.server.wait_request(0.05):
                self.answer(request)
            if done():
                return
        pytest.fail("what was waited for did not come")

    def exchange(self, plc: str, **io: bytes) -> Commands:
        self.publish(**io)
        commands = self.server.plcs.commands(plc, self.cycle, PATIENCE_S)
        assert commands is not None
        self.server.report(self.access.apply(commands))
        return commands

    def value(self, path: str) -> Any:
        return self.image.get(LAYOUT.element(path).id)


@pytest.fixture
def bench() -> Iterator[SmallBench]:
    bench = SmallBench()
    with bench.server:
        yield bench


@pytest.fixture(scope="module")
def elsewhere() -> Iterator[Callable[..., "Future[Any]"]]:
    """Runs a function of this module in another process."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        yield pool.submit


def ask(bench: SmallBench, elsewhere: Any, function: Callable[..., Any], *arguments: Any) -> Any:
    future = elsewhere(function, bench.endpoint, *arguments)
    bench.serve(future.done)
    return future.result()


# --- run in the other process


def with_client(endpoint: str, method: str, *arguments: Any) -> Any:
    with HliClient(endpoint) as client:
        try:
            return getattr(client, method)(*arguments)
        except InputError as error:
            return f"InputError: {error}"


def plain_get(endpoint: str, key: str, question: bytes | None = None) -> list[tuple[str, bytes, str]]:
    with connect(endpoint) as session:
        return [
            (str(reply.ok.key_expr), reply.ok.payload.to_bytes(), str(reply.ok.encoding))
            if reply.ok is not None
            else ("", reply.err.payload.to_bytes(), "")
            for reply in session.get(key, payload=question, timeout=10.0)
        ]


def plain_put(endpoint: str, key: str, value: bytes, encoding: str, attachment: str | None = None) -> Any:
    """Put, then wait for the record of the refusal or the changed unit, whichever comes."""
    answers: SimpleQueue[tuple[str, bytes]] = SimpleQueue()
    with connect(endpoint) as session:
        for watched in ("demo/hli/errors", "demo/hli/image"):
            session.declare_subscriber(
                watched, lambda sample: answers.put((str(sample.key_expr), sample.payload.to_bytes()))
            )
        session.put(key, value, encoding=encoding, attachment=attachment)
        key, answer = answers.get(timeout=PATIENCE_S)
        return json.loads(answer) if key.endswith("errors") else key


def lockstep_plc(endpoint: str, cycles: int) -> list[str]:
    """Answer `cycles` images; return where what belongs to an image had not arrived before it."""
    wrong: list[str] = []
    inbox: SimpleQueue[tuple[str, Any]] = SimpleQueue()
    time_id = LAYOUT.element(f"{TIME}/command_w").id
    with connect(endpoint) as session:
        token = session.liveliness().declare_token("demo/plc/lock/alive")
        for key in ("demo/io/probe", f"demo/hli/unit/{TIME}", "demo/hli/image"):
            session.declare_subscriber(key, queued(inbox.put, key))
        for reply in session.get("demo/plc/lock/attach", payload='{"period_us": 1000}', timeout=10.0):
            due = json.loads(reply.ok.payload.to_string())["cycle"]
        seen, first = {}, due
        while due < first + cycles:
            key, sample = inbox.get(timeout=PATIENCE_S)
            data = sample.payload.to_bytes()
            if not key.endswith("image"):
                seen[key] = data
                continue
            cycle, _ = struct.unpack_from("<Qq", data)
            if cycle != due:
                wrong.append(f"image {cycle} instead of {due}")
            if struct.unpack_from("<Q", seen["demo/io/probe"], 8)[0] != cycle:
                wrong.append(f"terminal of {cycle} late")
            if cycle > first and struct.unpack_from("<q", seen[f"demo/hli/unit/{TIME}"], 9)[0] != cycle - 1:
                wrong.append(f"unit of {cycle} late")
            session.put("demo/plc/lock/commands", struct.pack("<QHq", cycle, time_id, cycle), express=True)
            due += 1
        while not key.endswith("image") or struct.unpack_from("<Q", data)[0] < due:
            key, sample = inbox.get(timeout=PATIENCE_S)
            data = sample.payload.to_bytes()
        token.undeclare()
    return wrong


NEVER_READS = """
import sys, zenoh
from hli_bench.shells.zenoh_session import connect

with connect(sys.argv[1]) as session:
    subscriber = session.declare_subscriber("demo/hli/image", zenoh.handlers.FifoChannel(1))
    print("there", flush=True)
    sys.stdin.read()
"""


def send_commands(endpoint: str, plc: str, messages: list[bytes], *, attach: bool) -> str:
    """Send messages as a PLC; return what came back: nothing, or that it is to attach."""
    told: SimpleQueue[str] = SimpleQueue()
    with connect(endpoint) as session:
        session.declare_subscriber(f"demo/plc/{plc}/detached", lambda _: told.put("detached"))
        token = session.liveliness().declare_token(f"demo/plc/{plc}/alive")
        if attach:
            list(session.get(f"demo/plc/{plc}/attach", payload='{"period_us": 1000}', timeout=10.0))
        for message in messages:
            session.put(f"demo/plc/{plc}/commands", message)
        list(session.get("demo/cnc/state", timeout=10.0))
        answer = "" if attach else told.get(timeout=PATIENCE_S)
        token.undeclare()
        return answer


# --- keys and values


def test_a_taken_port_is_told(bench: SmallBench) -> None:
    with pytest.raises(EnvironmentLacks, match=r"cannot listen on .*in use.*--zenoh"):
        HliServer(bench.endpoint, "demo", LAYOUT, [])


def test_a_client_without_a_bench_is_told_what_to_do() -> None:
    with pytest.raises(EnvironmentLacks, match=r"no bench listens on .*hli-bench serve"):
        HliClient(free_endpoint())


def test_the_layout_is_a_list_of_all_elements(bench: SmallBench, elsewhere: Any) -> None:
    ((key, text, encoding),) = ask(bench, elsewhere, plain_get, "*/hli/layout")
    assert (key, encoding) == ("demo/hli/layout", "application/json")
    assert [row["path"] for row in json.loads(text)] == [element.path for element in LAYOUT.elements]


@pytest.mark.req("M-235", "M-238")
def test_units_and_members_are_got_packed_or_as_json_by_new_and_old_names(
    bench: SmallBench, elsewhere: Any
) -> None:
    bench.image.set(LAYOUT.element(f"{TIME}/command_w").id, -7)
    bench.publish()
    cases = {
        f"demo/hli/unit/{TIME}": struct.pack("<q?qq", 0, False, -7, 0),
        f"demo/hli/unit/{TIME}/command_w": struct.pack("<q", -7),
        f"demo/hli/unit/{TIME}/X_Command": struct.pack("<q", -7),
        "demo/hli/unit/ax/3/MCControlBoolUnit_ProbingSignal": bytes(4),
    }
    for key, packed in cases.items():
        assert ask(bench, elsewhere, plain_get, key) == [(key, packed, "application/octet-stream")]
    ((_, text, _),) = ask(bench, elsewhere, plain_get, f"demo/hli/unit/{TIME}?format=json")
    assert json.loads(text) == {"request_r": 0, "enable_w": False, "command_w": -7, "state_r": 0}


def test_a_wide_query_gets_all_units_and_members(bench: SmallBench, elsewhere: Any) -> None:
    keys = {key for key, _, _ in ask(bench, elsewhere, plain_get, "demo/hli/unit/**")}
    assert keys == {f"demo/hli/unit/{path}" for path in (*LAYOUT.groups, *(e.path for e in LAYOUT.elements))}


def test_an_unknown_path_is_refused_with_near_names_and_counted(bench: SmallBench, elsewhere: Any) -> None:
    ((_, reason, _),) = ask(bench, elsewhere, plain_get, "demo/hli/unit/ax/3/lr_mc_control/timestmp")
    assert b"near names: ax/3/lr_mc_control/timestamp" in reason
    assert bench.server.refused == 1


def test_terminals_are_got_whole_and_by_entry(bench: SmallBench, elsewhere: Any) -> None:
    bench.publish(probe=struct.pack("<?7xQ8x", True, 2**40))
    found = {key: data for key, data, _ in ask(bench, elsewhere, plain_get, "demo/io/probe/**")}
    assert found == {
        "demo/io/probe": struct.pack("<?7xQ8x", True, 2**40),
        "demo/io/probe/ch2/input": b"\x01",
        "demo/io/probe/ch2/latch_pos": struct.pack("<Q", 2**40),
        "demo/io/probe/ch2/latch_neg": bytes(8),
    }


def test_the_client_lists_gets_and_sets_elements(bench: SmallBench, elsewhere: Any) -> None:
    rows = ask(bench, elsewhere, with_client, "ls", "ch2")
    assert rows == [
        ("io/probe/ch2/input", "BOOL", "", "r"),
        ("io/probe/ch2/latch_pos", "UNS64", "", "r"),
        ("io/probe/ch2/latch_neg", "UNS64", "", "r"),
        ("io/cams/ch2/input", "BOOL", "", "r"),
    ]
    assert ask(bench, elsewhere, with_client, "set", f"{UNIT}/X_Command", "TRUE") == ""
    assert bench.value(f"{UNIT}/command_w") is True
    assert ask(bench, elsewhere, with_client, "get", f"{UNIT}/command_w") is True
    assert ask(bench, elsewhere, with_client, "get", "io/cams")["ch3/input"] is False


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        (f"{UNIT}/state_r", "TRUE", "written by the CNC"),
        (f"{TIME}/command_w", "soon", "'soon' is no SGN64"),
        ("io/probe/ch2/input", "TRUE", "is an input"),
        ("ax/3/nothing", "1", "no HLI element"),
    ],
)
def test_the_client_is_told_why_a_write_is_refused(
    bench: SmallBench, elsewhere: Any, name: str, text: str, reason: str
) -> None:
    assert reason in ask(bench, elsewhere, with_client, "set", name, text)


def test_program_state_reset_and_faults_reach_the_bench(bench: SmallBench, elsewhere: Any) -> None:
    result = ask(bench, elsewhere, with_client, "run", "N10 M30", "a;b &c=ü%.nc")
    assert result == {"status": "completed", "program": "a;b &c=ü%.nc", "text": "N10 M30"}
    assert ask(bench, elsewhere, with_client, "state") == {"mode": 2}
    assert ask(bench, elsewhere, with_client, "reset") == ""
    assert ask(bench, elsewhere, with_client, "fault", {"inject": "probe_stuck"}) == {"inject": "probe_stuck"}
    assert [type(request) for request in bench.seen] == [RunProgram, State, Reset, FaultOrder]
    assert "no NC program" in ask(bench, elsewhere, with_client, "run", "  ")


def test_error_records_of_the_cnc_are_kept(bench: SmallBench, elsewhere: Any) -> None:
    bench.server.put_error({"id": 50886, "axis": "Z"})
    assert ask(bench, elsewhere, with_client, "cnc_errors") == [{"id": 50886, "axis": "Z"}]


# --- writes by put


def test_what_the_bench_puts_is_no_request_to_itself(bench: SmallBench, elsewhere: Any) -> None:
    bench.image.set(LAYOUT.element(f"{TIME}/state_r").id, 5)
    bench.publish()
    ask(bench, elsewhere, with_client, "state")
    assert [type(request) for request in bench.seen] == [State]
    assert bench.server.refused == 0


@pytest.mark.parametrize(
    ("value", "encoding"),
    [(struct.pack("<q", -5), "zenoh/bytes"), (b"-5", "text/plain"), (b"-5", "application/json")],
)
def test_a_member_is_put_packed_or_as_text(
    bench: SmallBench, elsewhere: Any, value: bytes, encoding: str
) -> None:
    key = f"demo/hli/unit/{TIME}/command_w"
    assert ask(bench, elsewhere, plain_put, key, value, encoding) == "demo/hli/image"
    assert bench.value(f"{TIME}/command_w") == -5


@pytest.mark.req("M-237")
@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        (f"{UNIT}/state_r", b"\x01", "written by the CNC"),
        (f"{UNIT}/command_w", b"\x01\x00", "2 bytes, BOOL takes 1"),
        ("ax/3/nothing/command_w", b"\x01", "no HLI element"),
        (UNIT, b"\x01\x01\x01\x01", "whole unit"),
    ],
)
def test_a_put_that_is_refused_is_counted_and_reported(
    bench: SmallBench, elsewhere: Any, path: str, value: bytes, reason: str
) -> None:
    record = ask(bench, elsewhere, plain_put, f"demo/hli/unit/{path}", value, "zenoh/bytes")
    assert record["path"] == path
    assert reason in record["reason"]
    assert bench.server.refused == 1
    assert ask(bench, elsewhere, with_client, "hli_errors") == {"refused": 1, "last": [record]}


@pytest.mark.parametrize("key", ["io/probe", "io/probe/ch2/input", "io/nothing", "hli/layout", "cnc/state"])
def test_what_only_the_bench_puts_is_refused_to_clients(bench: SmallBench, elsewhere: Any, key: str) -> None:
    record = ask(bench, elsewhere, plain_put, f"demo/{key}", b"\x01", "zenoh/bytes")
    assert (record["path"], record["reason"]) == (key, "written by the bench, a client may only read it")
    assert bench.server.refused == 1


def test_a_unit_of_a_plc_is_refused_to_who_puts_only_whatever_he_calls_himself(
    bench: SmallBench, elsewhere: Any
) -> None:
    key = f"demo/hli/unit/{UNIT}/command_w"
    put = partial(ask, bench, elsewhere, plain_put, key, b"\x01", "zenoh/bytes")
    assert put("first") == "demo/hli/image"
    assert bench.access.owner(UNIT) == ""
    bench.access.apply(Commands("first", bench.cycle, (Write(f"{UNIT}/enable_w", True),)))
    for name in (None, "first"):
        assert put(name)["reason"] == "the unit belongs to PLC 'first'"


# --- PLCs


def test_lockstep_exchanges_2000_cycles_in_order(bench: SmallBench, elsewhere: Any) -> None:
    plc = elsewhere(lockstep_plc, bench.endpoint, 2000)
    bench.serve(lambda: bench.server.plcs.attached == ["lock"])
    for _ in range(2000):
        commands = bench.exchange("lock", probe=struct.pack("<8xQ8x", bench.cycle + 1))
        assert commands.cycle == bench.cycle
        assert [write.value for write in commands.writes] == [bench.cycle]
    bench.publish()
    assert plc.result() == []
    assert bench.server.plcs.late == {}
    assert bench.server.refused == 0


def test_a_reader_that_never_reads_holds_nobody(bench: SmallBench) -> None:
    """Images for it are dropped: a put that waited for it would end its link after some seconds."""
    command = [sys.executable, "-c", NEVER_READS, bench.endpoint]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as reader:
        assert reader.stdout is not None
        assert reader.stdout.readline() == "there\n"
        for _ in range(CYCLES_THAT_FILL):
            bench.publish(probe=struct.pack("<8xQ8x", bench.cycle + 1))
        assert bench.server.image_wanted, "it is still there"
        reader.kill()


def test_answers_to_older_cycles_count_late_and_to_future_ones_not_at_all(
    bench: SmallBench, elsewhere: Any
) -> None:
    element = LAYOUT.element(f"{TIME}/command_w").id
    messages = [struct.pack("<QHq", cycle, element, cycle) for cycle in (1, 9, 3)]
    future = elsewhere(send_commands, bench.endpoint, "p", messages, attach=True)
    bench.serve(lambda: any(isinstance(request, State) for request in bench.seen))
    commands = bench.server.plcs.commands("p", 3, 0)
    future.result()
    assert commands is not None
    assert [write.value for write in commands.writes] == [1, 3]
    assert bench.server.plcs.late == {"p": 1}
    assert bench.server.refused == 1


def test_paced_commands_are_all_that_came_with_the_newest_cycle(bench: SmallBench, elsewhere: Any) -> None:
    element = LAYOUT.element(f"{TIME}/command_w").id
    messages = [struct.pack("<QHq", cycle, element, cycle) for cycle in (1, 9, 2)]
    future = elsewhere(send_commands, bench.endpoint, "p", messages, attach=True)
    bench.serve(lambda: any(isinstance(request, State) for request in bench.seen))
    commands = bench.server.plcs.latest_commands("p", 2)
    future.result()
    assert commands is not None
    assert (commands.cycle, [write.value for write in commands.writes]) == (2, [1, 2])
    assert bench.server.plcs.latest_commands("p", 2) is None
    assert bench.server.refused == 1


def test_malformed_commands_are_refused_and_still_answer_their_cycle(
    bench: SmallBench, elsewhere: Any
) -> None:
    future = elsewhere(
        send_commands, bench.endpoint, "p", [b"\x01", struct.pack("<QH", 4, 60000)], attach=True
    )
    bench.serve(lambda: any(isinstance(request, State) for request in bench.seen))
    assert bench.server.plcs.commands("p", 4, 0) == Commands("p", 4, ())
    future.result()
    assert bench.server.refused == 2


def test_a_plc_that_is_not_attached_is_told_so(bench: SmallBench, elsewhere: Any) -> None:
    future = elsewhere(send_commands, bench.endpoint, "stranger", [struct.pack("<Q", 1)] * 3, attach=False)
    bench.serve(future.done)
    assert future.result() == "detached"
    assert bench.server.refused == 1


@pytest.mark.parametrize(
    "question",
    [
        *('{"period_us": 0}', "{}", "[]", "now", '{"period_us": "x"}', '{"period_us": "1000"}'),
        *('{"period_us": true}', '{"period_us": 1500.7}', '{"period_us": 1e400}', '{"period_us": 1e18}'),
        "[" * 100_000,
    ],
)
def test_an_attach_that_makes_no_sense_is_refused(bench: SmallBench, elsewhere: Any, question: str) -> None:
    ((_, reason, _),) = ask(bench, elsewhere, plain_get, "demo/plc/p/attach", question.encode())
    assert b"expected" in reason
    assert bench.server.plcs.attached == []


def test_an_attach_without_a_living_token_is_refused(bench: SmallBench, elsewhere: Any) -> None:
    ((_, reason, _),) = ask(bench, elsewhere, plain_get, "demo/plc/p/attach", b'{"period_us": 1000}')
    assert b"no liveliness token demo/plc/p/alive" in reason
    assert bench.server.plcs.attached == []


def attach_and_go(endpoint: str) -> str:
    """Attach and, before there is an answer, end; return the answer.

    The end of a token may overtake a query on its way: the question in between waits until the bench has both.
    """
    answers: SimpleQueue[Any] = SimpleQueue()
    with connect(endpoint) as session:
        token = session.liveliness().declare_token("demo/plc/brief/alive")
        session.get("demo/plc/brief/attach", answers.put, payload='{"period_us": 1000}', timeout=10.0)
        list(session.get("demo/hli/errors", timeout=10.0))
        token.undeclare()
        reply = answers.get(timeout=PATIENCE_S)
        return str(reply.err.payload.to_string()) if reply.ok is None else "taken in"


def test_a_plc_that_goes_while_it_attaches_is_not_taken_in(bench: SmallBench, elsewhere: Any) -> None:
    """Both come in one look at the inbox; afterwards nobody would tell the bench that the PLC has gone."""
    future = elsewhere(attach_and_go, bench.endpoint)
    requests: list[Request] = []
    for _ in range(int(PATIENCE_S / 0.05)):
        requests += bench.server.wait_request(0.05)
        if any(isinstance(request, Attach) for request in requests) and not bench.server.plcs._alive:
            break
        if future.done():
            pytest.fail(f"the PLC has ended: {future.result()}")
    else:
        pytest.fail(f"the PLC did not come and go: {requests}, {bench.server.plcs._alive}")
    for request in requests:
        bench.answer(request)
    bench.serve(future.done)
    assert "no liveliness token" in future.result()
    assert bench.server.plcs.attached == []
    assert bench.server.plcs.departed() == []


def many_strangers(endpoint: str) -> None:
    with connect(endpoint) as session:
        for number in range(3 * STRANGERS):
            session.put(f"demo/plc/s{number}/commands", struct.pack("<Q", 1))
        list(session.get("demo/cnc/state", timeout=10.0))


def test_names_that_clients_choose_are_not_gathered(bench: SmallBench, elsewhere: Any) -> None:
    ask(bench, elsewhere, many_strangers)
    assert bench.server.refused + bench.server.dropped >= 3 * STRANGERS
    assert bench.server.refused >= STRANGERS
    assert len(bench.server.plcs._strangers) == STRANGERS


@pytest.fixture
def processes() -> Iterator[list["subprocess.Popen[bytes]"]]:
    """Processes started in a test; those still there at its end are killed."""
    started: list[subprocess.Popen[bytes]] = []
    yield started
    for process in started:
        process.kill()
        process.wait()


def start_script(bench: SmallBench, processes: Any, name: str = "", script: Path | None = None) -> Any:
    path = script or loading.data_file("plc_scripts", "probing.py")
    process = plc_process.start(path, bench.endpoint, name)
    processes.append(process)
    bench.serve(lambda: (name or path.stem) in bench.server.plcs.attached)
    return process


@pytest.mark.req("M-182", "M-239")
def test_a_script_in_a_process_forwards_the_probe(bench: SmallBench, processes: Any) -> None:
    start_script(bench, processes)
    bench.exchange("probing")
    assert bench.value(f"{UNIT}/enable_w") is True
    assert bench.value(f"{UNIT}/command_w") is False
    assert len(bench.exchange("probing").writes) == 0
    bench.exchange("probing", probe=struct.pack("<?7xQ8x", True, 123_456))
    assert bench.value(f"{UNIT}/command_w") is True
    assert bench.value(f"{TIME}/command_w") == 123_456
    assert bench.value(f"{TIME}/enable_w") is True
    assert bench.server.refused == 0


def test_a_second_plc_is_refused_the_units_of_the_first(bench: SmallBench, processes: Any) -> None:
    start_script(bench, processes, "first")
    bench.exchange("first")
    start_script(bench, processes, "second")
    bench.publish()
    commands = bench.server.plcs.commands("second", bench.cycle, PATIENCE_S)
    assert commands is not None
    refusals = bench.access.apply(commands)
    units = [write.path for write in commands.writes if not write.path.endswith("/plc_present_w")]
    assert [refusal.path for refusal in refusals] == units != []
    assert {refusal.reason for refusal in refusals} == {"the unit belongs to PLC 'first'"}


def test_the_name_of_an_attached_plc_is_taken(bench: SmallBench, processes: Any) -> None:
    start_script(bench, processes, "same")
    process = plc_process.start(loading.data_file("plc_scripts", "probing.py"), bench.endpoint, "same")
    processes.append(process)
    bench.serve(lambda: process.poll() is not None)
    assert process.returncode == 2


def test_a_killed_plc_departs_and_its_units_fall_back(bench: SmallBench, processes: Any) -> None:
    process = start_script(bench, processes)
    bench.exchange("probing")
    process.kill()
    bench.publish()
    assert bench.server.plcs.commands("probing", bench.cycle, PATIENCE_S) is None
    assert bench.server.plcs.departed() == ["probing"]
    assert bench.server.plcs.attached == []
    bench.access.leave("probing")
    assert bench.value(f"{UNIT}/enable_w") is False
    assert bench.server.plcs.departed() == []


def test_a_frozen_plc_departs_and_attaches_anew_when_it_wakes(bench: SmallBench, processes: Any) -> None:
    process = start_script(bench, processes)
    first = bench.exchange("probing")
    process.send_signal(signal.SIGSTOP)
    assert bench.server.wait_request(PATIENCE_S) == []
    assert bench.server.plcs.departed() == ["probing"]
    bench.access.leave("probing")
    process.send_signal(signal.SIGCONT)

    def back() -> bool:
        bench.publish()
        return bench.server.plcs.attached == ["probing"]

    bench.serve(back)
    assert bench.exchange("probing").writes == first.writes
    assert bench.value(f"{UNIT}/enable_w") is True


def test_a_script_that_fails_ends_with_its_line(
    bench: SmallBench, processes: Any, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "broken.py"
    script.write_text("class Plc:\n    period_us = 1000\n    def cycle(self, hli, io):\n        hli.ax[99]\n")
    process = start_script(bench, processes, script=script)
    bench.publish()
    assert bench.server.plcs.commands("broken", bench.cycle, PATIENCE_S) is None
    assert bench.server.plcs.departed() == ["broken"]
    assert process.wait(PATIENCE_S) == 2
    assert f"{script}:4: KeyError" in capfd.readouterr().err


def test_a_plc_ends_with_the_bench(bench: SmallBench, processes: Any) -> None:
    process = start_script(bench, processes)
    bench.server.close()
    assert process.wait(PATIENCE_S) == 0


def test_a_plc_of_zenoh_and_struct_alone_forwards_the_probe(bench: SmallBench, processes: Any) -> None:
    path = Path(__file__).with_name("plain_zenoh_plc.py")
    processes.append(subprocess.Popen([sys.executable, str(path), bench.endpoint, "demo", "3"]))
    bench.serve(lambda: bench.server.plcs.attached == ["plain"])
    bench.exchange("plain")
    bench.exchange("plain", probe=struct.pack("<?7xQ8x", True, 77))
    assert (bench.value(f"{UNIT}/command_w"), bench.value(f"{TIME}/command_w")) == (True, 77)
    assert (bench.value(f"{UNIT}/enable_w"), bench.value(f"{TIME}/enable_w")) == (True, True)
    assert bench.server.refused == 0
    bench.server.close()
    assert processes[0].wait(PATIENCE_S) == 0


def test_image_subscribers_are_seen(bench: SmallBench, processes: Any) -> None:
    assert not bench.server.image_wanted
    process = start_script(bench, processes)
    bench.serve(lambda: bench.server.image_wanted)
    process.kill()
    bench.serve(lambda: not bench.server.image_wanted)


def watch_two(endpoint: str) -> list[Any]:
    with HliClient(endpoint) as client:
        values = []
        for value in client.watch(f"{TIME}/command_w"):
            values.append(value)
            client.set(f"{TIME}/command_w", str(value + 5))
            if len(values) == 3:
                return values
    return values


def test_watching_an_element_yields_every_change(bench: SmallBench, elsewhere: Any) -> None:
    assert ask(bench, elsewhere, watch_two) == [0, 5, 10]
