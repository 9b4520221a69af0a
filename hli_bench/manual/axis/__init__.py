"""Axis parameters as one tree of frozen dataclasses; the nesting is the path (`axis.kenngr.vb_messen`)."""

from dataclasses import dataclass, field

from hli_bench.manual.axis.antr import Antr
from hli_bench.manual.axis.getriebe import Getriebe
from hli_bench.manual.axis.kenngr import Kenngr
from hli_bench.manual.axis.kopf import Kopf
from hli_bench.manual.axis.lr_hw import LrHw
from hli_bench.manual.axis.lr_param import LrParam
from hli_bench.manual.axis.meas_simu import MeasSimu
from hli_bench.manual.sheet import array_of


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisParams:
    """One axis list. `getriebe[0]` and `lr_hw[0]` always exist."""

    kopf: Kopf = field(default_factory=Kopf)
    kenngr: Kenngr = field(default_factory=Kenngr)
    getriebe: tuple[Getriebe, ...] = field(default=(Getriebe(),), metadata=array_of(Getriebe, 4))
    lr_param: LrParam = field(default_factory=LrParam)
    lr_hw: tuple[LrHw, ...] = field(default=(LrHw(),), metadata=array_of(LrHw, 2))
    antr: Antr = field(default_factory=Antr)
    meas_simu: MeasSimu = field(default_factory=MeasSimu)
