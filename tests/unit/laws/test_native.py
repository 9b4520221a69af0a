"""Machine code of the laws: bound to rows, kept between runs, made again when what it comes from is another."""

import os
import pwd
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hli_bench.laws import cache, native
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


KEPT = cache.Code({"stride": "_ZN6stride"}, b"object\ncode")


def test_who_has_no_home_keeps_the_laws_beside_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("HOME", raising=False)
    monkeypatch.setattr(pwd, "getpwuid", {}.__getitem__)
    assert cache.places({}) == [cache.LAWS_FOLDER / "__pycache__"]


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: content.replace(b'"stride"', b'"strike"'),
        lambda content: content.replace(b"code", b"cold"),
        lambda content: content[:-1],
        lambda content: content.partition(b"\n")[2],
        lambda content: b"{}\n" + content,
        lambda _: b"[]\nobject",
        lambda _: b"\n",
        lambda _: b"",
    ],
)
def test_a_damaged_file_is_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: Callable[[bytes], bytes]
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    cache.keep("laws-a.bin", KEPT)
    assert cache.read("laws-a.bin") == KEPT
    (tmp_path / "laws-a.bin").write_bytes(damage((tmp_path / "laws-a.bin").read_bytes()))
    assert cache.read("laws-a.bin") is None


def test_nothing_is_left_of_a_file_that_was_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        cache.keep("laws-a.bin", KEPT)
    assert not list(tmp_path.iterdir())


def test_the_newest_files_stay_and_the_one_in_use(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    for number in range(7):
        (tmp_path / f"laws-{number}.bin").write_bytes(b"")
        os.utime(tmp_path / f"laws-{number}.bin", (2e9 + number, 2e9 + number))
    (tmp_path / "another.bin").write_bytes(b"")
    cache.keep("laws-used.bin", KEPT)
    left = {file.name for file in tmp_path.iterdir()}
    assert left == {"another.bin", "laws-used.bin", "laws-4.bin", "laws-5.bin", "laws-6.bin"}
    assert cache.read("laws-used.bin") == KEPT


def test_several_processes_may_thin_out_the_same_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What another one has removed already is no error."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    for number in range(7):
        (tmp_path / f"laws-{number}.bin").write_bytes(b"")
    there = Path.glob

    def overtaken(place: Path, pattern: str) -> list[Path]:
        found = list(there(place, pattern))
        (tmp_path / "laws-0.bin").unlink()
        return found

    monkeypatch.setattr(Path, "glob", overtaken)
    cache.keep("laws-used.bin", KEPT)
    assert cache.read("laws-used.bin") == KEPT


def test_code_without_a_law_is_not_called() -> None:
    class Empty:
        def get_function_address(self, symbol: str) -> int:
            return 0

    with pytest.raises(LookupError, match="no _ZN6stride"):
        native._address(Empty(), "_ZN6stride")


INTERRUPTED = """
import os, signal, threading
from hli_bench.laws import compiler, native
from hli_bench.shells.apart import apart

def compile_laws():
    print(threading.current_thread() is threading.main_thread(), flush=True)
    os.kill(os.getpid(), signal.SIGINT)
    threading.Event().wait()

compiler.compile_laws = compile_laws
try:
    native.prepare(apart=apart)
except KeyboardInterrupt:
    print("interrupted")
"""


def test_ctrl_c_ends_compiling(tmp_path: Path) -> None:
    """In the main thread it would be raised in what LLVM and numba call back, and be lost there."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, "-c", INTERRUPTED],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ended.stdout.split() == ["False", "interrupted"], ended.stderr
    assert ended.returncode == 0


def test_what_is_wrong_with_compiling_is_raised(tmp_path: Path) -> None:
    failing = INTERRUPTED.replace("    threading.Event().wait()\n", "").replace(
        "os.kill(os.getpid(), signal.SIGINT)", "raise RuntimeError('no such law')"
    )
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, "-c", failing],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ended.returncode == 1
    assert "RuntimeError: no such law" in ended.stderr
