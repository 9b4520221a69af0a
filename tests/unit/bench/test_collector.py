"""What a result gathers of a program that does not end."""

from types import SimpleNamespace
from typing import Any

import pytest

from hli_bench.bench import result
from hli_bench.kernel.records import MessageText


def test_messages_of_a_program_without_end_are_bounded_and_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(result, "MOST_KEPT", 3)
    collector = result.Collector([])
    source: Any = SimpleNamespace(name="N10")
    record: Any = MessageText.__new__(MessageText)
    for name, value in (("source", source), ("text", "there")):
        object.__setattr__(record, name, value)
    collector.take([record] * 5)
    assert (len(collector.messages), collector.left_out) == (3, 2)
