"""The text of an EDS: its bytes decoded, its sections, and what is wrong with it by line."""

from dataclasses import dataclass, field

from hli_bench.base.errors import InputError


def text_of(content: bytes) -> str:
    """Decode a file: as its byte order mark says, else as Latin-1, in which every byte is a character."""
    for mark, encoding in (
        (b"\xef\xbb\xbf", "utf-8"),
        (b"\xff\xfe", "utf-16-le"),
        (b"\xfe\xff", "utf-16-be"),
    ):
        if content.startswith(mark):
            return content[len(mark) :].decode(encoding, errors="replace")
    return content.decode("latin-1")


class Remarks:
    """Gathers what is wrong with a file, by line."""

    __slots__ = ("_found", "file")

    def __init__(self, file: str) -> None:
        self.file = file
        self._found: list[tuple[int, str]] = []

    def add(self, line: int, message: str) -> None:
        """Note that something is wrong with a line."""
        self._found.append((line, message))

    def lines(self) -> tuple[str, ...]:
        """Return the remarks in the order of the file."""
        return tuple(str(InputError(message, self.file, line)) for line, message in sorted(self._found))


@dataclass(frozen=True, slots=True)
class Section:
    """One bracketed section: where it starts, and value and line per upper-case key."""

    name: str
    line: int
    keys: dict[str, tuple[str, int]] = field(default_factory=dict)

    def value(self, key: str) -> tuple[str, int]:
        """Return value and line of a key; an empty value, and the line of the section, when it is missing."""
        return self.keys.get(key.upper(), ("", self.line))


def sections(text: str, remarks: Remarks) -> dict[str, Section]:
    """Split into sections by upper-case name; of two of one name the first counts."""
    sections: dict[str, Section] = {}
    current: Section | None = None
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.split(";", 1)[0].strip()
        if not line:
            continue
        if line.startswith("["):
            if not line.endswith("]"):
                remarks.add(number, f"section {line!r} is not closed with ]")
            current = Section(line[1:].rstrip("]").strip(), number)
            first = sections.setdefault(current.name.upper(), current)
            if first is not current:
                remarks.add(
                    number, f"section [{current.name}] stands twice, the first in line {first.line} counts"
                )
            continue
        key, equals, value = line.partition("=")
        if not equals:
            remarks.add(number, f"{line!r} is neither [section] nor key=value")
        elif current is None:
            remarks.add(number, f"key {key.strip()!r} stands before the first [section]")
        else:
            current.keys[key.strip().upper()] = (value.strip(), number)
    if not sections:
        raise InputError("not an EDS: no [section] in it", remarks.file)
    return sections
