"""Lines of a program put together to blocks: comments blanked, continued lines joined, places kept."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from hli_bench.base.errors import InputError, NotEmulated
from hli_bench.kernel.blocks import Source

MAX_CONTINUED_LINES: Final = 64
"""Lines of one block, decided here: a forgotten ']' must not swallow a whole program."""

MAX_LINE: Final = 4000
"""Characters of a line. Source: TF5200 programming manual, chapter 2 (block length)."""
SHOWN: Final = 40
"""Characters of a word that a message repeats."""

_MARK = re.compile(r'"[^"]*"?|[;(\[\]\\]')
_SOLID = re.compile(r"\S")
_COMMENT_MARK = re.compile(r"[()]")
_BLANKS = re.compile(r"\s+")
_NUMBER = re.compile(r"\s*(N[0-9]+)(?![0-9.]):?", re.IGNORECASE)
_NEW_BLOCK = re.compile(r"\s*(?:N[0-9]|%)", re.IGNORECASE)
_COMMENT_BEGIN = re.compile(r"\s*#\s*COMMENT\s+BEGIN\b", re.IGNORECASE)
_COMMENT_END = re.compile(r"\s*(?:N[0-9]+\s*)?#\s*COMMENT\s+END\b", re.IGNORECASE)


def short(word: str) -> str:
    """Return a word for a message, cut when it is long."""
    return word if len(word) <= SHOWN else f"{word[:SHOWN]}..."


class Lines:
    """Hands out the lines of a program one by one; remembers them only while a loop may return to them."""

    __slots__ = ("_base", "_buffer", "_cursor", "_lines", "comment", "number")

    def __init__(self, lines: Iterable[str]) -> None:
        self._lines = iter(lines)
        self._buffer: list[str] | None = None
        self._base = 0
        self._cursor = 0
        self.number = 0
        self.comment = 0
        """Line of a #COMMENT BEGIN that is open: what follows is to be taken by `comment`."""

    def next(self) -> str | None:
        """Return the next line or None at the end; `number` is its number, from 1."""
        buffer = self._buffer
        if buffer is None:
            line = next(self._lines, None)
            if line is not None:
                self.number += 1
            return line
        if self._cursor == len(buffer):
            line = next(self._lines, None)
            if line is None:
                return None
            buffer.append(line)
        self._cursor += 1
        self.number = self._base + self._cursor
        return buffer[self._cursor - 1]

    def mark(self) -> int:
        """Remember lines from here on and return the place for `rewind`."""
        if self._buffer is None:
            self._buffer = []
            self._base = self.number
            self._cursor = 0
        return self._cursor

    def rewind(self, place: int) -> None:
        """Go back to a marked place."""
        self._cursor = place

    def forget(self) -> None:
        """Stop remembering: the outermost loop is left."""
        if self._buffer is not None and self._cursor == len(self._buffer):
            self._buffer = None


@dataclass(frozen=True, slots=True)
class BlockText:
    """Text of one block without comments and N number; `pieces` are (offset, line, column offset)."""

    file: str
    source: Source
    text: str
    pieces: tuple[tuple[int, int, int], ...]

    def place(self, offset: int) -> tuple[int, int]:
        """Return line and column, both from 1, of an offset in `text`."""
        start, line, shift = next(piece for piece in reversed(self.pieces) if piece[0] <= offset)
        return line, offset - start + shift + 1


