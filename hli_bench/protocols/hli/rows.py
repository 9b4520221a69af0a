"""From the manual's table of control units to the members of an area, in order."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the table."""

    path: str
    kind: str
    data_type: str
    access: str = ""
    aliases: tuple[str, ...] = ()
    unit: str = ""


CONTROL_UNITS: Final = (
    Row("ax/*/head/plc_present_w", "value", "BOOL", "w"),
    Row("ax/*/head/log_ax_n_r", "value", "UNS16", "r"),
    Row("ax/*/head/axis_type_r", "value", "UNS16", "r"),
    Row("ax/*/head/error_r", "value", "BOOL", "r"),
    Row("ax/*/lr_mc_control/release_feedhold", "unit", "BOOL"),
    Row("ax/*/lr_mc_control/probing_signal", "unit", "BOOL", "", ("MCControlBoolUnit_ProbingSignal",)),
    Row(
        "ax/*/lr_mc_control/probing_position",
        "unit",
        "SGN32",
        "",
        ("MCControlSGN32Unit_ProbingPosition",),
        "0.1 um",
    ),
    Row("ax/*/lr_mc_control/timestamp", "unit", "SGN64", "", (), "ns"),
    Row("ax/*/lr_mc_control/reference_cam", "unit", "BOOL", "", ("MCControlBoolUnit_ReferenceCam",)),
    Row("ax/*/ext_latch/order_type_r", "value", "UNS16", "r"),
    Row("ax/*/ext_latch/input_r", "value", "UNS32", "r"),
    Row("ax/*/ext_latch/edge_r", "value", "UNS16", "r"),
    Row("ax/*/ext_latch/please_rw", "value", "BOOL", "rw"),
    Row("ax/*/ext_latch/done_w", "value", "BOOL", "w"),
    Row("ax/*/lr_state/measure_value_ok_r", "value", "BOOL", "r"),
    Row("ch/*/head/plc_present_w", "value", "BOOL", "w"),
    Row("ch/*/bahn_mc_control/feedhold", "unit", "BOOL"),
)

MEMBER_ALIASES: Final[Mapping[str, str]] = {
    "x_request": "request_r",
    "d_request": "request_r",
    "x_enable": "enable_w",
    "x_command": "command_w",
    "d_command": "command_w",
    "x_state": "state_r",
    "d_state": "state_r",
    "x_commandsemaphore": "command_semaphor_rw",
    "x_requestsemaphore": "request_semaphor_rw",
    "x_please": "please_rw",
    "x_done": "done_w",
}
"""Old member names, lower case, and what they are called now."""


@dataclass(frozen=True, slots=True)
class Member:
    """One value of an area before it has a place: `group` is the path of its unit or structure."""

    group: str
    name: str
    type: str
    unit: str
    access: str
    aliases: tuple[str, ...] = ()


def members(area: str, number: int, *, rotary: bool, rows: Iterable[Row] = CONTROL_UNITS) -> list[Member]:
    """Return the members of `ax/<number>` or `ch/<number>`, those of one unit next to each other."""
    grouped: dict[str, list[Member]] = {}
    for row in rows:
        if not row.path.startswith(f"{area}/*/"):
            continue
        path = row.path.replace("*", str(number), 1)
        unit = row.unit.replace("0.1 um", "0.0001 deg") if rotary else row.unit
        for member in _of(row, path, unit):
            grouped.setdefault(member.group, []).append(member)
    return [member for group in grouped.values() for member in group]


def _of(row: Row, path: str, unit: str) -> list[Member]:
    if row.kind == "value":
        group, _, name = path.rpartition("/")
        return [Member(group, name, row.data_type, unit, row.access)]
    return [
        Member(path, "request_r", row.data_type, unit, "r", row.aliases),
        Member(path, "enable_w", "BOOL", "", "w", row.aliases),
        Member(path, "command_w", row.data_type, unit, "w", row.aliases),
        Member(path, "state_r", row.data_type, unit, "r", row.aliases),
    ]
