"""All frames of a bus into a file: many cycles at once, each a template of its frames with stamps and data put in.

What a frame looks like in the file is a form: `candump` or `pcap`. Times are the DC times of the cycles as Unix
time.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from hli_bench.base.ids import NodeId
from hli_bench.base.time import DC_EPOCH, NS_PER_S
from hli_bench.laws.rows import Rows
from hli_bench.protocols.canopen.sync import sync_frame
from hli_bench.runtime.frames import AxisTelegram, BusOrder, Cyclic
from hli_bench.wire.can import CanFrame

UNIX_OF_DC_NS: Final = int(DC_EPOCH.timestamp()) * NS_PER_S


class Form(Protocol):
    """How a frame stands in a file: stamp, what depends on the identifier alone, data, `tail` bytes."""

    @property
    def head(self) -> bytes:
        """What the file begins with."""

    @property
    def tail(self) -> int:
        """Bytes behind the data of a frame."""

    def frame(self, frame: CanFrame, unix_ns: int) -> bytes:
        """Return one frame."""

    def stamps(self, unix_ns: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Return stamps, shape (instants, bytes of a stamp)."""

    def data(self, payload: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return data as they stand in the file, from shape (cycles, length)."""


@dataclass(frozen=True, slots=True)
class _Template:
    """Bytes of one cycle: `frames` holds the offset of each frame, `data` that of each telegram's data."""

    text: NDArray[np.uint8]
    frames: tuple[int, ...]
    data: tuple[int, ...]


class Out(Protocol):
    """What frames are written to."""

    def write(self, data: bytes | memoryview, /) -> int:
        """Write all of it."""

    def writelines(self, lines: Iterable[bytes], /) -> None:
        """Write them one behind the other."""


class BusFile:
    """Writes cycles and the frames beside them in bus order; `nodes` in row order."""

    def __init__(
        self, file: Out, form: Form, nodes: Sequence[NodeId], cycle_ns: int, dc_epoch_ns: int
    ) -> None:
        self._file = file
        self._form = form
        self._order = BusOrder(nodes)
        self._cycle_ns = cycle_ns
        self._epoch_ns = dc_epoch_ns + UNIX_OF_DC_NS
        self._templates: dict[tuple[bool, tuple[AxisTelegram, ...]], _Template] = {}
        file.write(form.head)

    def write(self, first: int, rows: Rows, others: Mapping[int, Sequence[CanFrame]]) -> None:
        """Write cycles `first` ... of shape (cycles, axes), with the frames beside them by cycle."""
        for part in self._order.parts(first, rows, others):
            if isinstance(part, Cyclic):
                self._file.write(self._page(part).data)
            else:
                at_ns = self._epoch_ns + part.cycle * self._cycle_ns
                self._file.writelines(self._form.frame(frame, at_ns) for frame in part.frames)

    def _page(self, part: Cyclic) -> NDArray[np.uint8]:
        """Return the bytes of cycles with nothing but telegrams, shape (cycles, bytes of a cycle)."""
        count = len(part.rows)
        payloads = [telegram.payload(part.rows) for telegram in part.telegrams]
        key = (part.sync, part.telegrams)
        template = self._templates.get(key)
        if template is None:
            template = self._templates[key] = self._template(part, [one.shape[1] for one in payloads])
        page = np.empty((count, len(template.text)), np.uint8)
        page[:] = template.text
        cycles = np.arange(part.first, part.first + count, dtype=np.int64)
        stamps = self._form.stamps(self._epoch_ns + cycles * self._cycle_ns)
        for at in template.frames:
            page[:, at : at + stamps.shape[1]] = stamps
        for at, payload in zip(template.data, payloads, strict=True):
            data = self._form.data(payload)
            page[:, at : at + data.shape[1]] = data
        return page

    def _template(self, part: Cyclic, lengths: Sequence[int]) -> _Template:
        text, frames, data = b"", [], []
        if part.sync:
            frames.append(0)
            text = self._form.frame(sync_frame(), 0)
        for telegram, length in zip(part.telegrams, lengths, strict=True):
            frames.append(len(text))
            text += self._form.frame(CanFrame(telegram.cob_id, bytes(length)), 0)
            width = self._form.data(np.zeros((1, length), np.uint8)).shape[1]
            data.append(len(text) - self._form.tail - width)
        return _Template(np.frombuffer(text, np.uint8), tuple(frames), tuple(data))
