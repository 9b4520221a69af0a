"""What the command line tells without a bench: help, and that checks load neither compiler nor buses."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from hli_bench.cli import doctor
from hli_bench.cli.main import main, parser

COMMANDS = [
    *("run", "serve", "plc", "hli", "state", "reset", "params"),
    *("errors", "drive", "machine", "inject", "clear", "sweep", "scope", "trace", "doctor"),
]
ACTIONS = {
    "hli": "{ls,get,set,watch}",
    "params": "{show,find,check}",
    "errors": "{show,find}",
    "drive": "{show,check}",
    "machine": "{check,schema,copy}",
    "trace": "{show,diff,export}",
}
LIGHT = """
import sys
from hli_bench.cli.main import main

for line in sys.argv[1:]:
    try:
        status = main(line.split())
    except SystemExit as ended:
        status = ended.code
    assert status == 0, (line, status)
heavy = [name for name in ("numba", "zenoh", "can") if name in sys.modules]
assert not heavy, heavy
"""


def help_of(*arguments: str, capsys: pytest.CaptureFixture[str]) -> str:
    with pytest.raises(SystemExit) as ended:
        main([*arguments, "--help"])
    assert ended.value.code == 0
    return capsys.readouterr().out


def test_help_lists_all_commands(capsys: pytest.CaptureFixture[str]) -> None:
    text = help_of(capsys=capsys)
    listed = text[text.index("{") + 1 : text.index("}")]
    assert set(listed.split(",")) == set(COMMANDS)
    assert "exit status: 0" in text


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_its_actions(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = help_of(command, capsys=capsys)
    assert f"hli-bench {command}" in text
    assert ACTIONS.get(command, "") in text


@pytest.mark.parametrize(("command", "pace"), [("run", "free"), ("serve", "real")])
def test_options_of_a_bench_name_their_defaults(
    command: str, pace: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = " ".join(help_of(command, capsys=capsys).split())
    for option in ("--machine", "--set", "--plc", "--pace", "--can", "--zenoh", "--modbus"):
        assert option in text
    assert f"(default {pace})" in text
    assert "(default demo)" in text
    assert "(default inproc)" in text


def test_the_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text())["project"]
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"hli-bench {project['version']}\n"


def test_a_fault_of_the_bench_is_no_error_of_the_cnc(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(_: object) -> int:
        raise ZeroDivisionError("nobody has foreseen this")

    monkeypatch.setattr(doctor, "execute", broken)
    assert main(["doctor"]) == 70
    assert "ZeroDivisionError: nobody has foreseen this" in capsys.readouterr().err


def test_a_command_is_needed() -> None:
    with pytest.raises(SystemExit) as ended:
        parser().parse_args([])
    assert ended.value.code == 2


def test_looking_and_checking_need_neither_compiler_nor_buses() -> None:
    lines = [
        "--help",
        "run --help",
        "params show P-AXIS-00516",
        "drive show servo402",
        "machine schema",
        "machine check demo",
        "doctor",
    ]
    done = subprocess.run([sys.executable, "-c", LIGHT, *lines], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
