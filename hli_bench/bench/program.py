"""An NC program given as text, as a file or as lines."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hli_bench.base.errors import InputError
from hli_bench.base.paths import is_file


@contextmanager
def opened(program: str | Path | Iterable[str], name: str = "") -> Iterator[tuple[Iterable[str], str]]:
    """Give the lines of a program and the name under which its errors are reported; close its file in the end.

    Lines of a file are read as they are needed. Raises InputError when there is no such file, or no program.
    """
    given: object = program
    if isinstance(given, bytes) or not isinstance(given, Iterable | Path):
        raise InputError(f"program {given!r}: expected NC text, a path or lines")
    if isinstance(program, str) and "\n" not in program and program.lower().endswith(".nc"):
        program = Path(program)
    if isinstance(program, Path):
        with _file(program) as lines:
            yield lines, name or str(program)
    elif isinstance(program, str):
        yield program.splitlines(), name or "program"
    else:
        yield program, name or "program"


@contextmanager
def _file(path: Path) -> Iterator[Iterable[str]]:
    if not is_file(path):
        raise InputError("no such NC program", file=str(path))
    try:
        file = path.open(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", file=str(path)) from error
    with file:
        yield (line.rstrip("\n") for line in file)
