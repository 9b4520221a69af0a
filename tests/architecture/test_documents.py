"""What the documents tell a reader to type exists, and their links lead somewhere."""

import functools
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.cli.main import main
from hli_bench.kernel.decoder import commands, control, expressions, words

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", "CHANGELOG.md", "programs/README.md")
DOCUMENTS = sorted([*(ROOT / page for page in PAGES), *(ROOT / "docs").rglob("*.md")])
DECISIONS = sorted((ROOT / "docs" / "decisions").glob("*.md"))

BLOCK = re.compile(r"^```console\n(.*?)^```", re.MULTILINE | re.DOTALL)
EXAMPLE = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?://|#)([^)#\s]+)")
PROMPT = "$ "
CLI = "import sys; from hli_bench.cli.main import main; sys.exit(main())"


def _commands(tool: str) -> list[tuple[str, ...]]:
    """The words after `tool` in every line of a console block that starts with the prompt and that tool."""
    lines = [
        line.removeprefix(PROMPT)
        for document in DOCUMENTS
        for block in BLOCK.findall(document.read_text(encoding="utf-8"))
        for line in block.replace("\\\n", " ").splitlines()
        if line.startswith(PROMPT)
    ]
    split = [shlex.split(line, comments=True) for line in lines]
    return sorted({tuple(words[1:]) for words in split if words and Path(words[0]).name == tool})


def _examples(document: Path) -> list[str]:
    return EXAMPLE.findall(document.read_text(encoding="utf-8"))


@functools.cache
def _help(*words: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", CLI, *words, "--help"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, f"hli-bench {' '.join(words)}: {run.stderr}"
    return run.stdout


def _offers(text: str, word: str) -> bool:
    """Whether a help text lists `word` as one of its commands or options."""
    return re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", text) is not None


def _make_targets() -> set[str]:
    return set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))


def test_the_documents_show_commands() -> None:
    assert ("run",) in _commands("make")
    assert ("test",) in _commands("make")
    assert _commands("hli-bench")


@pytest.mark.parametrize("words", _commands("make"), ids=" ".join)
def test_a_make_target_that_is_shown_exists(words: tuple[str, ...]) -> None:
    targets = {word for word in words if "=" not in word}
    assert targets <= _make_targets()


@pytest.mark.parametrize("words", _commands("hli-bench"), ids=" ".join)
def test_a_command_that_is_shown_exists_with_its_options(words: tuple[str, ...]) -> None:
    path = words[:1]
    assert _offers(_help(), path[0])
    nested = re.search(r"\{([\w,-]+)\}", _help(*path))
    if nested and len(words) > 1 and words[1] in nested[1].split(","):
        path = words[:2]
    options = [word.partition("=")[0] for word in words if word.startswith("--")]
    assert not [option for option in options if not _offers(_help(*path), option)]


@pytest.mark.parametrize("example", _examples(ROOT / "README.md"), ids=lambda text: text.splitlines()[0])
def test_the_examples_of_the_readme_run(example: str) -> None:
    exec(compile(example, "README.md", "exec"), {})


def test_the_traces_of_the_readme_are_as_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    (block,) = [
        text
        for text in BLOCK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
        if "trace diff" in text
    ]
    ends, said = [], []
    for line in block.replace(" out/", f" {tmp_path}/").splitlines():
        ends.append(main(shlex.split(line.removeprefix(PROMPT))[1:]))
        said.append(capsys.readouterr().out)
    assert ends == [0, 0, 0, 1]
    assert "edges   probe TRUE" in said[2]
    assert "first difference: edges at 13.110 s" in said[3]


def test_the_plc_script_and_the_test_that_the_interfaces_show_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, bench: Callable[..., Bench]
) -> None:
    """As a reader would take them over: the script in a file, the test beside it."""
    examples = _examples(ROOT / "docs" / "interfaces.md")
    (script,) = [text for text in examples if "class Probing" in text]
    (test,) = [text for text in examples if "my_plc.py" in text]
    (tmp_path / "my_plc.py").write_text(script)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(test, "interfaces.md", "exec"), names)
    names["test_the_face_is_found"](bench)


def test_the_built_words_of_the_nc_language_are_those_listed() -> None:
    text = (ROOT / "docs" / "interfaces.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| ([a-zG][a-zA-Z ]+) \| (.*) \|$", text, re.MULTILINE))
    takes_axes, _, in_force = rows["G functions"].partition(";")
    listed = {int(number) for number in re.findall(r"G(\d+)", takes_axes)}
    assert listed == {*words.TAKING_AXES, 0, 1, 4, 90, 91}
    assert {int(number) for number in re.findall(r"G(\d+)", in_force)} == words.IN_FORCE
    assert set(re.findall(r"#([A-Z]+)", rows["commands"])) == set(commands.COMMANDS)
    assert set(re.findall(r"\$([A-Z]+)", rows["statements"])) == set(control._WORDS)
    assert rows["functions"].partition(",")[0].split() == list(expressions.FUNCTIONS)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda document: str(document.relative_to(ROOT)))
def test_the_links_of_a_document_lead_somewhere(document: Path) -> None:
    links = LINK.findall(document.read_text(encoding="utf-8"))
    assert not [link for link in links if not (document.parent / link).exists()]


@pytest.mark.parametrize("decision", DECISIONS, ids=lambda decision: decision.stem)
def test_a_decision_says_context_decision_and_consequence(decision: Path) -> None:
    headings = re.findall(r"^## (\w+)", decision.read_text(encoding="utf-8"), re.MULTILINE)
    assert headings == ["Context", "Decision", "Consequence"]


@pytest.mark.parametrize("decision", DECISIONS, ids=lambda decision: decision.stem)
def test_a_decision_says_whether_it_holds(decision: Path) -> None:
    first = decision.read_text(encoding="utf-8").split("\n## ")[0]
    (status,) = re.findall(r"^Status: (.*)", first, re.MULTILINE)
    assert re.match(r"in force\b|superseded\b", status)
    for other in re.findall(r"\]\(([^)]+)\)", first):
        assert (decision.parent / other).is_file()


def test_decisions_are_numbered_without_a_gap() -> None:
    assert [int(decision.stem[:4]) for decision in DECISIONS] == list(range(1, len(DECISIONS) + 1))
