.DEFAULT_GOAL := help
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
NATIVE := $(wildcard src/fdvv/_native/*.[ch] firmware/core/*.[ch] firmware/boards/host/*.[ch])

# matrices here are small: threads of BLAS would only wait for each other
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: help demo test check format bench setup firmware firmware-tools docs web web-check web-tools test-browser clean

help: ## Show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 16

setup: $(VENV)/.ready src/fdvv/_native/libfdvv.so ## Make the virtual environment and build the C kernels

$(VENV)/.ready: pyproject.toml constraints.txt hatch_build.py tools/setup.sh
	bash tools/setup.sh "$(PYTHON)" "$(VENV)"
	@touch $@

src/fdvv/_native/libfdvv.so: $(VENV)/.ready $(NATIVE) hatch_build.py
	$(BIN)/python hatch_build.py

demo: setup ## Fit, compensate on the simulated rig and write demo/report.html
	$(BIN)/fdvv demo --output demo

check: setup ## Format, lint and type checks
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

test: check ## Every check and every test of the default run
	$(BIN)/pytest -n 2 -m "not slow and not browser"

test-slow: setup ## The long tests
	$(BIN)/pytest -n 2 --timeout 300 -m "slow and not browser"

test-browser: setup web-tools ## Drive the studio in a real browser
	$(BIN)/pytest -n 2 --timeout 180 -m browser

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

web: web-tools ## Check, test and build the studio's page into src/fdvv/studio/static
	cd web && npm run --silent check && npm test --silent && npm run --silent build

web-check: web ## The same, and the committed page must be that of the sources
	git diff --exit-code --stat -- src/fdvv/studio/static
	test -z "$$(git status --porcelain -- src/fdvv/studio/static)"

clean: ## Remove what was built
	rm -rf $(VENV) build dist demo .mypy_cache .ruff_cache .pytest_cache src/fdvv/_native/*.so
