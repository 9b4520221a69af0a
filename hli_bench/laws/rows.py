"""The rows that the laws work on: one structured numpy record an axis, drive, switch, signal, terminal channel.

Rows are state, owned by one node and never sent. Kernel rows count in 0.1 um (0.0001 degree) and seconds,
machine rows in encoder increments, rad, Nm and seconds; instants are whole ns since bench start.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[Any]
"""A structured array; its dtype is one of this module."""
Row = Any
"""One element of such an array. Laws about one thing take its row: unlike an array it costs nothing to pass on."""

HISTORY_CYCLES: Final = 4096
"""Depth of the position history in cycles."""
LOG_CYCLES: Final = 1024
"""Depth of the cycle log; no stride is longer."""
SEGMENTS: Final = 64
"""Depth of the ring of prepared path segments."""
EDGES: Final = 256
"""Edges that one stride can report; a stride ends when the ring is half full."""
SUB_STEPS: Final = 160
"""Greatest number of sub-steps in a cycle."""
NOISE: Final = 1024
"""Pre-drawn random trigger offsets of a switch, used cyclically."""

# Axis modes (AXIS["mode"])
HOLD: Final = 0
PATH: Final = 1
JOG: Final = 2
FOLLOW: Final = 3

# Path states (PATH_ROW["state"])
IDLE: Final = 0
RUN: Final = 1
BRAKE: Final = 2

# What makes the path stand (bits of PATH_ROW["hold"])
FEEDHOLD: Final = 1
SHORT_CUT: Final = 2

# Watch kinds (WATCH["kind"]); no row behind a W_NONE is in use, a W_FREE is a gap
W_NONE: Final = 0
W_PATH_DONE: Final = 1
W_SEGMENT: Final = 2
W_JOG_STOPPED: Final = 3
W_LAG_OVER: Final = 4
W_LAG_WITHIN: Final = 5
W_FIXED_STOP: Final = 6
W_PROBE_STATUS: Final = 7
W_STATUSWORD: Final = 8
W_DIGITAL_INPUT: Final = 9
W_CYCLE: Final = 10
W_STANDSTILL_LAG_OVER: Final = 11
W_MOVED: Final = 12
W_FREE: Final = 13
W_STATUSWORD_LEFT: Final = 14
W_PATH_STANDS: Final = 15
W_OUTSIDE: Final = 16

AXIS: Final = np.dtype(
    [
        ("command", "f8"),  # set point, ACS, 0.1 um
        ("velocity", "f8"),  # of the set point, 0.1 um/s
        ("past", "f8"),  # set point of the cycle before: where a drive without lag stands at the next SYNC
        ("feedback", "i8"),  # `received`, unwrapped
        ("increments_per_unit", "f8"),  # increments per 0.1 um, negative when the drive counts the other way
        ("reference", "i8"),  # increments at ACS position 0
        ("actual", "f8"),  # ACS, 0.1 um
        ("lag", "f8"),  # set point of two cycles before minus actual position, 0.1 um
        ("mode", "u1"),
        ("released", "u1"),  # feed released: without it the axis, and a path that moves it, brakes
        ("jog_velocity", "f8"),  # wanted velocity of a JOG, signed, 0.1 um/s
        ("jog_acceleration", "f8"),  # 0.1 um/s2
        ("target", "i4"),  # what goes into the command telegram, increments
        ("controlword", "u2"),
        ("statusword", "u2"),
        ("probe_function", "u2"),
        ("probe_status", "u2"),
        ("latch", "i4", (2,)),  # latched at the positive / negative edge of the telegram's probing input
        ("digital_inputs", "u4"),
        ("torque_permille", "i2"),
        ("following_error", "i4"),
        ("received", "i4"),  # actual position in the newest telegram, increments
    ],
    align=True,
)

SERVO: Final = np.dtype(
    [
        # what the bus writes and reads (drive user unit: increment)
        ("target", "i4"),
        ("demand", "i4"),
        ("position", "i4"),
        ("velocity", "i4"),
        ("following_error", "i4"),
        ("torque_permille", "i2"),
        ("torque_limit_permille", "f8"),
        ("positive_permille", "f8"),  # limit of positive torque beside it
        ("negative_permille", "f8"),  # of negative torque, as a positive number
        ("enabled", "u1"),
        ("following_window", "u4"),
        ("following_timeout_ms", "u2"),
        ("following_elapsed_ns", "i8"),
        ("probe_function", "u2"),
        ("probe_status", "u2"),
        ("latch", "i4", (4,)),
        ("latch_time", "u4", (4,)),
        ("digital_inputs", "u4"),
        ("status_flags", "u2"),
        ("fault", "u2"),
        # loop
        ("demand_from", "f8"),  # increments, start of the interpolation of this cycle
        ("span", "f8"),  # increments, way of the set point in this cycle
        (
            "stop_rate",
            "f8",
        ),  # increments/s2 at which the set point comes to a stop by itself, 0: it follows the target
        ("stop_speed", "f8"),  # increments/s, of that set point
        ("kv", "f8"),  # 1/s
        ("speed_gain", "f8"),  # Nm s/rad
        ("speed_integral_gain", "f8"),  # Nm/rad
        ("integrator", "f8"),  # Nm
        ("rated_torque", "f8"),  # Nm
        ("peak_permille", "f8"),
        # mechanics, motor side
        ("angle", "f8"),  # rad
        ("speed", "f8"),  # rad/s
        ("torque", "f8"),  # Nm
        ("inertia", "f8"),  # kg m2
        ("viscous", "f8"),  # Nm s/rad
        ("coulomb", "f8"),  # Nm
        ("static", "f8"),  # Nm
        ("brake", "f8"),  # Nm, of a brake that falls in without power
        ("increments_per_rad", "f8"),
        ("increments_per_turn", "i8"),
        ("zero_pulse", "i8"),  # count of the zero pulse within a turn
        ("encoder_offset", "i8"),  # count shown at angle 0
        # mechanical fixed stop
        ("stop_side", "i1"),  # 0 none, +1 solid above, -1 solid below
        ("stop_angle", "f8"),  # rad
        ("stop_stiffness", "f8"),  # Nm/rad
        ("stop_damping", "f8"),  # Nm s/rad
        # wiring: index of the signal, -1 for none
        ("probe_signal", "i4", (2,)),
        ("input_signal", "i4", (8,)),
        ("telegram_input", "u1"),  # probing input (0, 1) whose latches the telegrams carry
        ("probe_function_seen", "u2"),
        ("resting_limit", "f8", (2,)),  # torque limits under which the axis rests, -1 while it does not
        ("resting_flags", "u2"),
        ("angle_low", "f8"),  # rad, least and greatest angle of the cycle
        ("angle_high", "f8"),
        ("angles", "f8", (SUB_STEPS + 1,)),  # rad, at the borders of the cycle's sub-steps
    ],
    align=True,
)

SWITCH: Final = np.dtype(
    [
        ("signal", "i4"),
        ("axis", "i4"),
        ("weight", "i4"),  # what it counts for its signal while it holds
        ("low", "f8"),  # operated inside [low, high], rad of the axis' motor
        ("high", "f8"),
        ("hysteresis", "f8"),  # released beyond low - hysteresis, high + hysteresis, rad
        ("noise_index", "i4"),
        ("state", "u1"),
        ("bounce_ns", "i8"),
        ("noise", "f8", (NOISE,)),  # added to low / subtracted from high at each contact, rad
    ],
    align=True,
)

SIGNAL: Final = np.dtype(
    [
        ("operated", "i4"),  # weight of the switches that hold it
        ("needed", "i4"),  # weight from which on it is operated
        ("level", "u1"),
        ("forced", "i1"),  # -1 none, else the level it is stuck at
    ],
    align=True,
)

CHANNEL: Final = np.dtype(
    [
        ("signal", "i4"),
        ("delay_ns", "i8"),
        ("skew_ns", "i8"),  # how far the clock of the terminal is ahead of DC time
        ("single_event", "u1"),
        ("level", "u1"),  # behind the input filter
        ("level_due_ns", "i8"),
        ("level_next", "u1"),
        ("input", "u1"),  # as shown in the process image
        ("status", "u1"),
        ("latch_pos", "i8"),  # DC ns
        ("latch_neg", "i8"),
        ("taken", "u1"),  # single event: bit 0 positive, bit 1 negative edge taken since the last read
    ],
    align=True,
)

EDGE: Final = np.dtype([("at_ns", "i8"), ("signal", "i4"), ("level", "u1")], align=True)

PATH_ROW: Final = np.dtype(
    [
        ("state", "u1"),
        ("head", "i8"),  # number of the running segment
        ("tail", "i8"),  # number of the next segment to be put
        ("s", "f8"),  # path done in the running segment, 0.1 um
        ("v", "f8"),  # path velocity, 0.1 um/s
        ("override", "f8"),
        ("hold", "u1"),  # bits: FEEDHOLD, which holds axes that move by themselves too, SHORT_CUT
        ("brake", "f8", (2,)),  # deceleration below / above `brake_split` while state is BRAKE
        ("brake_split", "f8"),
        ("block", "u4"),  # N number of the block in execution while no path runs
    ],
    align=True,
)

WATCH: Final = np.dtype(
    [
        ("kind", "u1"),
        ("axis", "i4"),
        ("limit", "f8"),
        ("window", "f8"),
        ("mask", "u4"),
        ("value", "u4"),
        ("cycles", "i8"),
        ("count", "i8"),
        ("fired", "u1"),
    ],
    align=True,
)

LOG: Final = np.dtype(
    [
        ("command", "f8"),
        ("actual", "f8"),
        ("lag", "f8"),
        ("target", "i4"),
        ("position", "i4"),
        ("following_error", "i4"),
        ("latch", "i4", (2,)),
        ("digital_inputs", "u4"),
        ("controlword", "u2"),
        ("statusword", "u2"),
        ("probe_function", "u2"),
        ("probe_status", "u2"),
        ("torque_permille", "i2"),
    ]
)


SEGMENT: Final = np.dtype(
    [
        ("block", "u4"),  # N number
        ("length", "f8"),  # 0.1 um
        ("feed", "f8"),  # 0.1 um/s
        ("rapid", "u1"),  # the feed override does not act above 100 %
        ("v_start", "f8"),  # greatest velocity at which the axes may enter it
        ("v_end", "f8"),
        ("acceleration", "f8", (2,)),  # below / above `split`
        ("deceleration", "f8", (2,)),
        ("hold", "f8", (2,)),  # deceleration at feedhold
        ("split", "f8"),
    ],
    align=True,
)

LEG: Final = np.dtype(
    [("moves", "u1"), ("start", "f8"), ("direction", "f8"), ("end", "f8")],  # positions 0.1 um
    align=True,
)
"""What one axis does in a path segment."""

DYNAMICS: Final = np.dtype(
    [
        ("up", "f8", (3,)),  # rate below the split velocity, rate above it (0.1 um/s2), split (0.1 um/s)
        ("down", "f8", (3,)),
        ("hold", "f8", (3,)),
        ("limit", "f8"),  # greatest velocity, 0.1 um/s
    ]
)
"""What an axis may do in a kind of block."""


PLAN: Final = np.dtype(
    [
        ("joined", "u1"),  # the next segment may follow without a stop
        ("velocity", "f8"),  # feed of the last segment, 0.1 um/s
    ],
    align=True,
)
"""The end of the prepared path."""

TIP: Final = np.dtype(
    [
        ("end", "f8"),  # 0.1 um
        ("direction", "f8"),  # in the last segment
        ("linear", "u1"),  # the F word counts it before the others
    ],
    align=True,
)
"""The end of the prepared path, of one axis."""


@dataclass(slots=True)
class KernelRows:
    """The numbers of the kernel: axis, tip (n,), path, plan (1,), segment (S,), leg (S, n), watch (m,).

    And behind them: history (H, n), log (L, n).
    """

    axis: Rows
    path: Rows
    segment: Rows
    leg: Rows
    plan: Rows
    tip: Rows
    watch: Rows
    history: NDArray[np.int64]
    log: Rows

    @classmethod
    def allocate(cls, axes: int, watches: int) -> "KernelRows":
        """Return zeroed rows for `axes` axes and room for `watches` conditions."""
        rows = cls(
            axis=np.zeros(axes, AXIS),
            path=np.zeros(1, PATH_ROW),
            segment=np.zeros(SEGMENTS, SEGMENT),
            leg=np.zeros((SEGMENTS, axes), LEG),
            plan=np.zeros(1, PLAN),
            tip=np.zeros(axes, TIP),
            watch=np.zeros(watches, WATCH),
            history=np.zeros((HISTORY_CYCLES, axes), np.int64),
            log=np.zeros((LOG_CYCLES, axes), LOG),
        )
        rows.axis["increments_per_unit"] = 1.0
        rows.axis["released"] = 1
        rows.path["override"] = 1.0
        return rows


@dataclass(slots=True)
class MachineRows:
    """The machine's numbers: one `servo` row an axis, its switches, signals and terminal channels."""

    servo: Rows
    switch: Rows
    signal: Rows
    channel: Rows
    edge: Rows
    edges: NDArray[np.int64]
    """Shape (2,): how many entries of `edge` are filled, and how many changes of signals are pending."""

    @classmethod
    def allocate(cls, axes: int, switches: int, signals: int, channels: int) -> "MachineRows":
        """Return zeroed rows; every wiring index is -1 (not connected)."""
        rows = cls(
            servo=np.zeros(axes, SERVO),
            switch=np.zeros(switches, SWITCH),
            signal=np.zeros(signals, SIGNAL),
            channel=np.zeros(channels, CHANNEL),
            edge=np.zeros(EDGES, EDGE),
            edges=np.zeros(2, np.int64),
        )
        rows.servo["probe_signal"] = -1
        rows.servo["resting_limit"] = -1.0
        rows.servo["positive_permille"] = np.inf
        rows.servo["negative_permille"] = np.inf
        rows.servo["input_signal"] = -1
        rows.signal["forced"] = -1
        rows.signal["needed"] = 1
        rows.switch["weight"] = 1
        rows.channel["signal"] = -1
        rows.channel["level_due_ns"] = np.iinfo(np.int64).max
        return rows


