#!/usr/bin/env bash
# Runs a command where a real SocketCAN interface vcan0 is up: tools/vcan_vm.sh COMMAND [ARGUMENT]...
#
# Three ways, the first that works: the host's own vcan0; a network namespace with a vcan0 of its own (kernel with the
# vcan module, no privileges needed where user namespaces are allowed); User-mode Linux, a kernel that runs as an
# ordinary process on the host's files. VCAN_WAY=host|namespace|vm takes one of them; VCAN_SECONDS limits the command
# (600), VCAN_MEMORY the virtual machine (1G). Exit status: the command's; 124 time limit; 3 no way to a vcan0.
set -euo pipefail

top=$(cd "$(dirname "$0")/.." && pwd -P)
seconds=${VCAN_SECONDS:-600}
scratch=
machine=

say() {
  echo "vcan: $*" >&2
}

# Brings up loopback (Zenoh wants multicast on it) and vcan0 in the network namespace it is run in.
readonly bring_up='ip link set lo up multicast on && ip route replace 224.0.0.0/4 dev lo &&
  ip link add dev vcan0 type vcan && ip link set vcan0 up'

host_has_vcan() {
  [ "$(cat /sys/class/net/vcan0/flags 2> /dev/null)" != "" ] && [ $(($(cat /sys/class/net/vcan0/flags) & 1)) = 1 ]
}

in_namespace() {
  local as_root=()
  [ "$(id -u)" = 0 ] || as_root=(--user --map-root-user)
  unshare "${as_root[@]}" --net sh -c "$bring_up"' && exec "$@"' sh "$@"
}

# Prints the directory that holds usr/bin/linux.uml, empty for the installed package; unpacks it into .venv if need be.
find_kernel() {
  local unpacked=$top/.venv/uml
  if [ -x /usr/bin/linux.uml ]; then
    return
  fi
  if [ ! -x "$unpacked/usr/bin/linux.uml" ]; then
    command -v apt-get dpkg-deb > /dev/null || return 1
    say "fetching Debian's user-mode-linux into .venv/uml (once, 41 MB)"
    fetch_kernel "$unpacked" || return 1
  fi
  echo "$unpacked"
}

# Unpacking needs no privileges and leaves the computer as it was; only stale package lists need root to renew.
fetch_kernel() {
  local work
  work=$(mktemp -d)
  (
    cd "$work"
    chmod 755 . # apt fetches as a user of its own
    apt-get download --quiet=2 user-mode-linux ||
      { [ "$(id -u)" = 0 ] && apt-get update --quiet=2 && apt-get download --quiet=2 user-mode-linux; }
    mkdir -p "$1.part"
    dpkg-deb --extract user-mode-linux_*.deb "$1.part"
    mv "$1.part" "$1"
  ) > /dev/null 2> "$work/log" && { rm -rf "$work"; return; }
  tail -n 3 "$work/log" >&2
  rm -rf "$work" "$1.part"
  return 1
}

lacks() {
  say "no way to a vcan0 interface: the kernel has none to offer and User-mode Linux cannot be started."
  say "lacking: $*"
  say "either  sudo modprobe vcan && sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up"
  say "or      sudo apt-get install user-mode-linux iproute2 perl   (Debian, Ubuntu; x86-64)"
  exit 3
}

# numpy and glibc choose AVX-512 by themselves; User-mode Linux loses those registers in a signal.
without_avx512() {
  export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512BW
  export NUMBA_CPU_NAME=x86-64-v3 NUMBA_CACHE_DIR=$top/.venv/numba-vm
  if grep -q avx512 /proc/cpuinfo && [ -x "$top/.venv/bin/python" ]; then
    export OPENBLAS_CORETYPE=Haswell
    NPY_DISABLE_CPU_FEATURES=$("$top/.venv/bin/python" -c '
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__
print(*(name for name in __cpu_dispatch__ if __cpu_features__.get(name) and name.startswith(("AVX512", "X86_V4"))))')
    export NPY_DISABLE_CPU_FEATURES
  fi
}

# The kernel leads a process group of its own and writes its id to a file; nothing of it may outlive this script.
reap() {
  [ -z "$machine" ] || kill "$machine" 2> /dev/null || true
  [ ! -s "$scratch/vm/pid" ] || kill -KILL -- "-$(cat "$scratch/vm/pid")" 2> /dev/null || true
  rm -rf "$scratch"
}

in_machine() {
  local kernel modules cpu status=0 printer
  kernel=$1
  shift
  modules=$kernel/usr/lib/uml/modules/$("$kernel/usr/bin/linux.uml" --version)/kernel
  scratch=$(mktemp -d)
  trap reap EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM HUP
  without_avx512
  export -p > "$scratch/environment"
  printf '%q ' cd "$PWD" > "$scratch/command"
  printf '&& exec timeout --kill-after=5 %q ' "$seconds" >> "$scratch/command"
  printf '%q ' "$@" >> "$scratch/command"
  mkfifo "$scratch/out"
  cat "$scratch/out" &
  printer=$!
  # The machine has one CPU. Pinned to one of the host's, a system call needs no wake-up on another: four times faster.
  cpu=$(taskset -cp $$ | grep -oE '[0-9]+$')
  # What the kernel does not know on its command line, KEY=value, it hands to init as environment.
  timeout --kill-after=5 $((seconds + 60)) taskset -c "$cpu" "$kernel/usr/bin/linux.uml" \
    mem="${VCAN_MEMORY:-1G}" root=/dev/root rootfstype=hostfs rootflags=/ ro init="$top/tools/vcan_init.sh" \
    VCAN_SCRATCH="$scratch" VCAN_TOP="$top" VCAN_MODULES="$modules" \
    quiet loglevel=1 con=null con0=null,fd:2 con1=null,fd:1 uml_dir="$scratch/" umid=vm \
    > "$scratch/out" 2> "$scratch/log" < /dev/null &
  machine=$!
  wait "$machine" || status=$?
  machine=
  wait "$printer"
  if [ -s "$scratch/status" ]; then
    status=$(cat "$scratch/status")
  elif [ "$status" != 124 ]; then
    cat "$scratch/log" >&2
    say "the virtual machine ended before the command did"
    status=3
  fi
  exit "$status"
}

[ $# -gt 0 ] || { say "no command given: tools/vcan_vm.sh COMMAND [ARGUMENT]..."; exit 2; }
way=${VCAN_WAY:-any}

if [[ $way =~ ^(any|host)$ ]] && host_has_vcan; then
  exec timeout --kill-after=5 "$seconds" "$@"
fi
if [[ $way =~ ^(any|namespace)$ ]] && in_namespace true 2> /dev/null; then
  in_namespace timeout --kill-after=5 "$seconds" "$@"
  exit
fi
[[ $way =~ ^(any|vm)$ ]] || lacks "the way $way, which VCAN_WAY asks for"
for tool in ip perl taskset timeout; do
  command -v "$tool" > /dev/null || lacks "the command $tool"
done
[ "$(uname -sm)" = "Linux x86_64" ] || lacks "Linux on x86-64 (this is $(uname -sm))"
kernel=$(find_kernel) || lacks "the package user-mode-linux"
in_machine "$kernel" "$@"
