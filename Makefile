# Everything needs Python 3.11 or newer and make; the rest is put into .venv.
# Overrides: make figures CORES=8, make test PYTHON=python3.12, and for the claims about the authors'
# own tables (G1 to G3) make published TABLES=folder

PYTHON ?= python3
CORES ?= 2

VENV := .venv
STAMP := $(VENV)/.installed
SNAKEMAKE := $(VENV)/bin/snakemake
AUTHORS := $(if $(TABLES),--config published_tables=$(TABLES))

# what the workflow starts as `python` is the one in .venv
export PATH := $(CURDIR)/$(VENV)/bin:$(PATH)

.DEFAULT_GOAL := help
.PHONY: help figures published published_all accuracy smoke test docs bench env clean

help: ## list these targets
	@awk -F ':.*## ' '/^[a-z_]+:.*## / {printf "make %-13s %s\n", $$1, $$2}' Makefile

# Targets stand before the options: an option that takes a list swallows them.
figures: $(STAMP) ## every figure of the paper and the claims table
	$(SNAKEMAKE) figures --cores $(CORES) $(AUTHORS)

published: $(STAMP) ## the same, set up as the authors' code was
	$(SNAKEMAKE) published --cores $(CORES) $(AUTHORS)

published_all: $(STAMP) ## the same with every run of the authors: for a cluster, or a night
	$(SNAKEMAKE) published --cores $(CORES) --config published_all=True $(TABLES:%=published_tables=%)

docs: $(STAMP) ## the tables of numbers in docs/, from results/tables
	$(VENV)/bin/python -m fiberweb.tools.docs

accuracy: $(STAMP) ## error against cost, the model ladder and the limits of the step
	$(SNAKEMAKE) accuracy --cores $(CORES)

smoke: $(STAMP) ## every figure from small, short runs, about two minutes
	$(SNAKEMAKE) figures --cores $(CORES) --configfile config/smoke.yaml

test: $(STAMP) ## the tests
	$(VENV)/bin/python -m pytest

bench: $(STAMP) ## what a run and a job cost on this machine
	$(VENV)/bin/python -m fiberweb.tools.bench

env: $(STAMP) ## .venv alone, from envs/requirements.lock

clean: ## remove .venv and the caches; results stay
	rm -rf $(VENV) .pytest_cache .hypothesis .ruff_cache

# The stamp comes last: an install that failed or was interrupted has none, and
# the next make starts again from nothing, as it does after the lock changed.
$(STAMP): envs/requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	    echo "fiberweb needs Python 3.11 or newer, but $(PYTHON) is: $$($(PYTHON) --version 2>&1)." \
	        "Name another one, as in: make test PYTHON=python3.12" >&2; exit 1; }
	@echo "Installing envs/requirements.lock into $(VENV): about a minute, 1 GB."
	@rm -rf $(VENV)
	@$(PYTHON) -m venv $(VENV)
	@$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check \
	    --require-hashes --requirement envs/requirements.lock
	@touch $@
