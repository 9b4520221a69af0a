"""One cycle or a thousand, compiled or not: the same laws, the same bits."""

import os
import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

SCENARIO = Path(__file__).with_name("scenario.py")


@pytest.fixture(scope="module")
def digest() -> Any:
    return runpy.run_path(str(SCENARIO))["digest"]


def test_a_stride_of_a_thousand_equals_a_thousand_of_one(digest: Callable[[int, int], str]) -> None:
    whole = digest(1000, 1000)
    assert whole == digest(1000, 1)
    assert whole == digest(1000, 37)
    assert whole != digest(999, 999)


def test_compiled_equals_plain_python(digest: Callable[[int, int], str]) -> None:
    plain = subprocess.run(
        [sys.executable, str(SCENARIO), "300", "300"],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (plain.returncode, plain.stderr) == (0, "")
    assert plain.stdout == digest(300, 300)
