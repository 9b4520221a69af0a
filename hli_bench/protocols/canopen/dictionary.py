"""The values behind an object dictionary: typed store, access rules, hooks, what is kept over a reset."""

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache, partial

from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import DataType, Value, pack, size_of, unpack
from hli_bench.protocols.canopen.eds import Entry, ObjectDictionary

ReadHook = Callable[[], Value]
"""Gives the present value of an object that lives elsewhere."""
WriteHook = Callable[[Value], None]
"""Is asked before a value is stored and may refuse it with SdoAbort."""
RecordHook = Callable[[int, Value], None]
"""The same for all sub-indices of an object."""

COMMUNICATION = range(0x1000, 0x2000)
"""Indices of the communication profile area (reset by NMT reset communication)."""
APPLICATION = range(0x2000, 0x10000)
"""Indices of manufacturer and device profile."""
ALL_OBJECTS = range(0x1000, 0x10000)


class _Getters(dict[tuple[int, int], ReadHook]):
    """Read hooks by address, each made when first asked for; what has none is read from the stored values."""

    __slots__ = ("_values", "makers")

    def __init__(self, values: dict[tuple[int, int], Value]) -> None:
        super().__init__()
        self._values = values
        self.makers: dict[tuple[int, int], Callable[[tuple[int, int]], ReadHook]] = {}

    def __missing__(self, address: tuple[int, int]) -> ReadHook:
        if address not in self._values:
            raise KeyError(address)
        make = self.makers.get(address)
        getter = self[address] = partial(self._values.__getitem__, address) if make is None else make(address)
        return getter


