# Two commands for everybody: `make demo` and `make test`. Both make their own environment in .venv.

VENV   := .venv
PYTHON ?= python3
BIN    := $(VENV)/bin
# Of the random tests: the same cases for everybody. Others are tried with make test SEED=$$RANDOM.
SEED   ?= 1999
# Where the environment forbids compiled files, as container images do, Python compiles the package anew
# for every command that a test runs: that doubles the time of the tests.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: demo test wheel quick rust python docs bench peers clean tools
.DEFAULT_GOAL := help

help:
	@echo "make demo   build, run the SNECMA beam study, say where its table, picture and files are"
	@echo "make test   build, then all Rust and Python tests, linters and the documentation"
	@echo "make wheel  a wheel in dist, which pip installs where there is no Rust"
	@echo "make quick  build, then the linter and the quick Python tests: one minute after the build"
	@echo "make bench  criterion benchmarks of the core and the speed tables of the package"
	@echo "make peers  the same study with pyHarm-os, in an environment of its own"

# Says what is missing instead of failing half-way.
tools:
	@command -v $(PYTHON) >/dev/null || { \
	  echo "missing: $(PYTHON); install Python 3.11 or later, or name it: make PYTHON=/path/to/python"; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "too old: `$(PYTHON) --version`; Python 3.11 or later is needed: make PYTHON=/path/to/python"; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || { \
	  echo "missing: the venv module of $(PYTHON); on Debian and Ubuntu: apt install python3-venv"; exit 1; }
	@command -v cargo >/dev/null || { \
	  echo "missing: cargo; install Rust 1.85 or later from https://rustup.rs"; exit 1; }

$(BIN)/python: | tools
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip

# The package as a user gets it.
SOURCES := $(shell find core/src bindings/src -name '*.rs') Cargo.toml Cargo.lock \
           core/Cargo.toml bindings/Cargo.toml pyproject.toml
$(VENV)/.installed: $(BIN)/python $(SOURCES) $(shell find python -name '*.py*' -not -name '*.so')
	$(BIN)/python -m pip install --quiet .
	@touch $@

# The package as a developer needs it: editable, with test tools.
$(VENV)/.developed: $(BIN)/python $(SOURCES)
	$(BIN)/python -m pip install --quiet "maturin>=1.8,<2"
	. $(BIN)/activate && maturin develop --release --quiet --extras test,docs
	@touch $@ $(VENV)/.installed

demo: tools $(VENV)/.installed
	$(BIN)/stickslip run examples/snecma-beam/study.toml --out results

# For machines of the same kind as this one, with any Python from 3.11 on.
wheel: tools $(BIN)/python
	$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir dist .
	@ls dist/*.whl

test: tools rust python docs

quick: $(VENV)/.developed
	$(BIN)/ruff check .
	$(BIN)/pytest -n auto --dist loadfile -m "not slow"

rust:
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings
	PROPTEST_RNG_SEED=$(SEED) cargo test --release --workspace

python: $(VENV)/.developed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/pytest -n auto --dist loadfile --hypothesis-seed=$(SEED)

docs: $(VENV)/.developed
	PYTHONPATH=docs $(BIN)/zensical build --strict

bench: $(VENV)/.developed
	cargo bench -p stickslip-core
	$(BIN)/python benchmarks/speed.py
	$(BIN)/python benchmarks/table_4_1.py
	$(BIN)/python benchmarks/rings.py
	$(BIN)/python benchmarks/mistuning_study.py
	$(BIN)/python benchmarks/contacts.py
	$(BIN)/python benchmarks/interfaces.py
	$(BIN)/python benchmarks/joints.py
	$(BIN)/python benchmarks/flutter.py
	$(BIN)/python benchmarks/table_4_1_blade.py

peers: $(VENV)/.developed
	$(BIN)/python benchmarks/speed.py --peers
	$(BIN)/python benchmarks/rings.py --peers
	$(BIN)/python benchmarks/contacts.py --peers

clean:
	rm -rf $(VENV) .peers target site results dist
