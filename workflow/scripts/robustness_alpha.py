"""Capacities against the ridge penalty in one setup."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.studies.robustness import tables as robustness

to_log(snakemake.log[0])
made = robustness.alphas(snakemake.input.responses, **snakemake.params)
tables.write(made, snakemake.output[0])