class ObjectValues:
    """Values of one node. `upload`/`download` are the bus side, `get`/`put` the device's own side."""

    __slots__ = (
        "_defaults",
        "_entries",
        "_record_hooks",
        "_values",
        "_write_hooks",
        "description",
        "getters",
        "hooked",
        "node_id",
    )

    def __init__(self, description: ObjectDictionary, node_id: int) -> None:
        self.description = description
        self.node_id = node_id
        self._entries = description.entries
        self._defaults = self._factory()
        self._values = dict(self._defaults)
        self.getters = _Getters(self._values)
        """How each object is read; a dictionary of its own so that a PDO packs without detours."""
        self._write_hooks: dict[tuple[int, int], WriteHook] = {}
        self._record_hooks: dict[int, RecordHook] = {}
        self.hooked: Callable[[], None] = _nothing
        """Is told of every new hook from when somebody keeps getters or receivers."""

    def on_read(self, index: int, subindex: int, hook: ReadHook) -> None:
        """Let `hook` answer reads of an object from now on."""
        self._entry(index, subindex)
        self.getters[index, subindex] = hook
        self.hooked()

    def on_read_made(
        self, addresses: Iterable[tuple[int, int]], make: Callable[[tuple[int, int]], ReadHook]
    ) -> None:
        """Let the hooks that `make` gives for an address answer reads of many objects, each made when it is needed."""
        makers = dict.fromkeys(addresses, make)
        self._check(makers)
        self.getters.makers.update(makers)
        for address in makers:
            self.getters.pop(address, None)
        self.hooked()

    def on_write(self, index: int, subindex: int, hook: WriteHook) -> None:
        """Let `hook` check and follow writes from the bus (SDO and RPDO) to an object."""
        self._entry(index, subindex)
        self._write_hooks[index, subindex] = hook
        self.hooked()

    def on_writes(self, hooks: Mapping[tuple[int, int], WriteHook]) -> None:
        """Let each hook check and follow writes from the bus to its object."""
        self._check(hooks)
        self._write_hooks.update(hooks)
        self.hooked()

    def on_write_records(self, hooks: Mapping[int, RecordHook]) -> None:
        """Let each hook check and follow writes from the bus to any sub-index of its object."""
        for index in hooks:
            self._entry(index, 0)
        self._record_hooks.update(hooks)
        self.hooked()

    def get(self, index: int, subindex: int = 0) -> Value:
        """Return the present value. Raises SdoAbort when there is no such object."""
        try:
            hook = self.getters[index, subindex]
        except KeyError:
            raise self._missing(index) from None
        return hook()

    def number(self, index: int, subindex: int = 0) -> int:
        """Return the present value of an integer object. Raises TypeError for strings and domains."""
        value = self.get(index, subindex)
        if not isinstance(value, int):
            raise TypeError(f"{index:04X}:{subindex:02X} is no integer")
        return value

    def stored(self, index: int, subindex: int = 0) -> int:
        """Return the integer last stored, which a read hook may hide. Raises TypeError for other objects."""
        value = self._values[index, subindex]
        if not isinstance(value, int):
            raise TypeError(f"{index:04X}:{subindex:02X} is no integer")
        return value

    def put(self, index: int, subindex: int, value: Value) -> None:
        """Store a value from inside the device: no access rule, no hook."""
        self._entry(index, subindex)
        self._values[index, subindex] = value

    def has(self, index: int, subindex: int = 0) -> bool:
        """Whether the object exists."""
        return (index, subindex) in self._entries

    def upload(self, index: int, subindex: int) -> bytes:
        """Return an object's bytes for an SDO upload. Raises SdoAbort."""
        entry = self._entry(index, subindex)
        if not entry.access.readable:
            raise SdoAbort(AbortCode.WRITE_ONLY)
        return pack(entry.data_type, self.get(index, subindex))

    def check_download(self, index: int, subindex: int, size: int | None = None) -> None:
        """Raise SdoAbort when a download cannot be accepted, judged before its data are there."""
        entry = self._entry(index, subindex)
        if not entry.access.writable:
            raise SdoAbort(AbortCode.READ_ONLY)
        expected = size_of(entry.data_type)
        if size is not None and expected is not None:
            _check_length(size, expected)

    def download(self, index: int, subindex: int, data: bytes) -> None:
        """Store what an SDO download brought if length, limits and hook agree. Raises SdoAbort."""
        self.check_download(index, subindex, len(data))
        entry = self.description[index, subindex]
        self.receive(entry, unpack(entry.data_type, data))

    def receive(self, entry: Entry, value: Value) -> None:
        """Store a value from the bus (SDO or RPDO) after limits and hook agreed. Raises SdoAbort."""
        self.receiver(entry)(value)

    def receiver(self, entry: Entry) -> WriteHook:
        """Return what `receive` does with values of one object until a hook is set."""
        address = entry.index, entry.subindex
        hook = self._write_hooks.get(address)
        if hook is None and entry.index in self._record_hooks:
            hook = partial(self._record_hooks[entry.index], entry.subindex)
        limited = entry.low is not None or entry.high is not None or entry.data_type is DataType.BOOLEAN
        stored = self._values

        def receive(value: Value) -> None:
            if limited and isinstance(value, int):
                _check_limits(entry, value)
            if hook is not None:
                hook(value)
            stored[address] = value

        return receive

    def entry(self, index: int, subindex: int) -> Entry:
        """Return the description of an object. Raises SdoAbort when there is none."""
        return self._entry(index, subindex)

    def store(self, indices: range) -> None:
        """Keep the present values of writable objects over the next reset (object 0x1010)."""
        for entry in self.description:
            if entry.index in indices and entry.access.writable:
                self._defaults[entry.index, entry.subindex] = self._values[entry.index, entry.subindex]

    def restore_factory(self, indices: range) -> None:
        """Forget stored values: the EDS defaults count from the next reset (object 0x1011)."""
        factory = self._factory()
        self._defaults.update({address: value for address, value in factory.items() if address[0] in indices})

    def reset(self, indices: range) -> None:
        """Load the power-on values, without hooks."""
        for address, value in self._defaults.items():
            if address[0] in indices:
                self._values[address] = value

    def move(self, node_id: int) -> None:
        """Take over another node id: stored and present values start from the EDS again."""
        self.node_id = node_id
        self._defaults = self._factory()
        self._values.update(self._defaults)

    def _factory(self) -> dict[tuple[int, int], Value]:
        return dict(_factory(self.description, self.node_id))

    def _check(self, hooks: Mapping[tuple[int, int], object]) -> None:
        """Raise SdoAbort when one of the objects is not there."""
        for address in hooks:
            if address not in self._entries:
                raise self._missing(address[0])

    def _entry(self, index: int, subindex: int) -> Entry:
        try:
            return self._entries[index, subindex]
        except KeyError:
            raise self._missing(index) from None

    def _missing(self, index: int) -> SdoAbort:
        known = self.description.has_object(index)
        return SdoAbort(AbortCode.NO_SUBINDEX if known else AbortCode.NO_OBJECT)


@lru_cache(maxsize=256)
def _factory(description: ObjectDictionary, node_id: int) -> Mapping[tuple[int, int], Value]:
    """Return the values of a node as its EDS gives them."""
    return {address: entry.default_for(node_id) for address, entry in description.entries.items()}


def _nothing() -> None: ...


def _check_length(size: int, expected: int) -> None:
    if size > expected:
        raise SdoAbort(AbortCode.TOO_LONG)
    if size < expected:
        raise SdoAbort(AbortCode.TOO_SHORT)


def _check_limits(entry: Entry, value: int) -> None:
    if entry.high is not None and value > entry.high:
        raise SdoAbort(AbortCode.TOO_HIGH)
    if entry.low is not None and value < entry.low:
        raise SdoAbort(AbortCode.TOO_LOW)
    if entry.data_type is DataType.BOOLEAN and value not in {0, 1}:
        raise SdoAbort(AbortCode.RANGE)
