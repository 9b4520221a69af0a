#!/bin/bash
# First process of the virtual machine that tools/vcan_vm.sh starts: brings vcan0 up, runs the command, powers off.
# The host's files are the root, read-only; the checkout and the scratch directory are mounted again, writable.

export PATH=/usr/sbin:/usr/bin:/sbin:/bin

power_off() {
  sync
  echo o > /proc/sysrq-trigger
  sleep 60
}

fail() {
  echo "vcan machine: $*" > /dev/console
  power_off
}

# Debian's kmod may be absent, so the modules are loaded with the system call itself (313 is finit_module).
load_modules() {
  perl -e '
    for my $file (@ARGV) {
      open(my $module, "<", $file) or die "$file: $!\n";
      my $options = "";
      syscall(313, fileno($module), $options, 0) == 0 or die "$file: $!\n";
    }' "$@"
}

mount_writable() {
  mkdir -p "$1" && mount -t hostfs none "$1" -o "$1" || fail "cannot mount $1"
}

mount -t proc proc /proc
mount -t sysfs sysfs /sys
mkdir -p /dev/pts /dev/shm
mount -t devpts devpts /dev/pts
ln -s /proc/self/fd /dev/fd
ln -s fd/0 /dev/stdin
ln -s fd/1 /dev/stdout
ln -s fd/2 /dev/stderr
load_modules "$VCAN_MODULES"/lib/crc-ccitt.ko "$VCAN_MODULES"/net/ipv6/ipv6.ko \
  "$VCAN_MODULES"/net/can/{can,can-raw,can-bcm}.ko \
  "$VCAN_MODULES"/drivers/net/can/{dev/can-dev,vcan}.ko || fail "the CAN modules do not load"

# The scratch directory may lie below /tmp, which is about to be hidden: what is needed of it is opened first.
exec 4< "$VCAN_SCRATCH/environment" 5< "$VCAN_SCRATCH/command"
for directory in /dev/shm /tmp /run; do
  mount -t tmpfs -o mode=1777 tmpfs "$directory" || fail "cannot mount $directory"
done
mount_writable "$VCAN_TOP"
mount_writable "$VCAN_SCRATCH"

# Zenoh looks for multicast on loopback even where scouting is off.
ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo || fail "no loopback"
ip link add dev vcan0 type vcan && ip link set vcan0 up || fail "no vcan0"

# The command writes to a pipe, not to the console: what asks whether it talks to a terminal gets the true answer.
stty -opost < /dev/tty1
exec 3> >(exec cat > /dev/tty1)
console=$!
(
  source /dev/fd/4
  export HOME=/tmp TMPDIR=/tmp
  source /dev/fd/5
) >&3 2>&1 3>&- < /dev/null
echo $? > "$VCAN_SCRATCH/status"
exec 3>&-
# A process the command left behind would hold the pipe open for ever.
(sleep 3 && kill "$console") 2> /dev/null &
wait "$console"
power_off
