"""A bench that stays up: what `hli-bench serve` does."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from hli_bench.base.endpoints import DEFAULT_ENDPOINT
from hli_bench.bench.bench import Bench
from hli_bench.runtime.engine import Observer


def serve(
    machine: str | Path,
    settings: Mapping[str, object],
    *,
    plc: Sequence[str | Path] | None,
    pace: str,
    can: str,
    zenoh: str | None,
    on_line: Callable[[str], None],
    observers: Sequence[Observer] = (),
    realtime: bool = False,
    on_note: Callable[[str], None] = lambda _: None,
) -> None:
    """Start kernel, drives and terminals as processes and serve clients until KeyboardInterrupt.

    `on_line` gets a line for people when the bench is up; `on_note` as of `Bench`. Raises as `Bench` does.
    """
    endpoint = zenoh or DEFAULT_ENDPOINT
    with Bench(
        machine,
        settings,
        plc=plc,
        pace=pace,
        can=can,
        zenoh=endpoint,
        processes=True,
        observers=observers,
        realtime=realtime,
        on_note=on_note,
    ) as bench:
        bench.start_up()
        on_line(f"{bench.config.name} is up on {endpoint}, cycle {bench.config.cycle_us} us, pace {pace}")
        bench.serve()
