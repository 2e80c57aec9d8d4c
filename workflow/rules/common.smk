# The run table, and where things lie. Config errors end here, as one sentence each.

import os
import sys
from glob import glob
from pathlib import Path

from fiberweb.config import check_folders, load
from fiberweb.runs import SETUPS, STUDIES, check, example, run_table, runs

# jobs run side by side, and sums in another order by more threads would give other bits
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
SUFFIXES = {"described": "", "published": "-published"}  # of figures
PUBLISHED = {"published", "published_all"}
TABLES = {}  # the tables of each study; its rule file adds them
FROM_RIDGE = ("size", "pretension")  # studies at the best force that the ridge found


def response(run):
    return f"{RESULTS}/runs/{run.name}/response.nc"


def capacity(run):
    return f"{RESULTS}/runs/{run.name}/capacity.nc"


def ridge_best(setup):
    return f"{RESULTS}/tables/{setup}/ridge_best.csv"


def best_forces(path):
    """What the ridge's checkpoint found, for `runs`."""
    from fiberweb.scoring.tables import read_best  # with xarray and SciPy, a second few calls need to spend

    return read_best(path)


def targets():
    return set(workflow.dag_settings.targets or ["figures"])


def full():
    """Whether every run of the authors is asked for, and not only what two cores afford."""
    return "published_all" in targets()


def study_runs(study, setup):
    """The runs of a study; those that start from the ridge wait for its checkpoint."""
    best = None
    if study in FROM_RIDGE and setup == "described":
        best = best_forces(checkpoints.ridge_best.get(setup=setup).output[0])
    return runs(CONFIG, study, setup, best, full())


def capacities(study, setup):
    return [capacity(run) for run in study_runs(study, setup)]


def responses(study, setup):
    return [response(run) for run in study_runs(study, setup)]


def first_seed(setup):
    """The runs of the first seed of the config's list, one of each size."""
    seed = CONFIG.robustness.seed[0]
    return [run for run in study_runs("robustness", setup) if run.scene.seed == seed]


def verdict_response(setup):
    """The response whose signals are chosen one by one: the run by which claims are judged."""
    force = CONFIG.features.verdict_force
    found = [run for run in study_runs("features", setup) if run.scene.force == force]
    return response(found[0])


def figure(study, setup):
    return f"{RESULTS}/figures/{study}{SUFFIXES[setup]}.png"


def of_setup(name):
    """Input function of a figure: that file of the figure's setup."""
    setup_of = {suffix: setup for setup, suffix in SUFFIXES.items()}
    return lambda wildcards: f"{RESULTS}/tables/{setup_of[wildcards.suffix]}/{name}"


def code(*modules):
    """Files of the package, as `input: code=`: an edit reruns the rule, a touch does not."""
    return sorted(path for module in modules for path in glob(f"fiberweb/{module}"))


def all_tables():
    return [table for tables in TABLES.values() for table in tables]


def setups_at_hand(study):
    """The setups whose rows a table of this study gets.

    A setup takes part if this call of Snakemake asks for it (`published` as a target for the
    one, any other target for the other) or if all its runs are scored on disk already. So `make
    figures` alone does not begin on the published setup; and once `make published` is through,
    both want the same two inputs, keep both up to date, and find nothing to do. Names of runs hash
    their scenes: after a change of the config the other setup's files are not those asked for, and
    it leaves the table until it is asked for again.
    """
    asked = {"published"} if targets() & PUBLISHED else set()
    asked |= {"described"} if targets() - PUBLISHED else set()
    return [s for s in SETUPS if s in STUDY_SETUPS[study] and (s in asked or is_scored(study, s))]


def is_scored(study, setup):
    best = None
    if study in FROM_RIDGE and setup == "described":
        if not (Path(ridge_best(setup)).exists() and is_scored("ridge", setup)):
            return False
        best = best_forces(ridge_best(setup))
    paths = map(capacity, runs(CONFIG, study, setup, best, full()))
    return all(Path(path).exists() for path in paths)


def tables_to_merge():
    """The tables that some setup has rows for."""
    return [table for study, tables in TABLES.items() if setups_at_hand(study) for table in tables]


def merged():
    return [f"{RESULTS}/tables/{table}.csv" for table in tables_to_merge()]


def tables_at_hand(wildcards):
    """Input function of `merge`: the same table of each setup at hand."""
    study = next(study for study, tables in TABLES.items() if wildcards.table in tables)
    return [f"{RESULTS}/tables/{s}/{wildcards.table}.csv" for s in setups_at_hand(study)]


def authors_tables():
    folder = CONFIG.published_tables
    return sorted(glob(f"{folder}/*.csv")) if folder else []


try:
    CONFIG = load(config)
    RESULTS = CONFIG.results
    RUNS = run_table(CONFIG)
    STUDY_SETUPS = {study: [s for s in SETUPS if runs(CONFIG, study, s)] for study in STUDIES}
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
    setup="|".join(SETUPS),
    suffix="|".join(SUFFIXES.values()),
