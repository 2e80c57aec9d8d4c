# The run table, and where things lie. Config errors end here, as one sentence each.

import hashlib
import os
import sys
from functools import cache
from glob import glob
from pathlib import Path

from snakemake.exceptions import WorkflowError

from fiberweb import source, studies
from fiberweb.config import check_folders, load
from fiberweb.model.scene import SETUPS
from fiberweb.runs import check, run_table, runs

# jobs run side by side, and sums in another order by more threads would give other bits
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
SUFFIXES = {setup: f"-{setup}" for setup in SETUPS} | {"described": ""}  # of figures
SETUP_OF = {suffix: setup for setup, suffix in SUFFIXES.items()}


@cache
def code(script, *names):
    """A file with the digest of a script and of the code that modules or functions depend on.

    As an input it reruns what uses that code when it changed, and not for a touch or a comment.
    """
    asked = hashlib.sha256("+".join(names).encode()).hexdigest()[:8]
    path = Path(RESULTS, "code", f"{script}-{asked}")
    digest = source.digest(*names, script=Path(workflow.basedir, f"workflow/scripts/{script}.py"))
    if workflow.is_main_process and not (path.exists() and path.read_text() == digest):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(digest)
    return str(path)


def response(run):
    return f"{RESULTS}/runs/{run.name}/response.nc"


def capacity(run):
    return f"{RESULTS}/runs/{run.name}/capacity.nc"


def study_runs(study, setup):
    """The runs of a study; those that start from the ridge's best forces wait for them."""
    if setup != "published" and getattr(studies.load(study), "AFTER_RIDGE", False):
        from fiberweb.studies.ridge.best import read_best  # with pandas, which few calls need

        best = read_best(checkpoints.ridge_best.get(setup=setup).output[0])
        return runs(CONFIG, study, setup, best)
    return known_runs(study, setup)


@cache
def known_runs(study, setup):
    return runs(CONFIG, study, setup)


def table(file, setup):
    """A file of a study's `TABLES`, of a setup; or, of none, one that a rule of its own makes."""
    return f"{RESULTS}/tables/{setup}/{file}" if file in TABLES else f"{RESULTS}/tables/{file}"


def figure(name, setup):
    return f"{RESULTS}/figures/{name}{SUFFIXES[setup]}.png"


def drawn(study, setup):
    """All figures and tables of a study in one setup."""
    spec = studies.load(study)
    figures = [figure(name, setup) for name in spec.FIGURES]
    return figures + [table(file, setup) for file in spec.TABLES] + FURTHER.get(study, [])


def products(setup):
    """All figures, tables and claims of one setup."""
    taking_part = [study for study in studies.STUDIES if setup in studies.setups(study)]
    files = [file for study in taking_part for file in drawn(study, setup)]
    return [*files, f"{RESULTS}/tables/{setup}/claims.csv"]


FURTHER = {}  # what rules of its own make of a study
# which study makes a table or a figure
TABLES = studies.makers("TABLES")
FIGURES = studies.makers("FIGURES")

try:
    CONFIG = load(config)
    RESULTS = CONFIG.results
    RUNS = run_table(CONFIG)
    if workflow.is_main_process:  # a job on a cluster need not check again
        check_folders(CONFIG)
        check(run for run in RUNS.values() if not Path(response(run)).exists())
except ValueError as error:
    sys.exit(str(error))  # this prints the sentence and nothing else


pathvars:
    results=RESULTS,
    logs=f"{RESULTS}/logs",
    benchmarks=f"{RESULTS}/benchmarks",


wildcard_constraints:
    run="[^/]+",  # not every name: there are thousands, and each rule compiles the pattern
    setup="|".join(SUFFIXES),
    suffix="|".join(SUFFIXES.values()),
    table="|".join(TABLES),
    figure="|".join(FIGURES),
