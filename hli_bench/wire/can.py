"""A classical CAN data or remote frame as it passes between nodes."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class CanFrame:
    """One CAN 2.0A frame: 11-bit `cob_id`, 0..8 bytes of `data`; `remote` marks an RTR frame."""

    cob_id: int
    data: bytes = b""
    remote: bool = False
