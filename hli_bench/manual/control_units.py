"""Elements of the HLI: path, kind, data type, unit, who writes. Data only; offsets derive from them.

`<n>` in a path is the logical axis number (`gpAx[n]^`) or the channel number (`gpCh[n]^`), from 1.
Sources: measurement manual 8.2.3, HLI book (infosys pages 174722571, 174755851, 174754315, 174751755,
174907531, 174798347, 174914699). Marked 'decided here': no source at hand names it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final


class HliType(StrEnum):
    """Data types on the HLI, IEC spelling beside the manual's."""

    BOOL = "BOOL"
    UNS16 = "UNS16"
    UNS32 = "UNS32"
    SGN32 = "SGN32"
    SGN64 = "SGN64"


class Kind(StrEnum):
    """A control unit has members; a value stands alone."""

    UNIT = "unit"
    VALUE = "value"


class Writer(StrEnum):
    """Who may write an element, from the PLC's side: `_r` the CNC, `_w` the PLC, `_rw` both."""

    CNC = "r"
    PLC = "w"
    BOTH = "rw"


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """A member of a control unit."""

    name: str
    data_type: HliType
    writer: Writer
    aliases: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class HliElement:
    """One row: a control unit (its `data_type` is that of request, command and state) or a plain value."""

    path: str
    kind: Kind
    data_type: HliType
    writer: Writer
    unit: str = ""
    usage_check: bool = False
    """The unit also has semaphores: data are taken exactly once."""
    initial: int = 0
    aliases: tuple[str, ...] = ()
    """Old names of the unit, without the path."""
    doc: str = ""

    def members(self) -> tuple[Member, ...]:
        """Return the members of a unit in the order of memory; none for a value."""
        if self.kind is Kind.VALUE:
            return ()
        letter = "X" if self.data_type is HliType.BOOL else "D"
        plain = (
            Member(
                name="request_r", data_type=self.data_type, writer=Writer.CNC, aliases=_old(letter, "Request")
            ),
            Member(name="enable_w", data_type=HliType.BOOL, writer=Writer.PLC, aliases=("X_Enable",)),
            Member(
                name="command_w", data_type=self.data_type, writer=Writer.PLC, aliases=_old(letter, "Command")
            ),
            Member(
                name="state_r", data_type=self.data_type, writer=Writer.CNC, aliases=_old(letter, "State")
            ),
        )
        return (*plain, *SEMAPHORES) if self.usage_check else plain


def _old(letter: str, word: str) -> tuple[str, ...]:
    """Return the old names of a member; `X_` is accepted for every type."""
    return (f"{letter}_{word}",) if letter == "X" else (f"{letter}_{word}", f"X_{word}")


SEMAPHORES: Final = (
    Member(
        name="command_semaphor_rw",
        data_type=HliType.BOOL,
        writer=Writer.BOTH,
        aliases=("X_CommandSemaphore",),
    ),
    Member(
        name="request_semaphor_rw",
        data_type=HliType.BOOL,
        writer=Writer.BOTH,
        aliases=("X_RequestSemaphore",),
    ),
)


def _unit(
    path: str, data_type: HliType, doc: str, *aliases: str, unit: str = "", usage_check: bool = False
) -> HliElement:
    """Return the row of a control unit."""
    return HliElement(
        path=path,
        kind=Kind.UNIT,
        data_type=data_type,
        writer=Writer.BOTH,
        unit=unit,
        usage_check=usage_check,
        aliases=aliases,
        doc=doc,
    )


def _value(
    path: str, data_type: HliType, writer: Writer, doc: str, *aliases: str, unit: str = "", initial: int = 0
) -> HliElement:
    """Return the row of a plain value."""
    return HliElement(
        path=path,
        kind=Kind.VALUE,
        data_type=data_type,
        writer=writer,
        unit=unit,
        initial=initial,
        aliases=aliases,
        doc=doc,
    )


BOOL, UNS16, UNS32, SGN32, SGN64 = HliType.BOOL, HliType.UNS16, HliType.UNS32, HliType.SGN32, HliType.SGN64
CNC, PLC, BOTH = Writer.CNC, Writer.PLC, Writer.BOTH
POSITION: Final = "0.1 µm, 0.0001°"

