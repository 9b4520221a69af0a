"""Who may write what on the HLI: every write from outside passes here or is refused with a reason."""

from dataclasses import dataclass
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.image import Image, Value
from hli_bench.protocols.hli.layout import Element
from hli_bench.protocols.hli.packing import decoded
from hli_bench.wire.hli import Commands, Write

_BITS: Final = {
    "SGN08": 7,
    "UNS08": 8,
    "SGN16": 15,
    "UNS16": 16,
    "SGN32": 31,
    "UNS32": 32,
    "SGN64": 63,
    "UNS64": 64,
}


@dataclass(frozen=True, slots=True)
class Refusal:
    """A write that was not done, and why."""

    path: str
    reason: str
    writer: str = ""


@dataclass(frozen=True, slots=True)
class MemberWrite:
    """One member as a client put it: `payload` packed by the member's type, or as text (`TRUE`, `123`)."""

    path: str
    payload: bytes
    is_text: bool = False


class Access:
    """The door to an image: applies writes, remembers whose unit is whose."""

    __slots__ = ("_image", "_owner", "_units")

    def __init__(self, image: Image) -> None:
        self._image = image
        self._owner: dict[str, str] = {}
        groups = image.layout.groups.items()
        self._units = {path for path, group in groups if "enable_w" in group.ids}

    def apply(self, commands: Commands) -> list[Refusal]:
        """Write what may be written; return what was refused. Commands of nobody ("" as PLC) own nothing."""
        return [
            refusal
            for write in commands.writes
            if (refusal := self._write(write.path, write.value, commands.plc)) is not None
        ]

    def write_of(self, put: MemberWrite) -> Write:
        """Return what a client wants to write. Raises InputError for an unknown path and an unfit payload."""
        element = self._image.layout.element(put.path)
        return Write(element.path, decoded(element, put.payload, is_text=put.is_text))

    def owner(self, unit: str) -> str:
        """Return the name of the PLC that the unit belongs to, "" for none."""
        return self._owner.get(self._image.layout.resolve(unit), "")

    def leave(self, plc: str) -> list[str]:
        """Give up what `plc` owns: enable_w of its units becomes FALSE. Returns the paths of its units.

        Only control units have an owner. plc_present_w may be set by several PLCs that share an axis, so it
        stays, as do the values of other members (decided here).
        """
        owned = [unit for unit, owner in self._owner.items() if owner == plc]
        for unit in owned:
            del self._owner[unit]
            for element in self._image.layout.groups[unit].elements:
                if element.member == "enable_w":
                    self._image.write(element.id, False)
        return owned

    def _write(self, path: str, value: Value, writer: str) -> Refusal | None:
        try:
            element = self._image.layout.element(path)
        except InputError as error:
            return Refusal(path, error.message, writer)
        reason = self._against(element, value, writer)
        if reason:
            return Refusal(element.path, reason, writer)
        if writer and element.group in self._units:
            self._owner[element.group] = writer
        self._image.write(element.id, value)
        return None

    def _against(self, element: Element, value: Value, writer: str) -> str:
        if "w" not in element.access:
            return "written by the CNC, a client may only read it"
        owner = self._owner.get(element.group)
        if owner is not None and owner != writer:
            return f"the unit belongs to PLC {owner!r}"
        return unfit(element, value)


def unfit(element: Element, value: Value) -> str:
    """Return why `value` does not fit the element's type, "" when it does."""
    if element.type == "BOOL":
        return "" if value in (0, 1) else f"{value!r} is no BOOL: TRUE or FALSE expected"
    low = 0 if element.type[0] == "U" else -(1 << _BITS[element.type])
    high = (1 << _BITS[element.type]) - 1
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        return f"{value!r} is no {element.type}: a whole number in [{low}, {high}] expected"
    return ""
