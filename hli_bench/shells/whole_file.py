"""Files that are there whole or not at all: written beside their place, then renamed onto it.

A full disk, Ctrl-C or a power cut in the middle leaves what was there before. Renaming within a folder replaces the old
file in one step; the new one is synchronised first, so that no file system brings the name forward without its data.
"""

import os
import tempfile
from contextlib import suppress
from pathlib import Path

from hli_bench.base.errors import EnvironmentLacks, InputError


def check_writable(path: Path, option: str) -> None:
    """Make sure that `path` can be written later; what is there stays. Raises InputError naming the option."""
    try:
        if path.exists() and not path.is_file():
            if path.is_dir():
                raise InputError(f"{option}: is a folder, expected a file", file=str(path))
            return
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(13, os.strerror(13))
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".hli-bench-"):
            pass
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "no file can have that name"
        raise InputError(f"{option}: cannot be written: {reason}", file=str(path)) from error


def write_whole(path: Path, text: str) -> None:
    """Write `text` as UTF-8; a device or pipe is written as it stands. Raises EnvironmentLacks when it cannot be."""
    try:
        if path.exists() and not path.is_file():
            path.write_text(text, encoding="utf-8", errors="backslashreplace")
            return
        _replace(path.resolve(), text.encode("utf-8", errors="backslashreplace"))
    except OSError as error:
        raise EnvironmentLacks(f"{path}: cannot be written: {error.strerror}") from error


def _replace(place: Path, data: bytes) -> None:
    """Write the data beside `place` and rename it; the new file has the rights that the old one or a new one would."""
    number, name = tempfile.mkstemp(dir=place.parent, prefix=f".{place.name[:100]}-")
    try:
        with os.fdopen(number, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
            os.fchmod(file.fileno(), _rights(place))
        Path(name).replace(place)
    except BaseException:
        with suppress(OSError):
            Path(name).unlink()
        raise


def _rights(place: Path) -> int:
    """Return the permission bits of the file that is there, or those of a new one under the process's mask."""
    try:
        return place.stat().st_mode & 0o7777
    except FileNotFoundError:
        mask = os.umask(0)
        os.umask(mask)
        return 0o666 & ~mask
