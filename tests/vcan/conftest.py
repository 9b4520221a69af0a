"""Tests on a real SocketCAN vcan0: `make test-vcan` brings one, other runs leave the marker `vcan` out."""

from collections.abc import Iterator
from pathlib import Path

import can
import pytest

INTERFACE = "vcan0"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark everything of this folder, so that no test of it runs by accident where there is no interface."""
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.vcan)


@pytest.fixture
def bus() -> Iterator[can.BusABC]:
    """A python-can bus on vcan0, as any foreign tool would open it."""
    with can.Bus(INTERFACE, interface="socketcan") as opened:
        yield opened
