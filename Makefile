# One definition of every check, for a developer and for CI: `make help` lists the targets.
PYTHON ?= python3
RUN := .venv/bin
TEST := .venv-test/bin
DEV := .venv-dev/bin

.DEFAULT_GOAL := help
.PHONY: help run dev quick test clean wheel

help:  ## show this list
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /\1\t/' | expand -t 8

run: fresh = .venv
run: wheel  ## build and install rga in a fresh environment, and run the twin of the case study
	$(RUN)/python -m pip install --quiet "$$(echo dist/rga-*.whl)[twin]"
	$(RUN)/python examples/case_study.py

dev:  ## once, and after a change of Rust: an environment that uses the sources as they are
	$(PYTHON) -m venv .venv-dev
	$(DEV)/python -m pip install --quiet --editable ".[test]"

quick:  ## lint, types and unit tests in the environment of `make dev`, within a minute
	$(DEV)/ruff check
	$(DEV)/ruff format --check
	$(DEV)/mypy --strict python tests/typing
	$(DEV)/lint-imports
	$(DEV)/python -m pytest tests/unit --quiet --numprocesses auto --dist worksteal

test: fresh = .venv-test
test: export PYO3_PYTHON = $(abspath $(TEST)/python)
test: wheel  ## build and install rga in a fresh environment, and run every check
	$(TEST)/python -m pip install --quiet "$$(echo dist/rga-*.whl)[test]"
	$(TEST)/ruff check
	$(TEST)/ruff format --check
	$(TEST)/mypy --strict python tests/typing
	$(TEST)/lint-imports --no-cache
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	cargo test --workspace
	$(TEST)/python -m mypy.stubtest rga._core
	$(TEST)/python -m pytest tests --pyargs rga rga_bench --numprocesses auto --dist worksteal

# pip fetches maturin into an environment of its own; cargo keeps what it compiled in target/.
wheel:
	rm -rf dist $(fresh)
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "rga needs Python 3.11 or newer")'
	$(PYTHON) -m venv $(fresh)
	$(fresh)/bin/python -m pip wheel --quiet --no-deps --wheel-dir dist .

clean:  ## remove environments, builds and caches
	rm -rf .venv .venv-dev .venv-test dist target .pytest_cache .mypy_cache .ruff_cache \
	  .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
