import os
import re
from typing import Any

import pytest

from hli_bench.base.errors import InputError
from hli_bench.plc import Plc, load


def write(tmp_path: Any, text: Any) -> Any:
    path = tmp_path / f"script_{abs(hash(text))}.py"
    path.write_text(text)
    return path


def test_the_only_class_with_a_cycle_is_taken(tmp_path: Any) -> None:
    script = load(
        write(
            tmp_path,
            "from hli_bench.plc import Plc, R_TRIG\n"
            "class Helper:\n    pass\n"
            "class Mine(Plc):\n    period_us = 2000\n    def cycle(self, hli, io):\n        pass\n",
        )
    )
    assert type(script).__name__ == "Mine"
    assert script.period_us == 2000
    assert isinstance(script, Plc)


def test_of_several_classes_the_one_called_plc_is_taken(tmp_path: Any) -> None:
    text = "class Other:\n    def cycle(self, hli, io): ...\nclass Plc:\n    def cycle(self, hli, io): ...\n"
    assert type(load(write(tmp_path, text))).__name__ == "Plc"


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("x = 1\n", 0, "found: none"),
        ("class A:\n    def cycle(self): ...\nclass B:\n    def cycle(self): ...\n", 0, "found: A, B"),
        ("class A:\n    def cycle(self:\n", 2, "syntax: "),
        ("import nothing_of_that_name\n", 1, "ModuleNotFoundError: No module named 'nothing_of_that_name'"),
        (
            "class A:\n    def __init__(self):\n        1 / 0\n    def cycle(self): ...\n",
            3,
            "ZeroDivisionError",
        ),
    ],
)
def test_a_script_that_cannot_be_loaded_is_told_with_its_line(
    tmp_path: Any, text: Any, line: Any, message: Any
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=re.escape(message)) as error:
        load(path)
    assert (error.value.file, error.value.line) == (str(path), line)


def test_a_syntax_error_in_what_a_script_imports_is_told_where_it_is(tmp_path: Any) -> None:
    (tmp_path / "broken_helper.py").write_text("x = 1\n\nif x\n")
    path = write(tmp_path, "import broken_helper\n")
    with pytest.raises(InputError, match="syntax: ") as error:
        load(path)
    assert (error.value.file, error.value.line) == (str(tmp_path / "broken_helper.py"), 3)


def test_a_script_that_was_changed_at_once_is_taken_as_it_is_now(tmp_path: Any) -> None:
    """Python's byte code beside a file passes for fresh when date and size are the same."""
    path = tmp_path / "quick.py"
    for level in ("1", "2"):
        path.write_text(f"class P:\n    period_us = {level}000\n    def cycle(self, hli, io): ...\n")
        os.utime(path, (1, 1))
        assert load(path).period_us == int(level) * 1000
    assert [one.name for one in tmp_path.iterdir()] == ["quick.py"]


def test_a_missing_file_is_told(tmp_path: Any) -> None:
    with pytest.raises(InputError, match="no such file"):
        load(tmp_path / "none.py")
