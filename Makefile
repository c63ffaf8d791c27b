.DEFAULT_GOAL := help
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
PYTEST := $(BIN)/pytest -n 2 --dist worksteal
NATIVE := $(wildcard packages/fdvv/src/fdvv/_native/*.[ch] firmware/core/*.[ch] firmware/force_loop/*.[ch] firmware/boards/host/*.[ch])

LIBRARY := $(if $(filter Darwin,$(shell uname -s)),libfdvv.dylib,libfdvv.so)

# matrices here are small: threads of BLAS would only wait for each other
export OPENBLAS_NUM_THREADS ?= 1

# without bytecode every test process compiles all it imports: 20 s to collect the tests alone
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help demo lock quick test test-slow test-browser test-clock campaign check format bench setup firmware firmware-tools docs web web-check web-tools sdist wheel zig-tools lowest newcomer clean

help: ## Show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 16

setup: $(VENV)/.ready packages/fdvv/src/fdvv/_native/$(LIBRARY) ## Make the virtual environment and build the C kernels

$(VENV)/.ready: pyproject.toml $(wildcard packages/*/pyproject.toml extras/*/pyproject.toml) requirements.lock packages/fdvv/hatch_build.py tools/setup.sh
	bash tools/setup.sh "$(PYTHON)" "$(VENV)"
	@touch $@

# the library, and the Python tables of the protocol
packages/fdvv/src/fdvv/_native/$(LIBRARY): $(VENV)/.ready $(NATIVE) protocol/fdvv.toml protocol/force_loop.toml tools/make_protocol.py packages/fdvv/hatch_build.py
	$(BIN)/python packages/fdvv/hatch_build.py

demo: setup ## Fit, compensate on the simulated rig and write demo/report.html
	$(BIN)/fdvv demo --output demo

check: setup ## Format, lint, types, words, reasons, layers and the budget
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python -m tools.check_words
	$(BIN)/python -m tools.check_sentences
	$(BIN)/python -m tools.check_reasons
	$(BIN)/lint-imports --no-logo || { echo 'An import points up. Move the shared record down, or pass in a callable: see ARCHITECTURE.md.' >&2; exit 1; }
	$(BIN)/python -m tools.check_budget

# the packages with changes that are not committed, else model; make quick PKG="rendering live" picks others
PKG ?= $(or $(shell git diff --name-only HEAD -- packages | sed -n 's#^packages/[^/]*/src/[^/]*/\([a-z]*\)/.*#\1#p' | sort -u),model)
PACKAGES := $(sort $(filter-out __pycache__,$(notdir $(patsubst %/,%,$(wildcard packages/*/tests/*/ tests/*/)))))
tests_of = $(wildcard packages/*/tests/$(1) tests/$(1))
# of those that were asked for; a changed package may have no tests of its own
UNTESTED = $(if $(filter-out file,$(origin PKG)),$(strip $(foreach name,$(PKG),$(if $(call tests_of,$(name)),,$(name)))))

quick: setup ## Lint, and test one package, in 20 seconds: make quick PKG=rendering
	$(if $(UNTESTED),$(error no tests of $(firstword $(UNTESTED)); packages are $(PACKAGES)))
	$(BIN)/ruff check --quiet .
	FDVV_QUICK=1 $(BIN)/pytest -n 2 -q -p no:randomly -m "not slow and not browser and not firmware and not clock" \
	  tests/test_public_face.py tests/safety/test_zero_force.py $(foreach name,$(PKG),$(call tests_of,$(name)))

# MARKS="not browser and not clock" is the long ones too: each process collects all tests first, which takes it 12 s
MARKS ?= not slow and not browser and not clock

test: check ## Every check and every test of the default run
	$(PYTEST) --durations 25 -m "$(MARKS)"

test-slow: setup ## The long tests
	$(PYTEST) --durations 25 -m "slow and not browser and not clock"

test-clock: setup web-tools ## The tests that compare real times, one after the other
	$(BIN)/pytest -m clock $(shell grep -rl --include='*.py' 'pytest.mark.clock' tests packages)

campaign: setup ## Every case of the random tests of which the other runs play a part: hours
	FDVV_CAMPAIGN=1 $(PYTEST) --timeout 14400 --durations 25 -m campaign

lock: setup ## Write the hashes of what constraints.txt names, for every system, into requirements.lock
	$(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --upgrade constraints.txt -o requirements.lock

test-browser: setup web-tools ## Drive the studio in a real browser
	$(PYTEST) -m "browser and not clock"

format: setup ## Format the code in place
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

bench: setup ## Time fits, scans and the twin beside plain SciPy
	$(BIN)/python -m benchmarks

docs: setup ## Build the site of the documents into build/site
	$(BIN)/python -m tools.make_site

firmware-tools: ## Install the cross compilers and the emulator of the boards
	bash tools/firmware_tools.sh build

firmware: firmware-tools ## Build the boards' programs into build/firmware
	$(MAKE) --no-print-directory -C firmware BUILD="$(CURDIR)/build/firmware"

web-tools: ## Install the browser and the tools that build and test the studio's page
	bash tools/web_tools.sh

web: setup web-tools ## Check, test and build the studio's page into packages/fdvv-studio/src/fdvv_studio/studio/static
	cd web && PYTHON=$(BIN)/python npm run --silent check && npm test --silent && npm run --silent build

web-check: web ## The same, and the committed page must be that of the sources
	git diff --exit-code --stat -- packages/fdvv-studio/src/fdvv_studio/studio/static
	test -z "$$(git status --porcelain -- packages/fdvv-studio/src/fdvv_studio/studio/static)"

# the same sources, the same bytes
sdist wheel: export SOURCE_DATE_EPOCH ?= $(shell git log -1 --format=%ct 2>/dev/null || echo 1580601600)

sdist: build/tools/.ready ## Build the sdists into dist/
	for package in packages/*/; do build/tools/bin/python -m build --sdist --outdir dist "$$package"; done

wheel: build/tools/.ready ## Build the sdists, and from them the wheels of this machine, those of the extras too, into dist/
	for package in packages/*/ extras/*/; do build/tools/bin/python -m build --outdir dist "$$package"; done

build/tools/.ready:
	$(PYTHON) -m venv build/tools
	build/tools/bin/python -m pip install --quiet --disable-pip-version-check build
	@touch $@

zig-tools: ## Install the compiler that pip has, for builds on machines without one and for other systems
	test -x build/zig/bin/python || $(PYTHON) -m venv build/zig
	build/zig/bin/python -m pip install --quiet --disable-pip-version-check ziglang

lowest: setup ## Test with the lowest versions of what fdvv depends on
	bash tools/lowest_versions.sh "$(PYTHON)"

newcomer: ## Type what the README says, in an empty folder and a clean environment
	PYTHON="$(PYTHON)" bash tools/newcomer.sh

clean: ## Remove what was built
	rm -rf $(VENV) build dist demo .mypy_cache .ruff_cache .pytest_cache packages/fdvv/src/fdvv/_native/$(LIBRARY) packages/fdvv/src/fdvv/protocol/tables.py
