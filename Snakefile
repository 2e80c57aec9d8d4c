# Regenerates the paper: warmup -> one `simulate` a scene -> one `capacity` a scene -> tables,
# figures and the claims.
#
#   snakemake --cores 2 figures      the paper's text (setup `described`)
#   snakemake --cores 2 published    the authors' code (setup `published`)
#   snakemake published_all --profile profiles/slurm      every run of the authors, on a cluster
#   snakemake --cores 2 topology     one study alone
#   snakemake --cores 2 claims       only the table of the paper's claims
#   snakemake --cores 2 accuracy     error against cost, and limits of the step (some 12 minutes)

import subprocess
import sys

from snakemake.utils import min_version

min_version("9.27")


configfile: "config/config.yaml"


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/capacity.smk"
include: "workflow/rules/topology.smk"
include: "workflow/rules/studies.smk"
include: "workflow/rules/noise.smk"
include: "workflow/rules/robustness.smk"
include: "workflow/rules/chaos.smk"
include: "workflow/rules/narma.smk"
include: "workflow/rules/buckling.smk"
include: "workflow/rules/features.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/accuracy.smk"


rule figures:
    default_target: True
    input:
        [figure(study, "described") for study in DRAWN],
        ANIMATIONS,
        lambda wildcards: merged(),
        rules.claims.output,


rule published:
    input:
        [figure(study, "published") for study in DRAWN if "published" in STUDY_SETUPS[study]],
        lambda wildcards: merged(),
        rules.claims.output,


rule published_all:
    input:
        rules.published.input,


onstart:
    # commit and versions, of no use to a rule: they must not change tables nor cause reruns
    subprocess.run([sys.executable, "workflow/scripts/provenance.py", RESULTS], check=True)


onsuccess:
    print(f"Done: figures in {RESULTS}/figures, tables in {RESULTS}/tables;")
    print(f"{RESULTS}/tables/claims.csv holds each claim of the paper against them.")
    # whether the described setup's defaults are still the grid's best
    if "figures" in targets():
        grid = f"{RESULTS}/tables/described/calibration.csv"
        subprocess.run([sys.executable, "-m", "fiberweb.studies.calibration.tables", grid], check=False)
