"""How long an attached PLC may be silent in real pace, by machine time."""

from hli_bench.base.time import Ns
from hli_bench.bench.plc_ports import ANSWER_S, SILENCE_S, AttachedPlc
from hli_bench.wire.hli import Commands

CYCLE_NS = 1_000_000
CYCLES_A_SECOND = 1000


class Answers:
    """A door behind which the PLC answers until a cycle."""

    def __init__(self, last: int) -> None:
        self.last = last

    def commands(self, plc: str, cycle: int, timeout_s: float) -> Commands | None:
        raise AssertionError("not awaited")

    def latest_commands(self, plc: str, cycle: int, oldest: int = 0) -> Commands | None:
        assert oldest < cycle
        return Commands(plc, cycle, ()) if cycle <= self.last else None


def lost_in(last: int, period: int) -> int:
    """Return the cycle in which a PLC that answers until `last` counts as gone."""
    plc = AttachedPlc("p", period, Answers(last), lambda *_: None, lockstep=False, cycle_ns=CYCLE_NS)
    cycle = 0
    while plc.tick(cycle := cycle + period, Ns(0), bytearray(), {}) is not None:
        assert cycle < 100 * CYCLES_A_SECOND
    return cycle


def test_one_that_has_answered_may_be_silent_for_its_period_and_a_second() -> None:
    assert lost_in(last=500, period=1) == 500 + 1 + SILENCE_S * CYCLES_A_SECOND + 1
    assert lost_in(last=500, period=250) == 500 + 250 + SILENCE_S * CYCLES_A_SECOND + 250


def test_one_that_has_not_answered_yet_has_the_time_of_lock_step() -> None:
    assert lost_in(last=0, period=1) == 1 + 1 + ANSWER_S * CYCLES_A_SECOND + 1
