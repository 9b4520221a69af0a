"""The default telegram: which numbers travel cyclically, and its frames made later from logged numbers."""

import struct
from dataclasses import dataclass
from typing import Any, Final, Protocol

from drives.cia402 import objects
from drives.cia402.objects import ObjectAddress
from hli_bench.protocols.canopen.pdo import NO_RTR
from hli_bench.wire.can import CanFrame


class LoggedCycle(Protocol):
    """Numbers of one cycle by name, such as a record of the cycle log; `latch` has the latched positions.

    Names: target, controlword, probe_function, position, statusword, probe_status, latch, torque_permille,
    following_error, digital_inputs.
    """

    def __getitem__(self, name: str, /) -> Any:
        """Return the number or, for `latch`, the sequence."""


@dataclass(frozen=True, slots=True)
class Telegram:
    """One PDO of the default map: COB-ID of node 0 and the objects with their bits, in order."""

    cob_id: int
    objects: tuple[tuple[ObjectAddress, int], ...]

    @property
    def mapping(self) -> tuple[int, ...]:
        """The entries of 0x1600 or 0x1A00."""
        return tuple(index << 16 | subindex << 8 | bits for (index, subindex), bits in self.objects)


RPDOS: Final = (
    Telegram(0x200, ((objects.CONTROLWORD, 16), (objects.TARGET_POSITION, 32))),
    Telegram(0x300, ((objects.PROBE_FUNCTION, 16),)),
)


def tpdos(probing_input: int = 0) -> tuple[Telegram, ...]:
    """Return the TPDOs that carry the latches of a probing input (0 or 1); 0 is the default map."""
    positive, negative = objects.LATCHES[2 * probing_input : 2 * probing_input + 2]
    return (
        Telegram(0x180, ((objects.STATUSWORD, 16), (objects.POSITION_ACTUAL, 32))),
        Telegram(0x280, ((objects.PROBE_STATUS, 16), (positive, 32))),
        Telegram(0x380, ((objects.TORQUE_ACTUAL, 16), (objects.FOLLOWING_ERROR, 32))),
        Telegram(0x480, ((objects.DIGITAL_INPUTS, 32), (negative, 32))),
    )


TPDOS: Final = tpdos()
_UNUSED_RPDOS: Final = (0x400, 0x500)
_INVALID: Final = 1 << 31
_EVERY_SYNC: Final = 1

_WORD_AND_LONG: Final = struct.Struct("<Hi")
_WORD: Final = struct.Struct("<H")
_TORQUE_AND_ERROR: Final = struct.Struct("<hi")
_INPUTS_AND_LATCH: Final = struct.Struct("<Ii")


def signature(node_id: int, probing_input: int = 0) -> tuple[tuple[int, int, tuple[int, ...]], ...]:
    """Return what `PdoSet.signature` is while the telegram for a probing input is configured."""
    used = [(pdo.cob_id + node_id, _EVERY_SYNC, pdo.mapping) for pdo in RPDOS]
    unused = [(cob_id + node_id | _INVALID, _EVERY_SYNC, ()) for cob_id in _UNUSED_RPDOS]
    sent = [(pdo.cob_id + node_id | NO_RTR, _EVERY_SYNC, pdo.mapping) for pdo in tpdos(probing_input)]
    return (*used, *unused, *sent)


def actual_frames(node_id: int, values: LoggedCycle) -> list[CanFrame]:
    """Return the TPDOs that the drive sent at the SYNC of a cycle."""
    latch = values["latch"]
    payloads = (
        _WORD_AND_LONG.pack(values["statusword"], values["position"]),
        _WORD_AND_LONG.pack(values["probe_status"], latch[0]),
        _TORQUE_AND_ERROR.pack(values["torque_permille"], values["following_error"]),
        _INPUTS_AND_LATCH.pack(values["digital_inputs"], latch[1]),
    )
    return [CanFrame(pdo.cob_id + node_id, data) for pdo, data in zip(TPDOS, payloads, strict=True)]


def command_frames(node_id: int, values: LoggedCycle) -> list[CanFrame]:
    """Return the RPDOs that the CNC sent in a cycle."""
    payloads = (
        _WORD_AND_LONG.pack(values["controlword"], values["target"]),
        _WORD.pack(values["probe_function"]),
    )
    return [CanFrame(pdo.cob_id + node_id, data) for pdo, data in zip(RPDOS, payloads, strict=True)]


def pdo_frames(node_id: int, values: LoggedCycle) -> list[CanFrame]:
    """Return all PDOs of a cycle: TPDOs in the order of their numbers, then RPDOs."""
    return actual_frames(node_id, values) + command_frames(node_id, values)
