"""What readouts made of the input alone would score in a study."""

from logs import to_log

from fiberweb.scoring import tables

to_log(snakemake.log[0])
made = tables.floors(snakemake.input.response, **snakemake.params.scoring)
tables.write(made, snakemake.output[0])
