import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

TOOL = Path(__file__).parents[3] / "tools" / "coverage_req.py"


@pytest.fixture
def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("coverage_req", TOOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "tests" / "unit").mkdir(parents=True)
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "requirements_na.toml").write_text(
        '[M-003]\nreason = "alone"\n[group]\nids = ["M-004", "H-248"]\nreason = "together"\n'
    )
    (tmp_path / "tests" / "unit" / "test_a.py").write_text(
        "import pytest\n"
        "@pytest.mark.req('M-001', 'E-045')\n"
        "def test_one(): pass\n"
        "@pytest.mark.parametrize('x', [pytest.param(1, marks=pytest.mark.req('M-002'))])\n"
        "def test_two(x): pass\n"
        "class TestC:\n"
        "    @pytest.mark.req('F-121')\n"
        "    def test_three(self): pass\n"
    )
    return tmp_path


def test_report(tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert tool.main(project) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 252 + 248 + 121 + 45 + 1
    assert lines[:5] == [
        "covered: M-001 tests/unit/test_a.py::test_one",
        "covered: M-002 tests/unit/test_a.py::test_two",
        "not applicable: M-003 alone",
        "not applicable: M-004 together",
        "open: M-005",
    ]
    assert "covered: F-121 tests/unit/test_a.py::TestC::test_three" in lines
    assert "covered: E-045 tests/unit/test_a.py::test_one" in lines
    assert lines[-1] == "4 covered, 659 open, 3 not applicable"


def test_unknown_line_fails(tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "tests" / "test_b.py").write_text(
        "import pytest\n@pytest.mark.req('M-253')\ndef test(): pass\n"
    )
    assert tool.main(project) == 1
    assert capsys.readouterr().err == "unknown requirement: M-253 in tests/test_b.py::test\n"


def test_this_project_names_only_known_lines(tool: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    assert tool.main() == 0
    capsys.readouterr()
