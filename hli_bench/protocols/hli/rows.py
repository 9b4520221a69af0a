"""From the manual's table of HLI elements to the members of one axis or channel area, in order."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from hli_bench.manual.control_units import (
    AXIS_ELEMENTS,
    CHANNEL_ELEMENTS,
    OLD_GROUPS,
    POSITION,
    HliElement,
    Kind,
    numbered,
)


@dataclass(frozen=True, slots=True)
class Member:
    """One value of an area before it has a place: `group` is the path of its unit or structure."""

    group: str
    name: str
    type: str
    unit: str
    access: str
    group_aliases: tuple[str, ...] = ()
    old_paths: tuple[str, ...] = ()


def axis_members(number: int, *, rotary: bool) -> list[Member]:
    """Return the members of `ax/<number>`, those of one unit or structure next to each other."""
    linear_unit, rotary_unit = POSITION.split(", ")
    return _members(AXIS_ELEMENTS, number, rotary_unit if rotary else linear_unit)


def channel_members(number: int) -> list[Member]:
    """Return the members of `ch/<number>`, those of one unit or structure next to each other."""
    return _members(CHANNEL_ELEMENTS, number, POSITION)


def _members(rows: Sequence[HliElement], number: int, position_unit: str) -> list[Member]:
    grouped: dict[str, list[Member]] = {}
    for path, row in numbered(tuple(rows), number):
        unit = position_unit if row.unit == POSITION else row.unit
        old = tuple(one.replace("<n>", str(number)) for one in row.old_paths)
        for member in _of(row, path, unit, old):
            grouped.setdefault(member.group, []).append(member)
    return [member for group in grouped.values() for member in group]


def _of(row: HliElement, path: str, unit: str, old: tuple[str, ...]) -> list[Member]:
    if row.kind is Kind.VALUE:
        group, _, name = path.rpartition("/")
        return [Member(group, name, row.data_type, unit, row.writer, old_paths=old)]
    return [
        Member(
            path,
            member.name,
            member.data_type,
            unit if member.data_type is row.data_type else "",
            member.writer,
            group_aliases=row.aliases,
        )
        for member in row.members()
    ]


def _member_aliases() -> dict[str, str]:
    found: dict[str, str] = {}
    for row in (*AXIS_ELEMENTS, *CHANNEL_ELEMENTS):
        if row.kind is Kind.VALUE:
            name = row.path.rpartition("/")[2]
            found |= {alias.casefold(): name for alias in row.aliases}
        for member in row.members():
            found |= {alias.casefold(): member.name for alias in member.aliases}
    return found


MEMBER_ALIASES: Final[Mapping[str, str]] = _member_aliases()
"""Old names of members and values, lower case, and what they are called now."""

GROUP_ALIASES: Final[Mapping[str, str]] = {old.casefold(): now for old, now in OLD_GROUPS.items()}
"""Old names of groups, lower case, and what they are called now."""
