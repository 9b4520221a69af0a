"""Runs the decoder with a scripted machine."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import pytest

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Flush, MachineState, Text
from hli_bench.kernel.decoder import Decoder, DecoderAxis, DecoderDefaults
from hli_bench.kernel.decoder.context import Item

AXES = (
    DecoderAxis(AxisIndex(0), "X", 1, "T", True),
    DecoderAxis(AxisIndex(1), "Y", 2, "T", True),
    DecoderAxis(AxisIndex(2), "Z", 3, "T", True),
    DecoderAxis(AxisIndex(3), "C", 4, "R", False),
)
NAMES = {axis.name: axis.index for axis in AXES}


def _state(
    command: Sequence[float] = (0.0, 0.0, 0.0, 0.0),
    *,
    actual: Sequence[float] | None = None,
    measured: dict[str, float] | None = None,
    delivered: dict[str, int] | None = None,
    latched: dict[str, bool] | None = None,
    referenced: dict[str, bool] | None = None,
) -> MachineState:
    """Return an answer to a query; axes by name."""
    return MachineState(
        command={AxisIndex(i): value for i, value in enumerate(command)},
        actual={AxisIndex(i): value for i, value in enumerate(actual or command)},
        measured={NAMES[name]: value for name, value in (measured or {}).items()},
        delivered={NAMES[name]: value for name, value in (delivered or {}).items()},
        latched={NAMES[name]: value for name, value in (latched or {}).items()},
        referenced={NAMES[name]: value for name, value in (referenced or {}).items()},
    )


def _decode(
    program: str | Iterable[str],
    answers: Sequence[MachineState] = (),
    *,
    axes: Sequence[DecoderAxis] = AXES,
    measuring_type: int = 1,
) -> list[Item]:
    """Return all items of a program; the last answer serves all further queries."""
    lines = program.splitlines(keepends=True) if isinstance(program, str) else program
    blocks = Decoder(lines, "test.nc", axes, DecoderDefaults(measuring_type)).blocks()
    script = list(answers) or [_state()]
    items: list[Item] = []
    answer: MachineState | None = None
    flushes = 0
    while True:
        try:
            item = blocks.send(answer)
        except StopIteration:
            return items
        items.append(item)
        answer = None
        if isinstance(item, Flush):
            flushes += 1
            answer = script.pop(0) if len(script) > 1 else script[0]
            # every value that an answer holds is a new one, unless the answer says otherwise
            answer = replace(answer, delivered=answer.delivered or dict.fromkeys(answer.measured, flushes))


def _texts(items: Iterable[Item]) -> list[str]:
    """Return the texts of the #MSG blocks."""
    return [item.text for item in items if isinstance(item, Text)]


@pytest.fixture(scope="session")
def state() -> Callable[..., MachineState]:
    return _state


@pytest.fixture(scope="session")
def decode() -> Callable[..., list[Item]]:
    return _decode


@pytest.fixture(scope="session")
def texts() -> Callable[..., list[str]]:
    return _texts
