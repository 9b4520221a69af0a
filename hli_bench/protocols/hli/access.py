"""Who may write what on the HLI: every write from outside passes here or is refused with a reason."""

from dataclasses import dataclass
from typing import Final

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.image import Image, Value
from hli_bench.protocols.hli.layout import Element
from hli_bench.protocols.hli.packing import decoded
from hli_bench.wire.hli import Commands

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
    """One member as a client put it: `payload` packed by the member's type, or as text (`TRUE`, `123`).

    `writer` is the name of an attached PLC, or "" for anybody else.
    """

    path: str
    payload: bytes
    is_text: bool = False
    writer: str = ""


class Access:
    """The door to an image: applies writes, remembers whose unit is whose, counts refusals."""

    __slots__ = ("_image", "_owner", "_units", "refused")

    def __init__(self, image: Image) -> None:
        self._image = image
        self._owner: dict[str, str] = {}
        groups = image.layout.groups.items()
        self._units = {path for path, group in groups if "enable_w" in group.ids}
        self.refused = 0

    def apply(self, order: Commands | MemberWrite) -> list[Refusal]:
        """Write what may be written; return what was refused."""
        if isinstance(order, MemberWrite):
            refusals = self._member(order)
        else:
            refusals = [
                refusal
                for write in order.writes
                if (refusal := self._write(write.path, write.value, order.plc)) is not None
            ]
        self.refused += len(refusals)
        return refusals

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

    def _member(self, order: MemberWrite) -> list[Refusal]:
        try:
            element = self._image.layout.element(order.path)
            value = decoded(element, order.payload, is_text=order.is_text)
        except InputError as error:
            return [Refusal(order.path, error.message, order.writer)]
        refusal = self._write(element.path, value, order.writer)
        return [refusal] if refusal else []

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
