"""Random NC programs out of all that the decoder can do, and some that it cannot."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from net.machines import FACE_MM, LINEAR, SOURCES, STOP_MM, Machine, Random, chance, pick


@dataclass(frozen=True, slots=True)
class Block:
    """Lines that stand or fall together, and the axes that they may move."""

    text: str
    axes: frozenset[str] = frozenset()


def program_text(blocks: Sequence[Block]) -> str:
    """Return the program of these blocks, with a block number where one may stand."""
    lines = ["%swarm"]
    for number, block in enumerate(blocks, 1):
        plain = "\n" not in block.text and block.text[:1] not in ("N", "(", ";", "")
        lines.append(f"N{number}0 {block.text}" if plain else block.text)
    return "\n".join(lines) + "\n"


def random_program(random: Random, machine: Machine) -> list[Block]:
    """Return a program of up to two dozen blocks for a machine."""
    blocks = [Block("G90 G01 F6000")]
    names, weights = list(_KINDS), [weight for weight, _ in _KINDS.values()]
    shares = [weight / sum(weights) for weight in weights]
    for _ in range(int(random.integers(1, 12))):
        name = names[int(random.choice(len(names), p=shares))]
        blocks.append(_KINDS[name][1](random, machine))
    if chance(random, 0.95):
        blocks.append(Block(pick(random, "M30", "M30", "M02", "m30")))
    return blocks


def _feed(random: Random) -> str:
    return f"F{int(random.integers(8000, 30_000))}"


def _range(axis: str) -> tuple[float, float]:
    """Return where an axis may go: clear of face, stop and cam, within limits."""
    return (42.0, 68.0) if axis == "Z" else (-38.0, 60.0)


def _words(random: Random, machine: Machine, most: int = 3) -> tuple[str, frozenset[str]]:
    count = int(random.integers(1, min(most, len(machine.axes)) + 1))
    axes = [str(axis) for axis in random.choice(machine.axes, count, replace=False)]
    words = []
    for axis in axes:
        value = round(float(random.uniform(*_range(axis))), pick(random, 0, 2, 4))
        equals = "=" if axis[-1].isdigit() or chance(random, 0.1) else ""
        words.append(
            f"{axis}[{value}+0]" if chance(random, 0.05) and not equals else f"{axis}{equals}{value}"
        )
    return " ".join(words), frozenset(axes)


def _line(random: Random, machine: Machine) -> Block:
    words, axes = _words(random, machine)
    return Block(f"G01 {words} {_feed(random)}", axes)


def _rapid(random: Random, machine: Machine) -> Block:
    words, axes = _words(random, machine)
    return Block(f"G00 {words}", axes)


def _back(random: Random, machine: Machine) -> Block:
    """A relative way there and back."""
    axis = pick(random, *LINEAR)
    way = round(float(random.uniform(0.1, 6.0)), 3)
    return Block(f"G91 G01 {axis}{way} {_feed(random)}\n{axis}{-way}\nG90", frozenset((axis,)))


def _short(random: Random, machine: Machine) -> Block:
    axis = pick(random, *LINEAR)
    start = float(random.uniform(*_range(axis))) - 1.0
    lines = [
        f"G01 {axis}{start + number * 0.02:.3f} {_feed(random)}"
        for number in range(int(random.integers(3, 40)))
    ]
    return Block("\n".join(lines), frozenset((axis,)))


def _dwell(random: Random, machine: Machine) -> Block:
    return Block(pick(random, "G04 0.02", "G04 X0.3", "G04 0", "G04 0.0015"))


def _text(random: Random, machine: Machine) -> Block:
    variables = (
        "V.A.ABS.X",
        "V.A.MEIN.Z",
        "V.A.MERF.Z",
        "V.A.ACT_POS.Z",
        "V.G.MEAS_TYPE",
        "V.A.RERF.X",
        "V.A.MESS.Z",
    )
    asked = pick(random, *variables)
    return Block(
        pick(
            random, f'#MSG SYN["%f", {asked}]', f'#MSG ["%f", {asked}]', '#MSG ["here"]', '#MSG SYN["there"]'
        )
    )


def _settings(random: Random, machine: Machine) -> Block:
    axis = pick(random, *LINEAR)
    return Block(
        pick(
            random,
            f"#MEAS MODE[{pick(random, 1, 1, 2, 3, 4, 7)}]",
            f"#MEAS [AX={axis} SIGNAL={pick(random, *SOURCES)}]",
            f"#MEAS [AX={axis} EDGE={pick(random, 'POS', 'NEG')}]",
            f"#MEAS [TYPE={pick(random, 1, 2, 3)} ERR_NO_SIGNAL={pick(random, 0, 1)}]",
            "#MEAS DEFAULT",
            "#MEAS MODE",
        )
    )


def _probe(random: Random, machine: Machine) -> Block:
    """Up from the face, then onto it."""
    source = f"#MEAS [AX=Z SIGNAL={pick(random, *SOURCES[:3])}]\n" if chance(random, 0.5) else ""
    way = f"G01 Z{random.uniform(43, 60):.3f} F20000\n" if chance(random, 0.9) else ""
    back = f"\nG01 Z{random.uniform(45, 65):.3f} F20000" if chance(random, 0.9) else ""
    others = " X1 Y2" if chance(random, 0.1) else ""
    target = pick(random, FACE_MM - 5.0, FACE_MM - 1.0, FACE_MM + 1.0)
    axes = frozenset(LINEAR) if others else frozenset("Z")
    return Block(f"{source}{way}G100 Z{target}{others} F{int(random.integers(1500, 12_000))}{back}", axes)


def _measure_anything(random: Random, machine: Machine) -> Block:
    words, axes = _words(random, machine)
    return Block(f"G100 {words} {_feed(random)}", axes)


def _offset(random: Random, machine: Machine) -> Block:
    axis = pick(random, *LINEAR)
    moves = f"\nG01 {axis}{50 if axis == 'Z' else 5} F20000"
    return Block(
        pick(
            random,
            f"G101 {axis}1{moves}\nG102 {axis}1",
            f"G92 {axis}1.5{moves}\nG92 {axis}0",
            f"G91 G92 {axis}0.5\nG90",
            "G102",
            f"#CHANNEL INIT [ACTPOS AX={axis}]",
            "#CHANNEL INIT [CMDPOS]",
        ),
        frozenset((axis,)),
    )


def _frame(random: Random, machine: Machine) -> Block:
    words = pick(random, "0,0,3,0,0,0", "1,2,0,0,0,20", "0,0,45,0,15,0", "2,,1")
    inside = pick(random, "G01 Z5 F5000", "G01 X3 Y3 Z2 F20000", "G100 Z-2 F4000", "")
    return Block(f"#CS ON[{words}]\n{inside}\n#CS OFF", frozenset(LINEAR))


def _home(random: Random, machine: Machine) -> Block:
    words, axes = pick(
        random,
        ("X1", "X"),
        ("X1", "X"),
        ("Y1", "Y"),
        ("X1 Y1", "XY"),
        ("X2 Y1", "XY"),
        ("Z1 X1", "ZX"),
        ("A1", "A"),
    )
    return Block(f"G74 {words}", frozenset(axes))


def _press(random: Random, machine: Machine) -> Block:
    """A run onto the fixed stop with the torque limited, and what belongs to it."""
    limited = f"#DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL={pick(random, 5, 10, 20)} WAIT]"
    open_window = "#DRIVE WR SYN [AX=Z KEY=MON_WINDOW VAL=4294967295 WAIT]"
    closed = "#DRIVE WR SYN [AX=Z KEY=MON_WINDOW VAL=1048575 WAIT]"
    full = "#DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT VAL=300 WAIT]"
    run = f"G100 Z{STOP_MM + 5} F{int(random.integers(1500, 6000))}"
    there, back = f"G01 Z{STOP_MM - 6} F20000", f"G01 Z{STOP_MM - 10} F20000"
    lines = ("#MEAS MODE[7]", there, limited, open_window, run, back, closed, full, "#MEAS MODE[1]")
    return Block("\n".join(lines), frozenset("Z"))


def _drive(random: Random, machine: Machine) -> Block:
    axis, syn, wait = pick(random, *LINEAR), pick(random, "", " SYN"), pick(random, "", " WAIT")
    return Block(f"#DRIVE WR{syn} [AX={axis} KEY=TORQUE_LIMIT VAL={int(random.integers(60, 301))}{wait}]")


def _control(random: Random, machine: Machine) -> Block:
    words, axes = _words(random, machine, 2)
    other, more = _words(random, machine, 2)
    move = f"G01 {words} F20000"
    text = pick(
        random,
        f"P1 = {pick(random, 0, 1, 2)}\n$IF P1 == 1\n{move}\n$ELSEIF P1 > 1\nG01 {other}\n$ELSE\nG04 0.01\n$ENDIF",
        f"$FOR P2 = 1, {pick(random, 0, 2, 3)}, 1\n{move}\nG01 {other}\n$ENDFOR",
        f"P3 = 3\n$WHILE P3 > 0\nP3 = P3 - 1\n$IF P3 == 1\n$CONTINUE\n$ENDIF\n{move}\n$ENDWHILE",
        f"V.P.A = 2\n$WHILE TRUE\nV.P.A = V.P.A - 1\n$IF V.P.A < 0\n$BREAK\n$ENDIF\nG01 {other} F20000\n$ENDWHILE",
    )
    return Block(text, axes | more)


def _comment(random: Random, machine: Machine) -> Block:
    return Block(pick(random, "( a comment )", "; a comment", "#COMMENT BEGIN\nG01 X9999\n#COMMENT END", ""))


def _beyond(random: Random, machine: Machine) -> Block:
    """A target that a limit may forbid; the way there is short."""
    axis = pick(random, *LINEAR)
    return Block(f"G01 {axis}{pick(random, -45, 72)} F20000", frozenset((axis,)))


def _wrong(random: Random, machine: Machine) -> Block:
    """Words that are broken, unknown, forbidden or not built."""
    return Block(
        pick(
            random,
            "G01 X",
            "G01 X$ Y",
            "G1000",
            "G02 X1 Y1 I5",
            "#NONSENSE ON",
            "#MEAS MODE[9]",
            "#MEAS [AX=Q SIGNAL=PLC]",
            "#MEAS [AX=Z SIGNAL=PLC SIGNAL=DRIVE]",
            "#MEAS [AX=Z SIGNAL=PLC_EXT_LATCH_CONTROL]",
            "G100 F500",
            "G101 X1",
            "G74",
            "G74 X0",
            "G74 S1",
            "$IF P99 == 1",
            "$ENDIF",
            "P1 = 1/0",
            "G04 X[1/0]",
            "G01 X1 X2",
            "S1000 M3",
            "#CS ON[1,2",
            "#DRIVE WR SYN [AX=X KEY=NOTHING VAL=1 WAIT]",
            "#DRIVE WR SYN [AX=X KEY=TORQUE_LIMIT VAL=-5 WAIT]",
            '#MSG ["%q", 1]',
            "#DRIVE RD [AX=X]",
            "L sub.nc",
            "G01 X[SQRT[-1]]",
        )
    )


_KINDS: Final[dict[str, tuple[float, Callable[[Random, Machine], Block]]]] = {
    "line": (12, _line),
    "rapid": (4, _rapid),
    "back": (3, _back),
    "short": (2, _short),
    "dwell": (2, _dwell),
    "text": (4, _text),
    "settings": (4, _settings),
    "probe": (6, _probe),
    "measure": (1, _measure_anything),
    "offset": (3, _offset),
    "frame": (2, _frame),
    "home": (4, _home),
    "press": (2, _press),
    "drive": (1.5, _drive),
    "control": (3, _control),
    "comment": (1, _comment),
    "beyond": (1, _beyond),
    "wrong": (0.8, _wrong),
}
"""What a block may be, how often among the others, and what makes it."""
