#!/usr/bin/env bash
# Makes or brings up to date .venv from a lock file: tools/venv.sh LOCKFILE. PYTHON=... chooses the interpreter.
set -euo pipefail
cd "$(dirname "$0")/.."
lock=$1
candidates=${PYTHON:-python3 python3.14 python3.13 python3.12 python3.11}

lack() {
  echo "hli-bench cannot be set up: $*" >&2
  exit 3
}

new_enough() {
  "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2> /dev/null
}

interpreter() {
  local name
  for name in $candidates; do
    if new_enough "$name"; then
      echo "$name"
      return
    fi
  done
  lack "no Python 3.11 or newer among: $candidates. Install one," \
    "or name one: make PYTHON=/path/to/python3.11"
}

# A .venv whose interpreter has gone (the clone was moved, Python was upgraded) is of no use: make it again.
if ! new_enough .venv/bin/python || ! .venv/bin/python -m pip --version > /dev/null 2>&1; then
  python=$(interpreter)
  "$python" -c 'import venv, ensurepip' 2> /dev/null ||
    lack "$python has no venv module; on Debian and Ubuntu: apt-get install python3-venv"
  "$python" -m venv --clear .venv
fi

pip=(.venv/bin/python -m pip --quiet --disable-pip-version-check)
echo "installing what $lock lists into .venv ..." >&2
"${pip[@]}" install --require-hashes --requirement "$lock"
# The build tools stand in the lock; without isolation pip does not fetch newer ones.
"${pip[@]}" install --no-build-isolation --no-deps --editable .
# Where PYTHONDONTWRITEBYTECODE is set, every command would compile the package anew: 0.2 s of its start.
.venv/bin/python -m compileall -q hli_bench drives/hli_bench_drives
