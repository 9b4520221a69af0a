"""A program of any length is read line by line, when its blocks are asked for."""

from collections.abc import Iterator
from itertools import islice

from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Flush, MachineState
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
