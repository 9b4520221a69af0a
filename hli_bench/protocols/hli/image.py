"""All HLI elements as one run of bytes: what `hli/image` carries after its 16-byte header."""

from hli_bench.protocols.hli.layout import Layout

Value = int | bool


class Image:
    """The bytes behind all elements, with typed access by element id and memory of what changed."""

    __slots__ = ("_changed", "_offset", "_struct", "_written", "data", "layout")

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.data = bytearray(layout.size)
        self._struct, self._offset = layout.packing, layout.offsets
        self._changed: dict[int, None] = {}
        self._written: dict[int, None] = {}

    def get(self, element: int) -> Value:
        """Return the value of the element with that id."""
        value: Value = self._struct[element].unpack_from(self.data, self._offset[element])[0]
        return value

    def set(self, element: int, value: Value) -> None:
        """Set a value from the CNC's side. Raises struct.error when it does not fit the element's type."""
        packing, offset = self._struct[element], self._offset[element]
        if packing.unpack_from(self.data, offset)[0] != value:
            packing.pack_into(self.data, offset, value)
            self._changed[self.layout.group_of[element]] = None

    def write(self, element: int, value: Value) -> None:
        """Set a value from the PLC's side; the control units see it at their next sampling."""
        self.set(element, value)
        self._written[element] = None

    def take_written(self) -> list[int]:
        """Return the ids that the PLC side wrote since the last call, in order of writing."""
        written = list(self._written)
        self._written.clear()
        return written

    def take_changed(self) -> list[tuple[str, bytes]]:
        """Return (path, packed members) of every unit that changed since the last call, in layout order."""
        if not self._changed:
            return []
        groups = list(self.layout.groups.values())
        changed = [groups[index] for index in sorted(self._changed)]
        self._changed.clear()
        return [(group.path, group.pack(self.data)) for group in changed]
