"""The best unbuckled force of each spacing."""

from logs import to_log

from fiberweb.scoring import tables

to_log(snakemake.log[0])
tables.write(tables.best_unbuckled(tables.read(snakemake.input.ridge)), snakemake.output[0])
