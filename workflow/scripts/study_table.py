"""Table of one study in one setup: one row a run."""

from logs import to_log

from fiberweb.scoring import tables

to_log(snakemake.log[0])
made = tables.study(snakemake.input.capacities, snakemake.params.choices)
tables.write(made, snakemake.output[0])
