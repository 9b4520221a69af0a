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
FILES: Final = 4
"""Files that stay in a place: this text of the laws and some that other environments and branches may still use."""


class Code(NamedTuple):
    """An object file, and which of its symbols is the entry of which law."""

    symbols: Mapping[str, str]
    data: bytes


def places(environment: Mapping[str, str] = os.environ) -> list[Path]:
    """Return the directories that may hold the file: NUMBA_CACHE_DIR, or the user's cache, then beside the laws.

    The user's cache is still there when the environment is made anew; who has no home has none.
    """
    chosen = environment.get("NUMBA_CACHE_DIR")
    if chosen:
        return [Path(chosen)]
    beside = LAWS_FOLDER / "__pycache__"
    users = environment.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111 - raises nothing
    return [beside] if users.startswith("~") else [Path(users) / "hli-bench", beside]


def file_name(*made_by: str) -> str:
    """Return the name of the file for the present text of all laws and for what they are `made_by`."""
    digest = sha256("\n".join(made_by).encode())
    for file in sorted(LAWS_FOLDER.glob("*.py")):
        digest.update(file.read_bytes())
    return f"laws-{digest.hexdigest()[:32]}.bin"


def read(name: str) -> Code | None:
    """Return what an earlier run has kept, None when there is nothing or what is there is damaged."""
    for place in places():
        try:
            return _unpacked((place / name).read_bytes())
        except (OSError, ValueError):
            continue
    return None


def keep(name: str, code: Code) -> None:
    """Keep machine code in the first place that can be written; where none can, every process compiles anew."""
    content = _packed(code)
    for place in places():
        with suppress(OSError):
            _put(place, name, content)
            _thin_out(place, name)
            return


def _packed(code: Code) -> bytes:
    """Return the file: a digest of all that follows, the symbols as a line of JSON, the object file."""
    body = json.dumps(code.symbols).encode() + b"\n" + code.data
    return sha256(body).hexdigest().encode() + b"\n" + body


def _unpacked(content: bytes) -> Code:
    """Return what `_packed` was given. Raises ValueError for any other content."""
    digest, body = content.split(b"\n", 1)
    if digest != sha256(body).hexdigest().encode():
        raise ValueError("damaged")
    symbols, data = body.split(b"\n", 1)
    return Code(json.loads(symbols), data)


def _put(place: Path, name: str, content: bytes) -> None:
    """Put a file in place as a whole: another process may be reading or writing it."""
    place.mkdir(parents=True, exist_ok=True)
    handle, path = tempfile.mkstemp(prefix=name, dir=place)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        Path(path).chmod(0o644)  # beside the laws it serves everybody who uses this installation
        Path(path).replace(place / name)
    except BaseException:
        Path(path).unlink(missing_ok=True)
        raise


def _thin_out(place: Path, name: str) -> None:
    """Remove all but the newest files of a place, never `name`.

    Whoever needs one of the others has read it as a whole or compiles anew; it may go at any moment.
    """
    others = []
    for file in place.glob("laws-*.bin"):
        with suppress(OSError):
            others.append((file.stat().st_mtime_ns, file))
    others = sorted(one for one in others if one[1].name != name)
    for _, file in others[: max(0, len(others) - (FILES - 1))]:
        with suppress(OSError):
            file.unlink()