class Scanner:
    """A place in a block's text that moves on as words are taken."""

    __slots__ = ("block", "depth", "pos", "text")

    def __init__(self, block: BlockText) -> None:
        self.block = block
        self.text = block.text
        self.pos = 0
        self.depth = 0

    def skip(self) -> None:
        """Move over blanks."""
        if self.text[self.pos : self.pos + 1].isspace():
            found = _BLANKS.match(self.text, self.pos)
            self.pos = found.end() if found else self.pos

    @property
    def start(self) -> int:
        """Return the offset of the first word."""
        return len(self.text) - len(self.text.lstrip())

    def at_end(self) -> bool:
        """Tell whether only blanks are left."""
        self.skip()
        return self.pos >= len(self.text)

    def peek(self) -> str:
        """Return the next character that is no blank, "" at the end."""
        self.skip()
        return self.text[self.pos : self.pos + 1]

    def accept(self, literal: str) -> bool:
        """Take `literal` (no letters) when it comes next."""
        self.skip()
        if not self.text.startswith(literal, self.pos):
            return False
        self.pos += len(literal)
        return True

    def expect(self, literal: str) -> None:
        """Take `literal` or raise `InputError`."""
        if not self.accept(literal):
            raise self.error(f"expected '{literal}', found {self.found()}")

    def match(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Take what `pattern` matches here."""
        self.skip()
        found = pattern.match(self.text, self.pos)
        if found is not None:
            self.pos = found.end()
        return found

    def found(self) -> str:
        """Describe what comes next, for messages."""
        self.skip()
        rest = self.text[self.pos :].split(maxsplit=1)
        return f"'{rest[0][:24]}'" if rest else "the end of the block"

    def error(self, message: str, at: int | None = None) -> InputError:
        """Return an `InputError` that names this place (or offset `at`)."""
        line, column = self.block.place(self.pos if at is None else at)
        return InputError(message, self.block.file, line, column)

    def not_emulated(self, what: str, at: int | None = None) -> NotEmulated:
        """Return a `NotEmulated` that names this place."""
        line, column = self.block.place(self.pos if at is None else at)
        return NotEmulated(f"{self.block.file}:{line}:{column}: {what}")


@dataclass(slots=True)
class _Cleaned:
    text: str
    brackets: list[int]
    continued: bool


def read_block(lines: Lines, raw: str, file: str) -> BlockText:
    """Return the block that begins with line `raw`, reading on while it is continued.

    A line that begins with "->" is a result printed in a manual and counts as a comment; an open '['
    continues on the next line without a backslash (both decided here).
    """
    first = lines.number
    cleaned = _clean(raw, file, first, [])
    number = _NUMBER.match(cleaned.text)
    source = Source(number.group(1) if number else "", first)
    start = number.end() if number else 0
    if _COMMENT_BEGIN.match(cleaned.text, start):
        lines.comment = first
        return BlockText(file, source, "", ((0, first, 0),))
    text = cleaned.text[start:]
    if not (cleaned.continued or cleaned.brackets):
        return BlockText(file, source, text, ((0, first, start),))
    return _join(lines, cleaned, BlockText(file, source, text, ((0, first, start),)))


def _join(lines: Lines, cleaned: _Cleaned, block: BlockText) -> BlockText:
    parts, pieces = [block.text], list(block.pieces)
    length, opened = len(block.text), block.source.line
    while cleaned.continued or cleaned.brackets:
        raw = lines.next()
        if raw is None:
            break
        if raw.lstrip().startswith("->"):
            continue
        starts_new = _NEW_BLOCK.match(raw) is not None
        if (cleaned.brackets and not cleaned.continued and starts_new) or len(parts) == MAX_CONTINUED_LINES:
            if cleaned.brackets:
                column = cleaned.brackets[-1] + 1
                raise InputError("expected ']' for this '['", block.file, opened, column)
            message = f"expected at most {MAX_CONTINUED_LINES} lines in a block"
            raise InputError(message, block.file, lines.number)
        before = len(cleaned.brackets)
        cleaned = _clean(raw, block.file, lines.number, cleaned.brackets)
        if len(cleaned.brackets) > before:
            opened = lines.number
        number = _NUMBER.match(cleaned.text)
        shift = number.end() if number else 0
        pieces.append((length + 1, lines.number, shift))
        parts.append(cleaned.text[shift:])
        length += 1 + len(parts[-1])
    return BlockText(block.file, block.source, " ".join(parts), tuple(pieces))


def _clean(raw: str, file: str, line: int, brackets: list[int]) -> _Cleaned:
    """Blank comments of one line; `brackets` are the columns of '[' still open."""
    text = raw.rstrip("\r\n\x03\x00")
    if text.lstrip().startswith("->"):
        return _Cleaned("", brackets, continued=False)
    if len(text) > MAX_LINE:
        raise InputError(f"expected at most {MAX_LINE} characters in a line, found {len(text)}", file, line)
    brackets = list(brackets)
    kept: list[str] = []
    begin = pos = 0
    while mark := _MARK.search(text, pos):
        token, pos = mark.group(), mark.end()
        if token[0] == '"' and (token == '"' or token[-1] != '"'):
            raise InputError("expected a closing quote for this text", file, line, mark.start() + 1)
        if token == ";":
            text = text[: mark.start()]
        elif token == "(":
            pos = _comment_end(text, pos)
            kept.append(text[begin : mark.start()] + " " * (pos - mark.start()))
            begin = pos
        elif token == "[":
            brackets.append(mark.start())
        elif token == "]" and brackets:
            brackets.pop()
        elif token == "\\":
            _nothing_behind(text, pos, file, line)
            return _Cleaned("".join((*kept, text[begin : mark.start()])), brackets, continued=True)
    return _Cleaned("".join((*kept, text[begin:])), brackets, continued=False)


def _nothing_behind(text: str, pos: int, file: str, line: int) -> None:
    """Raise InputError when anything but a comment stands behind the backslash before `pos`."""
    while mark := _SOLID.search(text, pos):
        if mark.group() == ";":
            return
        if mark.group() != "(":
            raise InputError("expected the end of the line after '\\'", file, line, mark.start() + 1)
        pos = _comment_end(text, mark.end())


def _comment_end(text: str, pos: int) -> int:
    """Return where the comment ends whose '(' stands before `pos`: comments nest, an open one ends with the block.

    Source: TF5200 programming manual, chapter 2.4.2.
    """
    depth = 1
    while depth and (mark := _COMMENT_MARK.search(text, pos)):
        depth += 1 if mark.group() == "(" else -1
        pos = mark.end()
    return len(text) if depth else pos


def comment(lines: Lines, file: str) -> Iterator[str]:
    """Yield the lines of an open #COMMENT BEGIN up to its end; of none nothing."""
    begin = lines.comment
    while begin and (raw := lines.next()) is not None:
        if _COMMENT_END.match(raw):
            begin = lines.comment = 0
        yield raw
    if begin:
        raise InputError("expected #COMMENT END for this #COMMENT BEGIN", file, begin, 1)


def cost(raw: str) -> int:
    """Return what a line counts among the blocks without motion: long ones for several."""
    return 1 + (len(raw) >> 7)