AXIS_ELEMENTS: Final = (
    _value("ax/<n>/head/plc_present_w", BOOL, PLC, "The PLC serves this axis; FALSE: its units are ignored."),
    _value("ax/<n>/head/log_ax_n_r", UNS16, CNC, "Logical axis number."),
    _value("ax/<n>/head/axis_type_r", UNS16, CNC, "1 linear, 2 rotary, 4 spindle."),
    _value("ax/<n>/head/error_r", BOOL, CNC, "The axis is in an error state."),
    _unit(
        "ax/<n>/lr_mc_control/probing_signal",
        BOOL,
        "Probing signal for P-AXIS-00516 = PLC or PLC_TIMESTAMP.",
        "MCControlBoolUnit_ProbingSignal",
    ),
    _unit(
        "ax/<n>/lr_mc_control/probing_position",
        SGN32,
        "Probing position of external measuring hardware. New name decided here.",
        "MCControlSGN32Unit_ProbingPosition",
        unit=POSITION,
    ),
    _unit("ax/<n>/lr_mc_control/timestamp", SGN64, "DC time of the probing edge.", unit="ns"),
    _unit(
        "ax/<n>/lr_mc_control/reference_cam",
        BOOL,
        "Reference cam; its active level is P-AXIS-00038. New name decided here.",
        "MCControlBoolUnit_ReferenceCam",
    ),
    _unit(
        "ax/<n>/lr_mc_control/release_feedhold",
        BOOL,
        "Feed enable; must be TRUE for every axis that is to move.",
        "MCControlBoolUnit_ReleaseFeedhold",
    ),
    _unit("ax/<n>/ipo_mc_control/feedhold", BOOL, "Feedhold of the axis.", "MCControlBoolUnit_Feedhold"),
    _unit(
        "ax/<n>/ipo_mc_control/override",
        UNS16,
        "Override of independent axes and spindles; in the path and at homing that of the channel acts.",
        "MCControlUNS16Unit_Override",
        unit="0.1 %",
    ),
    _unit(
        "ax/<n>/ipo_mc_control/override_valid",
        BOOL,
        "The override of the axis counts.",
        "MCControlBoolUnit_OverrideValid",
    ),
    _value("ax/<n>/lr_state/measure_value_ok_r", BOOL, CNC, "A valid measured value was latched."),
    _value("ax/<n>/lr_state/probe_actuated_r", BOOL, CNC, "The probe is operated."),
    _value("ax/<n>/lr_state/measurement_active_r", BOOL, CNC, "A measuring run is active."),
    _value(
        "ax/<n>/lr_state/measure_equipment_active_r", BOOL, CNC, "Kept for compatibility, no longer supplied."
    ),
    _value("ax/<n>/lr_state/drive_type_r", UNS16, CNC, "Drive type, numbers of P-AXIS-00020."),
    _value("ax/<n>/lr_state/ready_for_power_on_r", BOOL, CNC, "The drive can be switched on."),
    _value("ax/<n>/lr_state/ready_for_control_loop_on_r", BOOL, CNC, "The control loop can be closed."),
    _value(
        "ax/<n>/lr_state/axis_state_r",
        UNS16,
        CNC,
        "1 ready, 3 active, 5 hold, 7 error. New name decided here.",
        "W_AxisState",
    ),
    _value(
        "ax/<n>/lr_state/homing_done_r",
        BOOL,
        CNC,
        "The axis is referenced. New name decided here.",
        "X_HomingDone",
    ),
    _value(
        "ax/<n>/lr_state/active_position_r", SGN32, CNC, "Actual position. Name decided here.", unit=POSITION
    ),
    _value(
        "ax/<n>/lr_state/command_position_r",
        SGN32,
        CNC,
        "Command position. Name decided here.",
        unit=POSITION,
    ),
    _value("ax/<n>/lr_state/position_lag_r", SGN32, CNC, "Position lag. Name decided here.", unit=POSITION),
    _value(
        "ax/<n>/ext_latch/order_type_r",
        UNS16,
        CNC,
        "0 none, 1 enable probe, 2 disable probe. Place and name decided here.",
    ),
    _value("ax/<n>/ext_latch/input_r", UNS32, CNC, "Probing input of the order (P-AXIS-00517)."),
    _value(
        "ax/<n>/ext_latch/edge_r", UNS32, CNC, "Edge of the order: 0 positive, 1 negative (decided here)."
    ),
    _value("ax/<n>/ext_latch/please_rw", BOOL, BOTH, "The CNC has an order; the PLC clears it.", "X_Please"),
    _value("ax/<n>/ext_latch/done_w", BOOL, PLC, "The PLC has executed the order.", "X_Done"),
)
"""Elements of an axis area, in the order of the image."""

