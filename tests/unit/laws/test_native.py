"""Machine code of the laws: bound to rows, kept between runs, made again when what it comes from is another."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from hli_bench.laws import cache
from hli_bench.laws.native import bind, prepare
from hli_bench.laws.rows import AXIS, SERVO
from hli_bench.laws.stride import exchange_out

FIRST = (
    "from hli_bench.laws.native import prepare; import sys\n"
    "prepare(lambda: print('compiling'))\n"
    "print('numba' in sys.modules)"
)


@pytest.fixture
def axis() -> np.ndarray:
    rows = np.zeros(2, AXIS)
    rows["target"] = 10, -3
    return rows


def test_a_bound_law_is_the_same_law(axis: np.ndarray) -> None:
    plain, bound = np.zeros(2, SERVO), np.zeros(2, SERVO)
    exchange_out(axis, plain)
    call = bind(exchange_out, axis, bound)
    call()
    assert bound.tobytes() == plain.tobytes()
    axis["target"] = 7, 8
    call()
    assert list(bound["target"]) == [7, 8], "rows are worked on where they lie"


@pytest.mark.parametrize(
    ("servo", "why"),
    [
        (np.zeros(2), "float64"),
        (np.zeros((2, 2), SERVO), "2 dimensions"),
        (np.zeros(4, SERVO)[::2], "contiguous"),
        (np.frombuffer(bytes(2 * SERVO.itemsize), SERVO), "writeable"),
    ],
)
def test_rows_of_another_kind_are_refused(axis: np.ndarray, servo: np.ndarray, why: str) -> None:
    with pytest.raises(TypeError, match=rf"exchange_out: servo .*{why}"):
        bind(exchange_out, axis, servo)


def test_too_few_rows_are_refused(axis: np.ndarray) -> None:
    with pytest.raises(TypeError, match="1 arguments to bind, expected 2"):
        bind(exchange_out, axis)


def first(folder: Path, **environment: str) -> str:
    """Return what a process says that needs the laws."""
    return subprocess.run(
        [sys.executable, "-c", FIRST],
        env={**os.environ, "NUMBA_CACHE_DIR": str(folder), **environment},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def test_laws_are_compiled_once_and_anew_for_another_processor_or_a_damaged_file(tmp_path: Path) -> None:
    assert first(tmp_path) == "compiling\nTrue\n"
    (kept,) = tmp_path.iterdir()
    assert first(tmp_path) == "False\n", "what is kept needs no compiler"
    assert first(tmp_path, NUMBA_CPU_NAME="x86-64" if "64" in os.uname().machine else "generic").startswith(
        "comp"
    )
    assert len(list(tmp_path.iterdir())) == 2, "one file for each processor"
    kept.write_bytes(kept.read_bytes()[:-100])
    assert first(tmp_path) == "compiling\nTrue\n"
    assert first(tmp_path) == "False\n"


def test_a_file_is_for_one_text_of_the_laws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "LAWS_FOLDER", tmp_path)
    (tmp_path / "servo.py").write_text("a = 1\n")
    before = cache.file_name("compiler", "processor")
    assert cache.file_name("compiler", "processor") == before
    assert cache.file_name("compiler", "another") != before
    (tmp_path / "servo.py").write_text("a = 2\n")
    assert cache.file_name("compiler", "processor") != before


def test_nothing_is_kept_where_nothing_can_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file" / "below"))
    cache.keep("laws.bin", cache.Code({}, b""))
    assert cache.read("laws.bin") is None
    prepare()
