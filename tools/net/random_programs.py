"""Random NC programs of the compared runs: homing, motion, dwells, texts and measuring runs."""

import numpy as np


def random_program(seed: int) -> str:
    """Return a program with homing, motion, dwells, texts and measuring runs, as a seed says."""
    random = np.random.default_rng(seed)
    blocks = ["%random", "N1 G74 X1", "N2 G01 X-20 F12000"]
    kinds = ("line", "line", "line", "rapid", "text", "dwell", "probe", "drive", "short", "stop")
    for number in range(3, 23):
        x, y, z = random.uniform(-15, 15), random.uniform(-20, 20), random.uniform(42, 60)
        feed = random.integers(500, 20_000)
        match random.choice(kinds):
            case "line":
                block = f"G01 X{x:.4f} Y{y:.3f} Z{z:.2f} F{feed}"
            case "rapid":
                block = f"G00 X{x:.3f} Z{z:.3f}"
            case "text":
                block = '#MSG SYN["%f", V.A.ABS.X]' if random.random() < 0.5 else f'#MSG SYN["at {number}"]'
            case "dwell":
                block = "G04 0.02"
            case "probe":
                source = random.choice(["PLC", "PLC_TIMESTAMP", "DRIVE"])
                block = f"#MEAS [AX=Z SIGNAL={source}]\nG01 Z{z:.3f} F9000\nG100 Z35 F{feed}\nG01 Z55 F20000"
            case "drive":
                block = f"#DRIVE WR SYN [AX=Y KEY=TORQUE_LIMIT VAL={random.integers(100, 300)} WAIT]"
            case "short":
                block = "\n".join(f"G01 X{x + i * 0.01:.3f} F{feed}" for i in range(30))
            case _:
                block = f"#MEAS MODE[7]\nG100 Y{y:.2f} F{feed}\n#MEAS MODE[1]"
        blocks.append(f"N{number} {block}" if "\n" not in block else block)
    return "\n".join([*blocks, "M30"]) + "\n"
