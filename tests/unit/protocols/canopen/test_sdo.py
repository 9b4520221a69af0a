"""SDO client against python-canopen's server, against ours, and against broken answers."""

import struct
from typing import Any

import canopen
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.sdo import SdoClient
from hli_bench.wire.can import CanFrame

BLOB = 0x2000


def run(client: Any, frames: Any, answer: Any) -> None:
    while frames:
        frames = [
            reply for frame in frames for given in answer(frame) for reply in client.on_frame(given, Ns(0))
        ]
    assert not client.busy


@pytest.fixture
def client() -> Any:
    return SdoClient(5)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(content=st.binary(max_size=60))
def test_with_our_server(device: Any, client: Any, content: bytes) -> None:
    def answer(frame: Any) -> Any:
        return device.on_frame(frame, Ns(0))

    run(client, client.begin_write(BLOB, 0, content, Ns(0)), answer)
    assert client.result() == b""
    run(client, client.begin_read(BLOB, 0, Ns(0)), answer)
    assert client.result() == content


class Oracle(canopen.Network):
    """python-canopen's slave whose answers are collected."""

    def __init__(self, eds: str) -> None:
        super().__init__()
        self.answers = []
        self.node = self.create_node(5, eds)

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        self.answers.append(CanFrame(can_id, bytes(data), remote))

    def answer(self, frame: Any) -> Any:
        self.answers.clear()
        self.notify(frame.cob_id, bytearray(frame.data), 0.0)
        return list(self.answers)


@pytest.mark.parametrize("content", [b"a", b"abcd", b"abcde", b"1234567", b"12345678", bytes(100)])
def test_with_python_canopens_server(client: Any, description: Any, request: Any, content: bytes) -> None:
    oracle = Oracle(str(request.path.with_name("node.eds")))
    run(client, client.begin_write(BLOB, 0, content, Ns(0)), oracle.answer)
    assert client.result() == b""
    run(client, client.begin_read(BLOB, 0, Ns(0)), oracle.answer)
    assert client.result() == content
    run(client, client.begin_read(0x3000, 0, Ns(0)), oracle.answer)
    with pytest.raises(SdoAbort, match="0x06020000") as refused:
        client.result()
    assert refused.value.code == AbortCode.NO_OBJECT


def reply(client: Any, *data: int) -> list[CanFrame]:
    return client.on_frame(CanFrame(0x585, bytes(data).ljust(8, b"\0")), Ns(0))


def assert_aborted(client: Any, frames: Any, code: int) -> None:
    assert frames == [CanFrame(0x605, struct.pack("<BHBI", 0x80, BLOB, 0, code))]
    with pytest.raises(SdoAbort) as refused:
        client.result()
    assert refused.value.code == code


@pytest.mark.parametrize(
    ("answers", "code"),
    [
        ([(0x61, 0, 0x20)], AbortCode.BAD_COMMAND),
        ([(0x60, 0, 0x20), (0x30,)], AbortCode.TOGGLE),
        ([(0x60, 0, 0x20), (0x20,), (0x20,)], AbortCode.TOGGLE),
    ],
)
def test_wrong_answers_to_a_download(client: Any, answers: Any, code: int) -> None:
    client.begin_write(BLOB, 0, bytes(20), Ns(0))
    for answer in answers[:-1]:
        assert reply(client, *answer)
    assert_aborted(client, reply(client, *answers[-1]), code)


@pytest.mark.parametrize(
    ("answers", "code"),
    [
        ([(0x41, 0, 0x20, 0, 9), (0x20,)], AbortCode.BAD_COMMAND),
        ([(0x41, 0, 0x20, 0, 9), (0x10,)], AbortCode.TOGGLE),
        ([(0x41, 0, 0x20, 0, 9), (0x01,)], AbortCode.LENGTH),
    ],
)
def test_wrong_answers_to_an_upload(client: Any, answers: Any, code: int) -> None:
    client.begin_read(BLOB, 0, Ns(0))
    for answer in answers[:-1]:
        assert reply(client, *answer)
    assert_aborted(client, reply(client, *answers[-1]), code)


@pytest.mark.parametrize(
    "others",
    [
        (0x60, 1, 0x20),
        (0x4B, 0x41, 0x60),
        (0x4B, 0, 0x20),
        (0x80, 0x41, 0x60, 0, 0, 0, 9, 6),
        (0x20,),
        (0x05,),
    ],
)
def test_answers_to_somebody_else_change_nothing(client: Any, others: Any) -> None:
    """Another client of the same server: the object tells its answers from ours, or that they are segments."""
    client.begin_write(BLOB, 0, b"ab", Ns(0))
    assert reply(client, *others) == []
    assert client.busy
    assert client.collided
    assert reply(client, 0x60, 0, 0x20) == []
    assert client.result() == b""
    client.begin_write(BLOB, 0, bytes(20), Ns(0))
    assert not client.collided
    assert len(reply(client, 0x60, 0, 0x20)) == 1
    if others[0] >= 0x40:
        assert reply(client, *others) == []
        assert len(reply(client, 0x20)) == 1


def test_upload_of_unknown_size(client: Any) -> None:
    client.begin_read(BLOB, 0, Ns(0))
    reply(client, 0x40, 0, 0x20)
    assert reply(client, 0x0B, 1, 2) == []
    assert client.result() == b"\x01\x02"


def test_time_out(client: Any) -> None:
    client.begin_read(BLOB, 0, Ns(7))
    due = client.next_due()
    assert due == 1_000_000_007
    assert client.tick(Ns(due - 1)) == []
    assert client.busy
    assert_aborted(client, client.tick(due), AbortCode.TIME_OUT)
    assert client.next_due() is None


def test_use_in_the_wrong_order(client: Any) -> None:
    with pytest.raises(RuntimeError, match="no finished"):
        client.result()
    client.begin_read(BLOB, 0, Ns(0))
    with pytest.raises(RuntimeError, match="still under way"):
        client.begin_write(BLOB, 0, b"x", Ns(0))
    with pytest.raises(RuntimeError, match="no finished"):
        client.result()
    assert client.on_frame(CanFrame(0x586, bytes(8)), Ns(0)) == []
    assert client.busy
