# hli-bench: `make run` shows it, `make test` proves it. Needs Python 3.11 or newer with venv; see README.md.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help

BIN := .venv/bin
# VCAN=no leaves the SocketCAN tests out of `make test`, for a computer that can offer no vcan at all.
VCAN ?= yes
# How many inputs of each kind `make fuzz` tries.
FUZZ ?= 20000
# How many processes share the tests.
WORKERS ?= 2

.PHONY: help run test lint pytest test-vcan vcan-where-possible fuzz coverage-req mutants swarm bench lock clean

help: ## Lists the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-13s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

run: .venv/.runtime ## Runs the probing program on the machine demo and writes out/report.html
	@mkdir -p out
	$(BIN)/hli-bench run programs/probe.nc --set plc.0.process=true \
	  --set plant.probe.Z.face_mm=100 --set plant.probe.Z.material=below \
	  --report out/report.html --result out/result.json --trace out/trace.mcap

test: lint pytest $(if $(filter yes,$(VCAN)),vcan-where-possible) ## Lint, types, import contracts and all tests

lint: .venv/.dev ## Lint, format, types, import contracts
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

pytest: .venv/.dev ## The tests that need no CAN interface
	$(BIN)/python -m pytest -m "not vcan" -n $(WORKERS) --dist loadfile --ignore tests/shells tests
	$(BIN)/python -m pytest -m "not vcan" tests/shells  # in real pace too: no other tests beside them

# User-mode Linux ends at once on processors whose register state it cannot hold (AMX); no other test may fail for that.
vcan-where-possible: .venv/.dev
	@if tools/vcan_vm.sh true > /dev/null 2>&1; then $(MAKE) --no-print-directory test-vcan; \
	else echo "make test: the tests on SocketCAN are LEFT OUT, this computer has no way to a vcan0; make test-vcan says why" >&2; fi

fuzz: .venv/.dev ## Spoilt inputs of every kind, FUZZ=N of each (default 20000)
	HLI_BENCH_FUZZ=$(FUZZ) $(BIN)/python -m pytest tests/fuzz

test-vcan: .venv/.dev ## The tests on a real SocketCAN vcan0, in a virtual machine where the host has none
	tools/vcan_vm.sh $(BIN)/python -m pytest -m vcan tests/vcan

coverage-req: .venv/.dev ## How each requirement line is shown: behaviour, parsing, table; open ones begin with open:
	$(BIN)/python tools/coverage_req.py

mutants: .venv/.dev ## Breaks the code on purpose: how many of the changes the marked tests notice
	$(BIN)/python tools/mutants.py

swarm: .venv/.dev ## 15 minutes of random benches, from a seed that the date gives; docs/net.md
	seed=$$(date +%s); $(BIN)/python tools/swarm.py --seeds $$seed:$$((seed + 1000000)) --minutes 15

bench: .venv/.dev ## The benchmarks; they print ratios measured side by side
	for benchmark in benchmarks/[a-z]*.py; do $(BIN)/python "$$benchmark"; done

lock: ## Rewrites the lock files from pyproject.toml (needs uv)
	tools/lock.sh

clean: ## Removes the environment and everything generated
	rm -rf .venv out build dist .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# The stamps lie in .venv: no environment, no stamp. The dev lock holds the runtime lock, so .dev serves both.
.venv/.runtime: requirements.lock pyproject.toml
	tools/venv.sh requirements.lock
	@touch $@

.venv/.dev: requirements-dev.lock pyproject.toml
	tools/venv.sh requirements-dev.lock
	@touch .venv/.runtime $@
