"""Capacities against the ridge penalty in one setup."""

from logs import to_log

from fiberweb import robustness, tables

to_log(snakemake.log[0])
made = robustness.alphas(snakemake.input.responses, **snakemake.params)
tables.write(made, snakemake.output[0])
