"""What this computer offers a bench and what to do about the rest: the probes behind `hli-bench doctor`."""

import errno
import os
import socket
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from hli_bench.base.endpoints import DEFAULT_PORT
from hli_bench.laws import cache
from hli_bench.shells.realtime import PRIORITY, give_back, take_fifo

LEAST_PYTHON: Final = (3, 11)
LEAST_LOCKED_BYTES: Final = 1 << 30
"""What a paced bench may lock, so that no page fault delays a cycle; `demo` has 0.4 GB of addresses (decided here)."""

PORTS: Final[Mapping[int, str]] = {DEFAULT_PORT: "Zenoh", 29536: "socketcand"}
"""The loopback ports a bench serves by default, and for what."""

LOOPBACK: Final = "127.0.0.1"
_ARPHRD_CAN: Final = 280
_NETWORK_CLASS: Final = Path("/sys/class/net")


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing looked at: `ok` is whether a bench finds what it wants, `advice` what to do if not."""

    name: str
    ok: bool
    detail: str
    advice: str


def findings() -> list[Finding]:
    """Look at everything a bench may use. Nothing is changed, no port stays bound."""
    return [
        python_version(),
        cores(),
        can_sockets(),
        can_interface("vcan0"),
        real_time_priority(),
        locked_memory(),
        *(loopback_port(port, purpose) for port, purpose in PORTS.items()),
        compiler_cache(),
    ]


def python_version(version: tuple[int, int] = sys.version_info[:2]) -> Finding:
    """Say whether the interpreter is new enough."""
    least = ".".join(map(str, LEAST_PYTHON))
    return Finding(
        "python",
        version >= LEAST_PYTHON,
        "Python " + ".".join(map(str, version)),
        f"Install Python {least} or newer and make the environment again: make clean, make run.",
    )


def cores() -> Finding:
    """Say whether a paced bench and a PLC beside it have a core each."""
    count = len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1
    return Finding(
        "cores",
        count >= 2,
        f"{count} usable",
        "Give the bench two cores or run it in free pace: a paced bench and its PLC share badly.",
    )


def can_sockets() -> Finding:
    """Say whether the kernel knows SocketCAN at all (AF_CAN)."""
    advice = (
        "Use --can inproc (the default), load the kernel's CAN modules "
        "(modprobe can-raw), or run in the virtual machine of tools/vcan_vm.sh."
    )
    if sys.platform != "linux":
        return Finding("socketcan", False, f"{sys.platform} has no AF_CAN", advice)
    try:
        socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW).close()
    except OSError as error:
        return Finding("socketcan", False, f"AF_CAN: {_reason(error)}", advice)
    return Finding("socketcan", True, "AF_CAN sockets open", advice)


def can_interface(name: str, network_class: Path = _NETWORK_CLASS) -> Finding:
    """Say whether the CAN interface `name` is there, and which others are."""
    present = can_interfaces(network_class)
    return Finding(
        name,
        name in present,
        "CAN interfaces: " + (", ".join(present) or "none"),
        f"As root: modprobe vcan; ip link add dev {name} type vcan; ip link set {name} up.",
    )


def can_interfaces(network_class: Path = _NETWORK_CLASS) -> list[str]:
    """Return the names of the CAN interfaces of this computer, sorted."""
    return [
        file.parent.name
        for file in sorted(network_class.glob("*/type"))
        if file.read_text(encoding="ascii").strip() == str(_ARPHRD_CAN)
    ]


def real_time_priority() -> Finding:
    """Say whether this user may run under SCHED_FIFO; tried on the calling thread, then undone."""
    advice = (
        "For a calm paced bench put '@realtime - rtprio 50' into /etc/security/limits.d and join that group "
        "or run as root; free pace needs none of it."
    )
    if sys.platform != "linux":
        return Finding("real-time", False, f"{sys.platform} has no SCHED_FIFO", advice)
    try:
        before = take_fifo()
    except OSError as error:
        return Finding("real-time", False, f"SCHED_FIFO: {_reason(error)}", advice)
    give_back(*before)
    return Finding("real-time", True, f"SCHED_FIFO with priority {PRIORITY} allowed", advice)


def locked_memory() -> Finding:
    """Say whether a paced bench may lock its memory."""
    advice = (
        "For a calm paced bench put '@realtime - memlock unlimited' into /etc/security/limits.d and join "
        "that group; free pace needs none of it."
    )
    if sys.platform == "win32":
        return Finding("locked-memory", False, "no such limit on Windows", advice)
    import resource

    soft, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    unlimited = soft == resource.RLIM_INFINITY
    detail = "unlimited" if unlimited else f"{soft // 1024} KiB"
    return Finding("locked-memory", unlimited or soft >= LEAST_LOCKED_BYTES, detail, advice)


def loopback_port(port: int, purpose: str) -> Finding:
    """Say whether a TCP port of the loopback interface is free; binds it for an instant."""
    advice = f"End what listens on {LOOPBACK}:{port} (ss -ltnp shows it), or choose another for {purpose}."
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        # A connection closed a moment ago does not keep a bench from listening, so it must not count here.
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port))
        except OSError as error:
            return Finding(f"port-{port}", False, f"{purpose}: {_reason(error)}", advice)
    return Finding(f"port-{port}", True, f"{purpose}: free", advice)


def compiler_cache(environment: Mapping[str, str] | None = None) -> Finding:
    """Say where the compiled laws are kept between runs: in the first place that can be written."""
    places = cache.places(os.environ if environment is None else environment)
    found = next((place for place in places if _can_be_written(place)), None)
    return Finding(
        "compiler-cache",
        found is not None,
        str(found or places[0]),
        "Set NUMBA_CACHE_DIR to a directory you may write, or every start compiles the laws again.",
    )


def _can_be_written(directory: Path) -> bool:
    """Return whether files can be made in `directory`, or the directory itself be made; found by trying."""
    nearest = next(place for place in (directory.absolute(), *directory.absolute().parents) if place.exists())
    try:
        Path(tempfile.mkdtemp(dir=nearest)).rmdir()
    except OSError:
        return False
    return True


def _reason(error: OSError) -> str:
    """Return an operating system error as its text and symbol."""
    symbol = errno.errorcode.get(error.errno or 0, "")
    return f"{error.strerror} ({symbol})" if symbol else str(error)
