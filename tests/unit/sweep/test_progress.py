import io

import pytest

from hli_bench.sweep.progress import Progress, clock


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_line_for_every_ten_percent():
    stream = io.StringIO()
    progress = Progress(40, 0, stream)
    for _ in range(40):
        progress.add(1)
    progress.end()
    lines = stream.getvalue().splitlines()
    assert [line.split(",")[0] for line in lines] == [f"{share} %" for share in range(0, 101, 10)]
    assert lines[0] == "0 %, 0 of 40 runs"
    assert all(line.endswith("left") for line in lines[1:-1])
    assert lines[-1] == "100 %, 40 of 40 runs"


def test_what_was_done_before_is_not_told_again():
    stream = io.StringIO()
    Progress(10, 9, stream).add(1)
    assert stream.getvalue() == "90 %, 9 of 10 runs\n100 %, 10 of 10 runs\n"


def test_a_bar_on_a_terminal():
    stream = Terminal()
    progress = Progress(4, 0, stream)
    progress.add(2)
    progress.end()
    first, second = stream.getvalue().rstrip("\n").split("\r")[1:]
    assert first.startswith(f"[{'.' * 30}] 0 %")
    assert second.startswith(f"[{'#' * 15}{'.' * 15}] 50 %, 2 of 4 runs")


@pytest.mark.parametrize(("seconds", "text"), [(12.4, "12 s"), (200, "3:20 min"), (7500, "2:05 h")])
def test_durations(seconds, text):
    assert clock(seconds) == text
