# Everything needs Python 3.11 or newer and make; the rest is put into .venv.
# Overrides: make figures CORES=8, make test PYTHON=python3.12, and for the claims about the authors'
# own tables (G1 to G3) make published TABLES=folder; of the report, what it is of, the config laid
# over config/config.yaml and where it goes:
# make report SHOWN="report_described report_published" CONFIG=my.yaml REPORT=results/mine/report

PYTHON ?= python3
CORES ?= 2
SHOWN ?= report_described
REPORT ?= results/report

VENV := .venv
STAMP := $(VENV)/.installed
SNAKEMAKE := $(VENV)/bin/snakemake
VENV_0_3_2 := .venv-0.3.2
STAMP_0_3_2 := $(VENV_0_3_2)/.installed
VENV_SLURM := .venv-slurm
STAMP_SLURM := $(VENV_SLURM)/.installed
VENV_REPORT := .venv-report
STAMP_REPORT := $(VENV_REPORT)/.installed
AUTHORS := $(if $(TABLES),--config 'published_tables=$(TABLES)')
LAID := $(if $(CONFIG),--configfile '$(CONFIG)') $(AUTHORS)

# what the workflow starts as `python` is the one in .venv
export PATH := $(CURDIR)/$(VENV)/bin:$(PATH)

# Snakemake does not start without a home folder that can be written, nor without a name for the
# user; in some containers there is neither.
ifneq ($(shell test -n "$$HOME" -a -w "$$HOME" && echo yes),yes)
    export HOME := $(CURDIR)/.snakemake/home
endif
export LOGNAME ?= $(shell id -u)

.DEFAULT_GOAL := help
.PHONY: $(shell sed -n 's/^\([a-z][a-z_-]*\):.*/\1/p' $(firstword $(MAKEFILE_LIST)))

help: ## list these targets
	@awk -F ':.*## ' '/^[a-z_-]+:.*## / {printf "make %-13s %s\n", $$1, $$2}' Makefile

# Targets stand before the options: an option that takes a list swallows them.
figures: $(STAMP) ## every figure of the paper and the claims table
	$(SNAKEMAKE) figures --cores $(CORES) $(AUTHORS)

published: $(STAMP) ## the same, set up as the authors' code was
	$(SNAKEMAKE) published --cores $(CORES) $(AUTHORS)

published_all: $(STAMP) ## the same with every run of the authors: for a cluster, or a night
	$(SNAKEMAKE) published --cores $(CORES) --config published_all=True $(if $(TABLES),'published_tables=$(TABLES)')

docs: $(STAMP) ## the tables of numbers in docs/, from results/tables
	$(VENV)/bin/python -m fiberweb.tools.docs

compliant: $(STAMP) ## the studies of the paper, with crossings that give
	$(SNAKEMAKE) compliant --cores $(CORES)

accuracy: $(STAMP) ## error against cost, the model ladder and the limits of the step
	$(SNAKEMAKE) accuracy --cores $(CORES)

resume: $(STAMP) ## go on with the last call that was killed, stopped or failed
	$(VENV)/bin/python -m fiberweb.tools.resume $(if $(filter command,$(firstword $(origin CORES))),--cores $(CORES))

smoke: $(STAMP) ## every figure from small, short runs, about two minutes
	$(SNAKEMAKE) figures --cores $(CORES) --configfile config/smoke.yaml

report: $(STAMP) ## figures, tables, claims and provenance as report.html and report.zip in results/
	$(SNAKEMAKE) $(SHOWN) --cores $(CORES) $(LAID)
	$(SNAKEMAKE) $(SHOWN) $(LAID) --report-stylesheet workflow/report/style.css \
	    --report '$(REPORT).html'
	$(SNAKEMAKE) $(SHOWN) $(LAID) --report-stylesheet workflow/report/style.css \
	    --report '$(REPORT).zip'

test: $(STAMP) ## the tests
	$(VENV)/bin/python -m pytest --numprocesses $(CORES) --dist loadfile --no-loadscope-reorder

