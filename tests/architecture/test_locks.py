"""The lock files against pyproject.toml and against each other."""

import re
import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[2]
PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^\s;]+)")


def _pins(name: str) -> dict[str, str]:
    lines = (ROOT / name).read_text(encoding="utf-8").splitlines()
    found = [match for line in lines if (match := PIN.match(line))]
    return {canonicalize_name(match[1]): match[2] for match in found}


def _project() -> dict[str, object]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def _unmet(requirements: list[str], pins: dict[str, str]) -> list[str]:
    """The requirements that no pin satisfies."""
    parsed = [Requirement(text) for text in requirements]
    return [
        str(wanted)
        for wanted in parsed
        if pins.get(canonicalize_name(wanted.name), "") not in wanted.specifier
    ]


def test_every_requirement_is_pinned_in_its_range() -> None:
    description = _project()
    runtime, development = _pins("requirements.lock"), _pins("requirements-dev.lock")
    assert not _unmet(description["project"]["dependencies"], runtime)
    assert not _unmet(description["build-system"]["requires"], runtime)
    assert not _unmet(description["project"]["optional-dependencies"]["dev"], development)


def test_the_development_lock_holds_the_runtime_lock() -> None:
    assert _pins("requirements.lock").items() <= _pins("requirements-dev.lock").items()


def test_every_pin_has_hashes_and_no_lock_names_an_index() -> None:
    for name in ("requirements.lock", "requirements-dev.lock"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert "://" not in text
        entries = re.split(r"\n(?=[A-Za-z0-9])", text)
        assert not [entry for entry in entries if PIN.match(entry) and "--hash=sha256:" not in entry]
