# The run table, and where things lie. Config errors end here, as one sentence each.

import sys
from glob import glob
from pathlib import Path

from fiberweb.config import check_folders, load
from fiberweb.runs import SETUPS, STUDIES, example, run_table, runs

SUFFIXES = {"described": "", "published": "-published"}  # of figures
TABLES = {}  # the tables of each study; its rule file adds them


def response(run):
    return f"{RESULTS}/runs/{run.name}/response.nc"


def capacity(run):
    return f"{RESULTS}/runs/{run.name}/capacity.nc"


def capacities(study, setup):
    return [capacity(run) for run in runs(CONFIG, study, setup)]


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
    targets = set(workflow.dag_settings.targets or ["figures"])
    asked = {"published"} & targets | ({"described"} if targets - {"published"} else set())
    scored = {s for s in SETUPS if all(Path(path).exists() for path in capacities(study, s))}
    return [setup for setup in SETUPS if setup in asked | scored]


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
    if workflow.is_main_process:  # a job on a cluster need not check again
        check_folders(CONFIG)
        for run in RUNS.values():
            if not Path(response(run)).exists():
                run.check()
except ValueError as error:
    sys.exit(str(error))  # this prints the sentence and nothing else


pathvars:
    results=RESULTS,
    logs=f"{RESULTS}/logs",
    benchmarks=f"{RESULTS}/benchmarks",


wildcard_constraints:
    run="|".join(RUNS),
    setup="|".join(SETUPS),
    suffix="|".join(SUFFIXES.values()),
