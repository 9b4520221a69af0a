"""The project as a wheel in an environment of its own: nothing of the checkout in reach."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FACE = ("--set", "plant.probe.Z.face_mm=100", "--set", "plant.probe.Z.material=below")
WHEEL = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
SOURCES = ("pyproject.toml", "README.md", "LICENSE", *WHEEL["packages"], *WHEEL["force-include"])
Command = Callable[..., subprocess.CompletedProcess[str]]
DEPENDENCIES = """
import importlib, sys
from pathlib import Path
site = Path(sys.argv[1])
# What stands in .pth files, the checkout among it, stays out: only names that are directories or files of site itself.
for entry in site.iterdir():
    if entry.suffix != ".pth" and not entry.name.lower().startswith(("hli_bench", "__editable__")):
        (Path(sys.argv[2]) / entry.name).symlink_to(entry)
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build from a copy, so that no build leaves its traces in the checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    source.mkdir()
    ignore = shutil.ignore_patterns("__pycache__")
    for name in SOURCES:
        place = ROOT / name
        copy = shutil.copytree if place.is_dir() else shutil.copy
        copy(place, source / name, **({"ignore": ignore} if place.is_dir() else {}))
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder, source]
    subprocess.run(build, check=True, capture_output=True)
    (built,) = folder.glob("hli_bench-*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path) -> Path:
    """A virtual environment with the wheel and links to the dependencies of the running one; its bin folder."""
    place = wheel.parent / "venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", place], check=True)
    site = place / "lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"
    of_this = Path(sysconfig.get_paths()["purelib"])
    subprocess.run([sys.executable, "-c", DEPENDENCIES, of_this, site], check=True)
    pip = [
        sys.executable,
        "-m",
        "pip",
        "--python",
        place / "bin" / "python",
        "install",
        "--no-deps",
        "--no-index",
    ]
    subprocess.run([*pip, "--quiet", "--disable-pip-version-check", wheel], check=True)
    return place / "bin"


@pytest.fixture
def command(installed: Path, tmp_path: Path) -> Command:
    """Return what runs a program of that environment in an empty folder, with an empty home."""
    home = tmp_path / "home"
    home.mkdir()
    # Named for laptops and CI alike: coverage, PYTHONPATH and the like of the test run do not reach it.
    environment = {"PATH": os.environ["PATH"], "HOME": str(home), "LANG": "C.UTF-8"}

    def run(program: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        (tmp_path / "work").mkdir(exist_ok=True)
        return subprocess.run(
            [installed / program, *map(str, arguments)],
            cwd=tmp_path / "work",
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )

    return run


def test_the_package_is_the_installed_one(installed: Path, command: Command) -> None:
    code = "import hli_bench, hli_bench_drives; print(hli_bench.__file__); print(hli_bench_drives.__file__)"
    for line in command("python", "-c", code).stdout.splitlines():
        assert Path(line).is_relative_to(installed.parent)


def test_the_main_job_runs_from_the_wheel(command: Command, tmp_path: Path) -> None:
    """Machine, program, PLC script (in a process of its own) and EDS come from the package."""
    run = command("hli-bench", "run", "meas1.nc", "--set", "plc.0.process=true", *FACE, "--result", "r.json")
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines()[0] == "V.A.MESS.Z=100.000000"
    assert json.loads((tmp_path / "work" / "r.json").read_text())["variables"]["V.A.MESS.Z"] == 100.0
    assert [entry.name for entry in (tmp_path / "work").iterdir()] == ["r.json"]


def test_kernel_drives_and_terminals_run_from_the_wheel_as_processes(command: Command) -> None:
    code = (
        "from hli_bench import Bench\n"
        "with Bench('demo', processes=True) as bench:\n"
        "    print(bench.run('N10 G01 G90 Z299 F6000\\nN20 M30').status)"
    )
    run = command("python", "-c", code)
    assert run.stdout == "completed\n", run.stderr


@pytest.mark.parametrize(
    ("arguments", "shown"),
    [
        (("doctor",), "compiler-cache"),
        (("params", "show", "P-AXIS-00516"), "kenngr.measure.signal"),
        (("drive", "show", "servo402"), "6072"),
        (("machine", "check", "demo"), "accepted"),
        (("machine", "schema"), "cycle_us"),
    ],
)
def test_commands_find_their_data(command: Command, arguments: tuple[str, ...], shown: str) -> None:
    run = command("hli-bench", *arguments)
    assert run.returncode == 0, run.stderr
    assert shown in run.stdout


PREPARE = "from hli_bench.laws.native import prepare; prepare(lambda: print('compiling'))"


def test_the_compiled_laws_are_kept_in_the_home_and_survive_a_new_installation(
    installed: Path, command: Command, tmp_path: Path
) -> None:
    run = command("python", "-c", PREPARE)
    assert run.stdout == "compiling\n", run.stderr
    assert list((tmp_path / "home" / ".cache" / "hli-bench").glob("laws-*.bin"))
    assert str(tmp_path / "home" / ".cache" / "hli-bench") in command("hli-bench", "doctor").stdout
    for file in _laws(installed).glob("*.py"):
        file.touch()
    shutil.rmtree(_laws(installed) / "__pycache__")
    assert command("python", "-c", PREPARE).stdout == ""


def test_without_any_place_for_them_the_laws_are_compiled_anew(
    installed: Path, command: Command, tmp_path: Path
) -> None:
    """Files stand where the places would be: they stop root too, which permissions do not."""
    shutil.rmtree(_laws(installed) / "__pycache__", ignore_errors=True)
    (_laws(installed) / "__pycache__").write_text("")
    (tmp_path / "home" / ".cache").write_text("")
    for _ in range(2):
        run = command("python", "-c", PREPARE)
        assert run.stdout == "compiling\n", run.stderr


def _laws(installed: Path) -> Path:
    (laws,) = (installed.parent / "lib").glob("python*/site-packages/hli_bench/laws")
    return laws
