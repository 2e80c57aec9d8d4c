"""Signals of one run in the order of forward selection."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.studies.features import tables as features

to_log(snakemake.log[0])
made = features.greedy_table(snakemake.input.response, **snakemake.params)
tables.write(made, snakemake.output[0])
