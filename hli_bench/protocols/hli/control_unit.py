"""The rule of a control unit: whose command counts, what the PLC gets to see, what happens without a PLC.

The CNC looks at `enable_w` and `command_w` once a kernel cycle (`sample`). While redirection is on, the
PLC's command counts and a wish of the GUI only shows in `request_r`; while it is off, the GUI's value counts
at once and `request_r` is not supplied. A unit counts only while `head.plc_present_w` of its axis or channel
is TRUE.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from hli_bench.protocols.hli.image import Image, Value
from hli_bench.protocols.hli.layout import Layout


class ControlUnit:
    """One control unit; `effective` and `redirected` hold from one sampling to the next."""

    __slots__ = (
        "_command",
        "_enable",
        "_gui",
        "_image",
        "_present",
        "_request",
        "_semaphor",
        "_state",
        "effective",
        "path",
        "redirected",
    )

    def __init__(self, image: Image, path: str, default: Value) -> None:
        """`default` is the GUI's value until `ask` changes it."""
        ids = image.layout.groups[path].ids
        self.path = path
        self._image = image
        self._request, self._enable = ids["request_r"], ids["enable_w"]
        self._command, self._state = ids["command_w"], ids["state_r"]
        self._semaphor = ids.get("command_semaphor_rw")
        self._present = image.layout.groups[f"{_area(path)}/head"].ids["plc_present_w"]
        self._gui = default
        self.effective: Value = default
        self.redirected = False

    @property
    def enabled(self) -> bool:
        """The PLC has switched redirection on; it holds only while the PLC is present as well."""
        return bool(self._image.get(self._enable))

    @property
    def unheard(self) -> str:
        """Why the PLC's command does not count, "" when it does."""
        image = self._image
        if not image.get(self._present):
            return f"{image.layout.elements[self._present].path} is FALSE"
        return "" if self.enabled else f"{self.path}/enable_w is FALSE"

    def ask(self, wish: Value) -> None:
        """Take a wish of the GUI: it acts at the next sampling, or shows in request_r under redirection."""
        self._gui = wish
        if self.redirected:
            self._image.set(self._request, wish)
        else:
            self.effective = wish

    def sample(self) -> bool:
        """Look at the PLC's members once; tell whether `effective` or `redirected` changed.

        A unit with usage check takes its command only while command_semaphor_rw is TRUE, and clears it.
        """
        image = self._image
        before = self.redirected, self.effective
        self.redirected = self.enabled and bool(image.get(self._present))
        image.set(self._request, self._gui if self.redirected else type(self._gui)())
        if not self.redirected:
            self.effective = self._gui
        elif self._semaphor is None:
            self.effective = image.get(self._command)
        elif image.get(self._semaphor):
            self.effective = image.get(self._command)
            image.set(self._semaphor, False)
            return True
        return before != (self.redirected, self.effective)

    def acknowledge(self, value: Value) -> None:
        """Write state_r: the CNC has acted and this is what holds now."""
        self._image.set(self._state, value)


class ControlUnits:
    """All control units of an image in which no PLC has written yet.

    A unit is made when it is asked for or written to; before that it has nothing to say.
    """

    __slots__ = ("_defaults", "_image", "_units", "_wiring")

    def __init__(self, image: Image, defaults: Mapping[str, Value]) -> None:
        """`defaults` gives the GUI's value by the last part of a unit's path; others start FALSE or 0."""
        self._image = image
        self._defaults = defaults
        self._wiring = _wiring(image.layout)
        self._units: dict[str, ControlUnit] = {}
        for path in self._wiring.zeros:
            if path.rpartition("/")[2] in defaults:
                self._unit(path).acknowledge(defaults[path.rpartition("/")[2]])

    def __getitem__(self, name: str) -> ControlUnit:
        """Return the unit that `name` means (path, ST form or old name)."""
        return self._unit(self._image.layout.resolve(name))

    def __contains__(self, path: str) -> bool:
        return path in self._wiring.zeros

    def enabled(self) -> list[ControlUnit]:
        """Return the units for which a PLC has switched redirection on."""
        image = self._image
        return [self._unit(path) for path, enable in self._wiring.enables.items() if image.get(enable)]

    def sample(self) -> list[ControlUnit]:
        """Sample once a kernel cycle: return the units whose effective value or redirection changed."""
        written = self._image.take_written()
        if not written:
            return []
        touched = dict.fromkeys(path for element in written for path in self._wiring.heard.get(element, ()))
        return [unit for unit in map(self._unit, touched) if unit.sample()]

    def _unit(self, path: str) -> ControlUnit:
        unit = self._units.get(path)
        if unit is None:
            default = self._defaults.get(path.rpartition("/")[2], self._wiring.zeros[path])
            unit = self._units[path] = ControlUnit(self._image, path, default)
        return unit


@dataclass(frozen=True, slots=True)
class _Wiring:
    """The units of a layout, each with FALSE or 0 by its type, and its `enable_w`; which units hear an element."""

    zeros: Mapping[str, Value]
    enables: Mapping[str, int]
    heard: Mapping[int, Sequence[str]]


@lru_cache(maxsize=64)
def _wiring(layout: Layout) -> _Wiring:
    zeros: dict[str, Value] = {}
    heard: dict[int, Sequence[str]] = {}
    areas: dict[str, list[str]] = {}
    for path, group in layout.groups.items():
        ids = group.ids
        if "enable_w" not in ids or "command_w" not in ids:
            continue
        zeros[path] = False if layout.elements[ids["command_w"]].type == "BOOL" else 0
        heard |= dict.fromkeys(ids.values(), (path,))
        areas.setdefault(_area(path), []).append(path)
    for area, paths in areas.items():
        heard[layout.groups[f"{area}/head"].ids["plc_present_w"]] = paths
    return _Wiring(zeros, {path: layout.groups[path].ids["enable_w"] for path in zeros}, heard)


def _area(path: str) -> str:
    """Return axis or channel of a unit: `ax/2` of `ax/2/lr_mc_control/probing_signal`."""
    return "/".join(path.split("/", 2)[:2])
