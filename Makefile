# Everything happens in a virtual environment of its own; nothing is asked of the system but
# Python 3.11 or newer and make.

PYTHON ?= python3
VENV ?= .venv
JOBS ?= 2
BIN := $(VENV)/bin
READY := $(VENV)/.ready
MISSION := missions/nine_point_half_cell.yaml
RUN := reports/nine-point-half-cell/tilt_rotor_hexarotor-seed1

.PHONY: demo test lint format regress bench clean

# Plan, fly and report the nine-point half-cell mission.
demo: $(READY)
	$(BIN)/inspect plan $(MISSION)
	$(BIN)/inspect fly $(MISSION) --seed 1
	$(BIN)/inspect report $(RUN)

test: $(READY)
	$(BIN)/python -m pytest -n $(JOBS) --dist loadgroup

lint: $(READY)
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	$(BIN)/codespell

# Turn the code into the project's form.
format: $(READY)
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

# Fly every mission with every seed and compare with reports/reference/.
regress: $(READY)
	$(BIN)/inspect regress --jobs $(JOBS)

# Measure what has a limit; writes reports/bench.json.
bench: $(READY)
	$(BIN)/python -m tests.bench

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[dev]"
	@touch $@

clean:
	rm -rf $(VENV) build dist *.egg-info .mypy_cache .ruff_cache .pytest_cache
