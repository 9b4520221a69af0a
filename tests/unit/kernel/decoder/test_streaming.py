"""A program of any length is read line by line, when its blocks are asked for."""

from collections.abc import Iterator
from itertools import islice

import pytest

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Flush, Idle, MachineState, ProgramEnd
from hli_bench.kernel.decoder import Decoder, DecoderAxis, DecoderDefaults

AXES = [DecoderAxis(AxisIndex(0), "X", 1, "T", True)]


class Program:
    """Counts the lines handed out."""

    def __init__(self, lines: int) -> None:
        self.handed_out = 0
        self._lines = lines

    def __iter__(self) -> Iterator[str]:
        for number in range(self._lines):
            self.handed_out += 1
            yield f"N{number} G00 X{number + 1}\n"
        yield "M30\n"


def test_no_line_is_read_before_its_block_is_wanted() -> None:
    program = Program(100_000)
    blocks = Decoder(program, "long.nc", AXES, DecoderDefaults()).blocks()
    assert program.handed_out == 0
    for count, block in enumerate(islice(blocks, 1000), start=1):
        assert block.source.line == count == program.handed_out
    assert sum(1 for _ in blocks) == 100_001 - 1000


def test_lines_are_kept_for_a_loop_only() -> None:
    lines = ["$FOR P1 = 1, 3\n", "G91 G00 X1\n", "$ENDFOR\n", *["G90 X0\n", "X1\n"] * 10, "M30\n"]
    decoder = Decoder(lines, "loop.nc", AXES, DecoderDefaults())
    blocks = decoder.blocks()
    answer = MachineState(
        command={AxisIndex(0): 5.0}, actual={}, measured={}, delivered={}, latched={}, referenced={}
    )
    first = next(blocks)
    assert isinstance(first, Flush)
    assert blocks.send(answer).target == {0: 6.0}
    assert decoder._lines._buffer is not None
    assert [next(blocks).source.line for _ in range(4)] == [2, 2, 4, 5]
    assert decoder._lines._buffer is None


@pytest.mark.parametrize(
    "text",
    [
        "#COMMENT BEGIN\n" + "X1\n" * 1000 + "#COMMENT END\n",
        "$IF 0\n" + "X1\n" * 1000 + "$ENDIF\n",
        "$WHILE 0\n" + "X1\n" * 1000 + "$ENDWHILE\n",
        "$IF 0\n#COMMENT BEGIN\n" + "X1\n" * 1000 + "#COMMENT END\n$ENDIF\n",
        "P1=1\n" * 1000,
        "(comment)\n" * 1000,
        ("(" + "c" * 3900 + ")\n") * 40,
    ],
)
def test_what_gives_no_motion_lets_cycles_pass(text: str) -> None:
    """Whatever is read over: no cycle has to take more than so many lines, long ones count for several."""
    blocks = Decoder(
        (text + "M30\n").splitlines(), "test.nc", AXES, DecoderDefaults(), without_motion=50
    ).blocks()
    items = list(blocks)
    assert sum(isinstance(item, Idle) for item in items) >= 20
    assert isinstance(items[-1], ProgramEnd)