test-anywhere: $(STAMP) ## odd folders, read-only clones, locales, other Pythons: 20 minutes
	ANYWHERE=1 $(VENV)/bin/python -m pytest -rs tests/anywhere

fuzz: $(STAMP) ## ten thousand configs and ten thousand recordings, most of them broken: 4 minutes
	$(VENV)/bin/python -m pytest --numprocesses $(CORES) tests/fuzz --hypothesis-profile fuzz

random_scenes: $(STAMP) ## what becomes of 10 000 random scenes: 6 minutes
	$(VENV)/bin/python -m fiberweb.tools.random_scenes

test-faults: $(STAMP) ## what is killed, full, damaged or shared, for real: 40 minutes
	FAULTS=1 $(VENV)/bin/python -m pytest --numprocesses $(CORES) -rs tests/faults

test-slurm: $(STAMP_SLURM) ## the workflow through a SLURM on this machine: Debian, as root
	PYTHONPATH=. $(VENV_SLURM)/bin/python -m pytest --capture no tests/slurm

test_authors: $(STAMP_0_3_2) ## published setup against the PyElastica the authors ran: 4 minutes
	PYTHONPATH=. $(VENV_0_3_2)/bin/python -m pytest --confcutdir tests/authors tests/authors

test-report: smoke $(STAMP_REPORT) ## report in Chromium, metadata by their own checkers: 15 minutes
	PYTHONPATH=. $(VENV_REPORT)/bin/python -m pytest --confcutdir tests/report tests/report

reproduce: $(STAMP) ## one run again from its own file, compared: make reproduce RUN=name-or-file
	$(VENV)/bin/python -m fiberweb.tools.reproduce $(if $(RUN),'$(RUN)')

crate: $(STAMP_REPORT) ## results as a Workflow Run RO-Crate, described by ro-crate-metadata.json
	PYTHONPATH=. $(VENV_REPORT)/bin/python -m fiberweb.tools.crate '$(or $(RESULTS),results)'

certificates: $(STAMP) ## whom certificates accuse: 236 scenes, over an hour
	$(VENV)/bin/python -m fiberweb.tools.certificates

bench: $(STAMP) ## what a run and a job cost on this machine
	$(VENV)/bin/python -m fiberweb.tools.bench

env: $(STAMP) ## .venv alone, from envs/requirements.lock

status: $(STAMP) ## how far the workflow is, from another terminal
	@$(VENV)/bin/python -m fiberweb.tools.status

clean: ## remove what was installed and the caches; results stay
	rm -rf $(VENV) $(VENV_0_3_2) $(VENV_SLURM) $(VENV_REPORT) .pytest_cache .hypothesis .ruff_cache

# What is called with a folder and a lock file.
define install
	@echo "Installing $(2) into $(1): about a minute, 1 GB."
	@rm -rf $(1)
	@$(PYTHON) -m venv $(1)
	@$(1)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes \
	    --requirement $(2)
	@touch $(1)/.installed
endef

# The stamp comes last: an install that failed or was interrupted has none, and
# the next make starts again from nothing, as it does after the lock changed.
$(STAMP): envs/requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	    echo "fiberweb needs Python 3.11 or newer, but $(PYTHON) is: $$($(PYTHON) --version 2>&1)." \
	        "Name another one, as in: make test PYTHON=python3.12" >&2; exit 1; }
	$(call install,$(VENV),$<)

$(STAMP_SLURM): envs/slurm.lock envs/requirements.lock
	$(call install,$(VENV_SLURM),$<)

$(STAMP_REPORT): envs/report.lock
	$(call install,$(VENV_REPORT),$<)

# The NumPy and Numba that PyElastica 0.3.2 needs end with Python 3.11.
$(STAMP_0_3_2): envs/pyelastica-0.3.2.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null || { \
	    echo "PyElastica 0.3.2 needs Python 3.11, but $(PYTHON) is: $$($(PYTHON) --version 2>&1)." \
	        "Name that one, as in: make test_authors PYTHON=python3.11" >&2; exit 1; }
	$(call install,$(VENV_0_3_2),$<)
