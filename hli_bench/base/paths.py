"""Paths as users give them: questions that never raise, texts of regular files with why they cannot be read.

`pathlib` raises for a name that no file can have (longer than 255 bytes, a NUL in it); to a user it is a file that is
not there, like any other misspelt name.
"""

import os
import stat
from pathlib import Path
from typing import Final

from hli_bench.base.errors import InputError

TEXT_LIMIT: Final = 64 * 2**20
"""Size of the largest text that is read at once, bytes (decided here): a device or a core dump is no list."""


def is_file(path: Path) -> bool:
    """Tell whether there is a regular file."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def is_folder(path: Path) -> bool:
    """Tell whether there is a folder."""
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def exists(path: Path) -> bool:
    """Tell whether there is anything of that name."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def size_to_read(path: Path) -> os.stat_result:
    """Return what the file system knows of a text file. Raises InputError for what is no file to be read at once."""
    try:
        status = path.stat()
    except (OSError, ValueError) as error:
        raise InputError(_reason(error), file=str(path)) from error
    if stat.S_ISDIR(status.st_mode):
        raise InputError("is a folder, expected a file", file=str(path))
    if not stat.S_ISREG(status.st_mode):
        raise InputError("is no regular file", file=str(path))
    if status.st_size > TEXT_LIMIT:
        message = f"has {status.st_size} bytes, more than {TEXT_LIMIT} are no text for the bench"
        raise InputError(message, file=str(path))
    return status


def text(path: Path) -> str:
    """Return the text of a UTF-8 file, without the byte order mark that editors on Windows write.

    Raises InputError naming the file and why it cannot be read.
    """
    size_to_read(path)
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        message = f"is not UTF-8 text: byte 0x{error.object[error.start]:02x} at offset {error.start}"
        raise InputError(message, file=str(path)) from error
    except OSError as error:
        raise InputError(_reason(error), file=str(path)) from error


def _reason(error: OSError | ValueError) -> str:
    """Return why a file cannot be read; a ValueError is a NUL in its name."""
    return f"cannot be read: {error.strerror if isinstance(error, OSError) else 'no file can have that name'}"
