"""The report on the requirement lines: what it reads, how it counts, what it refuses."""

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

TOOL = Path(__file__).parents[3] / "tools" / "coverage_req.py"

LINES = """# Page

- M-001: a run [1 Overview]
- M-002: a list [8.2.1 P-CHAN-00057]
- M-003: #MEAS [TYPE=2] is read [3 Basic (table 2)]
- M-004: two clauses [4 Measure]. Open: the second one is not built
- M-005: advice [6.1 SERCOS]. Not applicable: it asks nothing
- M-006: nobody looked [6.2 Lightbus]
"""


@pytest.fixture
def tool() -> Iterator[ModuleType]:
    spec = importlib.util.spec_from_file_location("coverage_req", TOOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # where dataclasses look their module up
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    pages = tmp_path / "docs" / "requirements"
    pages.mkdir(parents=True)
    (pages / "measurement.md").write_text(LINES)
    (pages / "README.md").write_text("- no line\n")
    for folder in ("bench", "tables", "unit/manual"):
        (tmp_path / "tests" / folder).mkdir(parents=True)
    return tmp_path


def write(project: Path, text: str, place: str = "bench/test_a.py") -> None:
    (project / "tests" / place).write_text(f"import pytest\nfrom pytest import mark\n{text}\n")


def report(tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, list[str], str]:
    status = tool.main(project)
    said = capsys.readouterr()
    return status, said.out.splitlines(), said.err


def test_each_line_stands_with_its_tests_and_the_counts_come_last(
    tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(
        project,
        "@pytest.mark.req('M-001', 'M-004')\ndef test_one(): pass\n"
        "class TestC:\n"
        "    @mark.parametrize('x', [pytest.param(1, marks=mark.req('M-003', by='parsing'))])\n"
        "    def test_two(self, x): pass\n",
    )
    write(project, "ROWS = [(1, pytest.mark.req('M-001', 'M-002'))]", "tables/test_t.py")
    assert report(tool, project, capsys) == (
        0,
        [
            "by behaviour: M-001 tests/bench/test_a.py::test_one tests/tables/test_t.py",
            "by table: M-002 tests/tables/test_t.py",
            "by parsing or look-up: M-003 tests/bench/test_a.py::TestC::test_two",
            "open: M-004 the second one is not built (in part: tests/bench/test_a.py::test_one)",
            "not applicable: M-005 it asks nothing",
            "open: M-006",
            (
                "1 by behaviour, 1 by parsing or look-up, 1 by table, 0 accepted but not emulated, "
                "2 open, 1 not applicable"
            ),
        ],
        "",
    )


def test_what_is_accepted_is_not_shown_by_its_table(
    tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(project, "ROW = pytest.mark.req('M-002')", "tables/test_t.py")
    write(project, "@mark.req('M-002', by='accepted')\ndef test_unused(): pass", "unit/manual/test_u.py")
    _, lines, _ = report(tool, project, capsys)
    assert lines[1].startswith("accepted but not emulated: M-002 tests/tables/test_t.py tests/unit/manual")


@pytest.mark.parametrize(
    ("text", "place", "fault"),
    [
        ("@mark.req('M-253')\ndef test(): pass", "bench/test_a.py", "unknown requirement: M-253"),
        ("@mark.req('M-005')\ndef test(): pass", "bench/test_a.py", "M-005 does not apply"),
        ("@mark.req(*(f'M-{n:03d}' for n in (1, 2)))\ndef test(): pass", "bench/test_a.py", "cannot be read"),
        ("@mark.req(NAME)\ndef test(): pass", "bench/test_a.py", "cannot be read"),
        ("@mark.req('M-001', by=KIND)\ndef test(): pass", "bench/test_a.py", "cannot be read"),
        ("@mark.req('M-001', kind='table')\ndef test(): pass", "bench/test_a.py", "cannot be read"),
        ("@mark.req\ndef test(): pass", "bench/test_a.py", "names no requirement"),
        ("@mark.req()\ndef test(): pass", "bench/test_a.py", "names no requirement"),
        ("@mark.req('M-001', by='magic')\ndef test(): pass", "bench/test_a.py", "by='magic'"),
        ("@mark.req('M-001', by='behaviour')\ndef test(): pass", "tables/test_a.py", "by='behaviour'"),
        ("@mark.req('M-001', by='behaviour')\ndef test(): pass", "unit/manual/test_a.py", "by='behaviour'"),
        ("@mark.req('M-001')\ndef helper(): pass", "bench/test_a.py", "helper is no test"),
        ("@mark.req('M-001')\n@mark.skip\ndef test(): pass", "bench/test_a.py", "switched off"),
        ("@mark.req('M-001')\n@mark.xfail(strict=True)\ndef test(): pass", "bench/test_a.py", "switched off"),
        ("def test():\n    x = mark.req('M-001')", "bench/test_a.py", "inside a function"),
        ("ROW = mark.req('M-001')", "bench/conftest.py", "not collect"),
        (
            "@mark.req('M-001', by='accepted')\ndef test(): pass\n@mark.req('M-001')\ndef test_b(): pass",
            "bench/test_a.py",
            "both as behaviour and as accepted",
        ),
    ],
)
def test_a_mark_that_cannot_be_relied_on_is_refused(
    tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str], text: str, place: str, fault: str
) -> None:
    write(project, text, place)
    status, _, said = report(tool, project, capsys)
    assert status == 1
    assert fault in said


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("- M-007 no colon [1 Overview]", "not a requirement line"),
        ("- M-007: no section", "not a requirement line"),
        ("- M-007: a text [1 Overview]. Perhaps: a word that is none", "not a requirement line"),
        ("- M-001: again [1 Overview]", "M-001 stands twice"),
    ],
)
def test_a_line_that_cannot_be_read_is_refused(
    tool: ModuleType, project: Path, capsys: pytest.CaptureFixture[str], line: str, fault: str
) -> None:
    (project / "docs" / "requirements" / "other.md").write_text(f"# Other\n\n{line}\n")
    status, _, said = report(tool, project, capsys)
    assert status == 1
    assert f"docs/requirements/other.md:3: {fault}" in said


def test_this_project_can_be_read_and_has_every_line(
    tool: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    assert tool.main() == 0
    capsys.readouterr()
    last = {"M": 252, "H": 248, "F": 121, "E": 45}
    expected = [f"{letter}-{number:03d}" for letter, end in last.items() for number in range(1, end + 1)]
    assert list(tool.states(tool.read())) == expected
