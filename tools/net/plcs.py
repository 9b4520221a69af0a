"""PLC scripts of the net: good ones, restless ones, slow, silent and failing ones. `{seed}` is the run's."""

from typing import Final

_ALL: Final = """
    def start(self, hli, io):
        self.n = 0
        self.random = np.random.default_rng({seed})
        self.axes = [n for n in range(1, 9) if n in hli.ax]
        self.cams = [f"ch{n}" for n in self.axes if n <= (3 if len(self.axes) == 3 else 4)]
        hli.ch[1].head.plc_present_w = True
        for n in self.axes:
            axis = hli.ax[n]
            axis.head.plc_present_w = True
            for unit in ("probing_signal", "timestamp", "reference_cam", "release_feedhold"):
                getattr(axis.lr_mc_control, unit).enable_w = True
            axis.lr_mc_control.release_feedhold.command_w = True

    def serve(self, hli, io):
        self.n += 1
        probe = io.probe.ch2
        for n in self.axes:
            axis = hli.ax[n].lr_mc_control
            axis.probing_signal.command_w = probe.input
            axis.timestamp.command_w = probe.latch_pos if probe.input else probe.latch_neg
            if f"ch{n}" in self.cams:
                axis.reference_cam.command_w = getattr(io.cams, f"ch{n}").input
"""
_HEAD: Final = (
    "import numpy as np\nfrom hli_bench.plc import Plc\n\n\nclass Script(Plc):\n    period_us = {period_us}\n"
)

SCRIPTS: Final = {
    "good": "    def cycle(self, hli, io):\n        self.serve(hli, io)\n",
    "restless": """
    def cycle(self, hli, io):
        self.serve(hli, io)
        channel = hli.ch[1].bahn_mc_control
        if self.n == 1:
            for unit in set(dir(channel)) & {"override", "override_feedrate", "override_valid", "feedhold"}:
                getattr(channel, unit).enable_w = True
            if "override_valid" in dir(channel):
                channel.override_valid.command_w = True
            self.override = channel.override_feedrate if "override_feedrate" in dir(channel) else channel.override
        if self.n % 50 == 1:
            self.override.command_w = int(self.random.integers(300, 1000))
            channel.feedhold.command_w = bool(self.random.random() < 0.1)
            axis = hli.ax[int(self.random.choice(self.axes))].lr_mc_control
            axis.release_feedhold.command_w = bool(self.random.random() < 0.9)
        elif self.n % 50 == 26:
            for n in self.axes:
                hli.ax[n].lr_mc_control.release_feedhold.command_w = True
""",
    "flicker": """
    def cycle(self, hli, io):
        self.serve(hli, io)
        n = int(self.random.choice(self.axes))
        axis = hli.ax[n]
        unit = str(self.random.choice(["probing_signal", "timestamp", "reference_cam"]))
        getattr(axis.lr_mc_control, unit).enable_w = bool(self.random.random() < 0.8)
        if self.random.random() < 0.01:
            axis.head.plc_present_w = bool(self.random.random() < 0.9)
""",
    "looker": "    def cycle(self, hli, io):\n        self.seen = hli.ax[1].lr_mc_control.probing_signal.state_r\n",
    "silent": "    def cycle(self, hli, io):\n        pass\n",
    "fails": """
    def cycle(self, hli, io):
        self.serve(hli, io)
        if self.n == 200 + {seed} % 1000:
            raise ValueError("as planned")
""",
}
"""What a script does in its cycle, by name."""
SERVING: Final = tuple(name for name in SCRIPTS if name != "looker")
"""Scripts that serve axes: of these a bench has one."""


def script(name: str, *, period_us: int = 1000, seed: int = 1) -> str:
    """Return the text of a PLC script."""
    text = _HEAD + _ALL + SCRIPTS[name]
    if name == "looker":
        text = _HEAD + SCRIPTS[name]
    return text.replace("{period_us}", str(period_us)).replace("{seed}", str(seed))
