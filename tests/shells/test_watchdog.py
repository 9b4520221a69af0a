"""Calls that have to be back in time: what ends them, what does not."""

import os
import queue
import signal
import threading
from collections.abc import Callable
from time import sleep

import pytest

from hli_bench.shells import watchdog
from hli_bench.shells.watchdog import WATCHDOG, Overdue

LIMIT_S = 0.2


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watchdog, "LOOK_S", 0.05)


def compute() -> None:
    while True:
        pass


def catch_exceptions() -> None:
    while True:
        try:
            sleep(3600.0)
        except Exception:
            continue


@pytest.mark.parametrize(
    "endless", [compute, catch_exceptions, lambda: queue.Queue[int]().get(), threading.Event().wait]
)
def test_a_call_that_does_not_return_is_ended(endless: Callable[[], object]) -> None:
    with pytest.raises(Overdue):
        WATCHDOG.limited(LIMIT_S, endless)


def test_a_call_in_time_is_left_alone() -> None:
    assert WATCHDOG.limited(3600.0, divmod, 7, 4) == (1, 3)
    with pytest.raises(ZeroDivisionError):
        WATCHDOG.limited(3600.0, divmod, 7, 0)


def test_a_call_that_catches_everything_is_overdue_when_it_returns() -> None:
    caught = []

    def stubborn() -> str:
        while not caught:
            try:
                sleep(3600.0)
            except BaseException as error:
                caught.append(error)
        return "as if in time"

    with pytest.raises(Overdue):
        WATCHDOG.limited(LIMIT_S, stubborn)
    assert isinstance(caught[0], Overdue)


def test_a_call_in_a_debugger_is_let_be() -> None:
    debugger = {"__name__": "bdb"}
    exec("def prompt(answer):\n    answer.wait()\n    return 'went on'", debugger)
    answer = threading.Event()
    threading.Timer(5 * LIMIT_S, answer.set).start()
    assert WATCHDOG.limited(LIMIT_S, debugger["prompt"], answer) == "went on"


def test_a_call_within_a_call_gives_the_limit_back() -> None:
    def nested() -> None:
        WATCHDOG.limited(3600.0, divmod, 7, 4)
        compute()

    with pytest.raises(Overdue):
        WATCHDOG.limited(LIMIT_S, nested)


def test_a_call_is_not_blamed_for_one_within_it() -> None:
    def survives() -> str:
        with pytest.raises(Overdue):
            WATCHDOG.limited(LIMIT_S, compute)
        return "went on"

    assert WATCHDOG.limited(3600.0, survives) == "went on"


def test_ctrl_c_is_not_lost_in_a_call_that_takes_long_to_clean_up() -> None:
    def interrupted() -> None:
        try:
            raise KeyboardInterrupt
        finally:
            sleep(5 * LIMIT_S)

    with pytest.raises(KeyboardInterrupt):
        WATCHDOG.limited(LIMIT_S, interrupted)


def test_a_call_in_another_thread_is_not_limited() -> None:
    answers = []
    thread = threading.Thread(target=lambda: answers.append(WATCHDOG.limited(0.0, sleep, 2 * LIMIT_S)))
    thread.start()
    thread.join()
    assert answers == [None]


def test_a_program_that_handles_the_signal_itself_keeps_it() -> None:
    fresh = watchdog.Watchdog()
    kept = signal.signal(watchdog.SIGNAL, lambda *_: None)
    try:
        mine = signal.getsignal(watchdog.SIGNAL)
        assert fresh.limited(0.0, divmod, 7, 4) == (1, 3)
        assert signal.getsignal(watchdog.SIGNAL) is mine
    finally:
        signal.signal(watchdog.SIGNAL, kept)


def test_a_forked_child_watches_too() -> None:
    WATCHDOG.limited(1.0, divmod, 7, 4)
    child = os.fork()
    if child == 0:
        try:
            WATCHDOG.limited(LIMIT_S, sleep, 3600.0)
        except Overdue:
            os._exit(7)
        finally:
            os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
