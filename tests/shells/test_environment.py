"""The doctor's probes against the computer the tests run on, and against conditions made here."""

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from hli_bench.shells import environment
from hli_bench.shells.realtime import ask


@pytest.fixture
def occupied() -> Iterator[int]:
    """A loopback port that somebody listens on."""
    with socket.create_server((environment.LOOPBACK, 0)) as server:
        yield server.getsockname()[1]


def _interface(folder: Path, name: str, kind: int) -> None:
    (folder / name).mkdir()
    (folder / name / "type").write_text(f"{kind}\n", encoding="ascii")


def test_every_finding_has_a_name_of_its_own_a_detail_and_an_advice_sentence() -> None:
    found = environment.findings()
    names = [finding.name for finding in found]
    assert len(set(names)) == len(names)
    assert all(finding.detail and finding.advice.endswith(".") for finding in found)
    assert {"python", "cores", "socketcan", "vcan0", "real-time", "locked-memory", "port-7447"} <= set(names)


def test_looking_twice_gives_the_same() -> None:
    assert environment.findings() == environment.findings()


def test_this_interpreter_is_new_enough_and_an_old_one_is_not() -> None:
    assert environment.python_version().ok
    old = environment.python_version((3, 10))
    assert not old.ok
    assert "3.10" in old.detail
    assert "3.11" in old.advice


def test_an_occupied_port_is_found_and_free_again_afterwards(occupied: int) -> None:
    finding = environment.loopback_port(occupied, "Zenoh")
    assert not finding.ok
    assert "EADDRINUSE" in finding.detail
    assert str(occupied) in finding.advice


def test_a_free_port_stays_free() -> None:
    with socket.create_server((environment.LOOPBACK, 0)) as server:
        port = server.getsockname()[1]
    assert environment.loopback_port(port, "Zenoh").ok
    socket.create_server((environment.LOOPBACK, port)).close()


def test_only_can_interfaces_are_listed(tmp_path: Path) -> None:
    _interface(tmp_path, "eth0", 1)
    _interface(tmp_path, "vcan1", 280)
    _interface(tmp_path, "can0", 280)
    assert environment.can_interfaces(tmp_path) == ["can0", "vcan1"]
    missing = environment.can_interface("vcan0", tmp_path)
    assert not missing.ok
    assert "can0, vcan1" in missing.detail
    assert environment.can_interface("vcan1", tmp_path).ok


def test_the_interface_finding_agrees_with_what_the_kernel_lists() -> None:
    listed = {name for _, name in socket.if_nameindex()}
    assert set(environment.can_interfaces()) <= listed
    assert environment.can_interface("vcan0").ok == ("vcan0" in listed)


def test_no_can_interface_without_can_sockets() -> None:
    assert environment.can_sockets().ok or not environment.can_interfaces()


def test_who_may_not_clear_the_flag_about_children_gets_the_schedule_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    allowed, flag = os.sched_setscheduler, os.SCHED_RESET_ON_FORK
    before = os.sched_getscheduler(0)

    def unprivileged(pid: int, policy: int, parameter: os.sched_param) -> None:
        if os.sched_getscheduler(pid) & flag and not policy & flag:
            raise PermissionError
        allowed(pid, policy, parameter)

    with monkeypatch.context() as patched:
        patched.setattr(os, "sched_setscheduler", unprivileged)
        environment.real_time_priority()
        ask(realtime=True).close()
    assert os.sched_getscheduler(0) & ~flag == before
    allowed(0, before, os.sched_param(0))


def test_trying_real_time_leaves_the_schedule_as_it_was() -> None:
    before = os.sched_getscheduler(0)
    environment.real_time_priority()
    assert os.sched_getscheduler(0) == before


def _finding_under_limit(probe: str, limit: str, value: int) -> str:
    """The finding of a child process whose soft limit was lowered; lowering it here could not be undone."""
    code = (
        "import resource; from hli_bench.shells import environment\n"
        f"hard = resource.getrlimit(resource.{limit})[1]\n"
        f"resource.setrlimit(resource.{limit}, ({value}, hard))\n"
        f"finding = environment.{probe}(); print(finding.ok, finding.detail)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return run.stdout.strip()


def test_a_low_limit_of_locked_memory_is_found() -> None:
    assert _finding_under_limit("locked_memory", "RLIMIT_MEMLOCK", 65536) == "False 64 KiB"


def test_a_cache_that_can_be_made_is_fine(tmp_path: Path) -> None:
    finding = environment.compiler_cache({"NUMBA_CACHE_DIR": str(tmp_path / "a" / "b")})
    assert finding.ok
    assert not (tmp_path / "a").exists()


def test_a_cache_below_a_file_is_found_and_the_variable_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="ascii")
    finding = environment.compiler_cache({"NUMBA_CACHE_DIR": str(tmp_path / "file" / "cache")})
    assert not finding.ok
    assert "NUMBA_CACHE_DIR" in finding.advice


def test_without_the_variable_the_cache_is_the_user_s_or_lies_beside_the_laws(tmp_path: Path) -> None:
    finding = environment.compiler_cache({"XDG_CACHE_HOME": str(tmp_path)})
    assert finding.detail == str(tmp_path / "hli-bench")
    (tmp_path / "hli-bench").write_text("a file")
    finding = environment.compiler_cache({"XDG_CACHE_HOME": str(tmp_path)})
    assert finding.detail.endswith("hli_bench/laws/__pycache__")
