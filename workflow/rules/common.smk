# The run table, and where things lie. Config errors end here, as one sentence each.

import os
import sys
from collections import Counter
from glob import glob
from pathlib import Path

from snakemake.exceptions import WorkflowError

from fiberweb import forks, studies, timed
from fiberweb.config import check_folders, load
from fiberweb.engines import ENGINES
from fiberweb.errors import unknown_key
from fiberweb.layers import check_call, check_keys, typed
from fiberweb.model.scene import SETUPS
from fiberweb.provenance import add_call
from fiberweb.recipes import BEST, Recipes, code, digest_of
from fiberweb.recorded import recorded
from fiberweb.runs import check, run_table, runs
from fiberweb.written import cut_short

# jobs run side by side, and sums in another order by more threads would give other bits
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# a notebook sets its own, without which matplotlib cannot even be imported elsewhere
os.environ.update(MPLBACKEND="agg")
SUFFIXES = {setup: f"-{setup}" for setup in SETUPS} | {"described": ""}  # of figures
SETUP_OF = {suffix: setup for setup, suffix in SUFFIXES.items()}


def make_whole(wildcards):
    """Have files that were cut short made again, as `--forcerun` would those that are asked for.

    Input function of the one job that every file hangs on; it gives no files.
    """
    workflow.dag.forcefiles.update(CUT_SHORT)
    return []


def made():
    """What the jobs of this call made, counted by folder."""
    runs = Path(RESULTS, "runs")
    finished = filter(workflow.dag.finished, workflow.dag.jobs)
    folders = Counter(
        runs if runs in Path(file).parents else Path(file).parent
        for job in finished
        for file in job.output
    )
    counts = [(f"{n} file{'s' * (n > 1)}", folder) for folder, n in sorted(folders.items())]
    return ", ".join(f"{files} in {folder}" for files, folder in counts)


def compiled(engine):
    return f"{RESULTS}/warmup/{engine}.done"


def response(run):
    return f"{RESULTS}/runs/{run.name}/response.nc"


def capacity(run):
    return f"{RESULTS}/runs/{run.name}/capacity.nc"


def certificate(run):
    return f"{RESULTS}/runs/{run.name}/certificate.csv"


def study_runs(study, setup):
    """The runs of a study; those that start from the ridge's best forces wait for them."""
    if studies.waits(study, setup):
        from fiberweb.studies.ridge.best import read_best  # with pandas, which few calls need

        best = read_best(checkpoints.ridge_best.get(setup=setup).output[0])
        return runs(CONFIG, study, setup, best)
    return RECIPES.possible(study, setup)


def table(file, setup):
    """A file of a study's `TABLES`, of a setup; or, of none, one that a rule of its own makes."""
    if file not in (known := [*TABLES, *RECIPES.own, BEST]):
        raise WorkflowError(f"no study makes the table {file}: {unknown_key(file, known)}")
    return f"{RESULTS}/tables/{'' if file in RECIPES.own else f'{setup}/'}{file}"


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
    for path in workflow.configfiles:
        check_keys(path)  # Snakemake read them, and kept the last of two
    CONFIG = load(config, typed(workflow.config_settings.config))
    RESULTS = CONFIG.results
    RUNS = run_table(CONFIG)
    RECIPES = Recipes(CONFIG, RUNS)
    RECORDED = recorded(CONFIG.recordings)
    CUT_SHORT = {}
    if workflow.is_main_process:  # a job on a cluster need not check again
        check_call(sys.argv)
        check_folders(CONFIG)
        CUT_SHORT = cut_short(RESULTS)
        check(run for run in RUNS.values() if not Path(response(run)).exists())
except ValueError as error:
    sys.exit(str(error))  # this prints the sentence and nothing else

for broken in CUT_SHORT.values():
    print(f"{broken}; it is made again with what rests on it.", file=sys.stderr)


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
    recording="[^/]+",
    engine="|".join(ENGINES),