class Cells:
    """The numbers of one row, an element of one of these tables, without numpy's detours.

    `cells(name)` is a memory view: `[0]` reads the number, `[0] = x` stores it, in a fraction of a numpy scalar's time.
    """

    __slots__ = ("_bytes", "_places")

    def __init__(self, row: Any) -> None:
        self._bytes: memoryview = np.asarray(row).reshape(1).view(np.uint8).data
        self._places = _places(row.dtype)

    def __call__(self, name: str, element: int = 0) -> memoryview:
        """Return a number, an `element` of it where it is an array."""
        start, size, code = self._places[name]
        start += element * size
        return self._bytes[start : start + size].cast(code)


@cache
def _places(table: np.dtype[Any]) -> Mapping[str, tuple[int, int, Any]]:
    """Return where in a row each number begins, its size, its `struct` code."""
    fields = (table.fields or {}).items()
    return {name: (at, kind.base.itemsize, kind.base.char) for name, (kind, at, *_) in fields}


TABLES: Final[Mapping[str, tuple[np.dtype[Any], int]]] = {
    "axis": (AXIS, 1),
    "path": (PATH_ROW, 1),
    "segment": (SEGMENT, 1),
    "leg": (LEG, 2),
    "plan": (PLAN, 1),
    "tip": (TIP, 1),
    "kinds": (DYNAMICS, 2),
    "target": (np.dtype("f8"), 1),
    "watch": (WATCH, 1),
    "history": (np.dtype("i8"), 2),
    "log": (LOG, 2),
    "servo": (SERVO, 1),
    "switch": (SWITCH, 1),
    "signal": (SIGNAL, 1),
    "channel": (CHANNEL, 1),
    "edge": (EDGE, 1),
    "edges": (np.dtype("i8"), 1),
    "pending": (np.dtype("i8"), 2),
    "image": (np.dtype("u1"), 1),
    "offsets": (np.dtype("i8"), 1),
}
"""What the parameters of a law are that are tables: dtype and number of dimensions by name."""
