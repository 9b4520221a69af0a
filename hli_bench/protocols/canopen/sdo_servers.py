"""The SDO servers of a node: the default one, and one more (0x1201) that a tool may set up for itself."""

from functools import partial
from typing import Final

from hli_bench.base.time import Ns
from hli_bench.protocols.canopen.aborts import AbortCode, SdoAbort
from hli_bench.protocols.canopen.datatypes import Value
from hli_bench.protocols.canopen.dictionary import ObjectValues
from hli_bench.protocols.canopen.sdo import REQUEST_COB_ID, RESPONSE_COB_ID
from hli_bench.protocols.canopen.sdo_server import SdoServer
from hli_bench.wire.can import CanFrame

SECOND_SERVER: Final = 0x1201
FREE: Final = range(0x680, 0x6E0)
"""Identifiers that the second server may have: those of no other service of CiA 301 (decided here)."""
_INVALID: Final = 1 << 31
_REQUEST: Final = 1
_RESPONSE: Final = 2


class SdoServers:
    """Offers a frame to the server that it is for. A transfer of one does not touch that of the other."""

    __slots__ = ("_default", "_second", "_values")

    def __init__(self, values: ObjectValues, node_id: int) -> None:
        self._values = values
        self._default = SdoServer(values, REQUEST_COB_ID + node_id, RESPONSE_COB_ID + node_id)
        self._second: SdoServer | None = None
        for sub in (_REQUEST, _RESPONSE):
            if values.has(SECOND_SERVER, sub):
                values.on_write(SECOND_SERVER, sub, partial(self._write, sub))
        self.reload(node_id)

    @property
    def requests(self) -> frozenset[int]:
        """Identifiers of the requests that are answered."""
        second = set() if self._second is None else {self._second.request}
        return frozenset({self._default.request} | second)

    def reload(self, node_id: int) -> None:
        """Begin anew after a reset: with the node id and the identifiers that the dictionary has then."""
        self._default = SdoServer(self._values, REQUEST_COB_ID + node_id, RESPONSE_COB_ID + node_id)
        self._set_up(self._stored(_REQUEST), self._stored(_RESPONSE))

    def on_frame(self, frame: CanFrame, now: Ns) -> list[CanFrame]:
        """Answer a request."""
        return [answer for server in self._all() for answer in server.on_frame(frame, now)]

    def tick(self, now: Ns) -> list[CanFrame]:
        """Abort transfers whose client fell silent."""
        return [frame for server in self._all() for frame in server.tick(now)]

    def next_due(self) -> Ns | None:
        """Return when `tick` has something to do at the latest."""
        dues = [due for server in self._all() if (due := server.next_due()) is not None]
        return min(dues, default=None)

    def _all(self) -> tuple[SdoServer, ...]:
        return (self._default,) if self._second is None else (self._default, self._second)

    def _stored(self, sub: int) -> int:
        there = self._values.has(SECOND_SERVER, sub)
        return self._values.number(SECOND_SERVER, sub) if there else _INVALID

    def _set_up(self, request: int, response: int) -> None:
        valid = not (request | response) & _INVALID and request != response
        self._second = SdoServer(self._values, request, response) if valid else None

    def _write(self, sub: int, value: Value) -> None:
        """Take an identifier: a valid one only in place of none, as the standard asks."""
        word, present = int(value), self._stored(sub)
        if not word & _INVALID and (word not in FREE or not present & _INVALID):
            raise SdoAbort(AbortCode.RANGE)
        other = self._stored(_RESPONSE if sub == _REQUEST else _REQUEST)
        self._set_up(*((word, other) if sub == _REQUEST else (other, word)))
