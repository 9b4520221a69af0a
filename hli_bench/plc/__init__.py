"""The PLC: cyclic tasks of user scripts, IEC blocks. A script imports what it needs from here only."""

from hli_bench.plc.function_blocks import CTU, F_TRIG, R_TRIG, RS, SR, TOF, TON, TP
from hli_bench.plc.script import Plc, load, period_of
from hli_bench.plc.task import Task

__all__ = ["CTU", "F_TRIG", "RS", "R_TRIG", "SR", "TOF", "TON", "TP", "Plc", "Task", "load", "period_of"]
