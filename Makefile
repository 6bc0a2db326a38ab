# make demo: renders two scenes; make test: all checks; make bench: measurements; make fuzz: the long run of the program generator;
# make sanitize: the runtime's tests under sanitizers.
# Each works alone in a clean clone: it makes .venv, builds the runtime and installs the project there, editable.

VENV := .venv
PYTHON ?= python3
BIN := $(VENV)/bin
JOBS ?= 2
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
NATIVE := CMakeLists.txt pyproject.toml compiler/optixc/version.py $(shell find runtime_cpp -type f)
INSTALL := $(PIP) install --no-build-isolation --editable

.PHONY: demo test sanitize bench fuzz clean
.DELETE_ON_ERROR:

demo: $(VENV)/ready-examples
	$(BIN)/python examples/demo.py

test: $(VENV)/ready-test
	$(BIN)/ruff check .
	MYPYPATH=compiler $(BIN)/mypy --strict -p optixc
	PYTHON=$(BIN)/python CMAKE=$(abspath $(BIN))/cmake tests/runtime/run.sh plain
	$(BIN)/python -m pytest -q -n $(JOBS) --dist worksteal

bench: $(VENV)/ready-bench
	$(BIN)/python -m benchmarks

# The runtime's C++ tests again, under AddressSanitizer with UBSan and under ThreadSanitizer.
sanitize: $(VENV)/ready-test
	PYTHON=$(BIN)/python CMAKE=$(abspath $(BIN))/cmake tests/runtime/run.sh address thread

fuzz: $(VENV)/ready-test
	$(BIN)/python -m pytest tests/property --fuzz

clean:
	rm -rf $(VENV) build

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "optixc needs Python 3.11 or newer; $(PYTHON) is older. Try: make PYTHON=python3.11 ..."; exit 1; }
	@$(PYTHON) -c 'import ensurepip' 2>/dev/null || \
	  { echo "$(PYTHON) has no ensurepip, so it cannot make a virtual environment. Debian: apt-get install python3-venv"; exit 1; }
	$(PYTHON) -m venv $(VENV)

# Build tools come from PyPI into the environment itself, so that building again is quick.
$(VENV)/tools: $(VENV)/bin/python
	$(PIP) install "scikit-build-core>=0.11" "cmake>=3.24" ninja
	@touch $@

$(VENV)/ready: $(VENV)/tools $(NATIVE)
	@mkdir -p build
	PATH="$(abspath $(BIN)):$$PATH" $(INSTALL) .
	@touch $@

$(VENV)/ready-examples: $(VENV)/ready
	PATH="$(abspath $(BIN)):$$PATH" $(INSTALL) ".[examples]"
	@touch $@

$(VENV)/ready-test: $(VENV)/ready
	PATH="$(abspath $(BIN)):$$PATH" $(INSTALL) ".[examples,test]"
	@touch $@

$(VENV)/ready-bench: $(VENV)/ready
	PATH="$(abspath $(BIN)):$$PATH" $(INSTALL) ".[examples,bench]"
	@touch $@
