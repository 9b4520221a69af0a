"""The pytest plugin, loaded into a pytest of its own as a user's project loads it."""

import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = """
def test_passes(bench):
    first, second = bench("demo", {"axis.Z.start_mm": 250.0}), bench(plc=[])
    first.start_up()
    assert first.position_mm("Z") == 250.0 and second.config.name == "demo"

def test_fails(bench):
    bench().advance(5)
    assert not "wrong"

def test_without():
    assert True
"""


def run_pytest(folder: Path, *options: str) -> "subprocess.CompletedProcess[str]":
    (folder / "test_project.py").write_text(PROJECT)
    return subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "-p",
            "no:cacheprovider",
            "--basetemp",
            str(folder / "tmp"),
            *options,
        ],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


def test_traces_of_failed_tests_are_kept_and_named_in_the_report(tmp_path: Path) -> None:
    from hli_bench.shells.trace_file import AxesBlock, read

    done = run_pytest(tmp_path, "--hli-bench-traces", str(tmp_path / "traces"))
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 2 passed" in done.stdout
    (kept,) = (tmp_path / "traces").iterdir()
    assert kept.name == "test_project.py_test_fails-0.mcap"
    assert "hli-bench traces" in done.stdout
    assert str(kept) in done.stdout
    blocks = [item for item in read(kept) if isinstance(item, AxesBlock)]
    assert sum(len(block.rows) for block in blocks) > 5


def test_the_plugin_loads_without_the_compiler() -> None:
    code = (
        "import sys, hli_bench.testing.plugin\n"
        "print([name for name in ('numba', 'numpy', 'zenoh', 'can') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_fixture_is_a_factory_of_benches(bench: object, tmp_path: Path) -> None:
    assert callable(bench)
    made = bench("demo", {"axis.Z.start_mm": 210.0})
    made.start_up()
    assert made.position_mm("Z") == pytest.approx(210.0, abs=1e-4)
    assert [file.name for file in tmp_path.iterdir()] == ["bench-0.mcap"]
