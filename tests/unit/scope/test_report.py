"""The report of real runs: complete, by itself, well formed."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from hli_bench.bench.bench import Bench
from hli_bench.runtime.recording import Recording, input_taps
from hli_bench.scope.report import report_html

VOID = {"meta", "br", "path"}


def report(settings: dict[str, object], program: str, **options: Any) -> str:
    bench = Bench("demo", settings, **options)
    recording = Recording(bench.kernel, input_taps(bench.config.terminals), {"demo": 1_000_000})
    bench.engine.observers.append(recording)
    result = bench.run(program, "probing <1> & 2")
    return report_html(recording, result.to_dict(), "demo")


def probing(source: str) -> dict[str, object]:
    return {
        "plant.probe.Z.face_mm": 299,
        "plant.probe.Z.material": "below",
        "axis.Z.kenngr.measure.signal": source,
    }


PROGRAM = 'N10 G01 G90 X5 F6000\nN20 G100 Z290 F500\nN30 #MSG SYN["Z=%f", V.A.MESS.Z]\nN40 G01 Z300\nN50 M30'


@pytest.fixture(scope="module")
def page() -> str:
    return report(probing("PLC_TIMESTAMP"), PROGRAM)


class Balance(HTMLParser):
    """Every element that is opened is closed in its place."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        names = [name for name, _ in attrs]
        assert len(names) == len(set(names))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert tag in VOID or self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_page_is_whole_and_needs_nothing_else(page: str) -> None:
    parser = Balance()
    parser.feed(page)
    parser.close()
    assert parser.open == []
    assert "probing <1> & 2" in parser.text
    assert not re.search(r"<script|<link|<img|url\(|@import|https?:", page)


def test_it_says_what_was_measured_and_when(page: str) -> None:
    assert '<b class="status completed">completed</b>' in page
    table = page[page.index("<h2>Measured values</h2>") : page.index("<h2>Messages</h2>")]
    assert table.count('<td class="n">299.0000</td>') == 2
    assert "Z=299.000000" in page
    assert "PLC_TIMESTAMP" in page


def test_only_axes_that_moved_have_curves(page: str) -> None:
    assert re.findall(r"<h3>Axis (\w+)</h3>", page) == ["X", "Z"]


def test_the_way_of_the_signal_is_drawn_row_by_row(page: str) -> None:
    diagram = page[page.index("<h2>Measuring events</h2>") :]
    names = re.findall(r'<div class="name">(.*?)</div>', diagram)
    plain = [re.sub("<.*?>", "", name) for name in names]
    assert plain == [
        "Position mm, line: measured value",
        "Lag µm",
        "probe",
        "EL1252 probe/ch2 input",
        "PLC demo cycle 1 ms; thick: writes command_w",
        "probing_signal command_w",
        "probing_signal state_r",
        "CNC cycle 1 ms; thick: takes the value",
    ]
    assert re.search(r"0 ms is the edge of the probe at 0\.\d{3}\u202f\d{3}\u202f\d{3} s", diagram)


def test_a_latch_of_the_drive_shows_its_words() -> None:
    page = report(probing("DRIVE"), PROGRAM, plc=[])
    assert "latch status word" in page
    assert "0001h" in page
    assert "0003h" in page
    assert "command_w" not in page


def test_a_fixed_stop_has_no_signal_to_follow() -> None:
    stop = {
        "axis.Z.start_mm": 9,
        "plant.stop.Z.at_mm": 10,
        "plant.stop.Z.side": "above",
        "channel.messtyp": 7,
    }
    program = (
        "N10 #DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=10 WAIT]\n"
        "N20 #DRIVE WR SYN [AX=Z KEY=MON_WINDOW VAL=4294967295 WAIT]\n"
        "N30 G100 G90 Z100 F100\nN40 M30"
    )
    page = report(stop, program, plc=[])
    assert "FIXED_STOP. 0 ms is the instant of the measured value" in page
    assert "<b>CNC</b>" not in page


def test_an_error_of_the_cnc_stands_in_a_table() -> None:
    page = report({"axis.Z.kenngr.messachse": 0}, "N10 G100 G90 Z200 F100\nN20 M30", plc=[])
    assert '<td class="t error">error</td>' in page
    assert "50059" in page
    assert "No axis moved." in page


def test_a_run_that_measured_nothing_stands_in_red() -> None:
    page = report(probing("PLC"), "N10 G100 G90 Z299.5 F100\nN20 M30")
    assert "Not measured" in page
    assert '<td class="w error">measured nothing: no probing signal came on its way</td>' in page


def test_two_runs_give_the_same_page(page: str, tmp_path: Path) -> None:
    assert report(probing("PLC_TIMESTAMP"), PROGRAM) == page
