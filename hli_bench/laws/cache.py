"""Where machine code is kept between runs: one file for one text of the laws, compiler and processor."""

import json
import os
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from typing import Final, NamedTuple

LAWS_FOLDER: Final = Path(__file__).parent


class Code(NamedTuple):
    """An object file, and which of its symbols is the entry of which law."""

    symbols: Mapping[str, str]
    data: bytes


def places(environment: Mapping[str, str] = os.environ) -> list[Path]:
    """Return the directories that may hold the file: NUMBA_CACHE_DIR, or the user's cache, then beside the laws.

    The user's cache is still there when the environment is made anew.
    """
    chosen = environment.get("NUMBA_CACHE_DIR")
    if chosen:
        return [Path(chosen)]
    users = environment.get("XDG_CACHE_HOME") or str(Path("~/.cache").expanduser())
    return [Path(users) / "hli-bench", LAWS_FOLDER / "__pycache__"]


def file_name(*made_by: str) -> str:
    """Return the name of the file for the present text of all laws and for what they are `made_by`."""
    digest = sha256("\n".join(made_by).encode())
    for file in sorted(LAWS_FOLDER.glob("*.py")):
        digest.update(file.read_bytes())
    return f"laws-{digest.hexdigest()[:32]}.bin"


def read(name: str) -> Code | None:
    """Return what an earlier run has kept, None when there is nothing or a part of it only."""
    for place in places():
        try:
            head, data = (place / name).read_bytes().split(b"\n", 1)
            about = json.loads(head)
        except (OSError, ValueError):
            continue
        if about["sha256"] == sha256(data).hexdigest():
            return Code(about["symbols"], data)
    return None


def keep(name: str, code: Code) -> None:
    """Keep machine code in the first place that can be written; where none can, every process compiles anew."""
    about = {"symbols": code.symbols, "sha256": sha256(code.data).hexdigest()}
    for place in places():
        with suppress(OSError):
            _put(place, name, json.dumps(about).encode() + b"\n" + code.data)
            return


def _put(place: Path, name: str, content: bytes) -> None:
    """Put a file in place as a whole: another process may be reading or writing it."""
    place.mkdir(parents=True, exist_ok=True)
    handle, path = tempfile.mkstemp(prefix=name, dir=place)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        Path(path).chmod(0o644)  # beside the laws it serves everybody who uses this installation
        Path(path).replace(place / name)
    except OSError:
        Path(path).unlink(missing_ok=True)
        raise
