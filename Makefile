# Everything a developer types. Each target does the set-up that it needs.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.ready

.PHONY: setup demo test test-units test-whole verify-long lint bench bench-protocol recordings page soak audit clean

setup: $(STAMP)

$(STAMP): pyproject.toml hatch_build.py
	$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed, this is %d.%d: make PYTHON=python3.11" % sys.version_info[:2] if sys.version_info < (3, 11) else 0)'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@

page: $(STAMP)
	$(BIN)/python hatch_build.py

demo: page
	$(BIN)/agent-server demo

# Two halves at once: what computes, shown when it is done, and what waits for servers and browsers.
test: $(STAMP)
	$(BIN)/python -m coverage erase
	$(MAKE) --jobs 2 test-units test-whole
	$(BIN)/python -m coverage combine --quiet
	$(BIN)/python -m coverage report --fail-under=90

test-units: UNITS := $(VENV)/units.log
test-units: page
	@$(BIN)/python -m coverage run -m pytest --durations 10 tests/unit > $(UNITS) 2>&1; status=$$?; cat $(UNITS); exit $$status

test-whole: page
	$(BIN)/python -m coverage run -m pytest --durations 10 tests --ignore tests/unit

verify-long: $(STAMP)
	$(BIN)/python -m tests.bench.disconnects --language python --count 1000 --json
	$(BIN)/python -m tests.bench.disconnects --language csharp --count 1000 --json
	$(BIN)/python -m tests.bench.disconnects --language node --count 1000 --json
	$(BIN)/python -m tests.bench.killed_recordings --count 200 --json
	$(BIN)/python -m tests.bench.damaged_recordings --count 500 --fuzz-bytes 10000000 --json
	$(BIN)/agent-server bench replay --runs 100 --json
	$(BIN)/python -m tests.bench.chaos --json
	$(BIN)/python -m tests.bench.bad_input --count 2000000 --json

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/agent-server schema --check

bench: $(STAMP)
	$(BIN)/agent-server bench ingest --json
	$(BIN)/agent-server bench decision --json
	$(BIN)/agent-server bench load --sessions 10 --json
	$(BIN)/agent-server bench replay --json
	$(BIN)/agent-server bench recording --json

bench-protocol: page
	$(BIN)/python -m tests.bench.command_latency --language python --json
	$(BIN)/python -m tests.bench.command_latency --language csharp --json
	$(BIN)/python -m tests.bench.command_latency --language node --json
	$(BIN)/python -m tests.bench.command_latency --language browser --json

# Three minutes by `make soak MINUTES=3`.
soak: MINUTES ?= 30
soak: $(STAMP)
	$(BIN)/python -m tests.bench.soak --minutes $(MINUTES) --sessions 50 --json

# What is installed for users, alone: known vulnerabilities, and a bill of materials.
audit: AUDIT := runs/audit
audit: $(STAMP)
	rm -rf $(AUDIT)
	$(PYTHON) -m venv $(AUDIT)/product
	$(AUDIT)/product/bin/python -m pip install --quiet --disable-pip-version-check '.[otel]'
	$(PYTHON) -m venv $(AUDIT)/tools
	$(AUDIT)/tools/bin/python -m pip install --quiet --disable-pip-version-check pip-audit cyclonedx-bom
	$(AUDIT)/tools/bin/cyclonedx-py environment --output-reproducible --output-file $(AUDIT)/sbom.json $(AUDIT)/product/bin/python
	$(AUDIT)/product/bin/python -m pip freeze --exclude agent-server > $(AUDIT)/product.txt
	$(AUDIT)/tools/bin/pip-audit --strict --no-deps --disable-pip --requirement $(AUDIT)/product.txt

recordings: $(STAMP)
	$(BIN)/python recorded_streams/make.py

clean:
	rm -rf $(VENV) dist build runs .coverage* agent_server/web/dist agent_server/web/node_modules
