"""What the PDO parameters of a drive are while its standard telegram is configured."""

from functools import cache
from typing import Final

from hli_bench.protocols.canopen.pdo import INVALID, NO_RTR
from hli_bench.protocols.canopen.telegram import RPDOS, tpdos

_UNUSED_RPDOS: Final = (0x400, 0x500)
_EVERY_SYNC: Final = 1


@cache
def signature(node_id: int, probing_input: int = 0) -> tuple[tuple[int, int, tuple[int, ...]], ...]:
    """Return what `PdoSet.signature` is while the telegram for a probing input (0 or 1) is configured."""
    used = [(pdo.base + node_id, _EVERY_SYNC, pdo.mapping) for pdo in RPDOS]
    unused = [(cob_id + node_id | INVALID, _EVERY_SYNC, ()) for cob_id in _UNUSED_RPDOS]
    sent = [(pdo.base + node_id | NO_RTR, _EVERY_SYNC, pdo.mapping) for pdo in tpdos(probing_input)]
    return (*used, *unused, *sent)
