"""Channel and axes of a machine: their parameters from list files and values, and what must fit together."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar, cast

from hli_bench.base.errors import InputError
from hli_bench.base.ids import AxisIndex, AxisNumber, NodeId
from hli_bench.bench.config import AxisConfig
from hli_bench.bench.parameters import built, listed
from hli_bench.bench.values import Values
from hli_bench.manual.axis import AxisParams
from hli_bench.manual.channel import ChannelParams
from hli_bench.manual.drive_types import DriveType
from hli_bench.manual.lists import Severity, converted
from hli_bench.manual.sheet import Value
from hli_bench.plant.settings import PlantSettings
from hli_bench.shells.texts import text_of

P = TypeVar("P")


def channel_of(values: Values) -> ChannelParams:
    """Return the parameters of the channel."""
    kept = values.untouched("channel.", "lenient")
    return kept.channel if kept else _tree(values, ChannelParams, "channel")


def params_of(values: Values, index: int, name: str) -> AxisParams:
    """Return the parameters of an axis."""
    kept = values.untouched(f"axis.{name}.", "lenient")
    return kept.axes[index].params if kept else _tree(values, AxisParams, f"axis.{name}")


def axis_of(values: Values, index: int, name: str, params: AxisParams) -> AxisConfig:
    """Return an axis with its drive."""
    kept = values.untouched(f"axis.{name}.", "lenient")
    if kept:
        return kept.axes[index]
    node = values.value(f"axis.{name}.node_id")
    return AxisConfig(
        index=AxisIndex(index),
        name=name,
        number=AxisNumber(params.kopf.achs_nr),
        node_id=NodeId(params.kopf.achs_nr if node is None else node),
        drive=values.value(f"axis.{name}.drive"),
        following_error=values.value(f"axis.{name}.following_error"),
        start_mm=values.value(f"axis.{name}.start_mm"),
        params=params,
    )


def check_axes(values: Values, axes: Sequence[AxisConfig], plant: PlantSettings) -> None:
    """Axis numbers and node ids are unique, start positions fit into 32 bits."""
    for what, path in (("number", "kopf.achs_nr"), ("node_id", "node_id")):
        owners: dict[int, str] = {}
        for axis in axes:
            value = getattr(axis, what)
            if value in owners:
                message = f"axis.{axis.name}.{path}: {value} is already that of axis {owners[value]}"
                values.fail(values.place(axis.name, path), message)
            owners.setdefault(value, axis.name)
    for axis, drive_train in zip(axes, (one.plant for one in plant.axes), strict=True):
        limit = 2**31 / drive_train.increments_per_turn * drive_train.pitch_mm
        if abs(axis.start_mm) >= limit:
            message = f"axis.{axis.name}.start_mm: {axis.start_mm} is beyond the encoder's +-{limit:g}"
            values.fail(values.given.get(f"axis.{axis.name}.start_mm"), message)


def _tree(values: Values, cls: type[P], owner: str) -> P:
    """Return the parameters of the channel or an axis: list file, then machine.toml, then overrides."""
    name = values.value(f"{owner}.list")
    text = _list_file(values, owner, name) if name else ""
    found = listed(cast("Any", cls), text, str(values.folder / name), lenient=values.value("lenient"))
    for finding in found.findings:
        values.note(finding.as_error(), finding.severity)
    places = dict(found.places)
    changes: dict[str, Value] = {}
    for path, given in values.lists.get(owner, {}).items():
        try:
            taken = converted(cls, {path: given.value})
        except InputError as error:
            values.fail(given, f"{owner}.{error.message}")
            continue
        changes.update(taken)
        places.update(dict.fromkeys(taken, given))
    values.places[owner] = places
    given_values = found.values | changes
    if cls is AxisParams:
        # Every drive model of a machine folder is a CANopen one: a list that names no drive type means it.
        given_values.setdefault("kenngr.antr_typ", DriveType.CANOPEN)
        # P-AXIS-00036 is no parameter of a CANopen drive: unless a list speaks of it, the PLC supplies the cam
        given_values.setdefault("lr_hw[0].cam_direct_access", False)
    tree = built(cast("Any", cls), tuple(given_values.items()), text, repr(changes))
    for path, finding in tree.findings:
        owned = f"{owner}.{finding.message}" if finding.severity is Severity.NOTE else finding.message
        values.note(places[path].error(owned), finding.severity)
    for path, not_built in tree.refused:
        values.refuse(places[path], f"{owner}: {not_built}")
    return cast("P", tree.params)


def _list_file(values: Values, owner: str, name: str) -> str:
    """Return the text of a list file, of one that cannot be read an empty one."""
    path = values.folder / name
    text = values.texts[path] if path in values.texts else list_text(path)
    if text is None:
        given = values.given.get(f"{owner}.list")
        values.fail(given, f"{owner}.list: {name!r} is not a readable file of {values.folder}")
    return text or ""


def list_text(path: Path) -> str | None:
    """Return the text of a list file, None when it cannot be read."""
    try:
        return text_of(path)
    except InputError:
        return None
