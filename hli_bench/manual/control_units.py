"""Elements of the HLI: path, kind, data type, unit, who writes. Data only; offsets derive from them.

`<n>` in a path is the logical axis number (`gpAx[n]^`) or the channel number (`gpCh[n]^`), from 1.
Sources: measurement manual 8.2.3, TF5200 HLI 1.22. Marked 'decided here': no source at hand names it.
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
    aliases: tuple[str, ...] = ()
    """Old names of the unit, without the path."""
    old_paths: tuple[str, ...] = ()
    """Earlier paths of a value, whose meaning was the same."""
    doc: str = ""

    def members(self) -> tuple[Member, ...]:
        """Return the members of a unit in the order of memory; none for a value."""
        if self.kind is Kind.VALUE:
            return ()
        letter = "X" if self.data_type is HliType.BOOL else "D"
        command = (
            Member(
                name="request_r", data_type=self.data_type, writer=Writer.CNC, aliases=_old(letter, "Request")
            ),
            Member(name="enable_w", data_type=HliType.BOOL, writer=Writer.PLC, aliases=("X_Enable",)),
            Member(
                name="command_w", data_type=self.data_type, writer=Writer.PLC, aliases=_old(letter, "Command")
            ),
        )
        state = Member(
            name="state_r", data_type=self.data_type, writer=Writer.CNC, aliases=_old(letter, "State")
        )
        return (*command, *SEMAPHORES, state) if self.usage_check else (*command, state)


def _old(letter: str, word: str) -> tuple[str, ...]:
    """Return the old names of a member; `X_` is accepted for every type."""
    return (f"{letter}_{word}",) if letter == "X" else (f"{letter}_{word}", f"X_{word}")


SEMAPHORES: Final = (
    Member(
        name="request_semaphor_rw",
        data_type=HliType.BOOL,
        writer=Writer.BOTH,
        aliases=("X_RequestSemaphore",),
    ),
    Member(
        name="command_semaphor_rw",
        data_type=HliType.BOOL,
        writer=Writer.BOTH,
        aliases=("X_CommandSemaphore",),
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
    path: str,
    data_type: HliType,
    writer: Writer,
    doc: str,
    *aliases: str,
    unit: str = "",
    old: tuple[str, ...] = (),
) -> HliElement:
    """Return the row of a plain value; `old` are its earlier paths."""
    return HliElement(
        path=path,
        kind=Kind.VALUE,
        data_type=data_type,
        writer=writer,
        unit=unit,
        aliases=aliases,
        old_paths=old,
        doc=doc,
    )


BOOL, UNS16, UNS32, SGN32, SGN64 = HliType.BOOL, HliType.UNS16, HliType.UNS32, HliType.SGN32, HliType.SGN64
CNC, PLC, BOTH = Writer.CNC, Writer.PLC, Writer.BOTH
POSITION: Final = "0.1 µm, 0.0001°"

LATCH: Final = "ax/<n>/lr_mc_control/ext_latch_control"

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
        "Probing position of external measuring hardware.",
        "MCControlSGN32Unit_ProbingPosition",
        unit=POSITION,
    ),
    _unit("ax/<n>/lr_mc_control/timestamp", SGN64, "DC time of the probing edge.", unit="ns"),
    _unit(
        "ax/<n>/lr_mc_control/reference_cam",
        BOOL,
        "Reference cam; its active level is P-AXIS-00038.",
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
    _value(
        "ax/<n>/lr_state/active_position_acs_r",
        SGN32,
        CNC,
        "Command position of the cycle.",
        unit=POSITION,
        old=("ax/<n>/lr_state/command_position_r",),
    ),
    _value(
        "ax/<n>/lr_state/current_position_acs_r",
        SGN32,
        CNC,
        "Actual position.",
        unit=POSITION,
        old=("ax/<n>/lr_state/active_position_r",),
    ),
    _value(
        "ax/<n>/lr_state/following_error_r",
        SGN32,
        CNC,
        "Position lag.",
        unit=POSITION,
        old=("ax/<n>/lr_state/position_lag_r",),
    ),
    _value(
        "ax/<n>/lr_state/axis_state_r",
        UNS16,
        CNC,
        "1 ready, 3 active, 5 hold (also while the drive is not in operation), 7 error.",
        "W_AxisState",
    ),
    _value(
        "ax/<n>/lr_state/ready_for_power_on_r", BOOL, CNC, "The drive is in the state 'operation enabled'."
    ),
    _value(
        "ax/<n>/lr_state/ready_for_control_loop_on_r",
        BOOL,
        CNC,
        "The drive is in any state but 'not ready to switch on'.",
    ),
    _value("ax/<n>/lr_state/homing_done_r", BOOL, CNC, "The axis is referenced.", "X_HomingDone"),
    _value("ax/<n>/lr_state/drive_type_r", UNS16, CNC, "Drive type, numbers of P-AXIS-00020."),
    _value("ax/<n>/lr_state/measure_value_ok_r", BOOL, CNC, "A valid measured value was latched."),
    _value("ax/<n>/lr_state/probe_actuated_r", BOOL, CNC, "The probe that the PLC hands over is operated."),
    _value("ax/<n>/lr_state/measurement_active_r", BOOL, CNC, "A measuring run is active."),
    _value(
        "ax/<n>/lr_state/measure_equipment_active_r", BOOL, CNC, "Kept for compatibility, no longer supplied."
    ),
    _value(
        f"{LATCH}/please_rw",
        BOOL,
        BOTH,
        "The CNC has an order; the PLC clears it.",
        "X_Please",
        old=("ax/<n>/ext_latch_control/please_rw", "ax/<n>/ext_latch/please_rw"),
    ),
    _value(
        f"{LATCH}/done_w",
        BOOL,
        PLC,
        "The PLC has executed the order.",
        "X_Done",
        old=("ax/<n>/ext_latch_control/done_w", "ax/<n>/ext_latch/done_w"),
    ),
    _value(
        f"{LATCH}/ext_latch_order_r/order_id",
        UNS32,
        CNC,
        "0 none, 1 enable probe, 2 disable probe, 3 prepare probe (decided here: the book prints no numbers).",
        old=("ax/<n>/ext_latch_control/ext_latch_order_r/order_id", "ax/<n>/ext_latch/order_type_r"),
    ),
    _value(
        f"{LATCH}/ext_latch_order_r/input",
        SGN32,
        CNC,
        "Probing input of the order (P-AXIS-00517).",
        old=("ax/<n>/ext_latch_control/ext_latch_order_r/input", "ax/<n>/ext_latch/input_r"),
    ),
    _value(
        f"{LATCH}/ext_latch_order_r/edge",
        UNS32,
        CNC,
        "Edge of the order: 1 falling, 2 rising (numbers of the kernel DLL).",
        old=("ax/<n>/ext_latch_control/ext_latch_order_r/edge", "ax/<n>/ext_latch/edge_r"),
    ),
)
"""Elements of an axis area, in the order of the image."""

MODE_AND_STATE: Final = "ch/<n>/channel_mc_control/mode_and_state/state_r"
ERROR_HEAD: Final = "ch/<n>/mc_error/satz_r/kopf"

CHANNEL_ELEMENTS: Final = (
    _value("ch/<n>/head/plc_present_w", BOOL, PLC, "The PLC serves this channel."),
    _unit(
        "ch/<n>/bahn_mc_control/feedhold",
        BOOL,
        "Feedhold of the channel.",
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
        f"{MODE_AND_STATE}/mode",
        UNS32,
        CNC,
        "1 standby, 2 automatic, 3 MDI, 4 manual, 5 homing.",
        old=("ch/<n>/channel_state/mode_r",),
    ),
    _value(
        f"{MODE_AND_STATE}/state",
        UNS32,
        CNC,
        "1 deselected, 2 selected, 3 ready, 4 active, 5 hold, 6 error.",
        old=("ch/<n>/channel_state/state_r",),
    ),
    _value(
        "ch/<n>/bahn_state/block_nr_r",
        UNS32,
        CNC,
        "N number of the block in execution, 0 of one without.",
        old=("ch/<n>/channel_state/block_number_r",),
    ),
    _value("ch/<n>/mc_error/enable_w", BOOL, PLC, "The PLC takes the error records."),
    _value(
        "ch/<n>/mc_error/semaphor_rw",
        BOOL,
        BOTH,
        "The CNC has an error record; the PLC that has read it clears it.",
    ),
    _value(
        "ch/<n>/mc_error/axis_r",
        UNS16,
        CNC,
        "Logical axis number of the error, 0 none. Place decided here: in the book a value of the body.",
    ),
    _value(
        "ch/<n>/mc_error/block_r",
        UNS32,
        CNC,
        "N number of the error's block, 0 none. Place decided here: in the book in the body.",
    ),
    _value(f"{ERROR_HEAD}/error_id", UNS32, CNC, "Number of the error.", old=("ch/<n>/mc_error/error_id_r",)),
    _value(
        f"{ERROR_HEAD}/behebungs_klasse",
        UNS16,
        CNC,
        "Remedy class, 0 to 8.",
        old=("ch/<n>/mc_error/remedy_r",),
    ),
    _value(
        f"{ERROR_HEAD}/reaktions_klasse",
        UNS16,
        CNC,
        "Reaction class, 0 to 8.",
        old=("ch/<n>/mc_error/reaction_r",),
    ),
    _value(f"{ERROR_HEAD}/cnc_channel", UNS16, CNC, "Number of the channel."),
)
"""Elements of a channel area, in the order of the image."""

OLD_GROUPS: Final = MappingProxyType({"StateLR_Data": "lr_state", "StateBahn_Data": "bahn_state"})
"""Old names of groups of values; those of units (`McControlLr_Data`) may stand before a unit and say nothing."""

SIZES: Final = MappingProxyType({BOOL: 1, UNS16: 2, UNS32: 4, SGN32: 4, SGN64: 8})
"""Bytes of each type in the image (little-endian)."""


def numbered(elements: tuple[HliElement, ...], number: int) -> Iterator[tuple[str, HliElement]]:
    """Yield (path with the number filled in, element)."""
    for element in elements:
        yield element.path.replace("<n>", str(number)), element
