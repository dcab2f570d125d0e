# One definition of every check, for a developer and for CI: `make help` lists the targets.
PYTHON ?= python3
DEV := .venv-dev/bin
# Modules are compiled when they are imported: few of those of torch ever are.
INSTALL := -m pip install --quiet --no-compile
# What the wheel is made of; a folder is newer when something in it was removed.
SOURCES := pyproject.toml Cargo.toml Cargo.lock README.md LICENSE \
  $(shell find rust python -name __pycache__ -prune -o -type d -print -o \
    -type f -not -name '_core*.so' -print)

.DEFAULT_GOAL := help
.PHONY: help run live dev quick docs test thorough crates lint tests clean wheel environment installed

# What is compiled on import is kept, whatever the environment says: tests begin hundreds of processes.
export PYTHONDONTWRITEBYTECODE =

# Every core has its process of the tests: products in several threads would wait for each other.
quick tests thorough: export OMP_NUM_THREADS = 1

help:  ## show this list
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /\1\t/' | expand -t 8

run: fresh = .venv
run: wheel  ## build and install rga in a fresh environment, and run the twin of the case study
	$(fresh)/bin/python $(INSTALL) "$$(echo dist/rga-*.whl)[twin]"
	$(fresh)/bin/python examples/case_study.py

live: fresh = .venv
live: wheel  ## build and install rga, and watch a served twin of a bridge in which something happens
	$(fresh)/bin/python $(INSTALL) "$$(echo dist/rga-*.whl)[serve]"
	$(fresh)/bin/python examples/live_bridge.py

dev:  ## once, and after a change of Rust: an environment that uses the sources as they are
	$(PYTHON) -m venv .venv-dev
	$(DEV)/python -m pip install --quiet --editable ".[test]"

quick:  ## lint, types and unit tests in the environment of `make dev`, within a minute
	$(DEV)/ruff check
	$(DEV)/ruff format --check
	$(DEV)/mypy --strict python tests/typing
	$(DEV)/lint-imports
	$(DEV)/python -m pytest tests/unit --quiet --numprocesses auto --dist worksteal

thorough:  ## all tests, those at full length as well, in the environment of `make dev`: about half an hour
	$(DEV)/python -m pytest tests --pyargs rga rga_bench -m "" --numprocesses auto --dist worksteal

docs:  ## the pages of docs as a site that needs no network: site/index.html
	$(DEV)/sphinx-build -W --keep-going --quiet -b html docs site

test: fresh = .venv-test
test:  ## build and install rga in a fresh environment, and run every check but those at full length
	$(MAKE) --jobs 2 fresh=$(fresh) crates installed
	$(MAKE) --jobs 2 fresh=$(fresh) tests lint

crates: export PYO3_PYTHON = $(PYTHON)
# Nobody steps through what is compiled here, and nothing of it is compiled again.
crates: export CARGO_PROFILE_DEV_DEBUG = 0
crates: export CARGO_INCREMENTAL = 0
# Clippy compiles what the tests then run, so that what they depend on is compiled once for both.
crates: export RUSTC_WORKSPACE_WRAPPER = clippy-driver
crates: export RUSTFLAGS = -D warnings
# The binding is linked as it is in the wheel: without a library of Python.
crates: export PYO3_BUILD_EXTENSION_MODULE = 1
crates:  ## every check of the Rust code
	cargo fmt --all --check
	cargo build --workspace --lib --tests --benches
	cargo test --workspace

installed: wheel
	$(fresh)/bin/python $(INSTALL) "$$(echo dist/rga-*.whl)[test]"

lint:  ## style, types and imports of the Python package, by the environment fresh=DIR
	$(fresh)/bin/ruff check
	$(fresh)/bin/ruff format --check
	$(fresh)/bin/mypy --strict python tests/typing
	$(fresh)/bin/lint-imports --no-cache
	$(fresh)/bin/python -m mypy.stubtest rga._core

tests:  ## the tests of the Python package that is installed in the environment fresh=DIR
	$(fresh)/bin/python -m pytest tests --pyargs rga rga_bench --numprocesses auto --dist worksteal

wheel: environment dist/built

environment:
	rm -rf $(fresh)
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "rga needs Python 3.11 or newer")'
	$(PYTHON) -m venv $(fresh)

# Built anew where a source is newer. pip fetches maturin into an environment of its own; cargo
# keeps what it compiled in target/.
dist/built: $(SOURCES) | environment
	rm -rf dist
	$(fresh)/bin/python -m pip wheel --quiet --no-deps --wheel-dir dist .
	touch $@

clean:  ## remove environments, builds and caches
	rm -rf .venv .venv-dev .venv-test dist site target .pytest_cache .mypy_cache .ruff_cache \
	  .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
