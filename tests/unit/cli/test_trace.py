"""`trace show`, `trace diff`, `trace export` as users call them."""

from pathlib import Path

import pytest

from hli_bench.base.errors import InputError
from hli_bench.bench.bench import Bench
from hli_bench.cli.main import main
from hli_bench.shells.trace_file import TraceFile

PROGRAM = 'N10 G01 G90 X80 F1000\nN20 G100 Z290 F500\nN30 #MSG SYN["done"]\nN50 M30'


def record(path: Path, face: float) -> Path:
    settings = {
        "plant.probe.Z.face_mm": face,
        "plant.probe.Z.material": "below",
    }
    with Bench("demo", settings) as bench:
        with TraceFile(path, bench.kernel.setup, bench.kernel.rows.log, "demo", settings) as trace:
            bench.engine.observers.append(trace)
            assert bench.run(PROGRAM).completed
        bench.engine.observers.clear()
    return path


@pytest.fixture(scope="module")
def traces(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("traces")
    return record(folder / "a.mcap", 299), record(folder / "b.mcap", 298.99)


def lines_of(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> list[str]:
    assert main(["trace", "show", *map(str, arguments)]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    return said.out.splitlines()


def instants(lines: list[str]) -> list[int]:
    return [int(line.split()[2]) for line in lines]


def test_show_prints_everything_in_order_of_time(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["trace", "show", str(traces[0])]) == 0
    lines = capsys.readouterr().out.splitlines()
    head, shown = lines[:5], lines[5:]
    assert head[0].startswith("machine demo, cycle 1000000 ns")
    assert "Z (axis 3, node 3, T)" in head[1]
    assert "set plant.probe.Z.face_mm=299" in head
    assert instants(shown) == sorted(instants(shown))
    assert {line.split()[4] for line in shown} == {"axes", "can", "edges", "plc", "cnc"}
    edge = next(line for line in shown if " edges " in line)
    seconds, _, at_ns, *_ = edge.split()
    assert f"{int(at_ns) // 1_000_000 / 1000:.3f}" == seconds
    assert edge.endswith("probe TRUE")


def test_a_long_show_says_how_to_get_fewer_lines(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["trace", "show", str(traces[0])]) == 0
    said = capsys.readouterr()
    assert said.err.startswith(f"{len(said.out.splitlines())} lines; fewer with --channel (meta|axes|")
    assert "--axis (X|Y|Z|" in said.err
    assert len(lines_of(capsys, traces[0], "--axis", "Z", "--every", "0.01")) > 200
    assert lines_of(capsys, traces[0], "--to", "0.1")


def test_lag_is_what_the_help_says(traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    moving = ("--channel", "axes", "--axis", "X", "--every", "0", "--from", "1", "--to", "1.2")
    values = [
        [float(text) for text in line.split()[6:9]] for line in lines_of(capsys, traces[0], *moving)[1:]
    ]
    assert abs(values[0][0] - values[0][1]) > 0.01
    for (earlier, _, _), (_, actual, lag) in zip(values, values[2:], strict=False):
        assert earlier - actual == pytest.approx(lag, abs=2e-4)
    with pytest.raises(SystemExit):
        main(["trace", "show", "--help"])
    assert "lag is the command of two cycles earlier" in " ".join(capsys.readouterr().out.split())


def test_show_of_one_channel_one_axis_some_time(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    lines = lines_of(
        capsys,
        traces[0],
        *("--channel", "axes", "--axis", "Z", "--from", "0.5", "--to", "0.7", "--every", "0.05"),
    )
    assert instants(lines[1:]) == [500_000_000 + at * 50_000_000 for at in range(5)]
    assert all(line.split()[4:6] == ["axes", "Z"] for line in lines[1:])
    every = lines_of(capsys, traces[0], *("--channel", "axes", "--axis", "Z", "--to", "0.3", "--every", "0"))
    assert instants(every[1:]) == [cycle * 1_000_000 for cycle in range(1, 301)]


def test_frames_and_writes_of_other_axes_are_not_of_one_axis(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    lines = lines_of(capsys, traces[0], "--channel", "can", "--channel", "plc", "--axis", "Z", "--to", "0.5")
    assert {line.rpartition("node ")[2] for line in lines if "node " in line} == {"3"}
    assert {line.partition("ax/")[2].partition("/")[0] for line in lines if " ax/" in line} <= {"3"}
    assert any(line.endswith("NMT") for line in lines)


def test_show_names_axis_and_block_of_what_the_cnc_said(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    lines = lines_of(capsys, traces[0], "--channel", "cnc")
    assert [line.split()[5:7] for line in lines] == [["MeasuredValue", "N20"], ["MessageText", "N30"]]
    assert "axis=Z" in lines[0]
    assert lines[1].endswith("text=done")
    assert len(lines_of(capsys, traces[0], "--channel", "cnc", "--axis", "X")) == 1


def test_diff_names_the_first_difference_and_ends_with_1(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["trace", "diff", *map(str, traces)]) == 1
    said = capsys.readouterr().out
    assert "meta: set plant.probe.Z.face_mm\n" in said
    assert "first difference: edges at" in said
    assert " in axes" in said.splitlines()[-1]
    assert main(["trace", "diff", str(traces[0]), str(traces[0])]) == 0
    assert capsys.readouterr().out == "equal\n"


def test_a_file_cut_off_is_shown_with_a_warning(
    traces: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    torn = tmp_path / "torn.mcap"
    data = traces[0].read_bytes()
    torn.write_bytes(data[: len(data) * 2 // 3])
    for arguments in (["show", str(torn)], ["export", str(torn), "--format", "csv"]):
        assert main(["trace", *arguments]) == 0
        assert f"warning: {torn}: cut off" in capsys.readouterr().err
    assert main(["trace", "diff", str(torn), str(traces[0])]) == 1
    assert "warning" in capsys.readouterr().err


def test_what_is_no_trace_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = tmp_path / "text.mcap"
    text.write_text("N10 M30\n")
    for file in (text, tmp_path / "missing.mcap"):
        for arguments in (["show", str(file)], ["diff", str(file), str(file)]):
            assert main(["trace", *arguments]) == InputError.exit_status
            assert str(file) in capsys.readouterr().err


def test_an_axis_the_machine_has_not_is_bad_input(
    traces: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["trace", "show", str(traces[0]), "--axis", "Q"]) == InputError.exit_status
    assert "--axis Q: expected one of X, Y, Z" in capsys.readouterr().err


def test_export_names_its_file_and_never_writes_over_the_trace(
    traces: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    trace = tmp_path / "run.mcap"
    trace.write_bytes(traces[0].read_bytes())
    for form, suffix in (("csv", "csv"), ("candump", "log"), ("pcap", "pcap")):
        assert main(["trace", "export", str(trace), "--format", form]) == 0
        assert trace.with_suffix(f".{suffix}").stat().st_size > 1000
    assert main(["trace", "export", str(trace), "--format", "csv", "--out", str(trace)]) == 2
    assert trace.read_bytes() == traces[0].read_bytes()
    capsys.readouterr()
    assert (
        main(["trace", "export", str(trace), "--format", "csv", "--out", str(tmp_path / "no" / "x.csv")]) == 2
    )
    assert "cannot be written" in capsys.readouterr().err
