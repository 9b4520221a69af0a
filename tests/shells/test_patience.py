"""Who waits is told why, who does not is not bothered."""

from threading import Event

from hli_bench.shells.patience import patience

FOREVER_S = 1e6


def test_what_takes_long_is_announced_while_it_lasts() -> None:
    told = Event()
    with patience(lambda note: told.set() if note == "compiling" else None, "compiling", after_s=0.0):
        assert told.wait(60.0)


def test_what_is_quick_passes_in_silence() -> None:
    notes: list[str] = []
    with patience(notes.append, "compiling", after_s=FOREVER_S):
        pass
    assert notes == []
