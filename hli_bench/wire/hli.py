"""What a PLC writes to the HLI in one of its cycles."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Write:
    """One element written; path as `ax/3/lr_mc_control/probing_signal/command_w`."""

    path: str
    value: int | bool


@dataclass(frozen=True, slots=True)
class Commands:
    """All writes of PLC `plc` in answer to kernel cycle `cycle`; they count from cycle + 1 on."""

    plc: str
    cycle: int
    writes: tuple[Write, ...]
