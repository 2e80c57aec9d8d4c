"""Capacities against readout noise in one setup."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.studies.noise import tables as noise

to_log(snakemake.log[0])
tables.write(noise.table(snakemake.input.responses, **snakemake.params), snakemake.output[0])
