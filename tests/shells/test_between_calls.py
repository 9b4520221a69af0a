"""Clients of a bench that a script runs are answered also while the script does something else."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

from hli_bench import Bench
from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.shells.zenoh_client import HliClient

SHORT = "N10 G04 0.01\nN20 M30\n"
ENDLESS = "N10 $WHILE 1\nN20 G04 0.1\nN30 $ENDWHILE\nN40 M30\n"


def elsewhere(endpoint: str, *words: str) -> Any:
    command = [str(Path(sys.executable).with_name("hli-bench")), *words, "--connect", endpoint]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_reset_between_programs_is_answered_when_it_has_taken_effect(endpoint: str, pace: str) -> None:
    with Bench("demo", plc=[], zenoh=endpoint, pace=pace) as bench:
        assert bench.run(SHORT).completed
        before = bench.engine.cycle
        done = elsewhere(endpoint, "reset")
        assert done.returncode == 0, done.stderr
        assert bench.engine.cycle > before
        assert bench.run(SHORT).completed


def test_a_write_between_programs_is_there_when_it_is_answered(endpoint: str) -> None:
    path = "ax/3/lr_mc_control/timestamp/command_w"
    with Bench("demo", plc=[], zenoh=endpoint) as bench:
        bench.start_up()
        assert elsewhere(endpoint, "hli", "set", path, "42").returncode == 0
        assert elsewhere(endpoint, "hli", "get", path).stdout.strip() == "42"


def test_a_reset_that_aborts_the_program_of_a_script_is_answered(endpoint: str) -> None:
    with Bench("demo", plc=[], zenoh=endpoint, pace="real") as bench:
        bench.start_up()
        answers: list[Any] = []
        asking = Thread(target=lambda: answers.append(elsewhere(endpoint, "reset")))
        asking.start()
        result = bench.run(ENDLESS, limit_s=60)
        asking.join()
    assert result.status == "aborted"
    assert result.sim_s < 60
    assert answers[0].returncode == 0, answers[0].stderr


def test_a_reset_of_run_with_an_endpoint_is_answered(
    start: Any, program: Callable[[str], Path], endpoint: str
) -> None:
    command = start("run", program(ENDLESS), "--plc", "none", "--pace", "real", "--zenoh", endpoint)
    client = None
    while client is None:
        try:
            client = HliClient(endpoint)
        except EnvironmentLacks:
            assert command.process.poll() is None, command.err
            time.sleep(0.1)
    with client:
        while client.state()["state"] != "active":
            time.sleep(0.1)
        assert client.reset() == ""
    assert command.end() == 130


def test_a_script_takes_no_programs_from_clients(endpoint: str) -> None:
    with Bench("demo", plc=[], zenoh=endpoint) as bench:
        bench.start_up()
        with HliClient(endpoint) as client, pytest.raises(InputError, match="takes none from clients"):
            client.run(SHORT)


# --- processes of the machine


def worker(bench: Any, name: str) -> int:
    for pid in bench.command.session():
        if f"{name}_process" in Path(f"/proc/{pid}/cmdline").read_text():
            return int(pid)
    raise AssertionError(name)


@pytest.mark.parametrize("name", ["drives", "terminals"])
def test_a_process_that_is_killed_shows_in_the_state_of_an_idle_bench(serve: Any, name: str) -> None:

    bench = serve("--plc", "none", "--pace", "free")
    assert bench.state()["processes"] == {"drives": "running", "terminals": "running"}
    os.kill(worker(bench, name), signal.SIGKILL)
    assert bench.state()["processes"][name] == "ended with status -9"
    with bench.client() as client, pytest.raises((InputError, EnvironmentLacks)):
        client.run("N10 G04 0.5\nN20 M30\n")
    assert bench.command.end() == 3


@pytest.mark.parametrize("pace", ["free", "real"])
def test_a_process_that_is_stopped_shows_in_the_state(serve: Any, pace: str) -> None:

    bench = serve("--plc", "none", "--pace", pace)
    pid = worker(bench, "drives")
    os.kill(pid, signal.SIGSTOP)
    try:
        assert bench.state()["processes"]["drives"] == "stopped"
    finally:
        os.kill(pid, signal.SIGCONT)
    bench.settled(lambda state: state["processes"]["drives"] == "running")
    with bench.client() as client:
        assert client.run(SHORT)["status"] == "completed"
