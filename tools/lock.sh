#!/usr/bin/env bash
# Rewrites requirements.lock (runtime and build) and requirements-dev.lock (the same plus the dev extra) from
# pyproject.toml, for every platform, with hashes. Versions already locked stay; `tools/lock.sh --upgrade` renews them.
# Needs uv (python3 -m pip install uv).
set -euo pipefail
cd "$(dirname "$0")/.."
command -v uv > /dev/null || { echo "lock: uv is missing: python3 -m pip install uv" >&2; exit 3; }

compile() {
  uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate \
    --no-emit-index-url --no-emit-find-links --custom-compile-command tools/lock.sh "$@"
}

compile "$@" pyproject.toml tools/build.in --output-file requirements.lock
# The shared part has to be the same release in both files, or `make run` after `make test` would be another bench.
compile "$@" --extra dev --constraint requirements.lock pyproject.toml tools/build.in --output-file requirements-dev.lock
