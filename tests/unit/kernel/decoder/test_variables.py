"""The table of NC variables and the decoder agree; what a run leaves for the result."""

import re
from typing import Any

import pytest

from hli_bench.base.errors import NotEmulated
from hli_bench.base.ids import AxisIndex
from hli_bench.kernel.blocks import Flush
from hli_bench.kernel.decoder import Decoder, DecoderAxis, DecoderDefaults
from hli_bench.manual.nc_variables import NC_VARIABLES, Access, NcVariable
from hli_bench.manual.sheet import Effect

ROWS = [
    pytest.param(row, id=row.pattern)
    for row in NC_VARIABLES
    if row.pattern.startswith(("V.A.", "V.G.", "V.RTA."))
]


@pytest.mark.parametrize("row", ROWS)
def test_every_row_of_the_table_is_read_as_it_says(decode: Any, state: Any, row: NcVariable) -> None:
    name = row.pattern.replace("<axis>", "Z")
    program = f"G00 Z1\nG100 Z2 F1\nG00 Z1\nP1 = {name}\nM30"
    answer = state(measured={"Z": 2.0}, latched={"Z": True})
    if row.effect is not Effect.EMULATED:
        with pytest.raises(NotEmulated, match=re.escape(row.pattern.partition(".<")[0])):
            decode(program, [answer])
        return
    assert any(isinstance(item, Flush) for item in decode(program, [answer])) is row.flush


@pytest.mark.parametrize("row", [row for row in ROWS if row.values[0].effect is Effect.EMULATED])
def test_what_a_program_may_not_write_is_refused(decode: Any, row: NcVariable) -> None:
    error = decode(f"{row.pattern.replace('<axis>', 'Z')} = 1\nM30")[-1]
    assert (error.number, row.access) == (20100, Access.READ)


@pytest.mark.req("M-007")
def test_a_run_leaves_its_measured_values_even_unread(state: Any) -> None:
    axes = [DecoderAxis(AxisIndex(2), "Z", 3, "T", True), DecoderAxis(AxisIndex(0), "X", 1, "T", True)]
    program = ["G92 Z10", "G01 Z200 F1", "G100 Z20", "V.P.A = 1", "P7 = 8", "P8 = V.G.MEAS_TYPE", "M30"]
    decoder = Decoder(program, "result.nc", axes, DecoderDefaults())
    assert len(list(decoder.blocks())) == 3
    assert decoder.variables(state(measured={"Z": 100.0}, delivered={"Z": 1}, latched={"Z": True})) == {
        "P7": 8.0,
        "P8": 1.0,
        "V.A.MEAS.ACS.VALUE.Z": 100.0,
        "V.A.MEAS.PCS.VALUE.Z": 90.0,
        "V.A.MEIN.Z": 0.0,
        "V.A.MERF.Z": 1.0,
        "V.A.MESS.Z": 100.0,
        "V.A.MOFFS.Z": 70.0,
        "V.G.MEAS_TYPE": 1.0,
        "V.P.A": 1.0,
    }
