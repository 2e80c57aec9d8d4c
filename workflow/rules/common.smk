# The run table, and where things lie. Config errors end here, as one sentence each.

import os
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError

from fiberweb import calls, failed, forks, progress, studies, timed
from fiberweb.config import check_folders, load
from fiberweb.engines import ENGINES
from fiberweb.files import SUFFIXES, Files
from fiberweb.folders import tables_in
from fiberweb.layers import check_call, read, typed
from fiberweb.model.scene import SETUPS
from fiberweb.provenance import add_call
from fiberweb.recipes import BEST, Recipes, code, of_card, of_recording
from fiberweb.recorded import findings, recorded
from fiberweb.runs import check, run_table, runs
from fiberweb.written import READ_ALL, broken

# jobs run side by side, and sums in another order by more threads would give other bits
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# a notebook sets another backend, and a locale of ASCII alone hides folders from NetCDF
os.environ.update(MPLBACKEND="agg", PYTHONUTF8="1")
# not every disk has file locks, and files that appear whole under their names need none
os.environ.setdefault("HDF5_USE_FILE_LOCKING", "FALSE")
SETUP_OF = {suffix: setup for setup, suffix in SUFFIXES.items()}  # of a figure


def make_whole(wildcards):
    """Have files that are broken made again, as `--forcerun` would those that are asked for.

    Input function of the jobs that every file hangs on, the first of a call; it gives no files.
    """
    workflow.dag.forcefiles.update(BROKEN)
    return []


def study_runs(study, setup):
    """The runs of a study; those that start from the ridge's best forces wait for them."""
    if studies.waits(study, setup):
        from fiberweb.studies.ridge.best import read_best  # with pandas, which few calls need

        best = read_best(checkpoints.ridge_best.get(setup=setup).output[0])
        return runs(CONFIG, study, setup, best)
    return RECIPES.possible(study, setup)


def under_way():
    """What is to be known of each job that is to run, by its number."""
    return {job.jobid: known(job) for job in workflow.dag.needrun_jobs()}


def known(job):
    run = RUNS.get(job.wildcards.get("run"))
    if run is None:
        return progress.Job(job.rule.name)
    weight = run.expected_seconds if job.rule.name == progress.RUN else 1.0
    return progress.Job(job.rule.name, f"{run.study}, {run.scene.setup}", weight)


try:
    for path in workflow.configfiles:
        read(path)  # as `profiles/default` has it done before Snakemake reads those of the call
    CONFIG = load(config, typed(workflow.config_settings.config))
    RESULTS = CONFIG.results
    FILES = Files(CONFIG)
    RUNS = run_table(CONFIG)
    RECIPES = Recipes(CONFIG, RUNS)
    RECORDED = recorded(CONFIG.recordings)
    BROKEN = {}
    if workflow.is_main_process:  # a job on a cluster need not check again
        check_call()
        check_folders(CONFIG)
        BROKEN = broken(RESULTS, READ_ALL in os.environ)
        check(run for run in RUNS.values() if not Path(FILES.of_run(run, "response.nc")).exists())
except ValueError as error:
    sys.exit(str(error))  # this prints the sentence and nothing else

for sentence in BROKEN.values():
    print(f"{sentence}; it is made again with what rests on it.", file=sys.stderr)


pathvars:
    results=RESULTS,
    logs=f"{RESULTS}/logs",


wildcard_constraints:
    run="[^/]+",  # not every name: there are thousands, and each rule compiles the pattern
    setup="|".join(SUFFIXES),
    suffix="|".join(SUFFIXES.values()),
    table="|".join(FILES.tables),
    figure="|".join(FILES.figures),
    recording="[^/]+",
    shown=r"(tables|figures)/.+",
    engine="|".join(ENGINES),
