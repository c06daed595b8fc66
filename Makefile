# make figures: run the book, render its films and build its report.  make test: all tests.  make docs: the manual.
# All set up everything they need, by a Python of their own choice; PYTHON=... chooses another.
PYTHON ?=
BIN := .venv/bin
EXTRAS ?= dev,docs

.PHONY: figures test check docs lint lock measure bench mutation wheel clean

figures: .venv/ready
	$(BIN)/dexrepro run
	$(BIN)/dexrepro render
	$(BIN)/dexrepro report

test: lint
	$(BIN)/python -m pytest -n auto

lint: .venv/ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

check: .venv/ready
	$(BIN)/dexrepro check

# The manual, results/docs/index.html: a link to nowhere or a tutorial that fails is an error.
docs: .venv/ready
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet docs results/docs

# .ci/lock.txt anew from pyproject.toml, versions as they are; UPGRADE="-P NAME" raises one, UPGRADE=-U all.
lock: .venv/ready
	.venv/uv/bin/uv --version >/dev/null 2>&1 || ($(BIN)/python -m venv .venv/uv && .venv/uv/bin/python -m pip install -q uv)
	{ head -1 .ci/lock.txt; .venv/uv/bin/uv pip compile -q $(foreach extra,dev docs slurm,--extra $(extra)) --generate-hashes \
	    --python-version 3.11.5 --python-platform x86_64-manylinux_2_28 --no-header --no-annotate $(UPGRADE) \
	    $(if $(UPGRADE),,-c .ci/lock.txt) pyproject.toml; } > .venv/lock.txt && mv .venv/lock.txt .ci/lock.txt

# What the two commands take, for the README: on a machine that does nothing else.   make measure PARTS=figures
measure: .venv/ready
	.ci/measure $(PARTS)

bench: .venv/bench
	$(BIN)/python -m pytest tests/bench -q -s -p no:xdist -o python_files='bench_*.py'

# Wrong laws that the tests have to notice: make mutation PLACES="control/holding networks" SHARE=1; the score: docs/mutation.md
PLACES ?= control primitives networks robots physics
SHARE ?= 0.25
mutation: .venv/ready
	$(BIN)/python tests/mutation/mutate.py $(PLACES) --share $(SHARE) --write

# What is uploaded: built, checked, installed into an empty environment and run from an empty folder.
wheel: .venv/ready
	rm -rf dist
	$(BIN)/python -m build
	$(BIN)/python -m twine check --strict dist/*
	.ci/try-wheel dist/*.whl

.venv/ready: pyproject.toml .ci/lock.txt .ci/environment
	.ci/environment $(EXTRAS) $(PYTHON)
	touch $@

.venv/bench: .venv/ready
	.ci/environment $(EXTRAS),bench $(PYTHON)
	touch $@

clean:
	rm -rf .venv dist results/chapter* results/runs results/report results/docs results/.cache