CHANNEL_ELEMENTS: Final = (
    _value("ch/<n>/head/plc_present_w", BOOL, PLC, "The PLC serves this channel."),
    _unit(
        "ch/<n>/bahn_mc_control/feedhold",
        BOOL,
        "Feedhold of the channel. Name decided here.",
        "MCControlBoolUnit_Feedhold",
    ),
    _unit(
        "ch/<n>/bahn_mc_control/override_feedrate",
        UNS16,
        "Feed override of the channel, up to P-CHAN-00056: path and homing.",
        "override",
        "MCControlUNS16Unit_Override",
        unit="0.1 %",
    ),
    _unit("ch/<n>/bahn_mc_control/delete_distance_to_go", BOOL, "Drop the rest of the path."),
    _value(
        "ch/<n>/channel_state/mode_r",
        UNS16,
        CNC,
        "1 standby, 2 automatic, 3 MDI, 4 manual, 5 reference. Name decided here.",
    ),
    _value(
        "ch/<n>/channel_state/state_r",
        UNS16,
        CNC,
        "1 deselected, 2 selected, 3 ready, 4 active, 5 hold, 6 error. Name decided here.",
    ),
    _value(
        "ch/<n>/channel_state/block_number_r", UNS32, CNC, "Number of the block in execution. Decided here."
    ),
    _value("ch/<n>/mc_error/semaphor_rw", BOOL, BOTH, "The CNC has an error record; the PLC clears it."),
    _value("ch/<n>/mc_error/error_id_r", UNS32, CNC, "Number of the error (`satz_r.kopf.error_id`)."),
    _value("ch/<n>/mc_error/axis_r", UNS16, CNC, "Logical axis number of the error, 0 none. Decided here."),
    _value("ch/<n>/mc_error/block_r", UNS32, CNC, "Block number of the error. Decided here."),
    _value("ch/<n>/mc_error/reaction_r", UNS16, CNC, "Reaction class of the error."),
    _value("ch/<n>/mc_error/remedy_r", UNS16, CNC, "Remedy class of the error."),
)
"""Elements of a channel area, in the order of the image."""

OLD_GROUPS: Final = MappingProxyType(
    {
        "McControlLr_Data": "lr_mc_control",
        "McControlIpo_Data": "ipo_mc_control",
        "StateLR_Data": "lr_state",
    }
)
"""Old names of groups in an area."""

SIZES: Final = MappingProxyType({BOOL: 1, UNS16: 2, UNS32: 4, SGN32: 4, SGN64: 8})
"""Bytes of each type in the image (little-endian)."""


def numbered(elements: tuple[HliElement, ...], number: int) -> Iterator[tuple[str, HliElement]]:
    """Yield (path with the number filled in, element)."""
    for element in elements:
        yield element.path.replace("<n>", str(number)), element


def canonical(path: str) -> str | None:
    """Return the path in today's names for a path that may use old ones; None when it is unknown.

    Takes `ax/2/lr_mc_control/MCControlBoolUnit_ProbingSignal/X_Command` and the like, with or without member.
    """
    parts = path.split("/")
    if len(parts) < 4 or not parts[1].isdecimal():
        return None
    for element in AXIS_ELEMENTS if parts[0] == "ax" else CHANNEL_ELEMENTS if parts[0] == "ch" else ():
        own = element.path.replace("<n>", parts[1]).split("/")
        if own[2] != OLD_GROUPS.get(parts[2], parts[2]) or (
            own[3] != parts[3] and parts[3] not in element.aliases
        ):
            continue
        if len(parts) == 4:
            return "/".join(own)
        for member in element.members():
            if len(parts) == 5 and parts[4] in (member.name, *member.aliases):
                return "/".join((*own, member.name))
    return None
