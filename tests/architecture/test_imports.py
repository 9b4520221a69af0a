"""The walls of the house: who imports whom, and that the guard would notice."""

import ast
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LINT_IMPORTS = Path(sys.executable).with_name("lint-imports")
PLC_SCRIPTS = sorted((ROOT / "plc_scripts").rglob("*.py"))


def _lint_imports(folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, LINT_IMPORTS, "--no-cache"]
    environment = {"PYTHONPATH": str(folder), "PATH": ""}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def _rooms_without_furniture(folder: Path) -> None:
    """The packages that the contracts name, all empty, with the project's own contracts."""
    shutil.copy(ROOT / "pyproject.toml", folder)
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = settings["contracts"][0]["layers"]
    rooms = [room.strip() for layer in layers for room in layer.split("|")]
    for package in ("hli_bench", "hli_bench_drives", *(f"hli_bench/{room}" for room in rooms)):
        (folder / package).mkdir()
        (folder / package / "__init__.py").touch()


def _imported(tree: ast.AST) -> set[str]:
    """Every module name that a file imports, at any depth of its code."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names.add("." * node.level + (node.module or ""))
    return names


def test_the_import_contracts_are_kept() -> None:
    run = _lint_imports(ROOT)
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.parametrize(
    ("package", "line", "contract"),
    [
        ("hli_bench/base", "import hli_bench.kernel", "Everything points down"),
        ("hli_bench/kernel", "import hli_bench.plc", "Everything points down"),
        ("hli_bench_drives", "import hli_bench.manual", "Drives meet the bench on the wire"),
        ("hli_bench/kernel", "import hli_bench_drives", "The bench loads drives by name"),
        ("hli_bench/laws", "import socket", "The core does no I/O"),
    ],
)
def test_a_broken_wall_is_noticed(tmp_path: Path, package: str, line: str, contract: str) -> None:
    _rooms_without_furniture(tmp_path)
    assert _lint_imports(tmp_path).returncode == 0
    (tmp_path / package / "__init__.py").write_text(f"{line}\n", encoding="utf-8")
    run = _lint_imports(tmp_path)
    assert run.returncode == 1
    assert re.findall(r"^(.*) BROKEN", run.stdout, re.MULTILINE) == [contract]


def test_there_are_plc_scripts_to_look_at() -> None:
    assert PLC_SCRIPTS


@pytest.mark.parametrize("script", PLC_SCRIPTS, ids=lambda script: script.name)
def test_a_plc_script_imports_the_plc_interface_only(script: Path) -> None:
    imported = _imported(ast.parse(script.read_text(encoding="utf-8")))
    foreign = {name for name in imported if name != "hli_bench.plc" and not name.startswith("hli_bench.plc.")}
    assert not foreign
