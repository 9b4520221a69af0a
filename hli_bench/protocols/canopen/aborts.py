"""SDO abort codes (CiA 301) and the exception that carries one."""

from enum import IntEnum


class AbortCode(IntEnum):
    """Why an SDO transfer ended early."""

    TOGGLE = 0x05030000
    TIME_OUT = 0x05040000
    BAD_COMMAND = 0x05040001
    BLOCK_SIZE = 0x05040002
    SEQUENCE = 0x05040003
    CRC = 0x05040004
    MEMORY = 0x05040005
    UNSUPPORTED_ACCESS = 0x06010000
    WRITE_ONLY = 0x06010001
    READ_ONLY = 0x06010002
    NO_OBJECT = 0x06020000
    NOT_MAPPABLE = 0x06040041
    PDO_LENGTH = 0x06040042
    PARAMETER_INCOMPATIBLE = 0x06040043
    INTERNAL_INCOMPATIBLE = 0x06040047
    HARDWARE = 0x06060000
    LENGTH = 0x06070010
    TOO_LONG = 0x06070012
    TOO_SHORT = 0x06070013
    NO_SUBINDEX = 0x06090011
    RANGE = 0x06090030
    TOO_HIGH = 0x06090031
    TOO_LOW = 0x06090032
    MAXIMUM_LESS_THAN_MINIMUM = 0x06090036
    RESOURCE = 0x060A0023
    GENERAL = 0x08000000
    CANNOT_STORE = 0x08000020
    LOCAL_CONTROL = 0x08000021
    DEVICE_STATE = 0x08000022
    NO_DICTIONARY = 0x08000023
    NO_DATA = 0x08000024


class SdoAbort(Exception):  # noqa: N818 - the field's word; it is the outcome of a transfer, not a failure of ours
    """A transfer was refused or broken off; `code` is an AbortCode or another stack's number.

    `collided`: somebody else used the same server meanwhile.
    """

    def __init__(self, code: int, *, collided: bool = False) -> None:
        also = ", another SDO client used the same server at the same time" if collided else ""
        super().__init__(f"SDO abort 0x{code:08X}{also}")
        self.code = code
        self.collided = collided
