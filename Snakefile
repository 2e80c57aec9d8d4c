# Regenerates the paper: warmup -> one `simulate` a scene -> one `capacity` a scene -> tables,
# figures and the claims.
#
#   snakemake --cores 2 figures      the paper's text (setup `described`)
#   snakemake --cores 2 published    the authors' code (setup `published`)
#   snakemake published --profile profiles/slurm --config published_all=True     all the authors' runs
#   snakemake --cores 2 topology     one study alone
#   snakemake --cores 2 compliant    the same with crossings that give (setup `compliant`)
#   snakemake --cores 2 recordings   a score card of each recording that the config lists

import atexit
import os
import shlex
import sys

from snakemake.utils import min_version

min_version("9.27")
# Snakemake writes the interpreter's path into shell commands as it is, and it may have a blank.
PYTHON = sys.executable
sys.executable = shlex.quote(PYTHON)


# beside this file, wherever Snakemake is called from
configfile: os.path.relpath(os.path.join(workflow.basedir, "config", "config.yaml"))


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/inputs.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/capacity.smk"
include: "workflow/rules/study.smk"
include: "workflow/rules/buckling.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/report.smk"


for setup in SETUPS:

    rule:
        name:
            {"described": "figures"}.get(setup, setup)
        default_target: setup == "described"
        input:
            FILES.products(setup),

    rule:
        name:
            f"report_{setup}"
        input:
            FILES.reported(setup),
            # written by every call that makes something, so it is there once the rest is
            ancient(report(lambda _: FILES.calls(), category="Provenance")),


for study in studies.STUDIES:
    if studies.setups(study):

        rule:
            name:
                study
            input:
                FILES.drawn(study, studies.setups(study)[0]),


onstart:
    # The limit on new jobs a second starts a timer at every pass of the scheduler, each of which
    # ends in another pass: a third of a core after some hundred jobs.
    workflow.scheduler.job_rate_limiter = None
    # of few jobs it takes longer than it saves
    if workflow.local_exec and len([*workflow.dag.needrun_jobs()]) > 8:
        workflow.forks = forks.start(PYTHON, RESULTS)
        if workflow.forks:
            sys.executable = forks.interpreter(PYTHON)
    workflow.progress = progress.Progress(RESULTS, under_way)
    logger.addHandler(workflow.progress)
    # commit and versions, of no use to a rule: they must not change tables nor cause reruns
    add_call(RESULTS, workflow.config_settings.configfiles)
    workflow.call = calls.begin(sys.argv[1:], workflow.overwrite_workdir)


onsuccess:
    workflow.call.unlink(missing_ok=True)
    done = list(workflow.dag.finished_jobs)
    read = [job for job in done if job.rule.name == "recording"]
    for line in findings({job.wildcards.recording: job.output.sanity for job in read}):
        print(line)
    workflow.progress.write(progress.FINISHED)
    timed.write(RESULTS, "snakemake")
    print(f"Done: {FILES.counted(file for job in done for file in job.output)}.")


onerror:
    print("No finished run is lost: without the cause below, `make resume` goes on from here.")
    # after what Snakemake itself still says
    atexit.register(failed.tell, workflow.scheduler.failed, RUNS)
    workflow.progress.write(progress.FAILED)
    timed.write(RESULTS, "snakemake")
