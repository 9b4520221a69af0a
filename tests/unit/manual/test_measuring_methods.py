"""The older parameters of the probing source: one method only, what counts, what is corrected or refused."""

import pytest

from hli_bench import Bench
from hli_bench.base.errors import NotEmulated
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.axis.fallbacks import effective_signal
from hli_bench.manual.lists import build, check_values, refusals
from hli_bench.manual.sheet import Value


def given(*names: str, **others: Value) -> dict[str, Value]:
    return {f"kenngr.{name}": True for name in names} | {"kenngr.antr_typ": 8} | others


@pytest.mark.req("M-187", "M-242", "M-247")
@pytest.mark.parametrize(
    ("names", "signal", "warnings"),
    [
        (["mess_signal_taster", "mess_signal_achs_steuer"], "PLC", {"taster": 110400}),
        (["mess_signal_taster", "meas_signal_drive"], "DRIVE", {"taster": 110401}),
        (["mess_signal_achs_steuer", "meas_signal_drive"], "DRIVE", {"achs_steuer": 110402}),
        (["mess_signal_taster", "probing_signal_via_plc"], "PLC", {"taster": 110399}),
        (["probing_signal_via_plc", "meas_signal_fixed_stop"], "FIXED_STOP", {"via_plc": 110399}),
    ],
)
def test_only_one_method_counts(names: list[str], signal: str, warnings: dict[str, int]) -> None:
    values = given(*names)
    found = {path: finding.message for path, finding in check_values(AxisParams, values)}
    for name, number in warnings.items():
        assert any(path.endswith(name) and f"P-ERR-{number}" in text for path, text in found.items())
    assert effective_signal(build(AxisParams, values).kenngr) == signal
    assert not refusals(AxisParams, values)


@pytest.mark.req("M-244")
def test_a_probe_at_the_hardware_of_the_cnc_is_not_emulated() -> None:
    settings = {"axis.Z.kenngr.mess_signal_taster": 1, "axis.Z.kenngr.measure.signal": ""}
    with (
        pytest.raises(NotEmulated, match=r"mess_signal_taster = 1.*hardware interface"),
        Bench("demo", settings),
    ):
        pass


def test_an_older_method_beside_the_new_parameter_is_named_as_unused() -> None:
    with Bench(
        "demo", {"axis.Z.kenngr.mess_signal_taster": 1, "axis.Z.kenngr.measure.signal": "PLC"}
    ) as bench:
        notes = [note.message for note in bench.config.notes]
    assert any("mess_signal_taster: does not count beside kenngr.measure.signal" in note for note in notes)
